#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "assets/reduction/reduced_bellies.h"
#include "components/pose.h"
#include "engine/access.h"
#include "systems/deformation/deformation.h"
#include "systems/lines/line_of_action.h"
#include "systems/people/simulation_spawn.h"

namespace mobil {
namespace {

template <class T>
using Blocks = std::unique_ptr<T[]>;

/// Muscles of one kind and one basis, which share a table: their values in blocks of sixteen people.
template <template <class> class End>
struct Group {
  std::size_t muscle;  // of the choice's
  const BellyTemplate* shape;
  std::shared_ptr<const ReducedBasis> basis;
  std::vector<std::uint32_t> who;

  Blocks<LegScale<Lanes<float>>> leg_scale;
  Blocks<BellyScale<Lanes<float>>> scale;
  Blocks<Lanes<float>> motion, rest_shape;
  struct OfSide {
    Blocks<MuscleOwner<Lanes<float>>> owner;
    Blocks<LineOfAction<Lanes<float>>> line;
    Blocks<End<Lanes<float>>> end;
    Blocks<Lanes<float>> displacement;
  };
  std::array<OfSide, 2> side;
  std::size_t motion_width = 0, shape_width = 0, nodal = 0;

  std::size_t blocks() const { return (who.size() + lane_count - 1) / lane_count; }
};

template <template <class> class End>
void make_room(Group<End>& group, const LegMuscles& choice) {
  const std::size_t blocks = group.blocks();
  const auto room = [blocks](auto& column, std::size_t words = 1) {
    using T = typename std::remove_reference_t<decltype(column)>::element_type;
    column = std::make_unique_for_overwrite<T[]>(blocks * words);
  };
  room(group.leg_scale);
  for (auto& side : group.side) {
    room(side.owner);
    room(side.line);
    room(side.end);
  }
  if (group.basis == nullptr) return;
  const ReducedBasis& basis = *group.basis;
  room(group.scale);
  if (choice.reduced.moving) {
    group.motion_width = reduced_motion_width(basis.vectors, basis.inputs);
    room(group.motion, group.motion_width);
  }
  if (!choice.reduced.control_points) return;
  group.shape_width = reduced_shape_width(basis.vectors, basis.inputs);
  group.nodal = nodal_width(choice.cells);
  room(group.rest_shape, group.shape_width);
  for (auto& side : group.side) room(side.displacement, group.nodal);
}

Lanes<float>& end_of(EndDisplacement<Lanes<float>>& end) {
  return end.to_m;
}
Lanes<float>& end_of(EndForce<Lanes<float>>& end) {
  return end.to_n;
}

/// What sixteen people of a group begin with.
struct Beginners {
  const World& world;
  std::span<const Entity> people;
  std::span<const MuscleSize> size;
  std::size_t muscles;  // a person
  float tick_s;
};

template <template <class> class End>
Result<void> begin_block(const Beginners& all, Group<End>& group, std::size_t b) {
  const std::size_t count = std::min(lane_count, group.who.size() - b * lane_count);
  const auto person = [&](std::size_t lane) { return group.who[b * lane_count + (lane < count ? lane : 0)]; };
  LegScale<Lanes<float>>& leg_scale = group.leg_scale[b];
  LineOfAction<Lanes<float>> rest{};
  std::array<BellyScale<float>, lane_count> scale;
  std::array<LegFrames<Lanes<float>>, 2> leg;
  const Lookup<Pose> poses(all.world);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const MuscleSize& size = all.size[person(lane) * all.muscles + group.muscle];
    const Entity human = all.people[person(lane)];
    leg_scale.thigh[lane] = size.leg_scale.thigh;
    leg_scale.shank[lane] = size.leg_scale.shank;
    leg_scale.across[lane] = size.leg_scale.across;
    rest.rest_length_m[lane] = size.rest_length_m;
    rest.stiffness_n_per_m[lane] = static_cast<float>(axial_stiffness(
        group.shape->axial, static_cast<double>(size.scale.across), static_cast<double>(size.scale.along)));
    scale[lane] = size.scale;
    const float* const pose = poses.find(human);
    for (const Side side : {right, left}) {
      gather_leg(pose, side, leg[side], lane);
      MuscleOwner<Lanes<float>>& owner = group.side[side].owner[b];
      owner.index[lane] = human.index;
      owner.generation[lane] = human.generation;
      owner.side[lane] = side;
    }
  }
  for (const Side side : {right, left}) {
    auto& of = group.side[side];
    of.line[b] = rest;
    of.end[b] = {};
    lines_of_action(*group.shape->lines, leg_scale, leg[side], of.line[b], of.end[b]);
  }
  if (group.basis == nullptr) return {};

  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    group.scale[b].across[lane] = scale[lane].across;
    group.scale[b].along[lane] = scale[lane].along;
  }
  const ReducedBasis& basis = *group.basis;
  ReducedBellies bellies;
  if (auto solved = solve_bellies(basis, {scale.data(), count}, bellies); !solved) return solved;
  const double damping = basis.options.damping_per_s;
  if (group.motion) {
    write_motions(bellies, damping, static_cast<double>(all.tick_s), group.motion[b * group.motion_width].lane);
  }
  if (!group.rest_shape) return {};
  write_shapes(bellies, damping, group.rest_shape[b * group.shape_width].lane);
  for (auto& side : group.side) {
    place_at_rest(basis, bellies, end_of(side.end[b]), side.displacement[b * group.nodal].lane);
  }
  return {};
}

