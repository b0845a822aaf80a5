#pragma once
// Kernels on each instruction set that has fused multiply-add, and whether blocks of lanes hold the same bits.

#include <hwy/targets.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "components/lanes.h"

namespace mobil {

/// Calls f() once for each such instruction set of this machine, with kernels dispatched to it.
template <class F>
void for_each_fused_instruction_set(F&& f) {
  for (const std::int64_t target : {std::int64_t{HWY_AVX2}, std::int64_t{HWY_AVX3}, std::int64_t{HWY_NEON}}) {
    if ((hwy::SupportedTargets() & target) == 0) continue;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    f();
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
}

/// All lanes but `but_lane`.
inline bool same_bits(const std::vector<Lanes<float>>& a, const std::vector<Lanes<float>>& b, std::size_t but_lane) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      if (l != but_lane && std::memcmp(&a[i].lane[l], &b[i].lane[l], sizeof(float)) != 0) return false;
    }
  }
  return true;
}

}  // namespace mobil
