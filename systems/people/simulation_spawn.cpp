// People who come and go, many at once.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include "assets/body/anthropometry.h"
#include "components/leg_frames.h"
#include "components/relevance.h"
#include "systems/gait/gait.h"
#include "systems/kinematics/kinematics.h"
#include "systems/muscles/begin_muscles.h"
#include "systems/muscles/change_muscles.h"
#include "systems/people/simulation_batch.h"
#include "systems/simulation.h"

namespace mobil {
namespace {

constexpr std::size_t together = 512;  // people whose rows are made before they are written

/// What is worked out of a request before anything changes.
struct Checked {
  Gait<float> gait;
  std::uint32_t choice = 0;    // of People::choices()
  std::size_t first_size = 0;  // of the muscles'
};

Result<void> check_place(const SpawnRequest& request) {
  if (std::fabs(request.x_m) < 1e6F && std::fabs(request.z_m) < 1e6F && std::fabs(request.heading_rad) < 1e4F) {
    return {};
  }
  return fail(fmt::format("a place of {} and {} m or a heading of {} rad is not within ±1000000 m and ±10000 rad",
                          request.x_m, request.z_m, request.heading_rad));
}

Result<void> check(const SpawnRequest& request, Checked& checked, std::span<MuscleSize> size) {
  const auto body = make_body(request.body);
  if (!body) return tl::unexpected(body.error());
  auto gait = resolve_gait(*body, request.gait);
  if (!gait) return tl::unexpected(gait.error());
  if (auto placed = check_place(request); !placed) return placed;
  checked.gait = *gait;
  checked.gait.heading_rad = request.heading_rad;
  for (std::size_t m = 0, at = 0; at < size.size(); ++m) {
    if (!request.muscles->muscles[m]) continue;
    const auto plan = make_muscle_plan(*body, static_cast<Muscle>(m));
    if (!plan) return tl::unexpected(plan.error());
    size[at++] = size_of(*plan);
  }
  return {};
}

/// What kinematics makes of walkers' first instants, sixteen to a block.
struct FirstInstants {
  explicit FirstInstants(std::size_t blocks)
      : size(std::make_unique_for_overwrite<BodySize<Lanes<float>>[]>(blocks)),
        gait(std::make_unique_for_overwrite<Gait<Lanes<float>>[]>(blocks)),
        plan(std::make_unique<StepPlan<Lanes<float>>[]>(blocks)),
        state(std::make_unique<GaitState<Lanes<float>>[]>(blocks)),
        pose(std::make_unique_for_overwrite<Pose<Lanes<float>>[]>(blocks)),
        angles(std::make_unique_for_overwrite<JointAngles<Lanes<float>>[]>(blocks)),
        feet(std::make_unique_for_overwrite<Feet<Lanes<float>>[]>(blocks)),
        centre(std::make_unique_for_overwrite<CentreOfMass<Lanes<float>>[]>(blocks)) {}

  void make(std::size_t b, std::span<const SpawnRequest> people, std::span<const Checked> checked) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const std::size_t i = b * lane_count + lane < people.size() ? b * lane_count + lane : b * lane_count;
      const SpawnRequest& request = people[i];
      size[b].height_m[lane] = request.body.height_m;
      size[b].mass_kg[lane] = request.body.mass_kg;
      state[b].line_x_m[lane] = request.x_m;
      state[b].line_z_m[lane] = request.z_m;
      state[b].heading_rad[lane] = request.heading_rad;
      const auto* row = reinterpret_cast<const std::byte*>(&checked[i].gait);
      auto* to = reinterpret_cast<std::byte*>(&gait[b]) + 4 * lane;
      for (std::size_t w = 0; w < sizeof(Gait<float>); w += 4) std::memcpy(to + w * lane_count, row + w, 4);
    }
    plan_first_step(size[b], gait[b], plan[b]);
    pose_skeleton(size[b], plan[b], state[b], pose[b], angles[b], feet[b]);
    centre_of_mass(size[b], pose[b], centre[b]);
  }

