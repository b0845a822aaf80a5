#pragma once
// Walkers without a pose of their own, who are compact (mobil/components/compact.h): what their pose would be, and how
// they get it back.

#include <cstdint>
#include <memory>
#include <span>

#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// A walker who is awake and has no pose; false for a stale handle.
bool is_compact(const World& world, Entity person);
/// The parts that a walker has of its pose, and somebody compact has not: their ids, sorted.
std::span<const std::uint64_t> pose_part_ids();

/// Pose, JointAngles, Feet or CentreOfMass as they would be, into `row`, which is one of them. Status::missing where
/// there is no such part or nobody is compact.
Status read_compact(const World& world, Entity person, std::uint64_t part, void* row);

/// Memory that people become whole in, kept from one time to the next.
struct FullPoseWork {
  FullPoseWork();
  ~FullPoseWork();
  struct Blocks;
  std::unique_ptr<Blocks> blocks;
};
/// Compact people of one table, named once each, have their pose again; of the parts that `gone` names (ids, sorted)
/// they keep none.
void make_full(World& world, const Jobs& jobs, std::span<const Entity> people, std::span<const std::uint64_t> gone,
               FullPoseWork& work);

}  // namespace mobil::inline v0_3
