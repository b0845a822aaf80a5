#include "systems/muscles/leg_muscles.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/components/activation.h>
#include <mobil/components/fade.h>
#include <mobil/each.h>
#include <mobil/engine/geometry.h>
#include <mobil/engine/interrupt.h>
#include <mobil/forces.h>
#include "engine/exact_math.h"
#include "systems/bellies/leg_muscles_io.h"
#include "systems/muscles/finite_shape_effect.h"
#include "systems/muscles/leg_moments.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/people/person_requests.h"

namespace mobil::inline v0_3 {
namespace {

/// New rows of a scene; the destructor undoes them unless `done`.
class NewRows {
 public:
  NewRows(const MuscleScene& scene, std::size_t room, std::span<Entity> entities = {})
      : scene_(scene), entities_(entities) {
    made.reserve(room);
  }
  ~NewRows() {
    if (done) return;
    scene_.world.undo_create(made);
    scene_.work.recent = {};  // these handles will be reused
    std::ranges::fill(entities_, Entity{});
  }
  NewRows(const NewRows&) = delete;
  NewRows& operator=(const NewRows&) = delete;

  std::vector<Entity> made;  // people and muscles in order of creation; has room for all
  bool done = false;

 private:
  const MuscleScene& scene_;
  std::span<Entity> entities_;  // the caller's
};

tl::unexpected<Error> not_there() {
  return fail("that person is not there (a stale handle); spawn one first", Status::stale_entity);
}

/// Sizes of the requested muscles, person by person.
class Sizes {
 public:
  explicit Sizes(std::span<const SpawnRequest> people) : people_(people), first_(people.size() + 1) {
    for (std::size_t i = 0; i < people.size(); ++i) first_[i + 1] = first_[i] + count(i);
    size_.resize(first_.back());
  }
  std::span<MuscleSize> of(std::size_t person) {
    return std::span(size_).subspan(first_[person], first_[person + 1] - first_[person]);
  }
  std::size_t all() const { return size_.size(); }

  Result<void> set(std::size_t person, const Body& body) {
    auto at = of(person).begin();
    for (std::size_t m = 0; at != of(person).end(); ++m) {
      if (!people_[person].muscles->muscles[m]) continue;
      const auto plan = make_muscle_plan(body, static_cast<Muscle>(m));
      if (!plan) return tl::unexpected(plan.error());
      *at++ = size_of(*plan);
    }
    return {};
  }

 private:
  std::size_t count(std::size_t person) const {
    return people_[person].muscles ? people_[person].muscles->muscles.count() : 0;
  }

  std::span<const SpawnRequest> people_;
  std::vector<std::size_t> first_;
  std::vector<MuscleSize> size_;
};

tl::expected<void, NotMade> check_choices(std::span<const SpawnRequest> people, double tick_s) {
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (people[i].muscles && follows_moments(*people[i].muscles))
      return tl::unexpected(
          NotMade{i, Error{"activation by moments needs forces: spawn without muscles, then enable Feature::forces "
                           "and call set_muscles",
                           Status::missing}});
    if (!people[i].muscles || (i > 0 && people[i - 1].muscles == people[i].muscles)) continue;
    if (auto ok = check_choice(*people[i].muscles, tick_s); !ok) return tl::unexpected(NotMade{i, ok.error()});
  }
  return {};
}

/// Creates the muscles of people in the world, one choice at a time. `first`: number of the first person.
tl::expected<void, NotMade> begin_each_choice(const MuscleScene& scene, std::span<const SpawnRequest> people,
                                              std::span<const Entity> entities, std::size_t first, Sizes& sizes,
                                              std::vector<Entity>& made) {
  std::vector<const LegMuscles*> choices;
  for (const SpawnRequest& one : people) {
    const auto same = [&](const LegMuscles* choice) { return *choice == *one.muscles; };
    if (one.muscles && std::ranges::none_of(choices, same)) choices.push_back(&*one.muscles);
  }
  for (const LegMuscles* const choice : choices) {
    std::vector<std::size_t> who;
    std::vector<Entity> their_people;
    std::vector<MuscleSize> their;
    for (std::size_t i = 0; i < people.size(); ++i) {
      if (people[i].muscles != *choice) continue;
      who.push_back(first + i);
      their_people.push_back(entities[i]);
      const auto of = sizes.of(first + i);
      their.insert(their.end(), of.begin(), of.end());
    }
    auto begun = begin_muscles(scene.world, scene.library, *choice, scene.time, scene.jobs, their_people, their, made);
    if (!begun) return tl::unexpected(NotMade{who[begun.error().person], begun.error().error});
  }
  return {};
}

/// Returns the belly of a muscle of that plan; errors name the muscle.
Result<Belly> belly_of(BellyLibrary& library, const MusclePlan& plan, Muscle muscle, const LegMuscles& choice,
                       double tick_s) {
  auto belly = library.belly(plan, choice, tick_s);
  if (!belly) return fail(std::string(muscle_name(muscle)) + ": " + belly.error().message, belly.error().status);
  return belly;
}

}  // namespace

