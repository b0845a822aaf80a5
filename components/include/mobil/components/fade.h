#pragma once
// Difference that a change of method leaves. It is added to the new method's result and faded out.

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Duration of a fade after a change of method, s.
inline constexpr float fade_s = 0.25F;

/// Ticks since the change of method.
template <class F>
struct Fade {
  UInt32<F> ticks;
};

/// Run-time sized columns. FadeStart: the shown minus the newly computed state at the change, displacement (m, three a
/// node) and then velocity (m/s, three a node). ShownDisplacement: displacement shown now (m, three a node).
struct FadeStart {};
struct ShownDisplacement {};

}  // namespace mobil::inline v0_3
