#include "systems/muscles/change_muscles.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <mobil/components/activation.h>
#include <mobil/components/fade.h>
#include "systems/deformation/deformation.h"
#include "systems/deformation/method_finite.h"
#include "systems/deformation/method_modal.h"
#include "systems/muscles/finite_shape_effect.h"
#include "systems/muscles/muscle_effect.h"
#include "systems/muscles/muscle_parts.h"

namespace mobil::inline v0_3 {
namespace {

/// One muscle of one leg.
struct OneChange : MuscleChange {
  Side side;
  const Belly& belly;
  Entity muscle;
};

/// New components of a muscle, and their values.
struct NextMuscle {
  Entity muscle;
  RowValues values;
  std::vector<PartValue> parts;
};

/// Returns the mesh of the control points; nothing for a muscle without a belly.
std::optional<Cells> cells_of(const MuscleKind& kind) {
  if (kind.basis.resource != nullptr) return kind.basis->options.control_cells;
  if (kind.shape.resource != nullptr) return kind.shape->mesh.cells;
  return std::nullopt;
}

/// Returns true if displacements of nodes are the method's state.
bool is_full(Method method) {
  return method != Method::modal && method != Method::none;
}

/// Returns a muscle's current line, or the line that a first tick would write.
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
  const Pose<float> pose = *world.get<Pose>(change.person);
  FirstLine first = first_line(*shape.lines, plan.leg_scale, far_end, rest, pose, change.side);
  if (line) first.line = *line;
  first.line.stiffness_n_per_m = rest.stiffness_n_per_m;
  return first;
}

/// Returns the shown displacement of a muscle and its velocity; `computed` is the result of the muscle's method.
BellyMotion shown_motion(const World& world, const OneChange& change, const MuscleKind& was, const NextBelly& next,
                         const BellyMotion& computed) {
  BellyMotion shown = computed;
  const auto tick_s = static_cast<float>(change.time.tick_s);
  if (was.finite.resource != nullptr && has_finite_shape(next.choice)) {
    const auto pulls = world.get<Activation>(change.muscle);
    const BellyMotion offset = shape_offset(next, pulls ? pulls->activation : 0);
    for (std::size_t i = 0; i < shown.velocity.size(); ++i) shown.velocity[i] += offset.velocity[i];
  }
  if (was.fading) add_fade(world, change.muscle, tick_s, shown);
  if (was.finite.resource == nullptr) return shown;
  std::vector<float> now = field_of<ShownDisplacement>(world, change.muscle);
  if (now.empty()) now = field_of<NodalDisplacement>(world, change.muscle);
  if (!now.empty()) shown.displacement = std::move(now);
  return shown;
}

/// Returns the far end's displacement along z at a tick's start and end, m: prescribed if held, else from `computed`.
EndDrive<float> end_of(const World& world, const OneChange& change, const MuscleKind& was,
                       const BellyMotion& computed) {
  const auto drive = world.get<EndDrive>(change.muscle);
  if (was.far_end == FarEnd::held && drive) return *drive;
  const Cells cells = *cells_of(was);
  const float to = plane_mean(computed.displacement, cells[2], plane_nodes(cells))[2];
  const float speed = plane_mean(computed.velocity, cells[2], plane_nodes(cells))[2];
  return {to - speed * static_cast<float>(change.time.tick_s), to};
}

/// Moves the belly statically with a far end that jumps because its tendon starts or stops stretching.
void move_end(const EndDrive<float>& was, const NextBelly& next, BellyMotion& motion) {
  if (next.load.far_end != FarEnd::held) return;
  BellyLoad jump = next.load;
  jump.frame.reset();
  jump.activation = 0;  // only the displacement of the end
  jump.from = jump.to = next.load.to - was.to;
  const BellyMotion moved = deformation_method(next.choice.method)->at_rest({next.belly, next.choice, next.line, jump});
  for (std::size_t i = 0; i < motion.displacement.size(); ++i) motion.displacement[i] += moved.displacement[i];
}

/// Converts `motion` between linear and finite strain, whose rest positions differ. Motion relative to the old rest
/// position becomes the same motion relative to the new one.
void change_strain(const World& world, const OneChange& change, const EndDrive<float>& was, const NextBelly& next,
                   BellyMotion& motion) {
  // A held end keeps its old displacement, a sliding end has its new load. Activation is the old one.
  BellyLoad load = next.load;
  if (load.far_end == FarEnd::held) {
    load.from = was.from;
    load.to = was.to;
  }
  const auto pulls = world.get<Activation>(change.muscle);
  load.activation = pulls ? pulls->activation : 0;
  const BellyMotion more = finite_less_linear({next.belly, next.choice, next.line, load});
  const float sign = next.choice.method == Method::finite ? 1.0F : -1.0F;
  for (std::size_t i = 0; i < motion.displacement.size(); ++i) {
    motion.displacement[i] += sign * more.displacement[i];
    motion.velocity[i] += sign * more.velocity[i];
  }
}

/// Returns the initial values of a belly. `offset` is the displacement that it will show in addition to its method's
/// result, or empty. Returns empty fields if all values continue unchanged.
Beginning beginning(const World& world, MuscleWork& work, const OneChange& change, const NextBelly& next,
                    const BellyMotion& offset) {
  const DeformationMethod* const method = deformation_method(next.choice.method);
  if (method == nullptr) return {};
  const auto tick_s = static_cast<float>(change.time.tick_s);
  const auto was = muscle_kind(world, change.muscle);
  const auto cells = was ? cells_of(*was) : std::nullopt;
  if (!cells || *cells != next.choice.cells) return method->begin(next, change.goes_on);
  const bool end_changes = (was->activation != ExcitationSource::none) != has_activation(next.choice);
  const bool finite_changes = (was->finite.resource != nullptr) != has_finite_shape(next.choice);
  const bool strain_changes = (was->method.method == Method::finite) != (next.choice.method == Method::finite);
  const bool same_sight = !was->fading && !end_changes && !finite_changes && !strain_changes;
  if (!change.goes_on && same_sight && is_full(next.choice.method) && is_full(was->method.method)) return {};
  auto computed = deformation_method(was->method.method)->computed(world, change.muscle, tick_s, work.last);
  if (!computed) return method->begin(next, true);
  PastBelly past;
  past.shown = shown_motion(world, change, *was, next, *computed);
  past.computed = std::move(*computed);
  past.seen = world.has<NodalDisplacement>(change.muscle);
  past.apart = !same_sight;
  const EndDrive<float> end = end_of(world, change, *was, past.computed);
  if (strain_changes) change_strain(world, change, end, next, past.computed);
  if (end_changes) move_end(end, next, past.computed);
  for (std::size_t i = 0; i < offset.displacement.size(); ++i) {
    past.shown.displacement[i] -= offset.displacement[i];
    past.shown.velocity[i] -= offset.velocity[i];
  }
  const bool keeps = next.choice.modal.moving && world.has<ModalState>(change.muscle) &&
                     was->basis.resource == next.belly.basis.get() && is_tuned(was->method) == is_tuned(next.choice);
  return method->go_on(next, past, keeps);
}

/// Sets the values of a belly. Adds `offset`, unless empty, to the method's result, in place or in ShownDisplacement.
void set_belly(const Beginning& from, const Belly& belly, const BellyMotion& offset, const MuscleKind& kind,
               RowValues& values) {
  values.set(belly.plan.scale);
  std::vector<float> shown = from.displacement;
  for (std::size_t i = 0; i < shown.size() && !offset.displacement.empty(); ++i) shown[i] += offset.displacement[i];
  values.set_field<NodalDisplacement>(shows_apart(kind) ? from.displacement : shown);
  values.set_field<NodalVelocity>(from.velocity);
  values.set_field<ModalState>(from.state);
  values.set_field<ModalMotion>(belly.motion);
  values.set_field<ModalShape>(belly.rest_shape);
  if (!from.fade.empty()) {
    values.set(Fade<float>{0});
    values.set_field<FadeStart>(from.fade);
    for (std::size_t i = 0; i < shown.size(); ++i) shown[i] += from.fade[i];
  }
  if (!from.fade.empty() || shows_apart(kind)) values.set_field<ShownDisplacement>(shown);
}

float next_activation(const World& world, const OneChange& change, const RowValues& values) {
  if (!has_activation(change.choice)) return 0;
  if (const auto begins = values.get<Activation>()) return begins->activation;
  const auto row = world.get<Activation>(change.muscle);
  return row ? row->activation : 0;
}

NextMuscle next_muscle(World& world, BellyLibrary& library, MuscleWork& work, const OneChange& change) {
  const Belly& belly = change.belly;
  const auto tick_s = static_cast<float>(change.time.tick_s);
  MuscleKind kind = kind_of(world, library, belly.plan.muscle, change.choice, belly);
  const FirstLine at = present_line(world, change);
  NextMuscle next{change.muscle, {}, {}};
  next.values.set(MuscleOwner<float>{change.person.index, change.person.generation, change.side});
  next.values.set(belly.plan.leg_scale);
  next.values.set(at.line);
  next.values.set(at.end);
  const MuscleSize size = size_of(belly.plan);
  for (const MuscleEffect& effect : muscle_effects()) {
    if (!effect.wanted(kind)) continue;
    effect.begin(
        {world, change.muscle, change.person, change.side, kind, size, at.line, change.time.tick, tick_s, work.recent},
        next.values);
  }
  const EndDrive<float> end = *next.values.get<EndDrive>();
  BellyLoad load{kind.far_end, end.from, end.to, {}, tick_s};
  if (kind.inertia)
    load.frame =
        next.values.get<FrameLoad>().value_or(world.get<FrameLoad>(change.muscle).value_or(FrameLoad<float>{}));
  load.activation = next_activation(world, change, next.values);
  const NextBelly next_belly{belly, change.choice, at.line, load};
  BellyMotion offset;
  if (kind.finite.resource != nullptr) offset = shape_offset(next_belly, load.activation);
  Beginning from = beginning(world, work, change, next_belly, offset);
  kind.fading = !from.fade.empty();
  if (from.displacement.empty() && shows_apart(kind))
    from.displacement = field_of<NodalDisplacement>(world, change.muscle);
  set_belly(from, belly, offset, kind, next.values);
  for (const ComponentId& part : muscle_parts(kind)) {
    next.parts.push_back({part, has_column(part.kind) ? next.values.find(part.id) : nullptr});
  }
  return next;
}

}  // namespace

std::uint32_t fade_ticks(float tick_s) {
  return static_cast<std::uint32_t>(std::ceil(fade_s / tick_s * (1 - 1e-5F)));
}

void change_muscles(World& world, BellyLibrary& library, MuscleWork& work, const MuscleChange& change,
                    std::span<const Belly> bellies, std::span<const MuscleRef> own) {
  // All allocations happen first. Rows of a muscle move only between tables of that muscle, so no earlier move takes
  // the room of a later one.
  std::vector<NextMuscle> next;
  next.reserve(2 * bellies.size());
  for (std::size_t m = 0; m < bellies.size(); ++m) {
    for (const Side side : {Side::right, Side::left}) {
      if (!world.alive(own[m].entity[side])) continue;
      next.push_back(next_muscle(world, library, work, {change, side, bellies[m], own[m].entity[side]}));
      world.reserve_remade(next.back().muscle, next.back().parts, muscle_part_ids(), 2);
    }
  }
  for (const NextMuscle& one : next) {
    world.remake_from(one.muscle, one.parts, muscle_part_ids());
    place_now(world, one.muscle);
  }
}

}  // namespace mobil::inline v0_3
