#include "systems/simulation.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "assets/body/anthropometry.h"
#include "components/leg_frames.h"
#include "systems/forces/forces.h"
#include "systems/gait/gait.h"
#include "systems/kinematics/kinematics.h"
#include "systems/muscles/simulation_change.h"
#include "systems/people/simulation_rows.h"

namespace mobil {
namespace {

Clock make_clock(const SimulationOptions& options) {
  auto clock = Clock::make(options.tick_s, options.max_frame_s);
  if (!clock) throw std::invalid_argument(clock.error().message);
  return *clock;
}

/// The motion of a person up to now, as two ticks of the system of forces would have recorded it.
MotionHistory<float> recent_motion(const BodySize<float>& size, const StepPlan<float>& plan,
                                   const GaitState<float>& state, float tick_s) {
  MotionHistory<Lanes<float>> history{};
  const auto sizes = broadcast(size);
  const auto plans = broadcast(plan);
  for (const float ago : {tick_s, 0.0F}) {
    GaitState<float> at_start = state;
    at_start.time_s = 0;
    const auto states = broadcast(earlier(state, plan, ago).value_or(at_start));
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

}  // namespace

std::optional<GaitState<float>> earlier(GaitState<float> state, const StepPlan<float>& plan, float seconds) {
  state.time_s -= seconds;
  if (state.time_s >= 0.0F) return state;
  const bool steady = plan.settled != 0 && plan.step_length_m > 0.0F && state.turn_before_rad == 0.0F;
  if (!steady) return std::nullopt;
  state.time_s += plan.duration_s;
  state.stance_side ^= 1U;
  state.line_x_m -= plan.length_before_m * std::sin(state.heading_rad);
  state.line_z_m -= plan.length_before_m * std::cos(state.heading_rad);
  state.turn_rad = 0.0F;
  return state;
}

Simulation::Simulation(const SimulationOptions& options)
    : world_(options.memory), clock_(make_clock(options)), work_(std::make_unique<MuscleWork>()) {
  if (options.jobs) {
    jobs_ = *options.jobs;
  } else {
    threads_.emplace(options.threads);
    jobs_ = threads_->jobs();
  }
  auto schedule = make_schedule(options.memory);
  if (!schedule) throw std::logic_error(schedule.error().message);
  schedule_ = std::move(*schedule);
}

Simulation::~Simulation() = default;

Result<void> Simulation::change_gait(Entity entity, const GaitRequest& request) {
  const PersonRecord* human = person(entity);
  if (human == nullptr) return fail("change_gait: that person is not there (a stale handle); spawn one first");
  if (human->posed) return fail("change_gait: this person's host animates the skeleton; spawn a walker instead");
  auto gait = resolve_gait(*make_body(human->body), request);
  if (!gait) return tl::unexpected(gait.error());
  const Gait<float> before = *world_.get<Gait>(entity);
  gait->heading_rad = before.heading_rad;
  gait->revision = before.revision + 1;
  world_.set(entity, *gait);
  return {};
}

Result<void> Simulation::turn_to(Entity entity, float heading_rad) {
  const PersonRecord* human = person(entity);
  if (human == nullptr) return fail("turn_to: that person is not there (a stale handle); spawn one first");
  if (human->posed) return fail("turn_to: this person's host animates the skeleton; turn the pose instead");
  if (!(std::fabs(heading_rad) < 1e4F))
    return fail(fmt::format("turn_to: a heading of {} rad is not within ±10000; give an angle about +Y", heading_rad));
  Gait<float> gait = *world_.get<Gait>(entity);
  gait.heading_rad = heading_rad;
  world_.set(entity, gait);
  return {};
}

Status Simulation::add_forces(Entity entity) {
  const PersonRecord* human = person(entity);
  if (human == nullptr) return Status::stale_entity;
  if (human->posed) return Status::missing;
  if (world_.has<MotionHistory>(entity)) return Status::ok;
  const auto tick_s = static_cast<float>(clock_.tick_s());
  const MotionHistory<float> motion = recent_motion(*world_.get<BodySize>(entity), *world_.get<StepPlan>(entity),
                                                    *world_.get<GaitState>(entity), tick_s);
  return world_.add_parts(
      entity, std::array<PartValue, 3>{
                  part_value(motion), {component_part<GroundReaction>()}, {component_part<JointMoments>()}});
}

Status Simulation::remove_forces(Entity entity) {
  if (find(entity) == nullptr) return Status::stale_entity;
  if (!world_.has<MotionHistory>(entity)) return Status::ok;
  return world_.remove_parts(
      entity, {type_id<MotionHistory<float>>(), type_id<GroundReaction<float>>(), type_id<JointMoments<float>>()});
}

Ticks Simulation::advance(double seconds) {
  const Ticks ticks = clock_.advance(seconds);
  for (std::uint32_t i = 0; i < ticks.count; ++i) tick();
  return ticks;
}

void Simulation::tick() {
  schedule_->run(world_, {static_cast<float>(clock_.tick_s()), tick_}, jobs_);
  ++tick_;
  end_fades();
}

std::optional<Human> Simulation::human(Entity entity) const {
  const PersonRecord* of = person(entity);
  if (of == nullptr) return std::nullopt;
  Human human{entity, *make_body(of->body), world_.get<Gait>(entity).value_or(Gait<float>{}), {}, {}, of->posed};
  for (const OwnMuscle& own : of->muscles) {
    human.muscles.push_back({*make_muscle_plan(human.body, own.muscle), own.entity, own.method});
  }
  if (!of->muscles.empty()) human.leg_muscles = people_.choice(*of);
  return human;
}

Entity Simulation::muscle(Entity entity, Muscle muscle, Side side) const {
  const PersonRecord* owner = person(entity);
  if (owner == nullptr) return {};
  for (const OwnMuscle& m : owner->muscles) {
    if (m.muscle == muscle) return m.entity[side];
  }
  return {};
}

}  // namespace mobil
