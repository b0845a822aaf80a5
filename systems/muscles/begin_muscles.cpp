#include "systems/muscles/begin_muscles.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include <mobil/components/activation.h>
#include <mobil/components/fade.h>
#include <mobil/components/pose.h>
#include <mobil/engine/access.h>
#include <mobil/engine/interrupt.h>
#include <mobil/rows.h>
#include "assets/reduction/modal_rows.h"
#include "systems/deformation/deformation.h"
#include "systems/deformation/method_modal.h"
#include "systems/lines/line_of_action.h"
#include "systems/muscles/finite_shape_effect.h"
#include "systems/muscles/muscle_effect.h"
#include "systems/muscles/muscle_parts.h"

namespace mobil::inline v0_3 {
namespace {

/// Initial values of one component, in blocks of sixteen rows.
struct Column {
  std::uint64_t part;
  std::size_t words;
  std::unique_ptr<Lanes<float>[]> data;

  Lanes<float>* block(std::size_t b) const { return &data[b * words]; }
};

class Columns {
 public:
  void add(const ComponentId& part, std::size_t blocks) {
    all_.push_back({part.id, static_cast<std::size_t>(part.value),
                    std::make_unique_for_overwrite<Lanes<float>[]>(blocks * part.value)});
  }
  /// Returns null for a component without a column.
  const Column* find(std::uint64_t part) const {
    const auto at = std::ranges::find(all_, part, &Column::part);
    return at == all_.end() ? nullptr : &*at;
  }
  template <template <class> class C>
  C<Lanes<float>>& block(std::size_t b) const {
    return *reinterpret_cast<C<Lanes<float>>*>(find(type_id<C<float>>())->block(b));
  }
  /// Returns null if the column does not exist.
  template <class Tag>
  Lanes<float>* field(std::size_t b) const {
    const Column* const column = find(type_id<Tag>());
    return column == nullptr ? nullptr : column->block(b);
  }

 private:
  std::vector<Column> all_;
};

/// Muscles of one kind, which share a table.
struct Group {
  std::size_t muscle;  // index among the choice's muscles
  MuscleKind kind;
  SharedBelly common;
  std::vector<std::uint32_t> who;
  std::vector<ComponentId> parts;
  Columns both;                 // equal on both sides
  std::array<Columns, 2> side;  // by side

  std::size_t blocks() const { return (who.size() + lane_count - 1) / lane_count; }
};

constexpr std::uint64_t alike_on_both_sides[] = {type_id<LegScale<float>>(), type_id<BellyScale<float>>(),
                                                 type_id<ModalMotion>(), type_id<ModalShape>()};
/// Components that start with zeros, except the states of tuned bellies with frame loads, whose rest position depends
/// on tension.
constexpr std::uint64_t zero_at_first[] = {type_id<NodalVelocity>(), type_id<ModalState>(),
                                           type_id<BellyReport<float>>()};

bool begins_with_state(const MuscleKind& kind) {
  return kind.inertia && is_tuned(kind.method);
}

void make_room(Group& group) {
  group.parts = muscle_parts(group.kind);
  for (const ComponentId& part : group.parts) {
    const bool own_state = part.id == type_id<ModalState>() && begins_with_state(group.kind);
    if (!has_column(part.kind) || (!own_state && std::ranges::count(zero_at_first, part.id) != 0)) continue;
    if (std::ranges::count(alike_on_both_sides, part.id) != 0) {
      group.both.add(part, group.blocks());
    } else {
      for (Columns& side : group.side) side.add(part, group.blocks());
    }
  }
}

struct BeginningMuscles {
  const World& world;
  const LegMuscles& choice;
  std::span<const Entity> people;
  std::span<const MuscleSize> size;
  std::size_t muscles;  // per person
  std::uint32_t tick;
  float tick_s;
};

/// Initialises one block of a group.
class Block {
 public:
  Block(const BeginningMuscles& all, const Group& group, std::size_t b)
      : all_(all), group_(group), b_(b), count_(std::min(lane_count, group.who.size() - b * lane_count)) {}

  Result<void> make() {
    follow_lines();
    begin_effects();
    return begin_bellies();
  }

 private:
  std::uint32_t person_index(std::size_t lane) const {
    return group_.who[b_ * lane_count + (lane < count_ ? lane : 0)];
  }
  const MuscleSize& size(std::size_t lane) const {
    return all_.size[person_index(lane) * all_.muscles + group_.muscle];
  }

