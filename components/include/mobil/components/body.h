#pragma once
// What makes an individual: what was asked for, and the sizes that follow.

#include <array>
#include <cstdint>

#include <mobil/components/lanes.h>
#include <mobil/components/segments.h>

namespace mobil::inline v0_3 {

/// Build, as a caller says it; what it does to muscle volume: `physique_factor` (mobil/body_composition.h).
enum class Constitution : std::uint8_t { thin, average, athletic, heavy };
/// Whose girths the skin has (assets/surfaces). Skeleton, masses and muscles are a man's of that height and mass so
/// far.
enum class Sex : std::uint8_t { man, woman };

/// Heath–Carter somatotype, each part from 1 (little) to about 7 (much): fat, muscle and bone, slenderness. With
/// endomorphy and ectomorphy as they stand here, these count as not asked for: they then follow from height and mass.
struct Biotype {
  float endo = 3, meso = 4, ecto = 3;
};

/// Lengths of long bones from joint to joint, m, both sides; 0: as long as the height makes them.
template <class F>
struct LimbLengths {
  F thigh_m, shank_m, upper_arm_m, forearm_m;
};

/// What a caller asks of a body. Ranges: height 1.2–2.2 m, mass 30–200 kg and at that height what a real body may
/// have (`living_mass_kg`), each part of the biotype 0.1–12, limbs 0.6–1.6 times what the height makes them. Limbs of
/// their own are for posed people (mobil/retarget.h): a walker's gait is that of a leg in proportion.
struct BodyRequest {
  float height_m = 1.75F;
  float mass_kg = 75.0F;
  Biotype biotype{};
  Constitution constitution = Constitution::average;
  LimbLengths<float> limbs{};
  Sex sex = Sex::man;
};
/// Whether any limb's length was asked for.
constexpr bool has_own_limbs(const BodyRequest& request) {
  const auto& [thigh_m, shank_m, upper_arm_m, forearm_m] = request.limbs;
  return thigh_m != 0 || shank_m != 0 || upper_arm_m != 0 || forearm_m != 0;
}

/// What a request had to give way in: bits of BodyComposition::notes, in words by `body_notes`
/// (mobil/body_composition.h).
enum class BodyNote : std::uint8_t {
  ectomorphy = 1,   // was asked otherwise than height and mass make it; what they make is taken
  fat_raised = 2,   // the endomorphy asked would leave more lean mass than anybody has at that height
  fat_lowered = 4,  // it would leave less than a real body has
  muscle = 8,       // constitution and mesomorphy ask for more muscle than the lean mass holds
};

/// What a body is made of, from its request; mobil/body_composition.h says how and after whom.
struct BodyComposition {
  float body_mass_index = 0;             // mass over height², kg/m²
  float height_over_cube_root_mass = 0;  // HWR, cm over kg^(1/3)
  float fat_kg = 0, lean_kg = 0;         // add up to the mass
  Biotype biotype{};                     // as it was taken: endomorphy of that fat, ectomorphy of height and mass
  float muscle_factor = 1;               // of the regression's muscle volumes, constitution and mesomorphy included
  std::uint8_t notes = 0;
};
constexpr bool has_note(const BodyComposition& composition, BodyNote note) {
  return (composition.notes & static_cast<std::uint8_t>(note)) != 0;
}

/// One individual's skeleton, host side: made once at spawn by `make_body` (mobil/anthropometry.h).
/// Frames: every segment's origin is its proximal joint (thigh: hip centre, shank: knee, foot: ankle, toes: ball of
/// the foot, pelvis: midpoint of the hip centres, patella: its centre); in the anatomical position all rotations are
/// identity, +Y up, +Z forward, +X left.
struct Body {
  BodyRequest request;
  BodyComposition composition;
  /// Origin of each segment in its parent's frame, m; the pelvis: its height over the ground when standing.
  std::array<Vec3<float>, segment_count> joint_offset_m;
  /// Centre of mass of each segment in its own frame, m.
  std::array<Vec3<float>, segment_count> centre_of_mass_m;
  /// Farthest point of each segment along its own axis (its distal joint, or its tip), in its own frame, m.
  std::array<Vec3<float>, segment_count> tip_m;
  std::array<float, segment_count> mass_kg;
  /// Lowest points of the foot in the foot's frame, right side, m: under the heel, and under the ball.
  Vec3<float> heel_m, ball_m;
  float thigh_length_m, shank_length_m;
  /// Hip centre over the ground when standing upright with straight knees, m.
  float hip_height_m;
};

/// The few sizes that per-tick kernels read; all other lengths are these times a constant. (Limbs of their own are in a
/// posed person's pose, and in the scale of its muscles' paths.)
template <class F>
struct BodySize {
  F height_m;
  F mass_kg;
  F extra_fat;  // part of the mass (assets/body/fat_distribution.h)
};

/// What was asked of a body besides its sizes and limbs.
template <class F>
struct Physique {
  F endo, meso, ecto;  // Biotype
  UInt32<F> build;     // build_word
};
/// Constitution and sex in a word.
inline constexpr std::uint32_t constitutions = static_cast<std::uint32_t>(Constitution::heavy) + 1;
constexpr std::uint32_t build_word(Constitution constitution, Sex sex) {
  return static_cast<std::uint32_t>(constitution) + constitutions * static_cast<std::uint32_t>(sex);
}
constexpr Constitution constitution_of(std::uint32_t build) {
  return static_cast<Constitution>(build % constitutions);
}
/// An invalid word, as from a file, gives a sex that `check_body` refuses.
constexpr Sex sex_of(std::uint32_t build) {
  const std::uint32_t sex = build / constitutions;
  return static_cast<Sex>(sex < 255 ? sex : 255);
}

}  // namespace mobil::inline v0_3
