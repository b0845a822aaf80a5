#include "systems/people/compact_pose.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include <mobil/components/avoidance.h>
#include <mobil/components/body.h>
#include <mobil/components/fat.h>
#include <mobil/components/gait.h>
#include <mobil/components/leg_frames.h>
#include <mobil/components/pose.h>
#include <mobil/components/step_plan.h>
#include <mobil/engine/access.h>
#include <mobil/rows.h>
#include "systems/gait/kinematics.h"
#include "systems/gait/shoulders.h"
#include "systems/people/fat_wobble.h"

namespace mobil::inline v0_3 {
namespace {

struct PosedBlock {
  BodySize<Lanes<float>> size;
  StepPlan<Lanes<float>> plan;
  GaitState<Lanes<float>> state;
  Lanes<float> shoulders_rad;
  Pose<Lanes<float>> pose;
  JointAngles<Lanes<float>> angles;
  Feet<Lanes<float>> feet;
  CentreOfMass<Lanes<float>> centre;

  void put(const World& world, Entity person, std::size_t lane) {
    put_row(*world.get<BodySize>(person), size, lane);
    put_row(*world.get<StepPlan>(person), plan, lane);
    put_row(*world.get<GaitState>(person), state, lane);
    const auto course = world.get<AvoidanceState>(person);
    shoulders_rad[lane] = course ? course->turn_rad : 0;
  }
  void make() {
    const FloatMode mode;  // as in a tick
    pose_skeleton(size, plan, state, nullptr, pose, angles, feet);
    turn_shoulders(shoulders_rad, pose);
    centre_of_mass(size, pose, centre);
  }
};

}  // namespace

struct FullPoseWork::Blocks {
  static constexpr std::size_t most = 64;  // blocks in a batch
  std::array<Pose<Lanes<float>>, most> pose;
  std::array<JointAngles<Lanes<float>>, most> angles;
  std::array<Feet<Lanes<float>>, most> feet;
  std::array<CentreOfMass<Lanes<float>>, most> centre;
  std::vector<std::uint64_t> owned;
};
FullPoseWork::FullPoseWork() = default;
FullPoseWork::~FullPoseWork() = default;

bool is_compact(const World& world, Entity person) {
  return world.has<Gait>(person) && !world.has<Pose>(person);
}

std::span<const std::uint64_t> pose_part_ids() {
  static const auto ids = [] {
    std::array all = {type_id<Pose<float>>(), type_id<JointAngles<float>>(), type_id<Feet<float>>(),
                      type_id<CentreOfMass<float>>(), type_id<PublishedLeg>()};
    std::ranges::sort(all);
    return all;
  }();
  return ids;
}

Status read_compact(const World& world, Entity person, std::uint64_t part, void* row) {
  if (!is_compact(world, person)) return world.alive(person) ? Status::missing : Status::stale_entity;
  const auto block = std::make_unique<PosedBlock>();
  for (std::size_t l = 0; l < lane_count; ++l) block->put(world, person, l);
  block->make();
  const auto copied = [&](const auto& of) {
    std::memcpy(row, &of, sizeof(of));
    return Status::ok;
  };
  if (part == type_id<Pose<float>>()) return copied(first_lane(block->pose));
  if (part == type_id<JointAngles<float>>()) return copied(first_lane(block->angles));
  if (part == type_id<Feet<float>>()) return copied(first_lane(block->feet));
  if (part == type_id<CentreOfMass<float>>()) return copied(first_lane(block->centre));
  return Status::missing;
}

void make_full(World& world, const Jobs& jobs, std::span<const Entity> people, std::span<const std::uint64_t> gone,
               FullPoseWork& work) {
  if (work.blocks == nullptr) work.blocks = std::make_unique<FullPoseWork::Blocks>();
  FullPoseWork::Blocks& blocks = *work.blocks;
  const std::array<PartValue, 5> parts = {{{component_id<Pose>(), blocks.pose.data()},
                                           {component_id<JointAngles>(), blocks.angles.data()},
                                           {component_id<Feet>(), blocks.feet.data()},
                                           {component_id<CentreOfMass>(), blocks.centre.data()},
                                           part_value(Publishes<PublishedLeg>{})}};
  blocks.owned.assign(gone.begin(), gone.end());
  blocks.owned.insert(blocks.owned.end(), pose_part_ids().begin(), pose_part_ids().end());
  std::ranges::sort(blocks.owned);
  while (!people.empty()) {
    const std::size_t count = std::min(people.size(), FullPoseWork::Blocks::most * lane_count);
    const auto some = people.first(count);
    people = people.subspan(count);
    in_parallel(jobs, (count + lane_count - 1) / lane_count, [&](std::size_t begin, std::size_t end) {
      const auto block = std::make_unique<PosedBlock>();
      for (std::size_t b = begin; b < end; ++b) {
        for (std::size_t l = 0; l < lane_count; ++l)
          block->put(world, some[b * lane_count + l < count ? b * lane_count + l : b * lane_count], l);
        block->make();
        blocks.pose[b] = block->pose;
        blocks.angles[b] = block->angles;
        blocks.feet[b] = block->feet;
        blocks.centre[b] = block->centre;
      }
    });
    world.change_archetype(some, parts, blocks.owned, jobs);
    if (world.has<FatWobble>(some.front()))
      for (const Entity person : some) settle_fat(world, person);
  }
}

}  // namespace mobil::inline v0_3
