#include "demo/measure/machine.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;

const char* target_name() {
  return hwy::TargetName(HWY_TARGET);
}

// Enough independent chains to hide the latency of a multiply-add: latency times units is 8 to 16 on current
// processors. Two more registers hold the factors; x86 before AVX-512 (better targets have lower numbers) has 16
// registers. The accumulators are separate variables because compilers keep an array of registers in memory.
#if HWY_ARCH_X86 && HWY_TARGET > HWY_AVX3
#define MOBIL_CHAINS(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7) X(8) X(9) X(10) X(11)
#else
#define MOBIL_CHAINS(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7) X(8) X(9) X(10) X(11) X(12) X(13) X(14) X(15)
#endif

/// Computes `rounds` multiply-adds in each lane of each chain. Returns the number of operations.
HWY_NOINLINE double multiply_add(std::size_t rounds, float factor, float summand, float* out) {
  const FloatTag tag;
  const auto m = hn::Set(tag, factor), a = hn::Set(tag, summand);
  std::size_t chains = 0;
#define MOBIL_BEGIN(i) auto r##i = hn::Set(tag, static_cast<float>(chains++));
#define MOBIL_STEP(i) r##i = hn::MulAdd(r##i, m, a);
#define MOBIL_END(i) sum = hn::Add(sum, r##i);
  MOBIL_CHAINS(MOBIL_BEGIN)
  for (std::size_t n = 0; n < rounds; ++n) {
    MOBIL_CHAINS(MOBIL_STEP)
  }
  auto sum = hn::Zero(tag);
  MOBIL_CHAINS(MOBIL_END)
#undef MOBIL_BEGIN
#undef MOBIL_STEP
#undef MOBIL_END
#undef MOBIL_CHAINS
  *out = hn::GetLane(sum);
  return 2.0 * static_cast<double>(rounds * chains * hn::Lanes(tag));
}

