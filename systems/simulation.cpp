#include "systems/simulation.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "assets/anthropometry.h"
#include "systems/deformation/deformation.h"
#include "systems/forces/forces.h"
#include "systems/gait/gait.h"
#include "systems/kinematics/kinematics.h"
#include "systems/lines/line_of_action.h"

namespace mobil {
namespace {

constexpr Cells belly_cells = {2, 2, 8};  // 81 nodes, the paper's choice for real time

Clock make_clock(const SimulationOptions& options) {
  auto clock = Clock::make(options.tick_s, options.max_frame_s);
  if (!clock) throw std::invalid_argument(clock.error().message);
  return *clock;
}

/// One row in all sixteen lanes.
template <template <class> class C>
C<Lanes<float>> broadcast(const C<float>& row) {
  C<Lanes<float>> block;
  constexpr std::size_t words = sizeof(row) / 4;
  std::uint32_t word[words];
  std::memcpy(word, &row, sizeof(row));
  auto* out = reinterpret_cast<std::byte*>(&block);
  for (std::size_t w = 0; w < words; ++w) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      std::memcpy(out + 4 * (w * lane_count + lane), &word[w], 4);
    }
  }
  return block;
}

/// Lane 0 of a block as a row.
template <template <class> class C>
C<float> first_lane(const C<Lanes<float>>& block) {
  C<float> row;
  const auto* in = reinterpret_cast<const std::byte*>(&block);
  auto* out = reinterpret_cast<std::byte*>(&row);
  for (std::size_t w = 0; w < sizeof(row) / 4; ++w) std::memcpy(out + 4 * w, in + 4 * w * lane_count, 4);
  return row;
}

/// What kinematics makes of a walker's first instant.
struct Standing {
  Pose<float> pose;
  JointAngles<float> angles;
  Feet<float> feet;
  CentreOfMass<float> centre;
};

Standing first_instant(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan) {
  Pose<Lanes<float>> pose;
  JointAngles<Lanes<float>> angles;
  Feet<Lanes<float>> feet;
  CentreOfMass<Lanes<float>> centre;
  pose_skeleton(size, plan, GaitState<Lanes<float>>{}, pose, angles, feet);
  centre_of_mass(size, pose, centre);
  return {first_lane(pose), first_lane(angles), first_lane(feet), first_lane(centre)};
}

/// Where a walker was some seconds before, as far as the present step and one like it before that tell.
GaitState<float> earlier(GaitState<float> state, const StepPlan<float>& plan, float seconds) {
  state.time_s -= seconds;
  if (state.time_s >= 0.0F) return state;
  const bool steady = plan.settled != 0 && plan.step_length_m > 0.0F && state.turn_before_rad == 0.0F;
  if (!steady) {
    state.time_s = 0.0F;
    return state;
  }
  state.time_s += plan.duration_s;
  state.stance_side ^= 1U;
  state.line_x_m -= plan.length_before_m * std::sin(state.heading_rad);
  state.line_z_m -= plan.length_before_m * std::cos(state.heading_rad);
  state.turn_rad = 0.0F;
  return state;
}

/// The motion of a person up to now, as two ticks of the system of forces would have recorded it.
MotionHistory<float> recent_motion(const BodySize<float>& size, const StepPlan<float>& plan,
                                   const GaitState<float>& state, float tick_s) {
  MotionHistory<Lanes<float>> history{};
  const auto sizes = broadcast(size);
  const auto plans = broadcast(plan);
  for (const float ago : {tick_s, 0.0F}) {
    const auto states = broadcast(earlier(state, plan, ago));
    Pose<Lanes<float>> pose;
    JointAngles<Lanes<float>> angles;
    Feet<Lanes<float>> feet;
    CentreOfMass<Lanes<float>> centre;
    GroundReaction<Lanes<float>> ground;
    JointMoments<Lanes<float>> moments;
    pose_skeleton(sizes, plans, states, pose, angles, feet);
    centre_of_mass(sizes, pose, centre);
    joint_forces(sizes, pose, feet, centre, plans, states, history, ground, moments, tick_s);
  }
  return first_lane(history);
}

