#include "systems/standard_modules.h"

#include <utility>

#include <mobil/systems/people/step_watch.h>
#include <mobil/systems/relevance/relevance_module.h>
#include "systems/avoidance/avoidance_module.h"
#include "systems/muscles/compact_module.h"
#include "systems/muscles/leg_moments.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/people/fat_wobble.h"
#include "systems/people/people_modules.h"
#include "systems/people/sleep_module.h"
#include "systems/simulation_waking.h"
#include "systems/terrain/terrain_module.h"

namespace mobil::inline v0_3 {

std::vector<Module> standard_modules() {
  std::vector<Module> all = {walking_module(), forces_module(),     skeleton_module(), leg_moments_module(),
                             sleep_module(),   step_watch_module(), fat_module()};
  for (Module& module : muscle_modules()) all.push_back(std::move(module));
  all.push_back(compact_module());
  all.push_back(relevance_module());
  all.back().after = {settled_walkers()};
  all.push_back(avoidance_module());
  all.push_back(terrain_module());
  return all;
}

}  // namespace mobil::inline v0_3
