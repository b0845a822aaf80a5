#pragma once
// Lines of action as a first tick would write them, and the frames of those before it. Part of the front door.

#include <cstdint>
#include <vector>

#include "components/leg_frames.h"
#include "components/muscle.h"
#include "components/pose.h"
#include "engine/entity.h"

namespace mobil {

struct MuscleLines;
class World;

/// The line of action of a leg of a given pose, with the end where it then is, as a first tick would write them.
template <template <class> class End>
struct FirstLine {
  LineOfAction<float> line;
  End<float> end;
};

template <template <class> class End>
FirstLine<End> first_line(const MuscleLines& lines, const LegScale<float>& scale, const LineOfAction<float>& rest,
                          const Pose<float>& pose, Side side);

/// Of a line that has just begun: it does not lengthen yet.
LineMotion<float> first_motion(const MuscleLines& lines, const LegScale<float>& scale, const Pose<float>& pose,
                               Side side, const LineOfAction<float>& line, float tick_s);

/// The last poses of a person, the present one at the end: a walker's four as far as they are known, of a posed person
/// that one alone. Kept for the person's other muscles.
struct RecentPoses {
  Entity human;
  std::uint32_t tick = 0;
  std::vector<Pose<float>> poses;
};
void look_back(const World& world, Entity human, std::uint32_t tick, float tick_s, RecentPoses& recent);

/// The motion of a muscle's frame up to now, as far as it is known, as the ticks before would have recorded it.
struct Inertia {
  FrameHistory<float> history;
  FrameLoad<float> load;
};
Inertia recent_inertia(const RecentPoses& recent, const MuscleLines& lines, const LegScale<float>& scale, Side side,
                       float tick_s);

}  // namespace mobil
