#include "systems/muscles/simulation_change.h"

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "components/fade.h"
#include "systems/deformation/deformation.h"

namespace mobil {
namespace {

/// The parts that a muscle is to consist of, values included.
class PartList {
 public:
  template <class... P>
  void add(const P&... part) {
    (add_one(part_value(part)), ...);
  }
  /// Without values a field keeps what it has, or begins with zeros.
  template <class Tag>
  void add_field(std::size_t words, const std::vector<float>& values) {
    add_one({key_part(FieldWidth<Tag>{static_cast<std::uint32_t>(words)}), values.empty() ? nullptr : values.data()});
  }
  /// Good until the next `add`.
  std::span<const PartValue> parts() {
    const std::byte* from = bytes_.data();
    for (PartValue& value : std::span(value_).first(count_)) {
      if (value.row == nullptr) continue;
      value.row = from;
      from += 4 * value.part.value;
    }
    return {value_.data(), count_};
  }

 private:
  void add_one(const PartValue& value) {
    const auto* row = static_cast<const std::byte*>(value.row);
    if (row != nullptr) bytes_.insert(bytes_.end(), row, row + 4 * value.part.value);
    value_[count_++] = value;
  }

  std::array<PartValue, 32> value_{};
  std::size_t count_ = 0;
  std::vector<std::byte> bytes_;  // of those with values, one after the other
};

/// One leg's.
struct OfLeg : MuscleChange {
  Side side;
  const Belly& belly;
};

/// What a muscle is about to become.
struct NextMuscle {
  PartList list;
  bool fades;
};

/// The control points' mesh; nothing where a muscle has no belly.
std::optional<Cells> cells_of(const World& world, Entity muscle) {
  if (const auto* basis = world.shared<ReducedBasis>(muscle)) return basis->options.control_cells;
  if (const auto* shape = world.shared<MuscleTemplate>(muscle)) return shape->mesh.cells;
  return std::nullopt;
}

/// Whether displacements of nodes are the state itself.
bool is_full(Method method) {
  return method != Method::reduced && method != Method::none;
}
bool was_full(const World& world, Entity muscle) {
  return world.has<MuscleTemplate>(muscle) && !world.has<ReducedBasis>(muscle);
}

bool is_reported(const LegMuscles& choice) {
  return has_control_points(choice) && (choice.method != Method::reduced || choice.reduced.reported);
}

/// A muscle's line as it is, or as a first tick would write it.
template <template <class> class End>
FirstLine<End> present_line(const World& world, const OfLeg& change, Entity muscle) {
  const MusclePlan& plan = change.belly.plan;
  const BellyTemplate* const shape = change.belly.shape;
  LineOfAction<float> rest{};
  rest.rest_length_m = static_cast<float>(plan.rest_length_m);
  rest.stiffness_n_per_m = static_cast<float>(
      axial_stiffness(shape->axial, static_cast<double>(plan.scale.across), static_cast<double>(plan.scale.along)));
  const auto line = world.get<LineOfAction>(muscle);
  const auto end = world.get<End>(muscle);
  if (line && end) {
    FirstLine<End> present{*line, *end};
    present.line.stiffness_n_per_m = rest.stiffness_n_per_m;
    return present;
  }
  const Pose<float> pose = *world.get<Pose>(change.human);
  FirstLine<End> first = first_line<End>(*shape->lines, plan.leg_scale, rest, pose, change.side);
  if (line) first.line = *line;
  first.line.stiffness_n_per_m = rest.stiffness_n_per_m;
  return first;
}

template <template <class> class End>
void drive(const End<float>& end, BellyLoad& load);
template <>
void drive(const EndDisplacement<float>& end, BellyLoad& load) {
  load.drive = Drive::displacement;
  load.from = end.from_m;
  load.to = end.to_m;
}
template <>
void drive(const EndForce<float>& end, BellyLoad& load) {
  load.drive = Drive::force;
  load.from = end.from_n;
  load.to = end.to_n;
}

/// What the belly begins with. Empty throughout where all goes on as it is.
Beginning beginning(const World& world, MuscleWork& work, const OfLeg& change, Entity muscle, const NextBelly& next) {
  if (next.choice.method == Method::none) return {};
  const bool was = world.alive(muscle);
  const auto cells = cells_of(world, muscle);
  if (!cells || *cells != next.choice.cells) return begin(next, change.goes_on && was);
  const bool fades = world.has<Fade>(muscle);
  if (!change.goes_on && !fades && is_full(next.choice.method) && was_full(world, muscle)) return {};
  PastBelly past;
  auto computed = computed_motion(world, muscle, change.tick_s, work.last);
  if (!computed) return begin(next, was);
  past.shown = past.computed = std::move(*computed);
  past.seen = world.has<NodalDisplacement>(muscle);
  if (fades) add_fade(world, muscle, change.tick_s, past.shown);
  const bool keeps = next.choice.reduced.moving && world.has<ReducedState>(muscle) &&
                     world.shared<ReducedBasis>(muscle) == next.belly.basis.get();
  return go_on(next, past, keeps);
}

/// Parts that the method calls for; keeps their values.
class MethodParts {
 public:
  MethodParts(World& world, const OfLeg& change, const Beginning& from, PartList& list)
      : world_(world), change_(change), from_(from), list_(list) {
    const LegMuscles& choice = change.choice;
    if (choice.method == Method::none) return;
    list_.add(change.belly.plan.scale);
    const std::size_t width = nodal_width(choice.cells);
    if (choice.method == Method::reduced) {
      add_reduced();
    } else {
      add_full(width);
    }
    if (has_control_points(choice)) add_control_points(width);
  }