std::vector<MuscleRef> muscles_of(const World& world, Entity person) {
  std::vector<MuscleRef> all;
  world.each_member(person, [&](Entity member) {
    const auto owner = world.get<MuscleOwner>(member);
    const auto number = world.get<Muscle>(member);
    if (!owner || !number) return;
    const auto muscle = static_cast<Muscle>(*number);
    auto at = std::ranges::find(all, muscle, &MuscleRef::muscle);
    if (at == all.end()) at = all.insert(at, {muscle, {}});
    at->entity[owner->side] = member;
  });
  std::ranges::sort(all, {}, &MuscleRef::muscle);
  return all;
}

bool has_muscles(const World& world, Entity person) {
  bool any = false;
  world.each_member(person, [&](Entity member) { any = any || world.has<MuscleOwner>(member); });
  return any;
}

Entity muscle_of(const World& world, Entity person, Muscle muscle, Side side) {
  Entity found{};
  world.each_member(person, [&](Entity member) {
    if (world.get<Muscle>(member) == static_cast<std::uint64_t>(muscle) && world.get<MuscleOwner>(member)->side == side)
      found = member;
  });
  return found;
}

std::optional<LegMuscles> choice_of(const World& world, Entity person) {
  const std::vector<MuscleRef> own = muscles_of(world, person);
  if (own.empty()) return std::nullopt;
  const Entity first =
      world.alive(own.front().entity[Side::right]) ? own.front().entity[Side::right] : own.front().entity[Side::left];
  LegMuscles choice = *world.shared<LegMuscles>(first);
  const MuscleMethod method = muscle_method(world, first);
  choice.method = method.method;
  choice.modal = method.modal;
  choice.muscles.reset();
  for (const MuscleRef& one : own) choice.muscles.set(static_cast<std::size_t>(one.muscle));
  return choice;
}

Shared<LegMuscles> keep_choice(World& world, BellyLibrary& library, const LegMuscles& choice) {
  auto kept = library.whole_choice(choice);
  const std::uint64_t content = hash_of(*kept);
  return world.share(std::move(kept), content);
}

tl::expected<void, NotMade> spawn_people(const MuscleScene& scene, std::span<const SpawnRequest> people,
                                         std::span<Entity> entities) {
  constexpr std::size_t batch_size = 512;  // people whose rows are computed before they are written
  if (auto ok = check_choices(people, scene.time.tick_s); !ok) return ok;
  Sizes sizes(people);
  std::vector<BodySize<float>> body(people.size());
  std::vector<Gait<float>> gait(people.size());
  const auto set_sizes = [&](std::size_t i, const Body& of) { return sizes.set(i, of); };
  if (auto ok = check_people(scene.jobs, people, body, gait, set_sizes); !ok) return ok;

  NewRows rows(scene, people.size() + 2 * sizes.all(), entities);
  for (std::size_t first = 0, count = 0; first < people.size(); first += count) {
    const auto parts = people[first].parts;
    for (count = 1; count < std::min(batch_size, people.size() - first); ++count) {
      if (!std::ranges::equal(people[first + count].parts, parts)) break;
    }
    const auto some = people.subspan(first, count);
    const auto made = entities.subspan(first, count);
    create_walkers(scene.world, scene.jobs, some, std::span<const BodySize<float>>(body).subspan(first, count),
                   std::span<const Gait<float>>(gait).subspan(first, count), made);
    rows.made.insert(rows.made.end(), made.begin(), made.end());
    if (auto begun = begin_each_choice(scene, some, made, first, sizes, rows.made); !begun) return begun;
  }
  rows.done = true;
  return {};
}

