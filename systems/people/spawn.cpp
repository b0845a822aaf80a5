#include "systems/people/spawn.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/components/leg_frames.h>
#include <mobil/components/pose.h>
#include <mobil/components/step_plan.h>
#include <mobil/engine/interrupt.h>
#include <mobil/engine/world.h>
#include <mobil/rows.h>
#include <mobil/systems/limits/style_limits.h>
#include "systems/gait/gait.h"
#include "systems/gait/kinematics.h"
#include "systems/people/person_requests.h"
#include "systems/people/pose_measures.h"

namespace mobil::inline v0_3 {
namespace {

Result<void> check_place(const SpawnRequest& request) {
  if (std::fabs(request.x_m) <= farthest_m && std::fabs(request.z_m) <= farthest_m &&
      std::fabs(request.heading_rad) <= 1e4F) {
    return {};
  }
  return fail(fmt::format("a place of {} and {} m or a heading of {} rad is not within ±1000000 m and ±10000 rad",
                          request.x_m, request.z_m, request.heading_rad));
}

Result<void> check(const SpawnRequest& request, BodySize<float>& size, Gait<float>& gait, std::size_t person,
                   const std::function<Result<void>(std::size_t, const Body&)>& each) {
  const auto body = make_body(request.body);
  if (!body) return tl::unexpected(body.error());
  if (has_own_limbs(request.body))
    return fail("body: limbs of their own are for posed people (spawn_posed); a walker's follow from the height");
  auto resolved = resolve_gait(*body, request.gait);
  if (!resolved) return tl::unexpected(resolved.error());
  if (auto placed = check_place(request); !placed) return placed;
  size = body->size;
  gait = *resolved;
  gait.heading_rad = request.heading_rad;
  return each(person, *body);
}

/// Components of walkers at their first instant, sixteen to a block.
struct FirstInstants {
  explicit FirstInstants(std::size_t blocks)
      : size(std::make_unique_for_overwrite<BodySize<Lanes<float>>[]>(blocks)),
        physique(std::make_unique_for_overwrite<Physique<Lanes<float>>[]>(blocks)),
        gait(std::make_unique_for_overwrite<Gait<Lanes<float>>[]>(blocks)),
        plan(std::make_unique<StepPlan<Lanes<float>>[]>(blocks)),
        state(std::make_unique<GaitState<Lanes<float>>[]>(blocks)),
        pose(std::make_unique_for_overwrite<Pose<Lanes<float>>[]>(blocks)),
        angles(std::make_unique_for_overwrite<JointAngles<Lanes<float>>[]>(blocks)),
        feet(std::make_unique_for_overwrite<Feet<Lanes<float>>[]>(blocks)),
        centre(std::make_unique_for_overwrite<CentreOfMass<Lanes<float>>[]>(blocks)) {}

  void make(std::size_t b, std::span<const SpawnRequest> people, std::span<const BodySize<float>> sizes,
            std::span<const Gait<float>> gaits) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const std::size_t i = b * lane_count + lane < people.size() ? b * lane_count + lane : b * lane_count;
      const SpawnRequest& request = people[i];
      put_row(sizes[i], size[b], lane);
      put_row(mobil::physique(request.body), physique[b], lane);
      put_row(gaits[i], gait[b], lane);
      state[b].line_x_m[lane] = state[b].anchor_x_m[lane] = request.x_m;
      state[b].line_z_m[lane] = state[b].anchor_z_m[lane] = request.z_m;
      state[b].heading_rad[lane] = request.heading_rad;
    }
    plan_first_step(size[b], gait[b], plan[b]);
    pose_skeleton(size[b], plan[b], state[b], nullptr, pose[b], angles[b], feet[b]);
    centre_of_mass(size[b], pose[b], centre[b]);
  }