/// A leg of a given pose, and its line of action with the end where it then is, as a first tick would write them.
template <template <class> class End>
struct FirstLine {
  LegFrames<float> leg;
  LineOfAction<float> line;
  End<float> end;
};

template <template <class> class End>
FirstLine<End> first_line(const MuscleLines& lines, const LegScale<float>& scale, const LineOfAction<float>& rest,
                          const Pose<float>& pose, Side side) {
  LegFrames<Lanes<float>> leg;
  for (std::size_t lane = 0; lane < lane_count; ++lane) gather_leg(pose, side, leg, lane);
  auto line = broadcast(rest);
  End<Lanes<float>> end{};
  lines_of_action(lines, broadcast(scale), leg, line, end);
  return {first_lane(leg), first_lane(line), first_lane(end)};
}

void gather_legs(Lookup<Pose> poses, const MuscleOwner<Lanes<float>>& owner, LegFrames<Lanes<float>>& leg) {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const float* pose = poses.find({owner.index[lane], owner.generation[lane]});
    if (pose != nullptr) gather_leg(pose, static_cast<Side>(owner.side[lane]), leg, lane);
  }
}

template <template <class> class End>
void follow_lines(Shared<MuscleLines> lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& leg,
                  LineOfAction<Lanes<float>>& line, End<Lanes<float>>& end) {
  lines_of_action(*lines, scale, leg, line, end);
}

template <template <class> class End>
void deform(Shared<MuscleTemplate> shape, TagValue<Substeps> substeps, float tick_s,
            const BellyScale<Lanes<float>>& scale, const End<Lanes<float>>& end, Field<NodalDisplacement> displacement,
            Field<NodalVelocity> velocity, BellyReport<Lanes<float>>& report) {
  deform_explicit({*shape, scale, displacement.data, velocity.data, report}, end,
                  static_cast<std::uint32_t>(substeps.value), tick_s);
}

bool same(const Material& a, const Material& b) {
  return a.density_kg_m3 == b.density_kg_m3 && a.young_pa == b.young_pa && a.poisson == b.poisson;
}

}  // namespace

Result<Schedule> make_schedule() {
  ScheduleBuilder systems;
  systems.add("gait", &advance_gait)
      .add_packed("replan", &lanes_to_plan, &plan_next_step)
      .after("gait")
      .add("turn", &turn_gait)
      .after("replan")
      .add("kinematics", &pose_skeleton)
      .add("centre of mass", &centre_of_mass)
      .add("forces", &joint_forces)
      .add("leg frames", &gather_legs)
      .add("lines of action", &follow_lines<EndDisplacement>)
      .add("lines of action, pulling", &follow_lines<EndForce>)
      .after("lines of action")
      .add("deformation", &deform<EndDisplacement>)
      .add("deformation, pulled", &deform<EndForce>)
      .after("deformation");
  return systems.build();
}

Simulation::Simulation(const SimulationOptions& options) : world_(options.memory), clock_(make_clock(options)) {
  if (options.jobs) {
    jobs_ = *options.jobs;
  } else {
    threads_.emplace(options.threads);
    jobs_ = threads_->jobs();
  }
  auto schedule = make_schedule();
  if (!schedule) throw std::logic_error(schedule.error().message);
  schedule_ = std::move(*schedule);
}

Result<Entity> Simulation::spawn(const BodyRequest& request, const GaitRequest& gait_request) {
  const auto body = make_body(request);
  if (!body) return tl::unexpected(body.error());
  const auto gait = resolve_gait(*body, gait_request);
  if (!gait) return tl::unexpected(gait.error());
  const BodySize<float> size{request.height_m, request.mass_kg};
  const auto sizes = broadcast(size);
  StepPlan<Lanes<float>> plan{};
  plan_first_step(sizes, broadcast(*gait), plan);
  const Standing standing = first_instant(sizes, plan);
  const Entity entity = world_.create(size, *gait, first_lane(plan), GaitState<float>{}, standing.pose, standing.angles,
                                      standing.feet, standing.centre);
  if (humans_.size() <= entity.index) humans_.resize(entity.index + std::size_t{1});
  humans_[entity.index] = std::make_unique<Human>(Human{entity, *body, *gait, {}, {}});
  return entity;
}