Status despawn_people(World& world, const Jobs& jobs, std::span<const Entity> people) {
  std::size_t count = people.size();
  for (const Entity person : people) {
    if (!is_person(world, person)) return Status::stale_entity;
    world.each_member(person, [&](Entity) { ++count; });
  }
  if (!world.alive_once(people)) return Status::stale_entity;
  std::vector<Entity> rows;
  try {
    rows.reserve(count);
    for (const Entity person : people) {
      world.each_member(person, [&](Entity member) { rows.push_back(member); });
      rows.push_back(person);
    }
    world.destroy_many(rows, jobs);
  } catch (const std::bad_alloc&) {  // destroying one at a time allocates no memory
    for (const Entity person : people) {
      for (Entity member = world.first_member(person); world.alive(member); member = world.first_member(person))
        world.destroy(member);
      world.destroy(person);
    }
  }
  return Status::ok;
}

Result<void> begin_leg_muscles(const MuscleScene& scene, std::span<const Entity> people, const LegMuscles& choice) {
  World& world = scene.world;
  const std::size_t each = choice.muscles.count();
  std::vector<MuscleSize> size(people.size() * each);
  in_parallel(scene.jobs, people.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t h = begin; h < end; ++h) {
      check_interrupt();
      const Body body = *make_body(body_request(world, people[h]));
      auto at = size.begin() + static_cast<std::ptrdiff_t>(h * each);
      for (std::size_t m = 0; m < choice.muscles.size(); ++m)
        if (choice.muscles[m]) *at++ = size_of(*make_muscle_plan(body, static_cast<Muscle>(m)));
    }
  });
  NewRows rows(scene, 2 * size.size());
  auto begun = begin_muscles(world, scene.library, choice, scene.time, scene.jobs, people, size, rows.made);
  if (!begun) return tl::unexpected(begun.error().error);
  // A person who lost forces meanwhile has no moments to follow.
  for (const Entity person : people)
    if (follows_moments(choice) && world.has<JointMoments>(person))
      set_leg_moments(world, person, *make_body(body_request(world, person)), choice);
  rows.done = true;
  return {};
}

Result<void> add_leg_muscles(const MuscleScene& scene, Entity person, const LegMuscles& choice) {
  World& world = scene.world;
  if (!is_person(world, person)) return not_there();
  if (!muscles_of(world, person).empty())
    return fail("this person has leg muscles; remove them first", Status::already_there);
  if (auto ok = check_choice(choice, scene.time.tick_s); !ok) return ok;
  if (auto ok = check_leg_moments(world, person, choice); !ok) return ok;
  return begin_leg_muscles(scene, {&person, 1}, choice);
}

Result<void> check_leg_muscles(const World& world, BellyLibrary& library, double tick_s, Entity person,
                               const LegMuscles& choice) {
  if (!is_person(world, person)) return not_there();
  if (auto ok = check_choice(choice, tick_s); !ok) return ok;
  if (auto ok = check_leg_moments(world, person, choice); !ok) return ok;
  const Body body = *make_body(body_request(world, person));
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    if (!choice.muscles[m]) continue;
    const auto muscle = static_cast<Muscle>(m);
    if (auto belly = belly_of(library, *make_muscle_plan(body, muscle), muscle, choice, tick_s); !belly)
      return tl::unexpected(belly.error());
  }
  return {};
}

