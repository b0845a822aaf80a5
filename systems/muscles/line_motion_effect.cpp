#include "systems/muscles/line_motion_effect.h"

#include <mobil/rows.h>
#include "systems/lines/line_motion.h"
#include "systems/lines/line_of_action.h"
#include "systems/muscles/owner_legs.h"

namespace mobil::inline v0_3 {
namespace {
namespace of_line_motion {

void move_lines(LegsOfOwners posts, const MuscleOwner<Lanes<float>>& owner, Ahead<MuscleOwner> ahead,
                Shared<MuscleLines> lines, const LegScale<Lanes<float>>& scale, const LineOfAction<Lanes<float>>& line,
                LineMotion<Lanes<float>>& motion, float tick_s) {
  line_motion(*lines, scale, legs_of(posts, owner, ahead), line, motion, tick_s);
}

Module module() {
  return {.name = "line motion", .parts = {component_id<LineMotion>()}, .systems = [](ScheduleBuilder& systems) {
            systems.add("line motion", &move_lines);
          }};
}

bool wanted(const MuscleKind& kind) {
  return kind.line_motion;
}

void parts(const MuscleKind&, std::vector<ComponentId>& to) {
  to.push_back(component_id<LineMotion>());
}

/// Sets the moment arms of a new line; its speed is 0.
void begin(const EffectStart& start, RowValues& values) {
  if (start.world.has<LineMotion>(start.entity)) return;
  LineMotion<Lanes<float>> motion{};
  line_motion(*start.kind.lines, broadcast(start.size.leg_scale),
              leg_of(*start.world.get<Pose>(start.person), start.side), broadcast(start.line), motion, start.tick_s);
  values.set(first_lane(motion));
}

}  // namespace of_line_motion
}  // namespace

constinit const MuscleEffect line_motion_effect = {&of_line_motion::module, &of_line_motion::wanted,
                                                   &of_line_motion::begin, &of_line_motion::parts};

}  // namespace mobil::inline v0_3