  void follow_lines() {
    auto& leg_scale = group_.both.block<LegScale>(b_);
    LineOfAction<Lanes<float>> rest{};
    std::array<LegFrames<Lanes<float>>, 2> leg;
    const Lookup<Pose> poses(all_.world);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const MuscleSize& of = size(lane);
      const Entity person = all_.people[person_index(lane)];
      put_row(of.leg_scale, leg_scale, lane);
      rest.rest_length_m[lane] = of.rest_length_m;
      rest.stiffness_n_per_m[lane] = static_cast<float>(axial_stiffness(
          group_.common.shape->axial, static_cast<double>(of.scale.across), static_cast<double>(of.scale.along)));
      const float* const pose = poses.find(person);
      for (const Side side : {Side::right, Side::left}) {
        gather_leg(pose, side, leg[side], lane);
        put_row(MuscleOwner<float>{person.index, person.generation, side}, group_.side[side].block<MuscleOwner>(b_),
                lane);
      }
    }
    for (const Side side : {Side::right, Side::left}) {
      auto& line = group_.side[side].block<LineOfAction>(b_);
      auto& end = group_.side[side].block<EndDrive>(b_);
      line = rest;
      end = {};
      lines_of_action(*group_.kind.lines, leg_scale, leg[side], group_.kind.far_end, line, end);
    }
  }

  /// Copies the initial rows of each effect to lanes.
  void begin_effects() {
    RecentPoses recent;
    for (const MuscleEffect& effect : muscle_effects()) {
      if (!effect.wanted(group_.kind)) continue;
      std::vector<ComponentId> parts;
      effect.parts(group_.kind, parts);
      std::erase_if(parts, [](const ComponentId& part) { return !has_column(part.kind); });
      for (std::size_t lane = 0; lane < count_; ++lane) {
        for (const Side side : {Side::right, Side::left}) {
          const Columns& of = group_.side[side];
          RowValues values;
          const auto line = row_of(of.block<LineOfAction>(b_), lane);
          effect.begin({all_.world,
                        {},
                        all_.people[person_index(lane)],
                        side,
                        group_.kind,
                        size(lane),
                        line,
                        all_.tick,
                        all_.tick_s,
                        recent},
                       values);
          for (const ComponentId& part : parts) scatter(values.find(part.id), part.value, *of.find(part.id), lane);
          if (const auto end = values.get<EndDrive>()) put_row(*end, of.block<EndDrive>(b_), lane);
        }
      }
      for (const Columns& of : group_.side) {
        for (const ComponentId& part : parts) park(*of.find(part.id));
        park(*of.find(type_id<EndDrive<float>>()));
      }
    }
  }

  void scatter(const float* row, std::size_t words, const Column& to, std::size_t lane) const {
    for (std::size_t w = 0; w < words; ++w) to.block(b_)[w][lane] = row == nullptr ? 0.0F : row[w];
  }

  Result<void> begin_bellies() {
    const DeformationMethod* const method = deformation_method(group_.kind.method.method);
    if (method == nullptr) return {};
    std::array<BellyScale<float>, lane_count> scale;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      scale[lane] = size(lane).scale;
      put_row(scale[lane], group_.both.block<BellyScale>(b_), lane);
    }
    ModalBellies bellies;
    bellies.tuned = is_tuned(group_.kind.method);
    const ModalBasis* const basis = group_.kind.basis.resource;
    if (basis != nullptr) {
      if (auto solved = solve_bellies(*basis, {scale.data(), count_}, bellies); !solved) return solved;
      const double damping = basis->options.damping_per_s;
      if (auto* const motion = group_.both.field<ModalMotion>(b_))
        write_motions(bellies, damping, static_cast<double>(all_.tick_s), motion->lane);
      if (auto* const shape = group_.both.field<ModalShape>(b_)) write_shapes(bellies, damping, shape->lane);
    }
    if (group_.kind.shape.resource == nullptr && !begins_with_state(group_.kind)) return {};
    for (const Side side : {Side::right, Side::left}) {
      auto* const displacement = group_.side[side].field<NodalDisplacement>(b_);
      if (basis != nullptr && !group_.kind.inertia && group_.kind.finite.resource == nullptr) {
        place_at_rest(*basis, bellies, group_.side[side].block<EndDrive>(b_).to, displacement->lane);
      } else {
        begin_one_by_one(*method, bellies, side);
      }
    }
    return {};
  }

  void begin_one_by_one(const DeformationMethod& method, const ModalBellies& bellies, Side side) const {
    const Columns& of = group_.side[side];
    const Column *const displacement = of.find(type_id<NodalDisplacement>()), *const state =
                                                                                  of.find(type_id<ModalState>());
    const bool pulls = of.find(type_id<Activation<float>>()) != nullptr;
    for (std::size_t lane = 0; lane < count_; ++lane) {
      Belly belly{group_.common, {}, {}, {}, {}};
      belly.plan.scale = size(lane).scale;
      if (belly.basis != nullptr) belly.motions = std::make_shared<ModalBelly>(belly_of(bellies, lane));
      const auto end = row_of(of.block<EndDrive>(b_), lane);
      BellyLoad load{group_.kind.far_end, end.from, end.to, {}, all_.tick_s};
      if (group_.kind.inertia) load.frame = row_of(of.block<FrameLoad>(b_), lane);
      if (pulls) load.activation = of.block<Activation>(b_).activation[lane];
      const auto line = row_of(of.block<LineOfAction>(b_), lane);
      const NextBelly next{belly, all_.choice, line, load};
      Beginning from = method.begin(next, false);
      if (group_.kind.finite.resource != nullptr) show_shape(next, of, lane, from);
      if (displacement != nullptr) scatter(from.displacement.data(), from.displacement.size(), *displacement, lane);
      if (state != nullptr) scatter(from.state.data(), from.state.size(), *state, lane);
    }
    for (const Column* const column : {displacement, state, of.find(type_id<ShownDisplacement>())}) {
      if (column != nullptr) park(*column);
    }
  }

