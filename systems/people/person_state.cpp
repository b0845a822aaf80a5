#include <mobil/systems/people/person_state.h>

#include <mobil/systems/people/person_requests.h>
#include <mobil/systems/people/sleepers.h>
#include "systems/people/compact_pose.h"

namespace mobil::inline v0_3 {

std::optional<PersonState> person_state(const World& world, Entity person) {
  if (!is_person(world, person)) return std::nullopt;
  if (is_asleep(world, person)) return PersonState::asleep;
  if (is_posed(world, person)) return PersonState::posed;
  return is_compact(world, person) ? PersonState::compact : PersonState::full;
}

}  // namespace mobil::inline v0_3
