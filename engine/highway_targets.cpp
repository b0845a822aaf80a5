// The two functions of libhwy that choose kernels at run time, for libraries that do not link it (MOBIL_SELF_CONTAINED).
#if defined(MOBIL_OWN_TARGETS)

#include <hwy/targets.h>

#include <cstdint>

namespace hwy {

int64_t SupportedTargets() {
  int64_t targets = HWY_STATIC_TARGET | HWY_EMU128 | HWY_SCALAR;
#if defined(__x86_64__)
  // Including the system's support of the registers. Every processor with these has the rest of Highway's sets.
  const auto all = [](auto... has) { return ((has != 0) && ...); };
  if (all(__builtin_cpu_supports("avx2"), __builtin_cpu_supports("fma"), __builtin_cpu_supports("bmi"),
          __builtin_cpu_supports("bmi2"))) {
    targets |= HWY_AVX2;
    if (all(__builtin_cpu_supports("avx512f"), __builtin_cpu_supports("avx512vl"), __builtin_cpu_supports("avx512dq"),
            __builtin_cpu_supports("avx512bw"), __builtin_cpu_supports("avx512cd")))
      targets |= HWY_AVX3;
  }
#endif
  return targets;
}

ChosenTarget& GetChosenTarget() {
  static ChosenTarget chosen;
  return chosen;
}

}  // namespace hwy

#endif
