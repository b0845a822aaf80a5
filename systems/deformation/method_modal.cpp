#include "systems/deformation/method_modal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <mobil/components/activation.h>
#include <mobil/each.h>
#include "assets/reduction/modal_bellies.h"
#include "systems/deformation/modal.h"
#include "systems/deformation/restart.h"

namespace mobil::inline v0_3 {
namespace {
namespace of_modal {

void move(const Table& table, Shared<ModalBasis> basis, float tick_s, const BellyScale<Lanes<float>>& scale,
          const EndDrive<Lanes<float>>& end, Maybe<FrameLoad> frame, Maybe<Activation> activation,
          Field<const ModalMotion> motion, Field<ModalState> state, const Rows& rows,
          Tally<RestartedBellies> restarted) {
  const ModalBlock block{*basis, scale, state.data, motion.data, frame.block, state.next, motion.next};
  const FarFaceDrive drive(basis->options.far_end, end);
  const bool tuned = find_component(table.key(), type_id<ModalTuned>()) != nullptr;
  restarted.add(count_rows(
      tuned ? deform_tuned(block, drive, activation.block->activation, tick_s) : deform_modal(block, drive, tick_s),
      rows));
}

/// Returns a block whose state is only read.
ModalBlock read_only(const ModalBasis& basis, const BellyScale<Lanes<float>>& scale, const float* state,
                     const float* motion, const FrameLoad<Lanes<float>>* frame) {
  return {basis, scale, const_cast<float*>(state), motion, frame};
}

/// Returns true if control points are written past the caches: no system reads them in this tick, and the table's
/// exceed its share of the caches. A crowd has about forty such tables (eight muscles in five ranges of slenderness).
/// In `mobil crowd --all-seen`, 300 people would lose a third and 800 nothing; 1500 and more are placed 1.5 to 2 times
/// faster.
bool streamed(const Table& table, std::uint32_t words) {
  constexpr std::size_t kept_bytes = 512 * 1024;
  if (find_component(table.key(), type_id<BellyReport<float>>()) != nullptr) return false;
  return std::size_t{table.row_count()} * words * sizeof(float) > kept_bytes;
}

/// Returns true if a finite shape places the control points again and computes their volume.
bool is_replaced(const Table& table) {
  return find_component(table.key(), type_id<FiniteShape>()) != nullptr;
}

void place(const Table& table, Shared<ModalBasis> basis, const BellyScale<Lanes<float>>& scale,
           const EndDrive<Lanes<float>>& end, Maybe<FrameLoad> frame, Field<const ModalState> state,
           Field<const ModalShape> shape, Field<NodalDisplacement> displacement) {
  if (is_replaced(table)) return;
  ModalBlock block = read_only(*basis, scale, state.data, nullptr, frame.block);
  block.next_state = state.next;
  place_control_points(block, {shape.data, displacement.data, streamed(table, displacement.words), shape.next},
                       {basis->options.far_end, end});
}

void place_still(const Table& table, Shared<ModalBasis> basis, TagValue<ModalStatic>,
                 const BellyScale<Lanes<float>>& scale, const EndDrive<Lanes<float>>& end, Maybe<FrameLoad> frame,
                 Field<const ModalShape> shape, Field<NodalDisplacement> displacement) {
  if (is_replaced(table)) return;
  place_static(read_only(*basis, scale, nullptr, nullptr, frame.block),
               {shape.data, displacement.data, streamed(table, displacement.words), shape.next},
               {basis->options.far_end, end});
}

/// Reports moving and static bellies. (With several inputs the motion's participations are read.)
void report(const Table& table, Shared<ModalBasis> basis, Shared<MuscleTemplate> control, float tick_s,
            const BellyScale<Lanes<float>>& scale, const EndDrive<Lanes<float>>& end, Maybe<FrameLoad> frame,
            MaybeField<const ModalMotion> motion, MaybeField<const ModalState> state, Field<const ModalShape> shape,
            Field<const NodalDisplacement> displacement, BellyReport<Lanes<float>>& report) {
  float* const placed = is_replaced(table) ? nullptr : const_cast<float*>(displacement.data);  // read-only here
  const ControlPoints points{shape.data, placed};
  report_modal(read_only(*basis, scale, state.data, motion.data, frame.block), *control, points,
               {basis->options.far_end, end}, tick_s, report);
}

/// Returns NodalDisplacement if it follows from motion and shape, or 0 if a finite shape changes it afterwards.
std::uint64_t placed_part(const Archetype& key) {
  const auto has = [&](std::uint64_t id) { return find_component(key, id) != nullptr; };
  const bool follows = has(type_id<ModalBasis>()) && has(type_id<ModalShape>()) && has(type_id<NodalDisplacement>()) &&
                       !has(type_id<FiniteShape>());
  return follows ? type_id<NodalDisplacement>() : 0;
}

void place_blocks(Table& table, const World& world, std::size_t begin, std::size_t end) {
  const TableColumn<BellyScale> scale(table);
  const TableColumn<EndDrive> drive(table);
  const TableColumn<FrameLoad> frame(table);
  const ComponentId* const part = find_component(table.key(), type_id<ModalBasis>());
  const auto& basis = *static_cast<const ModalBasis*>(world.resource(part->value));
  const bool still = find_component(table.key(), type_id<ModalStatic>()) != nullptr;
  const auto field = [&](std::size_t b, std::uint64_t id) { return table.block(b) + table.column(id) * lane_count; };
  for (std::size_t b = begin; b < end; ++b) {
    const ModalBlock block = read_only(basis, scale.at(table, b), still ? nullptr : field(b, type_id<ModalState>()),
                                       nullptr, frame ? &frame.at(table, b) : nullptr);
    const ControlPoints points{field(b, type_id<ModalShape>()), field(b, type_id<NodalDisplacement>())};
    const FarFaceDrive end_drive(basis.options.far_end, drive.at(table, b));
    still ? place_static(block, points, end_drive) : place_control_points(block, points, end_drive);
  }
}

Module modal_module() {
  return {.name = "deformation, modal",
          .parts = {component_id(Shared<ModalBasis>{}), component_id(FieldWidth<ModalState>{}),
                    component_id(FieldWidth<ModalMotion>{}), component_id(FieldWidth<ModalShape>{}),
                    component_id(TagValue<ModalStatic>{}), component_id(TagValue<ModalTuned>{})},
          .follows = &placed_part,
          .make = &place_blocks,
          .systems = [](ScheduleBuilder& systems) {
            systems.add("deformation, modal", &move)
                .add("control points", &place)
                .one_of("bellies")
                .add("control points, static", &place_still)
                .one_of("bellies")
                .add("reports", &report)
                .one_of("bellies");
          }};
}

void modal_parts(const MuscleKind& kind, std::vector<ComponentId>& parts) {
  const ModalBasis& basis = *kind.basis;
  const ModalOptions& choice = kind.method.modal;
  const auto field = [&]<class Tag>(Tag, std::size_t width) {
    parts.push_back(component_id(FieldWidth<Tag>{static_cast<std::uint32_t>(width)}));
  };
  parts.push_back(component_id(kind.basis));
  if (choice.moving) {
    field(ModalState{}, modal_state_width(basis.modes));
  } else {
    parts.push_back(component_id(TagValue<ModalStatic>{1}));
  }
  if (is_tuned(kind.method)) parts.push_back(component_id(TagValue<ModalTuned>{1}));
  const bool reported = choice.control_points && choice.reported;
  if (choice.moving || (reported && basis.inputs > 1)) {  // then the report reads participations
    field(ModalMotion{}, modal_motion_width(basis.modes, basis.inputs));
  }
  if (choice.control_points) field(ModalShape{}, modal_shape_width(basis.modes, basis.inputs));
}

bool recognise(const Archetype& key, MuscleKind& kind) {
  if (kind.basis.resource == nullptr) return false;
  const ModalBasis& basis = *kind.basis;
  const auto has = [&](std::uint64_t id) { return find_component(key, id) != nullptr; };
  kind.method = {Method::modal,
                 {basis.modes, !has(type_id<ModalStatic>()), basis.options.corrected, basis.cells,
                  has(type_id<ModalShape>()), has(type_id<BellyReport<float>>()), has(type_id<ModalTuned>())}};
  return true;
}

/// Inputs of a modal belly and their rates.
struct Inputs {
  std::array<double, 1 + frame_inputs> value{}, rate{};
  std::size_t count = 1;

