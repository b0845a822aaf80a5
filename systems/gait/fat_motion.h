#pragma once
// How fat under the skin follows the skeleton: each region is a mass on a damped spring.

#include <array>

#include <mobil/components/body.h>
#include <mobil/components/fat.h>
#include <mobil/components/pose.h>
#include <mobil/components/segments.h>
#include <mobil/systems/gait/shown_fat.h>
#include "assets/body/fat_distribution.h"

namespace mobil::inline v0_3 {

/// Fat of 10 mm swings at 10 Hz, thicker fat slower by the root of its thickness, with a quarter of critical damping.
/// For legs and arms of usual people that is within what is measured of thighs and calves (10 to 25 Hz and 0.1 to 0.4
/// where muscles pull; Wakeling and Nigg 2001); for thicker fat, down to 4 Hz, it is our choice.
inline constexpr float fat_hz = 10, fat_hz_thickness_m = 0.010F, fat_damping = 0.25F;
/// Who moves faster than that has jumped without saying so: fat begins at rest. Sprinters' feet do 20 m/s.
inline constexpr float fat_fastest_m_s = 30;

/// A region is carried by a point between the origins of two segments, `part` of the way, and its fat is so thick in a
/// man of 75 kg and 1.75 m: our choice, legs as mobil/assets/surfaces/leg_grid.h has them.
struct FatPoint {
  Segment from, to;
  float part, thickness_m;
};
inline constexpr std::array<FatPoint, fat_regions> fat_points = {{
    {Segment::thigh_right, Segment::shank_right, 0.5F, 0.009F},
    {Segment::thigh_left, Segment::shank_left, 0.5F, 0.009F},
    {Segment::shank_right, Segment::foot_right, 0.35F, 0.0042F},
    {Segment::shank_left, Segment::foot_left, 0.35F, 0.0042F},
    {Segment::upper_arm_right, Segment::forearm_right, 0.5F, 0.006F},
    {Segment::upper_arm_left, Segment::forearm_left, 0.5F, 0.006F},
    {Segment::L3, Segment::L3, 0, 0.018F},
    {Segment::pelvis, Segment::pelvis, 0, 0.022F},
}};
inline constexpr float thinnest_fat_m = 0.0015F, thickest_fat_m = 0.060F;

/// Fat over the height's square of that man, kg/m².
inline constexpr float usual_fat_index = static_cast<float>(usual_fat_share) * 75 / (1.75F * 1.75F);

/// How thick the fat of each region is, m: as a man of 75 kg and 1.75 m has it, and in proportion to a body's fat over
/// its height's square; 1.5 to 60 mm.
std::array<float, fat_regions> fat_thickness_m(const BodySize<float>& size);

/// One tick of it: the point that carries a region goes evenly from where it was to where `pose` has it, and the mass
/// swings about it, exactly for any length of tick. What knows nothing, and whose points have jumped, begins at rest
/// beside the skeleton. Gravity is in the shape at rest. A NaN stays in its lane and goes with it.
void fat_motion(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose, FatWobble<Lanes<float>>& fat,
                float tick_s);

}  // namespace mobil::inline v0_3
