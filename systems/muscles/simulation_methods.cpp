// Muscles that change their method under way, one by one.
#include <fmt/format.h>

#include <algorithm>

#include "assets/body/anthropometry.h"
#include "components/fade.h"
#include "systems/muscles/change_muscles.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/simulation.h"

namespace mobil {
namespace {

template <class Muscles>
auto find_muscle_of(Muscles& muscles, Muscle muscle) {
  return std::find_if(muscles.begin(), muscles.end(), [&](const OwnMuscle& m) { return m.muscle == muscle; });
}

}  // namespace

Result<void> Simulation::set_method(Entity entity, Muscle muscle, const MuscleMethod& method) {
  PersonRecord* human = find(entity);
  if (human == nullptr) return fail("set_method: that person is not there (a stale handle); spawn one first");
  const auto own = find_muscle_of(human->muscles, muscle);
  if (own == human->muscles.end())
    return fail("set_method: this person has no such muscle; choose one of those in add_leg_muscles");
  if (same_method(muscle_method(world_, own->entity[right]), method)) return {};
  LegMuscles choice = people_.choice(*human);
  choice.method = method.method;
  choice.reduced = method.reduced;
  const auto belly = bellies_.belly(*make_muscle_plan(*make_body(human->body), muscle), choice, tick_s());
  if (!belly) return fail(fmt::format("set_method: {}: {}", muscle_name(muscle), belly.error().message));
  change_muscles(world_, *work_, {entity, choice, true, {tick_, tick_s()}}, {&*belly, 1}, {&*own, 1});
  return {};
}

MuscleMethod Simulation::method(Entity entity, Muscle muscle) const {
  const PersonRecord* owner = person(entity);
  if (owner == nullptr) return {Method::none};
  const auto own = find_muscle_of(owner->muscles, muscle);
  return own == owner->muscles.end() ? MuscleMethod{Method::none} : muscle_method(world_, own->entity[right]);
}

/// Of those whose time is up; who changed again since has a later entry.
void Simulation::end_fades() {
  const std::uint32_t ticks = fade_ticks(static_cast<float>(clock_.tick_s()));
  for (; !work_->fading.empty() && work_->fading.front().ends <= tick_; work_->fading.pop_front()) {
    const Entity muscle = work_->fading.front().muscle;
    const auto fade = world_.get<Fade>(muscle);
    if (!fade || fade->ticks < ticks) continue;
    world_.remove_parts(muscle, {type_id<Fade<float>>(), type_id<FadeStart>(), type_id<ShownDisplacement>()});
  }
}

}  // namespace mobil
