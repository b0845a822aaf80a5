#pragma once
// Motion of subcutaneous fat relative to the skeleton: each region is a mass on a damped spring.

#include <array>

#include <mobil/components/body.h>
#include <mobil/components/fat.h>
#include <mobil/components/pose.h>
#include <mobil/components/segments.h>
#include <mobil/systems/gait/shown_fat.h>
#include "assets/body/fat_distribution.h"

namespace mobil::inline v0_3 {

/// Fat of 10 mm swings at 10 Hz, thicker fat slower by the square root of its thickness, with a quarter of critical
/// damping. For legs and arms of usual people this is within measurements of thighs and calves (10 to 25 Hz and 0.1 to
/// 0.4 with active muscles; Wakeling and Nigg 2001). For thicker fat, down to 4 Hz, the values are our choice.
inline constexpr float fat_hz = 10, fat_hz_thickness_m = 0.010F, fat_damping = 0.25F;
/// Speed above which a person must have jumped, so fat restarts at rest. Sprinters' feet reach 20 m/s.
inline constexpr float fat_fastest_m_s = 30;

/// Point that carries a region, at `part` of the way between the origins of two segments, and the thickness of its fat
/// in a man of 75 kg and 1.75 m. Thicknesses are our choice, for legs those of mobil/assets/surfaces/leg_grid.h.
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

/// Fat mass of that man over his squared height, kg/m².
inline constexpr float usual_fat_index = static_cast<float>(usual_mans_fat_share) * 75 / (1.75F * 1.75F);

/// Returns the fat thickness of each region, m. It is that of a man of 75 kg and 1.75 m, in proportion to the body's
/// fat mass over its squared height, limited to 1.5 to 60 mm.
std::array<float, fat_regions> fat_thickness_m(const BodySize<float>& size);

/// Advances the fat by one tick. The point that carries a region moves at constant speed from its last position to that
/// in `pose`, and the mass swings about it, exactly for any length of tick. Regions without history, or whose anchor
/// jumped, restart at rest. Gravity is part of the rest shape. A NaN stays in its lane and ends with its input.
void fat_motion(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose, FatWobble<Lanes<float>>& fat,
                float tick_s);

}  // namespace mobil::inline v0_3
