#pragma once
// Lines of action as a first tick would write them, and the poses of the ticks before: for muscles that begin under
// way.

#include <cstdint>
#include <vector>

#include <mobil/components/leg_frames.h>
#include <mobil/components/muscle.h>
#include <mobil/components/pose.h>
#include <mobil/engine/entity.h>

namespace mobil::inline v0_3 {

struct MuscleLines;  // systems/lines/muscle_lines.h
class World;

/// One leg of a pose, in all lanes.
LegFrames<Lanes<float>> leg_of(const Pose<float>& pose, Side side);

/// The line of action of a leg of a given pose, with the end where it then is, as a first tick would write them.
struct FirstLine {
  LineOfAction<float> line;
  EndDrive<float> end;
};
FirstLine first_line(const MuscleLines& lines, const LegScale<float>& scale, FarEnd far_end,
                     const LineOfAction<float>& rest, const Pose<float>& pose, Side side);

/// The last poses of a person, the present one at the end: a walker's four as far as they are known, of a posed person
/// that one alone. Kept for the person's other muscles.
struct RecentPoses {
  Entity person;
  std::uint32_t tick = 0;
  std::vector<Pose<float>> poses;
};
void look_back(const World& world, Entity person, std::uint32_t tick, float tick_s, RecentPoses& recent);

}  // namespace mobil::inline v0_3
