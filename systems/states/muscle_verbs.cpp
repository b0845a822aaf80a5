#include "systems/states/muscle_verbs.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include <mobil/muscle_table.h>
#include <mobil/systems/people/person.h>
#include "systems/muscles/muscle_parts.h"
#include "systems/states/person_states.h"

namespace mobil::inline v0_3 {
namespace {

const MuscleMeans& means_of(const Frame& frame) {
  return frame.workspace.get<MuscleMeans>();
}

Error of_person(std::span<const Entity> people, std::size_t i, const Error& error) {
  if (people.size() == 1) return error;
  return {one_line(fmt::format("person {}: {}", i, error.message)), error.status};
}

/// Asks `check(person)` of each, who is full for it, with muscles begun, and stays so where nobody is refused; else
/// nobody has changed.
template <class Check>
Result<void> check_full(const Frame& frame, std::span<const Entity> people, const Check& check) {
  for (std::size_t i = 0; i < people.size(); ++i)
    if (!is_person(frame.world, people[i]))
      return tl::unexpected(
          of_person(people, i, {"that person is not there (a stale handle); spawn one first", Status::stale_entity}));
  World::Attempt attempt(frame.world, frame.jobs);
  if (auto done = make_muscles_whole(frame, people); !done) return done;
  for (std::size_t i = 0; i < people.size(); ++i)
    if (const Result<void> ok = check(people[i]); !ok) return tl::unexpected(of_person(people, i, ok.error()));
  attempt.keep();
  return {};
}

Result<void> check_method(const Frame& frame, Entity person, Muscle muscle, const MuscleMethod& method) {
  auto choice = choice_of(frame.world, person);
  if (!choice || !choice->muscles[static_cast<std::size_t>(muscle)])
    return fail(fmt::format("{}: no such muscle; set_muscles gives muscles", muscle_name(muscle)), Status::missing);
  choice->muscles = MuscleSet(1UL << static_cast<unsigned long>(muscle));
  choice->method = method.method;
  choice->reduced = method.reduced;
  auto ok = check_leg_muscles(frame.world, *means_of(frame).library, means_of(frame).tick_s, person, *choice);
  if (ok) return ok;
  return fail(fmt::format("{}: {}", muscle_name(muscle), ok.error().message), ok.error().status);
}

}  // namespace

Result<void> set_muscles(const Frame& frame, std::span<const Entity> people, const std::optional<LegMuscles>& choice) {
  const auto check = [&](Entity person) -> Result<void> {
    if (!choice) return {};
    return check_leg_muscles(frame.world, *means_of(frame).library, means_of(frame).tick_s, person, *choice);
  };
  if (auto ok = check_full(frame, people, check); !ok) return ok;
  // Muscles that come can be undone, those that change or go cannot.
  std::optional<World::Attempt> attempt;
  if (std::ranges::none_of(people, [&](Entity person) { return has_muscles(frame.world, person); }))
    attempt.emplace(frame.world, frame.jobs);
  for (std::size_t i = 0; i < people.size(); ++i) {
    const Entity person = people[i];
    Result<void> done;
    if (!choice)
      done = has_muscles(frame.world, person)
                 ? result_of("no muscles", remove_leg_muscles(frame.world, frame.jobs, person))
                 : Result<void>{};
    else if (has_muscles(frame.world, person))
      done = change_leg_muscles(scene_of(frame), person, *choice);
    else
      done = add_leg_muscles(scene_of(frame), person, *choice);
    if (!done) return tl::unexpected(of_person(people, i, done.error()));
  }
  if (attempt) attempt->keep();
  for (const Entity person : people) choose_from_now(frame.world, person);
  return {};
}

Result<void> set_method(const Frame& frame, std::span<const Entity> people, Muscle muscle, const MuscleMethod& method) {
  const auto check = [&](Entity person) { return check_method(frame, person, muscle, method); };
  if (auto ok = check_full(frame, people, check); !ok) return ok;
  for (std::size_t i = 0; i < people.size(); ++i)
    if (auto done = set_method(scene_of(frame), people[i], muscle, method); !done)
      return tl::unexpected(of_person(people, i, done.error()));
  return {};
}

Result<void> set_excitation(const Frame& frame, std::span<const Entity> people, Muscle muscle, Side side,
                            std::span<const float> excitation) {
  std::size_t next = 0;
  const auto check = [&](Entity person) {
    return check_excitation(frame.world, person, muscle, side, excitation[next++]);
  };
  if (auto ok = check_full(frame, people, check); !ok) return ok;
  for (std::size_t i = 0; i < people.size(); ++i)
    (void)set_excitation(frame.world, people[i], muscle, side, excitation[i]);
  return {};
}

MuscleMethod method_of(const World& world, Entity person, Muscle muscle) {
  if (is_compact(world, person)) return compact_method(world, person, muscle);
  const Entity right_one = muscle_of(world, person, muscle, Side::right);
  return muscle_method(world, world.alive(right_one) ? right_one : muscle_of(world, person, muscle, Side::left));
}

}  // namespace mobil::inline v0_3
