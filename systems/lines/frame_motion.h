#pragma once
// Load on a belly by gravity and by the motion of its frame, from earlier frames.

#include <mobil/components/muscle.h>

namespace mobil::inline v0_3 {

inline constexpr float gravity_m_s2 = 9.81F;

/// Computes the load by gravity and by the acceleration and rotation of the frame, in the muscle's frame. It uses
/// central differences, exact to second order in the tick, of the frames of this tick (`line.start_m`, `line.rotation`)
/// and the two before (`history`, which is updated). Central differences describe the middle frame, so the load is one
/// tick late: `from` is that of two ticks ago, `to` that of the last one.
///
/// With an empty history (all zero) the load starts as gravity alone. One tick later the frame is assumed to have moved
/// at constant velocity. A left muscle's frame and load are mirror images. In single precision, positions 100 m from
/// the world's origin are 8 µm apart: 0.03 m/s² at 60 ticks a second. A NaN stays in its lane.
void frame_motion(const LineOfAction<Lanes<float>>& line, FrameHistory<Lanes<float>>& history,
                  FrameLoad<Lanes<float>>& load, float tick_s);

}  // namespace mobil::inline v0_3