  /// Those at the end are of people who are `managed`.
  std::span<const PartValue> parts(bool managed) {
    parts_ = {{{component_part<BodySize>(), size.get()},
               {component_part<Gait>(), gait.get()},
               {component_part<StepPlan>(), plan.get()},
               {component_part<GaitState>(), state.get()},
               {component_part<Pose>(), pose.get()},
               {component_part<JointAngles>(), angles.get()},
               {component_part<Feet>(), feet.get()},
               {component_part<CentreOfMass>(), centre.get()},
               part_value(Publishes<LegPost>{}),
               {component_part<Needs>(), nullptr},
               {component_part<Tiers>(), nullptr}}};
    return std::span(parts_).first(managed ? parts_.size() : parts_.size() - 2);
  }

  std::unique_ptr<BodySize<Lanes<float>>[]> size;
  std::unique_ptr<Gait<Lanes<float>>[]> gait;
  std::unique_ptr<StepPlan<Lanes<float>>[]> plan;
  std::unique_ptr<GaitState<Lanes<float>>[]> state;
  std::unique_ptr<Pose<Lanes<float>>[]> pose;
  std::unique_ptr<JointAngles<Lanes<float>>[]> angles;
  std::unique_ptr<Feet<Lanes<float>>[]> feet;
  std::unique_ptr<CentreOfMass<Lanes<float>>[]> centre;

 private:
  std::array<PartValue, 11> parts_{};
};

}  // namespace

tl::expected<void, NotMade> Simulation::spawn_all(std::span<const SpawnRequest> people, std::span<Entity> entities) {
  std::vector<Checked> checked(people.size());
  std::size_t sizes = 0;
  for (std::size_t i = 0; i < people.size(); ++i) {
    checked[i].first_size = sizes;
    if (!people[i].muscles) continue;
    const LegMuscles& choice = *people[i].muscles;
    if (i > 0 && people[i - 1].muscles == choice) {
      checked[i].choice = checked[i - 1].choice;
    } else {
      if (auto ok = check_choice(choice, tick_s()); !ok) return tl::unexpected(NotMade{i, ok.error()});
      checked[i].choice = people_.number_of(choice);
    }
    sizes += choice.muscles.count();
  }
  std::vector<MuscleSize> size(sizes);
  const auto sizes_of = [&](std::size_t i) {
    return std::span(size).subspan(checked[i].first_size, people[i].muscles ? people[i].muscles->muscles.count() : 0);
  };
  std::atomic<std::size_t> wrong = people.size();  // the first of those who cannot be
  in_parallel(jobs_, people.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (check(people[i], checked[i], sizes_of(i))) continue;
      for (std::size_t before = wrong; i < before && !wrong.compare_exchange_weak(before, i);) {
      }
      return;
    }
  });
  if (const std::size_t i = wrong; i < people.size()) {
    return tl::unexpected(NotMade{i, check(people[i], checked[i], sizes_of(i)).error()});
  }

  Batch batch(*this, people.size() + 2 * sizes);
  batch.entities = entities;
  for (std::size_t first = 0, count = 0; first < people.size(); first += count) {
    const bool managed = people[first].managed;
    for (count = 1; count < std::min(together, people.size() - first); ++count) {
      if (people[first + count].managed != managed) break;
    }
    const auto some = people.subspan(first, count);
    const auto some_checked = std::span<const Checked>(checked).subspan(first, count);
    const auto made = entities.subspan(first, count);
    const std::size_t blocks = (count + lane_count - 1) / lane_count;
    FirstInstants instants(blocks);
    in_parallel(jobs_, blocks, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) instants.make(b, some, some_checked);
    });
    world_.create_many(instants.parts(managed), made, jobs_);
    batch.made.insert(batch.made.end(), made.begin(), made.end());
    std::size_t index_end = 0;
    for (const Entity entity : made) index_end = std::max(index_end, std::size_t{entity.index} + 1);
    people_.reserve(count, index_end);
    std::vector<std::uint32_t> choices;
    for (std::size_t i = 0; i < count; ++i) {
      people_.add({made[i], some[i].body, false, some_checked[i].choice, {}});
      if (some[i].muscles && std::find(choices.begin(), choices.end(), some_checked[i].choice) == choices.end()) {
        choices.push_back(some_checked[i].choice);
      }
    }
    for (const std::uint32_t number : choices) {
      const LegMuscles choice = people_.choices()[number];
      std::vector<std::size_t> who;
      std::vector<Entity> humans;
      std::vector<MuscleSize> their;
      for (std::size_t i = 0; i < count; ++i) {
        if (!some[i].muscles || some_checked[i].choice != number) continue;
        who.push_back(first + i);
        humans.push_back(made[i]);
        const auto of = sizes_of(first + i);
        their.insert(their.end(), of.begin(), of.end());
      }
      if (auto begun = begin(batch, humans, their, choice); !begun) {
        return tl::unexpected(NotMade{who[begun.error().person], begun.error().error});
      }
    }
  }
  batch.done = true;
  return {};
}

