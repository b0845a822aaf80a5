#pragma once
// Runs kernels on each instruction set of this machine, and compares the bits of blocks.

#include <hwy/targets.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include <mobil/components/lanes.h>

namespace mobil {

inline constexpr std::int64_t fused_targets = HWY_AVX2 | HWY_AVX3 | HWY_AVX3_DL | HWY_NEON;

/// Returns the instruction sets that kernels are compiled for and this machine has: only one if MOBIL_X86 is `native`.
inline std::vector<std::int64_t> instruction_sets() {
  auto sets = hwy::SupportedAndGeneratedTargets();  // the best one first
#if defined(MOBIL_KERNELS_FOR_THIS_MACHINE)
  sets.resize(1);
#endif
  return sets;
}

/// Calls f(name) once for each of these instruction sets, with kernels dispatched to it.
template <class F>
void for_each_instruction_set(std::int64_t targets, F&& f) {
  for (const std::int64_t target : instruction_sets()) {
    if ((targets & target) == 0) continue;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    f(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
}
/// Runs `f` for all of this machine's instruction sets.
template <class F>
void for_each_instruction_set(F&& f) {
  for_each_instruction_set(~std::int64_t{0}, f);
}
/// Runs `f` for the instruction sets with fused multiply-add, which give the same bits.
template <class F>
void for_each_fused_instruction_set(F&& f) {
  for_each_instruction_set(fused_targets, [&](const char*) { f(); });
}
/// Returns true if kernels are now dispatched to an instruction set with fused multiply-add.
inline bool has_fused_multiply_add() {
  return (hwy::SupportedTargets() & ~fused_targets) == 0;
}

/// Compares the bits of all lanes except `but_lane`.
inline bool same_bits(const std::vector<Lanes<float>>& a, const std::vector<Lanes<float>>& b, std::size_t but_lane) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      if (l != but_lane && std::memcmp(&a[i].lane[l], &b[i].lane[l], sizeof(float)) != 0) return false;
    }
  }
  return true;
}

}  // namespace mobil