 private:
  void add_full(std::size_t width) {
    const Method method = change_.choice.method;
    const Belly& belly = change_.belly;
    list_.add(TagValue<ScratchFloats>{scratch_floats(*belly.shape->shape, method)});
    if (method != Method::statics) list_.add_field<NodalVelocity>(width, from_.velocity);
    if (method == Method::ecd) {
      list_.add(TagValue<Substeps>{belly.steps});
      return;
    }
    if (method == Method::statics) {
      list_.add(TagValue<StaticSteps>{belly.steps});
    } else {
      list_.add(TagValue<SolvedSteps>{belly.steps});
    }
    list_.add(world_.share(belly.solver));
  }

  void add_reduced() {
    const ReducedChoice& reduced = change_.choice.reduced;
    const ReducedBasis& basis = *change_.belly.basis;
    list_.add(world_.share(change_.belly.basis));
    if (reduced.moving) {
      list_.add_field<ReducedState>(reduced_state_width(basis.vectors), from_.state);
    } else {
      list_.add(TagValue<ReducedStatic>{1});
    }
    if (reduced.moving || (is_reported(change_.choice) && basis.inputs > 1)) {  // there the report reads participations
      list_.add_field<ReducedMotion>(change_.belly.motion.size(), change_.belly.motion);
    }
    if (reduced.control_points) {
      list_.add_field<ReducedShape>(change_.belly.rest_shape.size(), change_.belly.rest_shape);
    }
  }

  void add_control_points(std::size_t width) {
    list_.add(world_.share(change_.belly.shape->shape));
    list_.add_field<NodalDisplacement>(width, from_.displacement);
    if (from_.fade.empty()) return;
    list_.add(Fade<float>{0});
    list_.add_field<FadeStart>(2 * width, from_.fade);
    std::vector<float> shown(width);
    for (std::size_t i = 0; i < width; ++i) shown[i] = from_.displacement[i] + from_.fade[i];
    list_.add_field<ShownDisplacement>(width, shown);
  }

  World& world_;
  const OfLeg& change_;
  const Beginning& from_;
  PartList& list_;
};

template <template <class> class End>
NextMuscle work_out(World& world, MuscleWork& work, const OfLeg& change, Entity muscle) {
  const LegMuscles& choice = change.choice;
  const Belly& belly = change.belly;
  const MusclePlan& plan = belly.plan;
  const auto at = present_line<End>(world, change, muscle);
  BellyLoad load;
  drive(at.end, load);
  load.tick_s = change.tick_s;
  std::optional<Inertia> inertia;
  if (feels_frame(choice)) {
    const auto history = world.get<FrameHistory>(muscle);
    const auto felt = world.get<FrameLoad>(muscle);
    if (history && felt) {
      inertia = {*history, *felt};
    } else {
      look_back(world, change.human, change.tick, change.tick_s, work.recent);
      inertia = recent_inertia(work.recent, *belly.shape->lines, plan.leg_scale, change.side, change.tick_s);
    }
    load.frame = inertia->load;
  }
  const Beginning from = beginning(world, work, change, muscle, {belly, choice, at.line, load});

  PartList list;
  const MuscleOwner<float> owner{change.human.index, change.human.generation, change.side};
  list.add(owner, plan.leg_scale, at.line, at.end, world.share(belly.shape->lines));
  MethodParts(world, change, from, list);
  const BellyReport<float> report = world.get<BellyReport>(muscle).value_or(BellyReport<float>{});
  if (is_reported(choice)) list.add(report);
  if (inertia) list.add(inertia->history, inertia->load);
  if (choice.line_motion) {
    const auto before = world.get<LineMotion>(muscle);
    list.add(before ? *before
                    : first_motion(*belly.shape->lines, plan.leg_scale, *world.get<Pose>(change.human), change.side,
                                   at.line, change.tick_s));
  }
  return {std::move(list), !from.fade.empty()};
}

}  // namespace

std::uint32_t fade_ticks(float tick_s) {
  return static_cast<std::uint32_t>(std::ceil(fade_s / tick_s * (1 - 1e-5F)));
}

void make_muscles(World& world, MuscleWork& work, const MuscleChange& change, std::span<const Belly> bellies,
                  std::span<OwnMuscle> own) {
  // All that takes memory comes first. A muscle's rows come from and go to tables of that muscle alone, so that none of
  // those that go before takes the room of another.
  std::vector<NextMuscle> next;
  next.reserve(2 * bellies.size());
  const bool follows = change.choice.drive == Drive::displacement;
  for (std::size_t m = 0; m < bellies.size(); ++m) {
    for (const Side side : {right, left}) {
      const OfLeg leg{change, side, bellies[m]};
      next.push_back((follows ? work_out<EndDisplacement> : work_out<EndForce>)(world, work, leg, own[m].entity[side]));
      world.reserve(next.back().list.parts(), 2);
    }
  }
  world.reserve_entities(next.size());
  const std::size_t fading = work.fading.size();
  try {
    for (std::size_t i = 0; i < next.size(); ++i) {  // only what was there fades
      if (!next[i].fades) continue;
      work.fading.push_back({own[i / 2].entity[i % 2], change.tick + fade_ticks(change.tick_s)});
    }
  } catch (...) {
    while (work.fading.size() > fading) work.fading.pop_back();
    throw;
  }
  for (std::size_t i = 0; i < next.size(); ++i) {
    Entity& muscle = own[i / 2].entity[i % 2];
    if (world.alive(muscle)) {
      world.remake_from(muscle, next[i].list.parts());
    } else {
      muscle = world.create_from(next[i].list.parts());
    }
  }
}

}  // namespace mobil
