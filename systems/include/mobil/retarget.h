#pragma once
// Drives a person by a game's own skeleton: any number of bones, in its axes and units, become the 48 segments.
//
//   const auto map = Retarget::make(simulation.person(person)->body, bones, rest, {PoseAxes::z_up_left_handed, 100});
//   simulation.set_pose(person, *map->pose(bones_now));                     // before each tick
//
// Each segment rotates as its bone has rotated from the rest pose, for any direction of the bone's own axes. The
// rotation of the spine's bones is divided among the vertebrae by height, and kneecaps glide as in walkers. Segments
// keep the lengths of the body. To give the body the lengths of the skeleton:
//
//   BodyRequest request;
//   request.limbs = *limb_lengths(bones, rest, units);                      // before the person is spawned

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/lanes.h>
#include <mobil/components/pose.h>
#include <mobil/components/segments.h>
#include <mobil/engine/error.h>
#include <mobil/pose_writer.h>

namespace mobil::inline v0_3 {

/// Position of a bone's joint and rotation (unit quaternion x y z w), in model or world space, in the host's axes and
/// units.
struct BonePlace {
  Vec3<float> position{};
  Quat<float> rotation{0, 0, 0, 1};
};

/// Indices of the game's bones by the part that they move. A part with `no_bone` follows its parent.
struct SkeletonBones {
  static constexpr std::int32_t no_bone = -1;
  struct Limbs {
    std::int32_t thigh = no_bone, shank = no_bone, foot = no_bone;  // required
    std::int32_t toes = no_bone;
    std::int32_t clavicle = no_bone, upper_arm = no_bone, forearm = no_bone, hand = no_bone;
  };

  std::int32_t pelvis = no_bone;      // required
  std::vector<std::int32_t> spine{};  // from the pelvis up to the chest, neck included; at least one
  std::int32_t head = no_bone;
  std::array<Limbs, 2> limbs{};  // by Side
};

/// Axes and units of the host, as in PoseLayout.
struct BoneUnits {
  PoseAxes axes = PoseAxes::y_up;
  float units_per_m = 1;
};

/// Returns the lengths of a skeleton's thighs, shanks, upper arms and forearms at rest, m, for BodyRequest: the mean of
/// both sides, or 0 if no bone marks the end. Errors: those of Retarget::make.
Result<LimbLengths<float>> limb_lengths(const SkeletonBones& bones, std::span<const BonePlace> rest,
                                        const BoneUnits& units = {});

class Retarget {
 public:
  /// Prepares the mapping from a rest pose to a body. `rest` contains every bone of a skeleton that stands upright with
  /// feet flat and pointing ahead. The arms can be in any pose (a T, an A, or hanging), and the skeleton can face in
  /// any direction. Errors: a bone index out of range or used twice, a missing bone, units out of range; positions that
  /// are not finite, quaternions whose length is not 1 within 1 %, a leg of zero length, coincident hips.
  static Result<Retarget> make(const Body& body, const SkeletonBones& bones, std::span<const BonePlace> rest,
                               const BoneUnits& units = {});

  /// Returns the person's pose for the present bones (world, m), for Simulation::set_pose. The midpoint of the hips is
  /// that of the bones. Takes some microseconds and no heap memory. Errors: fewer bones than at rest; a position or
  /// quaternion as above, with the index of the bone.
  Result<Pose<float>> pose(std::span<const BonePlace> bones) const;

 private:
  /// Source of a segment's rotation: `bone`, or, in the spine, an interpolation between two bones.
  struct Source {
    std::int32_t bone = SkeletonBones::no_bone, next = SkeletonBones::no_bone;
    double share = 0;  // weight of `next`
    Quat<double> rest{0, 0, 0, 1};
  };

  void set_column(const SkeletonBones& bones, std::span<const Vec3<double>> joint);
  void set_leg(const SkeletonBones::Limbs& limbs, std::size_t side, std::span<const Vec3<double>> joint);
  void set_arm(const SkeletonBones::Limbs& limbs, std::size_t side, std::span<const Vec3<double>> joint);

  Body body_{};
  BoneUnits units_{};
  Quat<double> facing_{0, 0, 0, 1};
  std::array<std::int32_t, 2> hip_{};
  std::array<Source, segment_count> source_{};
  std::vector<Quat<double>> rest_;  // inverse rotation of every bone, in the library's axes
};

}  // namespace mobil::inline v0_3