/// Existing muscles keep their handles, missing ones are created, and those outside the choice are destroyed.
Result<void> change_leg_muscles(const MuscleScene& scene, Entity person, const LegMuscles& choice) {
  World& world = scene.world;
  if (!is_person(world, person)) return not_there();
  const std::vector<MuscleRef> before = muscles_of(world, person);
  if (before.empty()) return fail("this person has no leg muscles; add them first", Status::missing);
  const Body body = *make_body(body_request(world, person));
  LegMuscles new_ones = choice;
  std::vector<MuscleRef> stay;
  std::vector<Belly> bellies;
  std::vector<MuscleSize> size;
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    if (!choice.muscles[m]) continue;
    const auto muscle = static_cast<Muscle>(m);
    const MusclePlan plan = *make_muscle_plan(body, muscle);
    const auto own = std::ranges::find(before, muscle, &MuscleRef::muscle);
    if (own == before.end()) {
      size.push_back(size_of(plan));
      continue;
    }
    new_ones.muscles.reset(m);
    stay.push_back(*own);
    auto belly = belly_of(scene.library, plan, muscle, choice, scene.time.tick_s);
    if (!belly) return tl::unexpected(belly.error());
    bellies.push_back(std::move(*belly));
  }
  NewRows rows(scene, 2 * size.size());
  auto begun = begin_muscles(world, scene.library, new_ones, scene.time, scene.jobs, {&person, 1}, size, rows.made);
  if (!begun) return tl::unexpected(begun.error().error);
  if (follows_moments(choice)) set_leg_moments(world, person, body, choice);
  change_muscles(world, scene.library, scene.work, {person, choice, false, scene.time}, bellies, stay);
  if (!follows_moments(choice)) forget_leg_moments(world, person);
  rows.done = true;
  for (const MuscleRef& one : before) {
    if (choice.muscles[static_cast<std::size_t>(one.muscle)]) continue;
    for (const Entity muscle : one.entity) world.destroy(muscle);
  }
  return {};
}

Status remove_leg_muscles(World& world, const Jobs& jobs, Entity person) {
  if (!is_person(world, person)) return Status::stale_entity;
  std::array<Entity, 2 * MuscleSet{}.size()> rows;
  std::size_t count = 0;
  world.each_member(person, [&](Entity member) {
    if (world.has<MuscleOwner>(member) && count < rows.size()) rows[count++] = member;
  });
  if (count == 0) return Status::missing;
  // A single call, so that nothing is removed if memory runs out. LegMuscles is the kept choice of a person who woke.
  const Status status =
      world.remove_parts(person, {type_id<LegDesign<float>>(), type_id<MomentReserve<float>>(),
                                  type_id<SharingProgress<float>>(), type_id<AskedForces>(), type_id<LegMuscles>()});
  if (status != Status::ok) return status;
  return world.destroy_many(std::span(rows).first(count), jobs);
}

Result<void> set_method(const MuscleScene& scene, Entity person, Muscle muscle, const MuscleMethod& method) {
  World& world = scene.world;
  if (!is_person(world, person)) return not_there();
  const MuscleRef own{muscle,
                      {muscle_of(world, person, muscle, Side::right), muscle_of(world, person, muscle, Side::left)}};
  const Entity one = world.alive(own.entity[Side::right]) ? own.entity[Side::right] : own.entity[Side::left];
  if (!world.alive(one)) return fail("this person has no such muscle; choose it in set_muscles", Status::missing);
  if (same_method(muscle_method(world, one), method)) return {};
  LegMuscles choice = *world.shared<LegMuscles>(one);
  choice.method = method.method;
  choice.modal = method.modal;
  const MusclePlan plan = *make_muscle_plan(*make_body(body_request(world, person)), muscle);
  const auto belly = belly_of(scene.library, plan, muscle, choice, scene.time.tick_s);
  if (!belly) return tl::unexpected(belly.error());
  change_muscles(world, scene.library, scene.work, {person, choice, true, scene.time}, {&*belly, 1}, {&own, 1});
  return {};
}

Result<void> check_excitation(const World& world, Entity person, Muscle muscle, Side side, float excitation) {
  if (!is_person(world, person)) return not_there();
  const Entity one = muscle_of(world, person, muscle, side);
  if (!world.alive(one)) return fail("this person has no such muscle; choose it in set_muscles", Status::missing);
  const std::string name(muscle_name(muscle));
  const auto source = static_cast<std::uint64_t>(ExcitationSource::host);
  if (world.get<ExcitationSource>(one) != source)
    return fail(name + ": the host does not excite it; choose ExcitationSource::host in set_muscles", Status::missing);
  if (!std::isfinite(excitation))
    return fail(name + ": the excitation is not a number; give one from 0 to 1", Status::not_valid);
  return {};
}