/// Both sides' rows.
template <template <class> class End>
void create_rows(World& world, const LegMuscles& choice, const Jobs& jobs, const Group<End>& group, std::size_t muscles,
                 std::span<OwnMuscle> own, std::vector<Entity>& all_made) {
  const ReducedBasis* const basis = group.basis.get();
  for (const Side side : {right, left}) {
    const auto& of = group.side[side];
    std::vector<PartValue> parts;
    const auto component = [&](const auto* blocks) {
      parts.push_back(
          {[]<template <class> class C>(const C<Lanes<float>>*) { return component_part<C>(); }(blocks), blocks});
    };
    const auto field = [&]<class Tag>(FieldWidth<Tag> width, const Lanes<float>* blocks) {
      parts.push_back({key_part(width), blocks});
    };
    const auto words = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
    component(of.owner.get());
    component(group.leg_scale.get());
    component(of.line.get());
    component(of.end.get());
    parts.push_back(part_value(world.share(group.shape->lines)));
    if (basis != nullptr) {
      component(group.scale.get());
      parts.push_back(part_value(world.share(group.basis)));
      if (choice.reduced.moving) {
        field(FieldWidth<ReducedState>{words(reduced_state_width(basis->vectors))}, nullptr);
        field(FieldWidth<ReducedMotion>{words(group.motion_width)}, group.motion.get());
      } else {
        parts.push_back(part_value(TagValue<ReducedStatic>{1}));
      }
      if (choice.reduced.control_points) {
        field(FieldWidth<ReducedShape>{words(group.shape_width)}, group.rest_shape.get());
        parts.push_back(part_value(world.share(group.shape->shape)));
        field(FieldWidth<NodalDisplacement>{words(group.nodal)}, of.displacement.get());
        if (choice.reduced.reported) parts.push_back({component_part<BellyReport>(), nullptr});
      }
    }
    std::vector<Entity> made(group.who.size());
    world.create_many(parts, made, jobs);
    all_made.insert(all_made.end(), made.begin(), made.end());
    for (std::size_t i = 0; i < made.size(); ++i) own[group.who[i] * muscles + group.muscle].entity[side] = made[i];
  }
}

template <template <class> class End>
tl::expected<void, NotMade> begin_with(World& world, BellyLibrary& library, const LegMuscles& choice, float tick_s,
                                       const Jobs& jobs, std::span<const Entity> people,
                                       std::span<const MuscleSize> size, std::span<OwnMuscle> own,
                                       std::vector<Entity>& made) {
  const std::size_t muscles = choice.muscles.count();
  std::vector<Group<End>> groups;
  for (std::size_t at = 0, number = 0; number < choice.muscles.size(); ++number) {
    if (!choice.muscles[number]) continue;
    const auto muscle = static_cast<Muscle>(number);
    const std::size_t first = groups.size();
    for (std::uint32_t i = 0; i < people.size(); ++i) {
      auto shared = library.shared(muscle, choice, size[i * muscles + at].scale);
      if (!shared) {
        return tl::unexpected(NotMade{i, {std::string(muscle_name(muscle)) + ": " + shared.error().message}});
      }
      std::size_t g = first;
      while (g < groups.size() && groups[g].basis != shared->basis) ++g;
      if (g == groups.size()) {
        groups.push_back({});
        groups[g].muscle = at;
        groups[g].shape = shared->shape;
        groups[g].basis = std::move(shared->basis);
      }
      groups[g].who.push_back(i);
      own[i * muscles + at] = {muscle, {}, {choice.method, choice.reduced}};
    }
    ++at;
  }
  struct Task {
    std::size_t group, block;
    Result<void> done;
  };
  std::vector<Task> tasks;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    make_room(groups[g], choice);
    for (std::size_t b = 0; b < groups[g].blocks(); ++b) tasks.push_back({g, b, {}});
  }
  const Beginners all{world, people, size, muscles, tick_s};
  in_parallel(jobs, tasks.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      tasks[t].done = begin_block(all, groups[tasks[t].group], tasks[t].block);
    }
  });
  for (const Task& task : tasks) {
    if (!task.done) return tl::unexpected(NotMade{groups[task.group].who[task.block * lane_count], task.done.error()});
  }
  for (const auto& group : groups) create_rows(world, choice, jobs, group, muscles, own, made);
  return {};
}

}  // namespace

MuscleSize size_of(const MusclePlan& plan) {
  return {plan.scale, plan.leg_scale, static_cast<float>(plan.rest_length_m)};
}

bool begin_together(const LegMuscles& choice) {
  const bool fits = choice.method == Method::none || choice.method == Method::reduced;
  return fits && !choice.inertia && !choice.line_motion;
}

tl::expected<void, NotMade> begin_muscles(World& world, BellyLibrary& library, const LegMuscles& choice, float tick_s,
                                          const Jobs& jobs, std::span<const Entity> people,
                                          std::span<const MuscleSize> size, std::span<OwnMuscle> own,
                                          std::vector<Entity>& made) {
  return choice.drive == Drive::displacement
             ? begin_with<EndDisplacement>(world, library, choice, tick_s, jobs, people, size, own, made)
             : begin_with<EndForce>(world, library, choice, tick_s, jobs, people, size, own, made);
}

}  // namespace mobil