  /// Fills lanes without a row with copies of the first lane.
  void park(const Column& column) const {
    for (std::size_t lane = count_; lane < lane_count; ++lane) {
      for (std::size_t w = 0; w < column.words; ++w) column.block(b_)[w][lane] = column.block(b_)[w][0];
    }
  }

  /// Adds the shape at finite strain to `from`, or stores the sum in ShownDisplacement if the row has that column.
  void show_shape(const NextBelly& next, const Columns& of, std::size_t lane, Beginning& from) const {
    std::vector<float> shown = from.displacement;
    const BellyMotion offset = shape_offset(next, next.load.activation);
    for (std::size_t i = 0; i < shown.size(); ++i) shown[i] += offset.displacement[i];
    if (const Column* const apart = of.find(type_id<ShownDisplacement>())) {
      scatter(shown.data(), shown.size(), *apart, lane);
    } else {
      from.displacement = std::move(shown);
    }
  }

  const BeginningMuscles& all_;
  const Group& group_;
  std::size_t b_, count_;
};

/// Creates the rows of both sides.
void create_rows(World& world, const Jobs& jobs, const Group& group, std::vector<Entity>& all_made) {
  for (const Side side : {Side::right, Side::left}) {
    std::vector<PartValue> parts;
    for (const ComponentId& part : group.parts) {
      const Column* column = group.side[side].find(part.id);
      if (column == nullptr) column = group.both.find(part.id);
      parts.push_back({part, column == nullptr ? nullptr : column->data.get()});
    }
    std::vector<Entity> made(group.who.size());
    world.create_many(parts, made, jobs);
    all_made.insert(all_made.end(), made.begin(), made.end());
    // One row of each block, because the new rows are contiguous.
    const std::size_t before = world.locate(made.front())->row % lane_count;
    in_parallel(jobs, (before + made.size() + lane_count - 1) / lane_count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) place_now(world, made[b == 0 ? 0 : b * lane_count - before]);
    });
  }
}

}  // namespace

tl::expected<void, NotMade> begin_muscles(World& world, BellyLibrary& library, const LegMuscles& choice,
                                          const MuscleTime& time, const Jobs& jobs, std::span<const Entity> people,
                                          std::span<const MuscleSize> size, std::vector<Entity>& made) {
  const std::size_t muscles = choice.muscles.count();
  std::vector<Group> groups;
  for (std::size_t at = 0, number = 0; number < choice.muscles.size(); ++number) {
    if (!choice.muscles[number]) continue;
    const auto muscle = static_cast<Muscle>(number);
    const std::size_t first = groups.size();
    for (std::uint32_t i = 0; i < people.size(); ++i) {
      check_interrupt();
      auto common = library.shared(muscle, choice, size[i * muscles + at].scale, time.tick_s);
      if (!common) {
        return tl::unexpected(NotMade{i, {std::string(muscle_name(muscle)) + ": " + common.error().message}});
      }
      std::size_t g = first;
      while (g < groups.size() && groups[g].common != *common) ++g;
      if (g == groups.size()) {
        groups.push_back({at, kind_of(world, library, muscle, choice, *common), std::move(*common), {}, {}, {}, {}});
      }
      groups[g].who.push_back(i);
    }
    ++at;
  }
  struct Task {
    std::size_t group, block;
    Result<void> done;
  };
  std::vector<Task> tasks;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    make_room(groups[g]);
    for (std::size_t b = 0; b < groups[g].blocks(); ++b) tasks.push_back({g, b, {}});
  }
  const BeginningMuscles all{world, choice, people, size, muscles, time.tick, static_cast<float>(time.tick_s)};
  in_parallel(jobs, tasks.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      check_interrupt();
      tasks[t].done = Block(all, groups[tasks[t].group], tasks[t].block).make();
    }
  });
  for (const Task& task : tasks) {
    if (!task.done) return tl::unexpected(NotMade{groups[task.group].who[task.block * lane_count], task.done.error()});
  }
  for (const Group& group : groups) {
    check_interrupt();
    create_rows(world, jobs, group, made);
  }
  return {};
}

}  // namespace mobil::inline v0_3
