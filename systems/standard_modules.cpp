#include "systems/standard_modules.h"

#include <utility>

#include <mobil/systems/people/step_log.h>
#include "systems/avoidance/avoidance_module.h"
#include "systems/lod/lod_module.h"
#include "systems/muscles/leg_moments.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/people/fat_wobble.h"
#include "systems/people/people_modules.h"
#include "systems/states/compact_module.h"
#include "systems/states/person_states.h"
#include "systems/states/sleep_module.h"
#include "systems/terrain/terrain_module.h"

namespace mobil::inline v0_3 {

/// Phases of a tick run in the order of modules. Before the systems: level of detail, which wakes people, then
/// avoidance, then the ground under the chosen steps, then memory for step events (step_memory_module()).
std::vector<Module> standard_modules() {
  std::vector<Module> all = {walking_module(), forces_module(),      skeleton_module(),  leg_moments_module(),
                             sleep_module(),   lod_module(),         avoidance_module(), terrain_module(),
                             compact_module(), step_events_module(), fat_module()};
  for (Module& module : muscle_modules()) all.push_back(std::move(module));
  all.back().after.push_back(settled_walkers());
  return all;
}

}  // namespace mobil::inline v0_3