/// Computes a = b + s·c. The length must be a multiple of 64, the arrays aligned to 64 bytes.
HWY_NOINLINE void triad(float* HWY_RESTRICT a, const float* HWY_RESTRICT b, const float* HWY_RESTRICT c, float s,
                        std::size_t length) {
  const FloatTag tag;
  const auto factor = hn::Set(tag, s);
  const std::size_t lanes = hn::Lanes(tag);
  for (std::size_t i = 0; i < length; i += lanes) {
    hn::Store(hn::MulAdd(factor, hn::Load(tag, c + i), hn::Load(tag, b + i)), tag, a + i);
  }
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <barrier>
#include <fstream>
#include <sstream>
#include <thread>
#include <tuple>

#include "demo/measure/measure.h"
#include "demo/program/json.h"

namespace mobil {
namespace {

HWY_EXPORT(target_name);
HWY_EXPORT(multiply_add);
HWY_EXPORT(triad);

constexpr std::size_t triads = 10;  // passes over the arrays

/// Returns the text after the colon in the first line of a file that starts with `beginning`.
std::string line_of(const char* file, const std::string& beginning) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(beginning)) continue;
    const auto colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return {};
}

/// Returns the size of the first core's data cache of one level, private or shared; 0 if the system does not report it.
std::size_t cache_bytes(const std::string& level) {
  for (int i = 0; i < 8; ++i) {
    const auto about = [folder = "/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(i)](const char* what) {
      std::string text;
      std::ifstream(folder + "/" + what) >> text;
      return text;
    };
    if (about("level") != level || about("type") == "Instruction") continue;
    std::size_t size = 0;
    char unit = 0;
    std::istringstream(about("size")) >> size >> unit;
    return size << (unit == 'K' ? 10 : unit == 'M' ? 20 : 0);
  }
  return 0;
}

/// Measures the clock by a chain of dependent additions, one per cycle on all known processors.
double measure_clock_ghz() {
  constexpr int rounds = 100'000, chain = 16;
  const Measured time = measure(bench_repeats, [] {
    std::uint64_t x = 0, y = 1;
    asm volatile("" : "+r"(y));
    for (int i = 0; i < rounds; ++i) {
      for (int k = 0; k < chain; ++k) {
        x += y;
        asm volatile("" : "+r"(x));  // keeps the compiler from merging the sixteen
      }
    }
  });
  return rounds * chain / time.best_s * 1e-9;
}

void measure_peak(Machine& machine) {
  volatile float factor = 0.999F, summand = 0.001F;  // hidden from the compiler; every chain converges to 1
  volatile float kept = 0;
  constexpr std::size_t rounds = 200'000;  // 1 to 3 ms
  double operations = 0;
  const Measured time = measure(bench_repeats, [&] {
    float out = 0;
    operations = HWY_DYNAMIC_DISPATCH(multiply_add)(rounds, factor, summand, &out);
    kept = out;
  });
  machine.fma_peak_gflops = operations / time.best_s * 1e-9;
  machine.fma_peak_median_gflops = operations / time.median_s * 1e-9;
}

/// Returns best and median rate (GB/s) of `threads` threads that share arrays of `length` numbers. A single thread is
/// timed in pieces, so that on a busy machine some pieces run without interruption.
std::pair<double, double> triad_gbps(unsigned threads, std::size_t length) {
  const std::size_t pieces = threads == 1 ? 8 : 1;
  const std::size_t piece = length / threads / pieces / 64 * 64, part = piece * pieces;
  std::vector<double> rates;
  rates.reserve(triads * pieces);
  double start_s = 0;
  std::barrier begin(threads, [&]() noexcept { start_s = wall_now_s(); });
  std::barrier end(threads, [&]() noexcept {
    rates.push_back(3.0 * sizeof(float) * static_cast<double>(piece * threads) / (wall_now_s() - start_s) * 1e-9);
  });
  const auto work = [&] {
    // allocated and first touched by each thread, so that they are in its local memory
    const auto a = hwy::AllocateAligned<float>(part), b = hwy::AllocateAligned<float>(part),
               c = hwy::AllocateAligned<float>(part);
    std::fill_n(a.get(), part, 0.0F);
    std::fill_n(b.get(), part, 1.0F);
    std::fill_n(c.get(), part, 2.0F);
    for (std::size_t i = 0; i < triads * pieces; ++i) {
      const std::size_t at = i % pieces * piece;
      begin.arrive_and_wait();
      HWY_DYNAMIC_DISPATCH(triad)(a.get() + at, b.get() + at, c.get() + at, 0.5F + static_cast<float>(i), piece);
      end.arrive_and_wait();
    }
  };
  std::vector<std::jthread> others;
  for (unsigned t = 1; t < threads; ++t) others.emplace_back(work);
  work();
  others.clear();
  return {std::ranges::max(rates), median(rates)};
}

}  // namespace

Machine describe_machine() {
  Machine machine;
  machine.cpu = line_of("/proc/cpuinfo", "model name");
  if (machine.cpu.empty()) machine.cpu = "unknown";
  machine.target = HWY_DYNAMIC_DISPATCH(target_name)();
#ifdef __clang__
  machine.compiler = "clang " __clang_version__;
#else
  machine.compiler = "gcc " __VERSION__;
#endif
#ifdef MOBIL_BUILD_FLAGS
  machine.flags = MOBIL_BUILD_FLAGS;
#endif
  machine.cores = std::max(1U, std::thread::hardware_concurrency());
  machine.l1_bytes = cache_bytes("1");
  machine.l2_bytes = cache_bytes("2");
  machine.l3_bytes = cache_bytes("3");
  return machine;
}

Json machine_json(const Machine& machine) {
  return {{"cpu", machine.cpu},
          {"cores", machine.cores},
          {"target", machine.target},
          {"compiler", machine.compiler},
          {"flags", machine.flags}};
}

void measure_machine(Machine& machine) {
  machine.clock_ghz = measure_clock_ghz();
  measure_peak(machine);
  constexpr std::size_t least = std::size_t{64} << 20, most = std::size_t{400} << 20;  // bytes an array
  const std::size_t length = std::clamp(4 * machine.l3_bytes / 3, least, most) / sizeof(float);
  std::tie(machine.bandwidth_gbps, machine.bandwidth_median_gbps) = triad_gbps(1, length);
  std::tie(machine.all_cores_bandwidth_gbps, machine.all_cores_bandwidth_median_gbps) =
      machine.cores == 1 ? std::pair(machine.bandwidth_gbps, machine.bandwidth_median_gbps)
                         : triad_gbps(machine.cores, length);
}

}  // namespace mobil
#endif
