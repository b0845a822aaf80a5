#include "systems/muscles/change_muscles.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "components/fade.h"
#include "systems/deformation/deformation.h"
#include "systems/muscles/muscle_effect.h"
#include "systems/muscles/muscle_parts.h"

namespace mobil {
namespace {

/// One muscle of one leg.
struct OneChange : MuscleChange {
  Side side;
  const Belly& belly;
  Entity muscle;
};

/// What a muscle is about to become.
struct NextMuscle {
  Entity muscle;
  RowValues values;
  std::vector<PartValue> parts;
};

/// The control points' mesh; nothing where a muscle has no belly.
std::optional<Cells> cells_of(const MuscleKind& kind) {
  if (kind.basis.resource != nullptr) return kind.basis->options.control_cells;
  if (kind.shape.resource != nullptr) return kind.shape->mesh.cells;
  return std::nullopt;
}

/// Whether displacements of nodes are the state itself.
bool is_full(Method method) {
  return method != Method::reduced && method != Method::none;
}

/// A muscle's line as it is, or as a first tick would write it.
FirstLine present_line(const World& world, const OneChange& change) {
  const MusclePlan& plan = change.belly.plan;
  const BellyTemplate& shape = *change.belly.shape;
  LineOfAction<float> rest{};
  rest.rest_length_m = static_cast<float>(plan.rest_length_m);
  rest.stiffness_n_per_m = static_cast<float>(
      axial_stiffness(shape.axial, static_cast<double>(plan.scale.across), static_cast<double>(plan.scale.along)));
  const auto line = world.get<LineOfAction>(change.muscle);
  const auto end = world.get<EndDrive>(change.muscle);
  const FarEnd far_end = far_end_of(change.choice);
  const bool same_drive = world.get<FarEnd>(change.muscle) == static_cast<std::uint64_t>(far_end) &&
                          world.has<Activation>(change.muscle) == has_activation(change.choice);
  if (line && end && same_drive) {
    FirstLine present{*line, *end};
    present.line.stiffness_n_per_m = rest.stiffness_n_per_m;
    return present;
  }
  const Pose<float> pose = *world.get<Pose>(change.human);
  FirstLine first = first_line(*shape.lines, plan.leg_scale, far_end, rest, pose, change.side);
  if (line) first.line = *line;
  first.line.stiffness_n_per_m = rest.stiffness_n_per_m;
  return first;
}

/// What the belly begins with. Empty throughout where all goes on as it is.
Beginning beginning(const World& world, MuscleWork& work, const OneChange& change, const NextBelly& next) {
  const DeformationMethod* const method = deformation_method(next.choice.method);
  if (method == nullptr) return {};
  const auto tick_s = static_cast<float>(change.time.tick_s);
  const auto was = muscle_kind(world, change.muscle);
  const auto cells = was ? cells_of(*was) : std::nullopt;
  if (!cells || *cells != next.choice.cells) return method->begin(next, change.goes_on);
  if (!change.goes_on && !was->fading && is_full(next.choice.method) && is_full(was->method.method)) return {};
  auto computed = deformation_method(was->method.method)->computed(world, change.muscle, tick_s, work.last);
  if (!computed) return method->begin(next, true);
  PastBelly past;
  past.shown = past.computed = std::move(*computed);
  past.seen = world.has<NodalDisplacement>(change.muscle);
  if (was->fading) add_fade(world, change.muscle, tick_s, past.shown);
  const bool keeps = next.choice.reduced.moving && world.has<ReducedState>(change.muscle) &&
                     was->basis.resource == next.belly.basis.get();
  return method->go_on(next, past, keeps);
}

void set_belly(const Beginning& from, const Belly& belly, RowValues& values) {
  values.set(belly.plan.scale);
  values.set_field<NodalDisplacement>(from.displacement);
  values.set_field<NodalVelocity>(from.velocity);
  values.set_field<ReducedState>(from.state);
  values.set_field<ReducedMotion>(belly.motion);
  values.set_field<ReducedShape>(belly.rest_shape);
  if (from.fade.empty()) return;
  values.set(Fade<float>{0});
  values.set_field<FadeStart>(from.fade);
  std::vector<float> shown(from.displacement.size());
  for (std::size_t i = 0; i < shown.size(); ++i) shown[i] = from.displacement[i] + from.fade[i];
  values.set_field<ShownDisplacement>(shown);
}

NextMuscle next_muscle(World& world, BellyLibrary& library, MuscleWork& work, const OneChange& change) {
  const Belly& belly = change.belly;
  const auto tick_s = static_cast<float>(change.time.tick_s);
  MuscleKind kind = kind_of(world, library, belly.plan.muscle, change.choice, belly);
  const FirstLine at = present_line(world, change);
  NextMuscle next{change.muscle, {}, {}};
  next.values.set(MuscleOwner<float>{change.human.index, change.human.generation, change.side});
  next.values.set(belly.plan.leg_scale);
  next.values.set(at.line);
  next.values.set(at.end);
  const MuscleSize size = size_of(belly.plan);
  for (const MuscleEffect& effect : muscle_effects()) {
    if (!effect.wanted(kind)) continue;
    effect.begin(
        {world, change.muscle, change.human, change.side, kind, size, at.line, change.time.tick, tick_s, work.recent},
        next.values);
  }
  const EndDrive<float> end = *next.values.get<EndDrive>();
  BellyLoad load{kind.far_end, end.from, end.to, {}, tick_s};
  if (kind.inertia)
    load.frame =
        next.values.get<FrameLoad>().value_or(world.get<FrameLoad>(change.muscle).value_or(FrameLoad<float>{}));
  const Beginning from = beginning(world, work, change, {belly, change.choice, at.line, load});
  kind.fading = !from.fade.empty();
  set_belly(from, belly, next.values);
  for (const KeyPart& part : muscle_parts(kind)) {
    next.parts.push_back({part, has_column(part.kind) ? next.values.find(part.id) : nullptr});
  }
  return next;
}

}  // namespace

std::uint32_t fade_ticks(float tick_s) {
  return static_cast<std::uint32_t>(std::ceil(fade_s / tick_s * (1 - 1e-5F)));
}

void change_muscles(World& world, BellyLibrary& library, MuscleWork& work, const MuscleChange& change,
                    std::span<const Belly> bellies, std::span<const OwnMuscle> own) {
  // All that takes memory comes first. A muscle's rows come from and go to tables of that muscle alone, so that none of
  // those that go before takes the room of another.
  std::vector<NextMuscle> next;
  next.reserve(2 * bellies.size());
  for (std::size_t m = 0; m < bellies.size(); ++m) {
    for (const Side side : {Side::right, Side::left}) {
      if (!world.alive(own[m].entity[side])) continue;
      next.push_back(next_muscle(world, library, work, {change, side, bellies[m], own[m].entity[side]}));
      world.reserve_remade(next.back().muscle, next.back().parts, muscle_part_ids(), 2);
    }
  }
  for (const NextMuscle& one : next) world.remake_from(one.muscle, one.parts, muscle_part_ids());
}

}  // namespace mobil