tl::expected<void, NotMade> Simulation::begin(Batch& batch, std::span<const Entity> people,
                                              std::span<const MuscleSize> size, const LegMuscles& choice) {
  const std::size_t muscles = choice.muscles.count();
  std::vector<OwnMuscle> own(people.size() * muscles);
  std::vector<std::vector<OwnMuscle>> theirs(people.size());
  for (auto& one : theirs) one.reserve(muscles);
  auto begun = begin_muscles(world_, bellies_, choice, {tick_, tick_s()}, jobs_, people, size, own, batch.made);
  if (!begun) return begun;
  for (std::size_t i = 0; i < people.size(); ++i) {
    PersonRecord& person = *find(people[i]);
    theirs[i].assign(own.begin() + static_cast<std::ptrdiff_t>(i * muscles),
                     own.begin() + static_cast<std::ptrdiff_t>((i + 1) * muscles));
    person.muscles = std::move(theirs[i]);
  }
  return {};
}

Result<void> Simulation::spawn(std::span<const SpawnRequest> people, std::span<Entity> entities) {
  if (people.size() != entities.size()) {
    return fail(
        fmt::format("spawn: {} people, and room for the handles of {}; give as many", people.size(), entities.size()));
  }
  auto made = spawn_all(people, entities);
  if (!made) return fail(fmt::format("spawn: person {}: {}", made.error().person, made.error().error.message));
  return {};
}

Result<Entity> Simulation::spawn(const BodyRequest& body, const GaitRequest& gait) {
  const SpawnRequest request{body, gait, 0, 0, 0, {}};
  Entity entity;
  if (auto made = spawn_all({&request, 1}, {&entity, 1}); !made) return tl::unexpected(made.error().error);
  return entity;
}

Result<void> Simulation::add_leg_muscles(Entity entity, const LegMuscles& choice) {
  const PersonRecord* human = person(entity);
  if (human == nullptr) return fail("add_leg_muscles: that person is not there (a stale handle); spawn one first");
  if (!human->muscles.empty()) return fail("add_leg_muscles: this person has leg muscles; remove them first");
  if (auto ok = check_choice(choice, tick_s()); !ok) return fail("add_leg_muscles: " + ok.error().message);
  const std::uint32_t number = people_.number_of(choice);
  std::vector<MuscleSize> size;
  const auto body = make_body(human->body);
  for (std::size_t m = 0; m < choice.muscles.size(); ++m) {
    if (choice.muscles[m]) size.push_back(size_of(*make_muscle_plan(*body, static_cast<Muscle>(m))));
  }
  Batch batch(*this, 2 * choice.muscles.count());
  if (auto begun = begin(batch, {&entity, 1}, size, choice); !begun) {
    return fail("add_leg_muscles: " + begun.error().error.message);
  }
  batch.done = true;
  find(entity)->choice = number;
  return {};
}

Status Simulation::despawn(std::span<const Entity> people) {
  std::size_t count = people.size();
  for (const Entity entity : people) {
    const PersonRecord* of = person(entity);
    if (of == nullptr) return Status::stale_entity;
    count += 2 * of->muscles.size();
  }
  if (!world_.alive_once(people)) return Status::stale_entity;
  const auto each_row = [&](const auto& go) {
    for (const Entity entity : people) {
      for (const OwnMuscle& own : find(entity)->muscles) {
        for (const Entity muscle : own.entity) go(muscle);
      }
      go(entity);
    }
  };
  std::vector<Entity> rows;
  try {
    rows.reserve(count);
    each_row([&](Entity row) {
      if (world_.alive(row)) rows.push_back(row);
    });
    world_.destroy_many(rows, jobs_);
  } catch (const std::bad_alloc&) {  // going needs no memory
    each_row([&](Entity row) { world_.destroy(row); });
  }
  for (const Entity entity : people) people_.remove(entity);
  return Status::ok;
}

Status Simulation::despawn(Entity entity) {
  return despawn(std::span(&entity, 1));
}

}  // namespace mobil
