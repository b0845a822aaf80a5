#pragma once
// Poses of compact walkers (mobil/components/compact.h), who store none: computed on request, or restored to the row.

#include <cstdint>
#include <memory>
#include <span>

#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// Returns true for an awake walker without a pose; false for a stale handle.
bool is_compact(const World& world, Entity person);
/// Returns the ids, sorted, of the pose components that a full walker has and a compact one lacks.
std::span<const std::uint64_t> pose_part_ids();

/// Computes Pose, JointAngles, Feet or CentreOfMass of a compact person into `row`, which has that type. Returns
/// Status::missing for any other component and for a person who is not compact.
Status read_compact(const World& world, Entity person, std::uint64_t part, void* row);

/// Scratch memory of make_full, reused between calls.
struct FullPoseWork {
  FullPoseWork();
  ~FullPoseWork();
  struct Blocks;
  std::unique_ptr<Blocks> blocks;
};
/// Restores the pose of compact people of one table, each named once, and removes the components in `gone` (ids,
/// sorted).
void make_full(World& world, const Jobs& jobs, std::span<const Entity> people, std::span<const std::uint64_t> gone,
               FullPoseWork& work);

}  // namespace mobil::inline v0_3