Status Simulation::despawn(Entity entity) {
  if (find(entity) == nullptr) return Status::stale_entity;
  remove_leg_muscles(entity);
  humans_[entity.index].reset();
  return world_.destroy(entity);
}

Result<void> Simulation::change_gait(Entity entity, const GaitRequest& request) {
  Human* human = find(entity);
  if (human == nullptr) return fail("change_gait: that person is not there (a stale handle); spawn one first");
  auto gait = resolve_gait(human->body, request);
  if (!gait) return tl::unexpected(gait.error());
  gait->heading_rad = human->gait.heading_rad;
  gait->revision = human->gait.revision + 1;
  human->gait = *gait;
  world_.set(entity, *gait);
  return {};
}

Result<void> Simulation::turn_to(Entity entity, float heading_rad) {
  Human* human = find(entity);
  if (human == nullptr) return fail("turn_to: that person is not there (a stale handle); spawn one first");
  if (!(std::fabs(heading_rad) < 1e4F))
    return fail(fmt::format("turn_to: a heading of {} rad is not within ±10000; give an angle about +Y", heading_rad));
  human->gait.heading_rad = heading_rad;
  world_.set(entity, human->gait);
  return {};
}

Status Simulation::add_forces(Entity entity) {
  if (find(entity) == nullptr) return Status::stale_entity;
  if (world_.has<MotionHistory>(entity)) return Status::ok;
  const auto tick_s = static_cast<float>(clock_.tick_s());
  world_.add(entity, recent_motion(*world_.get<BodySize>(entity), *world_.get<StepPlan>(entity),
                                   *world_.get<GaitState>(entity), tick_s));
  world_.add(entity, GroundReaction<float>{});
  return world_.add(entity, JointMoments<float>{});
}

Status Simulation::remove_forces(Entity entity) {
  if (find(entity) == nullptr) return Status::stale_entity;
  if (!world_.has<MotionHistory>(entity)) return Status::ok;
  world_.remove<MotionHistory>(entity);
  world_.remove<GroundReaction>(entity);
  return world_.remove<JointMoments>(entity);
}

Result<void> Simulation::add_leg_muscles(Entity entity, Drive drive, const Material& material) {
  Human* human = find(entity);
  if (human == nullptr) return fail("add_leg_muscles: that person is not there (a stale handle); spawn one first");
  if (!human->muscle_plan.empty()) return fail("add_leg_muscles: this person has leg muscles; remove them first");

  std::vector<Belly> bellies;
  for (std::size_t g = 0; g < muscle_group_count; ++g) {
    const auto plan = make_muscle_plan(human->body, static_cast<MuscleGroup>(g));
    if (!plan) return tl::unexpected(plan.error());
    const auto shape = muscle_template(plan->group, drive, material);
    if (!shape) return tl::unexpected(shape.error());
    const auto critical = critical_step((*shape)->shape->critical_steps, static_cast<double>(plan->scale.across),
                                        static_cast<double>(plan->scale.along));
    if (!critical) return tl::unexpected(critical.error());
    bellies.push_back({*plan, *shape, substeps_within(*critical, clock_.tick_s())});
  }

  const Pose<float> pose = *world_.get<Pose>(entity);
  for (const Belly& belly : bellies) {
    for (const Side side : {right, left}) {
      human->muscle[static_cast<std::size_t>(belly.plan.group)][side] =
          drive == Drive::displacement ? create_muscle<EndDisplacement>(entity, side, belly, pose)
                                       : create_muscle<EndForce>(entity, side, belly, pose);
    }
  }
  for (Belly& belly : bellies) human->muscle_plan.push_back(std::move(belly.plan));
  return {};
}

