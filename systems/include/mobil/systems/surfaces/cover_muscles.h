#pragma once
// Skin over muscles that move: how far each point of a leg's skin is lifted so that nothing comes through.

#include <array>
#include <span>

#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/components/muscle.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// How far each point of a leg's grid is lifted, m; of the right leg and the left one.
struct SkinCover {
  std::array<std::array<float, leg_grid_points>, 2> lift_m{};
};

/// Finds it from the muscles as they are drawn now (world, m), of one leg; tendons too. A point is lifted where a
/// muscle and the fat over it reach farther from the leg's line than the skin does; what is lifted is rounded off to
/// its neighbours. In the bend of hip and knee, where flesh lies in flesh, no more than the crease has room for.
/// Vertices that are no numbers, or a metre and more from the leg, count for nothing. `lengths`: as of SkinShape. Some
/// 4 ns a vertex of muscle and 2 µs. The same bits on every instruction set with fused multiply-add.
void cover_muscles(const BodySkin& skin, const Pose<float>& pose, float lengths, Side side,
                   std::span<const Vec3<float>> muscles, std::array<float, leg_grid_points>& lift_m);

}  // namespace mobil::inline v0_3
