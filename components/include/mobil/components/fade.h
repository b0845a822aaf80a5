#pragma once
// What is left of a change of method: shown on top of what the new method computes, and faded out.

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Time from a change of method to when nothing is left of what was before, s.
inline constexpr float fade_s = 0.25F;

/// How long ago the change was, in ticks.
template <class F>
struct Fade {
  UInt32<F> ticks;
};

/// Run-time sized columns: by how much displacement (m, three a node) and then velocity (m/s, three a node) of what was
/// shown differed at the change from what is computed since; and what is shown now (m, three a node).
struct FadeStart {};
struct ShownDisplacement {};

}  // namespace mobil::inline v0_3