template <template <class> class End>
Entity Simulation::create_muscle(Entity human, Side side, const Belly& belly, const Pose<float>& pose) {
  const MusclePlan& plan = belly.plan;
  const Template& shape = *belly.shape;
  LineOfAction<float> rest{};
  rest.rest_length_m = static_cast<float>(plan.rest_length_m);
  rest.stiffness_n_per_m = static_cast<float>(
      axial_stiffness(shape.axial, static_cast<double>(plan.scale.across), static_cast<double>(plan.scale.along)));
  const auto first = first_line<End>(*shape.lines, plan.leg_scale, rest, pose, side);
  const auto width = static_cast<std::uint32_t>(nodal_width(shape.shape->mesh.cells));
  const Entity muscle = world_.create(
      MuscleOwner<float>{human.index, human.generation, side}, plan.leg_scale, first.leg, plan.scale, first.line,
      first.end, BellyReport<float>{}, FieldWidth<NodalDisplacement>{width}, FieldWidth<NodalVelocity>{width},
      world_.share(shape.shape), world_.share(shape.lines), TagValue<Substeps>{belly.substeps});
  // At rest under the line's first length, so that a walk begins without a ring.
  const float elongation = first.line.length_m - first.line.rest_length_m;
  const float sideways = elongation * plan.scale.across / plan.scale.along;
  std::vector<float> at_rest(width);
  for (std::size_t i = 0; i < width; ++i) {
    at_rest[i] = (i % 3 == 2 ? elongation : sideways) * static_cast<float>(shape.stretch.displacement[i]);
  }
  world_.set_field<NodalDisplacement>(muscle, at_rest);
  return muscle;
}

Status Simulation::remove_leg_muscles(Entity entity) {
  Human* human = find(entity);
  if (human == nullptr) return Status::stale_entity;
  for (auto& group : human->muscle) {
    for (Entity& muscle : group) {
      if (!human->muscle_plan.empty()) world_.destroy(muscle);
      muscle = Entity{};
    }
  }
  human->muscle_plan.clear();
  return Status::ok;
}

Ticks Simulation::advance(double seconds) {
  const Ticks ticks = clock_.advance(seconds);
  for (std::uint32_t i = 0; i < ticks.count; ++i) tick();
  return ticks;
}

void Simulation::tick() {
  schedule_->run(world_, {static_cast<float>(clock_.tick_s()), tick_}, jobs_);
  ++tick_;
}

const Human* Simulation::human(Entity entity) const {
  return const_cast<Simulation*>(this)->find(entity);
}

Human* Simulation::find(Entity entity) {
  if (!world_.alive(entity) || entity.index >= humans_.size()) return nullptr;
  Human* human = humans_[entity.index].get();
  return human != nullptr && human->entity == entity ? human : nullptr;
}

Entity Simulation::muscle(Entity entity, MuscleGroup group, Side side) const {
  const Human* owner = human(entity);
  return owner == nullptr ? Entity{} : owner->muscle[static_cast<std::size_t>(group)][side];
}

NodalView Simulation::nodal_displacement(Entity muscle) const {
  const auto place = world_.find(muscle);
  if (!place) return {};
  const KeyPart* part = find_part(place.table->key(), type_id<NodalDisplacement>());
  if (part == nullptr) return {};
  const float* block = place.table->block(place.row / lane_count);
  return {block + place.table->column(part->id) * lane_count + place.row % lane_count,
          static_cast<std::uint32_t>(part->value / 3)};
}

Result<const Simulation::Template*> Simulation::muscle_template(MuscleGroup group, Drive drive,
                                                                const Material& material) {
  for (const auto& made : templates_) {
    if (made->group == group && made->drive == drive && same(made->material, material)) return made.get();
  }
  auto mesh = bend_block(belly_cells, group_cage(group), reference_belly_m(group));
  if (!mesh) return tl::unexpected(mesh.error());
  MuscleOptions options;
  options.far_end = drive == Drive::displacement ? FarEnd::held : FarEnd::sliding;
  options.lowest_ratio = 0.4;  // bodies in range have 0.44 to 3.06
  options.highest_ratio = 3.2;
  auto shape = make_muscle_template(std::move(*mesh), material, options);
  if (!shape) return tl::unexpected(shape.error());
  auto made = std::make_unique<Template>(Template{drive, material, group, nullptr, nullptr, {}, {}});
  made->axial = tabulate_axial_stiffness(shape->terms, options.lowest_ratio, options.highest_ratio);
  made->stretch = static_stretch(shape->terms, 1, 1);
  made->lines = std::make_shared<const MuscleLines>(make_muscle_lines(group));
  made->shape = std::make_shared<const MuscleTemplate>(std::move(*shape));
  templates_.push_back(std::move(made));
  return templates_.back().get();
}

}  // namespace mobil
