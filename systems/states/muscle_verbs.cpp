#include "systems/states/muscle_verbs.h"

#include <fmt/format.h>

#include <cstddef>
#include <vector>

#include <mobil/engine/interrupt.h>
#include <mobil/muscle_table.h>
#include "systems/muscles/muscle_parts.h"
#include "systems/people/person_requests.h"
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

Result<void> check_there(const Frame& frame, std::span<const Entity> people) {
  for (std::size_t i = 0; i < people.size(); ++i)
    if (!is_person(frame.world, people[i]))
      return tl::unexpected(
          of_person(people, i, {"that person is not there (a stale handle); spawn one first", Status::stale_entity}));
  return {};
}

/// Makes people full, with kept muscles started, and calls `change(i)` for each. A refused change has no effect. For
/// several people `check(i)` is called for each before any change; if it refuses one, no person changes.
template <class Check, class Change>
Result<void> change_full(const Frame& frame, std::span<const Entity> people, const Check& check, const Change& change) {
  if (auto ok = check_there(frame, people); !ok) return ok;
  const bool is_one = people.size() == 1;
  if (is_one && !is_asleep(frame.world, people[0]) && !is_compact(frame.world, people[0]) &&
      !kept_choice(frame.world, people[0]))
    return change(0);
  World::Transaction transaction(frame.world, frame.jobs);
  if (auto done = make_muscles_full(frame, people); !done) return done;
  if (is_one) {
    auto done = change(0);
    if (done) transaction.commit();
    return done;
  }
  for (std::size_t i = 0; i < people.size(); ++i) {
    check_interrupt();
    if (const Result<void> ok = check(i); !ok) return tl::unexpected(of_person(people, i, ok.error()));
  }
  transaction.commit();
  for (std::size_t i = 0; i < people.size(); ++i) {
    check_interrupt();
    if (const Result<void> done = change(i); !done) return tl::unexpected(of_person(people, i, done.error()));
  }
  return {};
}

Result<void> check_method(const Frame& frame, Entity person, Muscle muscle, const MuscleMethod& method) {
  auto choice = choice_of(frame.world, person);
  if (!choice || !choice->muscles[static_cast<std::size_t>(muscle)])
    return fail(fmt::format("{}: no such muscle; set_muscles gives muscles", muscle_name(muscle)), Status::missing);
  choice->muscles = MuscleSet{}.set(static_cast<std::size_t>(muscle));
  choice->method = method.method;
  choice->modal = method.modal;
  auto ok = check_leg_muscles(frame.world, *means_of(frame).library, means_of(frame).tick_s, person, *choice);
  if (ok) return ok;
  return fail(fmt::format("{}: {}", muscle_name(muscle), ok.error().message), ok.error().status);
}

}  // namespace

/// Allocates no memory for people who are full.
static Result<void> remove_muscles(const Frame& frame, std::span<const Entity> people) {
  if (auto done = make_muscles_full(frame, people); !done) return done;
  for (const Entity person : people) {
    check_interrupt();
    if (!has_muscles(frame.world, person)) continue;
    if (auto done = result_of("no muscles", remove_leg_muscles(frame.world, frame.jobs, person)); !done) return done;
    choose_from_now(frame.world, person);
  }
  return {};
}

Result<void> set_muscles(const Frame& frame, std::span<const Entity> people, const std::optional<LegMuscles>& choice) {
  if (auto ok = check_there(frame, people); !ok) return ok;
  if (!choice) return remove_muscles(frame, people);
  // Added muscles can be undone, changed ones cannot. Changes therefore follow after all checks.
  std::vector<std::size_t> have;
  World::Transaction transaction(frame.world, frame.jobs);
  if (auto done = make_muscles_full(frame, people); !done) return done;
  for (std::size_t i = 0; i < people.size(); ++i) {
    check_interrupt();
    Result<void> ok;
    if (has_muscles(frame.world, people[i])) {
      have.push_back(i);
      ok = check_leg_muscles(frame.world, *means_of(frame).library, means_of(frame).tick_s, people[i], *choice);
    } else {
      ok = add_leg_muscles(scene_of(frame), people[i], *choice);
    }
    if (!ok) return tl::unexpected(of_person(people, i, ok.error()));
  }
  transaction.commit();
  for (const Entity person : people) choose_from_now(frame.world, person);
  for (const std::size_t i : have) {
    check_interrupt();
    if (const auto done = change_leg_muscles(scene_of(frame), people[i], *choice); !done)
      return tl::unexpected(of_person(people, i, done.error()));
    choose_from_now(frame.world, people[i]);
  }
  return {};
}

Result<void> set_method(const Frame& frame, std::span<const Entity> people, Muscle muscle, const MuscleMethod& method) {
  return change_full(
      frame, people, [&](std::size_t i) { return check_method(frame, people[i], muscle, method); },
      [&](std::size_t i) { return set_method(scene_of(frame), people[i], muscle, method); });
}

Result<void> set_excitation(const Frame& frame, std::span<const Entity> people, Muscle muscle, Side side,
                            std::span<const float> excitation) {
  return change_full(
      frame, people,
      [&](std::size_t i) { return check_excitation(frame.world, people[i], muscle, side, excitation[i]); },
      [&](std::size_t i) { return set_excitation(frame.world, people[i], muscle, side, excitation[i]); });
}

MuscleMethod method_of(const World& world, Entity person, Muscle muscle) {
  if (is_compact(world, person)) return compact_method(world, person, muscle);
  const Entity right_one = muscle_of(world, person, muscle, Side::right);
  return muscle_method(world, world.alive(right_one) ? right_one : muscle_of(world, person, muscle, Side::left));
}

}  // namespace mobil::inline v0_3
