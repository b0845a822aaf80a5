#pragma once
// Lines of action as a first tick would write them, and poses of the previous ticks, for muscles that start in motion.

#include <cstdint>
#include <vector>

#include <mobil/components/leg_frames.h>
#include <mobil/components/muscle.h>
#include <mobil/components/pose.h>
#include <mobil/engine/entity.h>

namespace mobil::inline v0_3 {

struct MuscleLines;  // systems/lines/muscle_lines.h
class World;

/// Returns one leg of a pose, in all lanes.
LegFrames<Lanes<float>> leg_of(const Pose<float>& pose, Side side);

/// Line of action of a leg in a given pose, and the drive of its end, as a first tick would write them.
struct FirstLine {
  LineOfAction<float> line;
  EndDrive<float> end;
};
FirstLine first_line(const MuscleLines& lines, const LegScale<float>& scale, FarEnd far_end,
                     const LineOfAction<float>& rest, const Pose<float>& pose, Side side);

/// Last poses of a person, the current one at the end: up to four of a walker, as far as they are known, and only the
/// current one of a posed person. Kept for the person's other muscles.
struct RecentPoses {
  Entity person;
  std::uint32_t tick = 0;
  std::vector<Pose<float>> poses;
};
void look_back(const World& world, Entity person, std::uint32_t tick, float tick_s, RecentPoses& recent);

}  // namespace mobil::inline v0_3