  std::span<const double> values() const { return {value.data(), count}; }
  std::span<const double> rates() const { return {rate.data(), count}; }
};

Inputs inputs_of(const BellyLoad& load, std::uint32_t count) {
  Inputs inputs;
  inputs.count = count;
  const auto set = [&](std::size_t i, float from, float to) {
    inputs.value[i] = static_cast<double>(to);
    inputs.rate[i] = (static_cast<double>(to) - static_cast<double>(from)) / static_cast<double>(load.tick_s);
  };
  set(0, load.from, load.to);
  if (count == 1 || !load.frame) return inputs;
  const FrameLoad<float>& f = *load.frame;
  const std::pair<const Vec3<float>*, const Vec3<float>*> rows[] = {{&f.constant_from, &f.constant_to},
                                                                    {&f.gradient_from.x, &f.gradient_to.x},
                                                                    {&f.gradient_from.y, &f.gradient_to.y},
                                                                    {&f.gradient_from.z, &f.gradient_to.z}};
  std::size_t next = 1;
  for (const auto& [from, to] : rows) {
    set(next++, from->x, to->x);
    set(next++, from->y, to->y);
    set(next++, from->z, to->z);
  }
  return inputs;
}

/// Returns motions at the velocity of their static solutions, lagging behind these by the effect of damping.
std::vector<float> state_with_loads(const ModalBelly& belly, const Inputs& inputs, double damping_per_s) {
  std::vector<float> state(modal_state_width(belly.modes));
  for (std::size_t j = 0; j < belly.modes; ++j) {
    double rate = inputs.rate[0];  // with one input a motion is kept over its participation
    if (inputs.count > 1) {
      rate = 0;
      for (std::size_t i = 0; i < inputs.count; ++i) rate += belly.participation[j][i] * inputs.rate[i];
    }
    state[2 * j] = static_cast<float>(-damping_per_s / belly.omega_1_s[j] * rate);
    state[2 * j + 1] = static_cast<float>(rate);
  }
  return state;
}

/// Returns that state for a tuned belly at an activation, or a state at rest unless it `moves`.
std::vector<float> tuned_state(const ModalBelly& belly, const Inputs& inputs, double activation, bool moves) {
  const auto square = [&](std::size_t j) {
    return belly.omega_1_s[j] * belly.omega_1_s[j] + (activation - tuned_activation) * belly.tension_1_s2[j];
  };
  double least = square(0);
  for (std::size_t j = 1; j < belly.modes; ++j) least = std::min(least, square(j));
  const double damping = std::min(tuned_damping_per_s(activation), 1.9 * std::sqrt(least));
  const std::size_t ends = inputs.count > frame_inputs ? inputs.count - frame_inputs : inputs.count;
  std::vector<float> state(modal_state_width(belly.modes));
  for (std::size_t j = 0; j < belly.modes; ++j) {
    const double omega = belly.omega_1_s[j], give = omega * omega / square(j);
    double rate = inputs.count == 1 ? inputs.rate[0] : 0, frame = 0;
    for (std::size_t i = 0; inputs.count > 1 && i < inputs.count; ++i) {
      rate += belly.participation[j][i] * (i < ends ? 1 : give) * inputs.rate[i];
      if (i >= ends) frame += belly.participation[j][i] * inputs.value[i];
    }
    if (!moves) rate = 0;
    state[2 * j] = static_cast<float>(omega * ((give - 1) * frame - damping / square(j) * rate));
    state[2 * j + 1] = static_cast<float>(rate);
  }
  return state;
}

/// Returns the initial state of a belly: at rest, or at the velocity of its static solutions.
std::vector<float> first_state(const ModalBelly& belly, const ModalBasis& basis, const BellyLoad& load, bool moves) {
  const Inputs inputs = inputs_of(load, basis.inputs);
  if (belly.tuned) return tuned_state(belly, inputs, std::max(double{load.activation}, double{min_activation}), moves);
  if (moves) return state_with_loads(belly, inputs, basis.options.damping_per_s);
  return std::vector<float>(modal_state_width(belly.modes));
}

/// Returns the state that continues from `motion`.
std::vector<float> modal_state(const Belly& belly, const BellyLoad& load, const BellyMotion& motion) {
  const ModalBasis& basis = *belly.basis;
  const Inputs inputs = inputs_of(load, basis.inputs);
  std::vector<float> state(modal_state_width(basis.modes));
  fit_state(basis, *belly.motions, inputs.values(), inputs.rates(), motion.displacement, motion.velocity, state);
  return state;
}

/// Returns the motion shown by a state, or the static solution for an empty state.
BellyMotion modal_motion(const ModalBasis& basis, const ModalBelly& belly, const BellyLoad& load,
                         const std::vector<float>& state) {
  const Inputs inputs = inputs_of(load, basis.inputs);
  const std::size_t width = 3 * basis.control_weight.size();
  BellyMotion motion{std::vector<float>(width), std::vector<float>(width)};
  show_state(basis, belly, inputs.values(), inputs.rates(), state.empty() ? state_with_loads(belly, inputs, 0) : state,
             motion.displacement, motion.velocity);
  return motion;
}

std::optional<BellyMotion> computed(const World& world, Entity muscle, float tick_s, LastReducedBelly& last) {
  const BellyScale<float> scale = *world.get<BellyScale>(muscle);
  const auto* basis = world.shared<ModalBasis>(muscle);
  const bool tuned = world.get<ModalTuned>(muscle).has_value();
  if (last.basis != basis || last.scale.across != scale.across || last.scale.along != scale.along ||
      last.belly.tuned != tuned) {
    ModalBellies one;
    one.tuned = tuned;
    if (!solve_bellies(*basis, {&scale, 1}, one)) return std::nullopt;  // cannot happen: it was solved before
    last = {basis, scale, belly_of(one, 0)};
  }
  return modal_motion(*basis, last.belly, load_of(world, muscle, tick_s), field_of<ModalState>(world, muscle));
}

Beginning begin(const NextBelly& next, bool moves) {
  Beginning from;
  const ModalBasis& basis = *next.belly.basis;
  if (next.choice.modal.moving) from.state = first_state(*next.belly.motions, basis, next.load, moves);
  if (has_control_points(next.choice)) {
    from.displacement = modal_motion(basis, *next.belly.motions, next.load, from.state).displacement;
  }
  return from;
}

BellyMotion at_rest(const NextBelly& next) {
  return modal_motion(*next.belly.basis, *next.belly.motions, next.load, {});
}

Beginning go_on(const NextBelly& next, const PastBelly& past, bool keeps) {
  Beginning from;
  if (next.choice.modal.moving && !keeps) from.state = modal_state(next.belly, next.load, past.motion());
  if (!has_control_points(next.choice)) return from;
  BellyMotion after =
      keeps ? past.computed : modal_motion(*next.belly.basis, *next.belly.motions, next.load, from.state);
  if (past.seen) from.fade = fade_between(past.shown, after);
  from.displacement = std::move(after.displacement);
  return from;
}

}  // namespace of_modal
}  // namespace

void place_now(World& world, Entity muscle) {
  const auto* const at = world.locate(muscle);
  if (at == nullptr || of_modal::placed_part(world.tables()[at->table].key()) == 0) return;
  const std::size_t block = at->row / lane_count;
  of_modal::place_blocks(world.tables()[at->table], world, block, block + 1);
}

constinit const DeformationMethod modal_method = {Method::modal,        &of_modal::modal_module, &of_modal::modal_parts,
                                                  &of_modal::recognise, &of_modal::computed,     &of_modal::begin,
                                                  &of_modal::at_rest,   &of_modal::go_on};

}  // namespace mobil::inline v0_3
