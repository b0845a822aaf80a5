#pragma once
// What a belly feels of gravity and of the motion of its frame, from where that frame was.

#include <mobil/components/muscle.h>

namespace mobil::inline v0_3 {

inline constexpr float gravity_m_s2 = 9.81F;

/// The load by gravity and by the frame's acceleration and turning, in the muscle's frame, from the frames of this tick
/// and of the two before (`line.start_m` and `line.rotation`; `history`, which moves on): central differences, exact to
/// second order in the tick. They tell of the middle of those three, so the load is one tick late: `from` is that of
/// two ticks ago, `to` that of the last one.
///
/// A history that knows nothing (all zero) begins with gravity alone; a tick later the frame is taken to have come as
/// it goes, evenly. A left muscle's frame is the mirror image's, and so is its load. In single precision places 100 m
/// from the world's origin are 8 µm apart: 0.03 m/s² at 60 ticks a second. A NaN stays in its lane.
void frame_motion(const LineOfAction<Lanes<float>>& line, FrameHistory<Lanes<float>>& history,
                  FrameLoad<Lanes<float>>& load, float tick_s);

}  // namespace mobil::inline v0_3
