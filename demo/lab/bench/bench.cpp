#include "demo/lab/bench/bench.h"

#include <fmt/format.h>

#include <algorithm>
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
  BenchResult& result = results.emplace_back();
  result.name = std::move(name);
  result.value = time.best_s * scale;
  result.unit = std::move(unit);
  result.median = time.median_s * scale;
  if (time.cpu_s) result.cpu = *time.cpu_s * scale;
  return result;
}

std::string at_peak(const Machine& machine, double seconds) {
  return fmt::format("instructions; {:.0f} multiply-adds at peak take as long",
                     seconds * machine.fma_peak_gflops * 1e9 / 2);
}

Result<void> bench_machine(BenchRun& run) {
  const Machine& machine = run.machine;
  const auto add = [&](const char* name, double best, double median_value, const char* unit, std::string bound) {
    BenchResult& result = run.results.emplace_back();
    result.name = name;
    result.value = best;
    result.median = median_value;
    result.unit = unit;
    result.bound = std::move(bound);
  };
  add("machine.fma_peak_gflops", machine.fma_peak_gflops, machine.fma_peak_median_gflops, "Gflop/s",
      fmt::format("one core, single precision: {:.1f} operations a cycle of {:.2f} GHz",
                  machine.fma_peak_gflops / machine.clock_ghz, machine.clock_ghz));
  add("machine.bandwidth_gbps", machine.bandwidth_gbps, machine.bandwidth_median_gbps, "GB/s", "one core, triad");
  add("machine.bandwidth_all_cores_gbps", machine.all_cores_bandwidth_gbps, machine.all_cores_bandwidth_median_gbps,
      "GB/s", fmt::format("{} cores at once", machine.cores));
  return {};
}

}  // namespace mobil