Result<void> set_excitation(World& world, Entity person, Muscle muscle, Side side, float excitation) {
  if (auto ok = check_excitation(world, person, muscle, side, excitation); !ok) return ok;
  const Entity one = muscle_of(world, person, muscle, side);
  Activation<float> row = *world.get<Activation>(one);
  row.excitation = std::clamp(excitation, min_activation, max_activation);
  world.set(one, row);
  return {};
}

void move_muscles(World& world, Entity person, const Placing& way) {
  using geometry::operator+, geometry::operator-;
  world.each_member(person, [&](Entity muscle) {
    const auto owner = world.get<MuscleOwner>(muscle);
    if (!owner) return;
    // A left muscle is stored in the mirror image of the world.
    const float mirrored = owner->side == Side::left ? -1.0F : 1.0F;
    const Vec3<float> from = {mirrored * way.from_x_m, 0, way.from_z_m}, to = {mirrored * way.to_x_m, 0, way.to_z_m};
    const double half = 0.5 * double{mirrored} * double{way.turn_rad()};
    const Quat<float> turn = {0, static_cast<float>(exact::sin(half)), 0, static_cast<float>(exact::cos(half))};
    const auto moved = [&](const Vec3<float>& at) { return to + geometry::rotated(turn, at - from); };
    if (auto line = world.get<LineOfAction>(muscle)) {
      line->start_m = moved(line->start_m);
      line->rotation = geometry::product(turn, line->rotation);
      world.set(muscle, *line);
    }
    if (auto history = world.get<FrameHistory>(muscle)) {
      history->start_m = moved(history->start_m);
      history->rotation = geometry::product(turn, history->rotation);
      history->step_m = geometry::rotated(turn, history->step_m);
      history->turn_rad = geometry::rotated(turn, history->turn_rad);
      world.set(muscle, *history);
    }
  });
}

void shift_muscles(World& world, float x_m, float z_m) {
  // A left muscle is stored in the mirror image of the world.
  const auto shift = [&](const MuscleOwner<Lanes<float>>& owner, Vec3<Lanes<float>>& at) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      at.x[lane] -= owner.side[lane] == Side::left ? -x_m : x_m;
      at.z[lane] -= z_m;
    }
  };
  each(world,
       [&](const MuscleOwner<Lanes<float>>& owner, LineOfAction<Lanes<float>>& line) { shift(owner, line.start_m); });
  each(world, [&](const MuscleOwner<Lanes<float>>& owner, FrameHistory<Lanes<float>>& history) {
    shift(owner, history.start_m);
  });
}

void forget_motion(World& world, Entity person) {
  for (const MuscleRef& own : muscles_of(world, person)) {
    for (const Entity muscle : own.entity)
      if (world.has<FrameHistory>(muscle)) world.set(muscle, FrameHistory<float>{});
  }
}

void end_fades(World& world, float tick_s, MuscleWork& work) {
  const std::uint32_t ticks = fade_ticks(tick_s);
  work.faded.clear();
  for (; work.tables_seen < world.tables().size(); ++work.tables_seen) {
    if (TableColumn<Fade>(world.tables()[work.tables_seen])) work.fading.push_back(work.tables_seen);
  }
  for (const std::size_t at : work.fading) {
    const Table& table = world.tables()[at];
    const TableColumn<Fade> fades(table);
    for (std::size_t b = 0; b < table.block_count(); ++b) {
      const auto& fade = fades.at(table, b);
      for (std::uint32_t lane = 0; lane < table.live(b); ++lane) {
        if (fade.ticks[lane] >= ticks) work.faded.push_back(table.entities(b)[lane]);
      }
    }
  }
  for (const Entity muscle : work.faded) {
    const auto place = world.find(muscle);
    if (place && shows_apart(place.table->key())) {
      world.remove_parts(muscle, {type_id<Fade<float>>(), type_id<FadeStart>()});
    } else {
      world.remove_parts(muscle, {type_id<Fade<float>>(), type_id<FadeStart>(), type_id<ShownDisplacement>()});
    }
  }
}

}  // namespace mobil::inline v0_3
