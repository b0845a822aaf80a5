#include "systems/muscles/inertia_effect.h"

#include <mobil/rows.h>
#include "systems/lines/frame_motion.h"

namespace mobil::inline v0_3 {
namespace {
namespace of_inertia {

Module module() {
  return {.name = "inertia",
          .parts = {component_id<FrameLoad>(), component_id<FrameHistory>()},
          .systems = [](ScheduleBuilder& systems) { systems.add("frame motion", &frame_motion); }};
}

bool wanted(const MuscleKind& kind) {
  return kind.inertia;
}

void parts(const MuscleKind&, std::vector<ComponentId>& to) {
  to.push_back(component_id<FrameLoad>());
  to.push_back(component_id<FrameHistory>());
}

/// Sets the past motion of the muscle's frame, as far as it is known, as the previous ticks would have recorded it.
void begin(const EffectStart& start, RowValues& values) {
  if (start.world.has<FrameHistory>(start.entity) && start.world.has<FrameLoad>(start.entity)) return;
  look_back(start.world, start.person, start.tick, start.tick_s, start.recent);
  FrameHistory<Lanes<float>> history{};
  FrameLoad<Lanes<float>> load{};
  for (const Pose<float>& pose : start.recent.poses) {
    const auto line = first_line(*start.kind.lines, start.size.leg_scale, FarEnd::held, {}, pose, start.side).line;
    frame_motion(broadcast(line), history, load, start.tick_s);
  }
  values.set(first_lane(history));
  values.set(first_lane(load));
}

}  // namespace of_inertia
}  // namespace

constinit const MuscleEffect inertia_effect = {&of_inertia::module, &of_inertia::wanted, &of_inertia::begin,
                                               &of_inertia::parts};

}  // namespace mobil::inline v0_3
