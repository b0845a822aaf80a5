#pragma once
// A game's own skeleton drives a person: its bones, however many, in its axes and units, become the 48 segments.
//
//   const auto map = Retarget::make(simulation.person(person)->body, bones, rest, {PoseAxes::z_up_left_handed, 100});
//   simulation.set_pose(person, *map->pose(bones_now));                     // before each tick
//
// Each segment turns as its bone has turned from the rest pose, whatever way the bone's own axes point; the vertebrae
// share out what the bones of the spine do, by height; kneecaps glide as they do in walkers. Segments are as long as
// the body's: bones of other lengths turn them alike, unless the body was asked for with theirs:
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

/// Where a bone is: its joint's place and its rotation (x y z w, of length 1), in the model or in the world, in the
/// host's axes and units.
struct BonePlace {
  Vec3<float> position{};
  Quat<float> rotation{0, 0, 0, 1};
};

/// The numbers of the game's bones, by what they carry. `no_bone`: the game has none; the part then keeps to its
/// parent.
struct SkeletonBones {
  static constexpr std::int32_t no_bone = -1;
  struct Limbs {
    std::int32_t thigh = no_bone, shank = no_bone, foot = no_bone;  // needed
    std::int32_t toes = no_bone;
    std::int32_t clavicle = no_bone, upper_arm = no_bone, forearm = no_bone, hand = no_bone;
  };

  std::int32_t pelvis = no_bone;      // needed
  std::vector<std::int32_t> spine{};  // from the pelvis up to the chest, neck included; one at least
  std::int32_t head = no_bone;
  std::array<Limbs, 2> limbs{};  // by Side
};

/// The host's axes and units, as of PoseLayout.
struct BoneUnits {
  PoseAxes axes = PoseAxes::y_up;
  float units_per_m = 1;
};

/// How long a skeleton's thighs, shanks, upper arms and forearms are at rest, m, in the mean of both sides, for
/// BodyRequest; 0 where no bone ends one. Errors: as Retarget::make.
Result<LimbLengths<float>> limb_lengths(const SkeletonBones& bones, std::span<const BonePlace> rest,
                                        const BoneUnits& units = {});

class Retarget {
 public:
  /// `rest`: every bone of a skeleton that stands upright, feet flat and ahead, arms anywhere (a T, an A, or hanging).
  /// It may face anywhere. Errors, in one line: a number that is not among the bones or twice there, a needed one that
  /// is not given, places that are not finite, quaternions whose length is not 1 within 1 %, a leg of no length, hips
  /// that lie upon each other, units out of range.
  static Result<Retarget> make(const Body& body, const SkeletonBones& bones, std::span<const BonePlace> rest,
                               const BoneUnits& units = {});

  /// The person's pose with the bones as they are now, for Simulation::set_pose. The hips' middle is where the bones
  /// have it. Some microseconds; no heap. Errors: fewer bones than at rest; a place or quaternion as above, which names
  /// the bone.
  Result<Pose<float>> pose(std::span<const BonePlace> bones) const;

 private:
  /// A segment turns as `bone` has turned since the rest pose, or, in the column, as between two bones.
  struct Source {
    std::int32_t bone = SkeletonBones::no_bone, next = SkeletonBones::no_bone;
    double share = 0;  // of `next`
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
  std::vector<Quat<double>> rest_;  // of every bone, in our axes, turned back
};

}  // namespace mobil::inline v0_3