  std::vector<PartValue> parts(std::span<const ComponentId> more) const {
    std::vector<PartValue> all = {
        {component_id<BodySize>(), size.get()},       {component_id<Physique>(), physique.get()},
        {component_id<Gait>(), gait.get()},           {component_id<StepPlan>(), plan.get()},
        {component_id<GaitState>(), state.get()},     {component_id<Pose>(), pose.get()},
        {component_id<JointAngles>(), angles.get()},  {component_id<Feet>(), feet.get()},
        {component_id<CentreOfMass>(), centre.get()}, part_value(Publishes<PublishedLeg>{})};
    for (const ComponentId& part : more) all.push_back({part, nullptr});
    return all;
  }

  std::unique_ptr<BodySize<Lanes<float>>[]> size;
  std::unique_ptr<Physique<Lanes<float>>[]> physique;
  std::unique_ptr<Gait<Lanes<float>>[]> gait;
  std::unique_ptr<StepPlan<Lanes<float>>[]> plan;
  std::unique_ptr<GaitState<Lanes<float>>[]> state;
  std::unique_ptr<Pose<Lanes<float>>[]> pose;
  std::unique_ptr<JointAngles<Lanes<float>>[]> angles;
  std::unique_ptr<Feet<Lanes<float>>[]> feet;
  std::unique_ptr<CentreOfMass<Lanes<float>>[]> centre;
};

}  // namespace

tl::expected<void, NotMade> check_people(const Jobs& jobs, std::span<const SpawnRequest> people,
                                         std::span<BodySize<float>> size, std::span<Gait<float>> gait,
                                         const std::function<Result<void>(std::size_t, const Body&)>& each) {
  std::atomic<std::size_t> wrong = people.size();  // the first invalid request
  in_parallel(jobs, people.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      check_interrupt();
      if (check(people[i], size[i], gait[i], i, each)) continue;
      for (std::size_t before = wrong; i < before && !wrong.compare_exchange_weak(before, i);) {
      }
      return;
    }
  });
  const std::size_t i = wrong;
  if (i < people.size()) return tl::unexpected(NotMade{i, check(people[i], size[i], gait[i], i, each).error()});
  StyleLimitWork work;
  keep_walk_limits(jobs, size, gait, work);
  return {};
}

void create_walkers(World& world, const Jobs& jobs, std::span<const SpawnRequest> people,
                    std::span<const BodySize<float>> size, std::span<const Gait<float>> gait,
                    std::span<Entity> entities) {
  const std::size_t blocks = (people.size() + lane_count - 1) / lane_count;
  FirstInstants instants(blocks);
  in_parallel(jobs, blocks, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      check_interrupt();
      instants.make(b, people, size, gait);
    }
  });
  world.create_many(instants.parts(people.front().parts), entities, jobs);
}

Result<Entity> spawn_posed(World& world, const BodyRequest& request) {
  const auto body = make_body(request);
  if (!body) return tl::unexpected(body.error());
  const BodySize<float>& size = body->size;
  const Pose<float> pose = standing_pose(*body);
  CentreOfMass<Lanes<float>> centre;
  centre_of_mass(broadcast(size), broadcast(pose), centre);
  if (!has_own_limbs(request)) {
    return world.create(size, physique(request), pose, joint_angles(pose), sole_points(size.leg_scale_m, pose),
                        first_lane(centre), Publishes<PublishedLeg>{});
  }
  move_mass_along_limbs(broadcast(size), broadcast(request.limbs), broadcast(pose), centre);
  return world.create(size, physique(request), request.limbs, pose, joint_angles(pose),
                      sole_points(size.leg_scale_m, pose), first_lane(centre), Publishes<PublishedLeg>{});
}

void keep_walk_limits(const World& world, const Jobs& jobs, Entity person, Gait<float>& gait, StyleLimitWork& work) {
  const auto before = asked_body(world, person);
  if (before && !same_walk(before->gait, gait)) keep_walk_limits(jobs, {&before->size, 1}, {&gait, 1}, work);
}

}  // namespace mobil::inline v0_3
