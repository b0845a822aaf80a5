#include "demo/lab/bench/bench.h"

#include <fmt/format.h>

#include <utility>

#include "demo/lab/bench/bench_crowd.h"

namespace mobil {
namespace {

constexpr std::size_t small_crowd_size = 512;

Result<BenchCrowd*> made_once(std::shared_ptr<BenchCrowd>& crowd, std::size_t humans) {
  if (crowd == nullptr) {
    auto made = BenchCrowd::make(humans);
    if (!made) return tl::unexpected(made.error());
    crowd = std::move(*made);
  }
  return crowd.get();
}

}  // namespace

Result<BenchCrowd*> BenchRun::crowd() {
  return made_once(crowd_, humans);
}

Result<BenchCrowd*> BenchRun::small_crowd() {
  if (humans <= small_crowd_size) return nullptr;
  return made_once(small_crowd_, small_crowd_size);
}

BenchResult& BenchRun::add_time(std::string name, const Measured& time, double items, double unit_s, std::string unit) {
  const double scale = 1 / (items * unit_s);
  BenchResult& result = add_figure(std::move(name), time.best_s * scale, std::move(unit), "");
  result.median = time.median_s * scale;
  if (time.cpu_s) result.cpu = *time.cpu_s * scale;
  return result;
}

BenchResult& BenchRun::add_figure(std::string name, double value, std::string unit, std::string bound) {
  return results.emplace_back(
      BenchResult{.name = std::move(name), .value = value, .unit = std::move(unit), .bound = std::move(bound)});
}

std::string at_peak(const Machine& machine, double seconds) {
  return fmt::format("instructions; {:.0f} multiply-adds at peak take as long",
                     seconds * machine.fma_peak_gflops * 1e9 / 2);
}

Result<void> bench_machine(BenchRun& run) {
  const Machine& machine = run.machine;
  run.add_figure("machine.fma_peak_gflops", machine.fma_peak_gflops, "Gflop/s",
                 fmt::format("one core, single precision: {:.1f} operations a cycle of {:.2f} GHz",
                             machine.fma_peak_gflops / machine.clock_ghz, machine.clock_ghz))
      .median = machine.fma_peak_median_gflops;
  run.add_figure("machine.bandwidth_gbps", machine.bandwidth_gbps, "GB/s", "one core, triad").median =
      machine.bandwidth_median_gbps;
  run.add_figure("machine.bandwidth_all_cores_gbps", machine.all_cores_bandwidth_gbps, "GB/s",
                 fmt::format("{} cores at once", machine.cores))
      .median = machine.all_cores_bandwidth_median_gbps;
  return {};
}

}  // namespace mobil
