#pragma once
// Body of a person: the request, and the sizes that follow from it.

#include <array>
#include <cstdint>

#include <mobil/components/lanes.h>
#include <mobil/components/segments.h>

namespace mobil::inline v0_3 {

/// Requested build; `physique_factor` (mobil/body_composition.h) returns its effect on muscle volume.
enum class Constitution : std::uint8_t { thin, average, athletic, heavy };
/// Sex of a body: girths of the skin, fat and muscle. Skeleton and masses are so far a man's of that height and mass.
enum class Sex : std::uint8_t { man, woman };

/// Age of a request without one, years. `build_word` stores it as 0, as in files from before ages.
inline constexpr float usual_age_y = 25;

/// Heath–Carter somatotype, each part from 1 (little) to about 7 (much): fat, muscle and bone, slenderness. If
/// endomorphy and ectomorphy both have these defaults, they are unset and follow from height and mass.
struct Biotype {
  float endo = 3, meso = 4, ecto = 3;
};

/// Lengths of long bones from joint to joint, m, both sides; 0: in proportion to the height.
template <class F>
struct LimbLengths {
  F thigh_m, shank_m, upper_arm_m, forearm_m;
};

/// A request for a body. Ranges: age 6–95 years; height 1.2–2.2 m, below 18 years that of the age (`living_height_m`);
/// mass that of a real body of that height and age (`living_mass_kg`), for adults within 30–200 kg; each part of the
/// biotype 0.1–12; limbs 0.6–1.6 times the proportional length. Custom limbs are for posed people (mobil/retarget.h),
/// because a walker's gait assumes proportional legs. `typical_body` (mobil/anthropometry.h) makes requests from ages.
struct BodyRequest {
  float height_m = 1.75F;
  float mass_kg = 75.0F;
  Biotype biotype{};
  Constitution constitution = Constitution::average;
  LimbLengths<float> limbs{};
  Sex sex = Sex::man;
  float age_y = usual_age_y;  // kept to half years
};
/// Returns true if any limb's length is set.
constexpr bool has_own_limbs(const BodyRequest& request) {
  const auto& [thigh_m, shank_m, upper_arm_m, forearm_m] = request.limbs;
  return thigh_m != 0 || shank_m != 0 || upper_arm_m != 0 || forearm_m != 0;
}

/// Adjustments of a request: bits of BodyComposition::notes. `body_notes` (mobil/body_composition.h) returns them as
/// text.
enum class BodyNote : std::uint8_t {
  ectomorphy = 1,   // the request contradicts height and mass, whose value is used
  fat_raised = 2,   // the request leaves more lean mass than any person of that height has
  fat_lowered = 4,  // the requested endomorphy leaves less than a real body has
  muscle = 8,       // constitution and mesomorphy require more muscle than the lean mass holds
};

/// Composition of a body, computed from its request; method and sources are in mobil/body_composition.h.
struct BodyComposition {
  float body_mass_index = 0;             // mass over height², kg/m²
  float height_over_cube_root_mass = 0;  // HWR, cm over kg^(1/3)
  float fat_kg = 0, lean_kg = 0;         // add up to the mass
  Biotype biotype{};                     // as used: endomorphy of that fat, ectomorphy of height and mass
  float muscle_factor = 1;               // times the regression's muscle volumes (`physique_factor`)
  std::uint8_t notes = 0;
};
constexpr bool has_note(const BodyComposition& composition, BodyNote note) {
  return (composition.notes & static_cast<std::uint8_t>(note)) != 0;
}

/// Sizes that per-tick kernels read. A length of the unit body (mobil/anthropometry.h) times the scale of its group is
/// the person's; assets/body/body_scales.h has the groups, and those that follow from others. Each scale is thus the
/// height of the unit body with that part. Walks scale with the legs. (Custom limbs are in a posed person's pose, and
/// in the scale of its muscles' paths.) Masses are parts of the body mass, a limb's of one side;
/// assets/body/segment_masses.h has the groups, and the lower trunk has the rest.
template <class F>
struct BodySize {
  F height_m, mass_kg;
  F fat_share;  // of the mass
  F leg_scale_m, trunk_scale_m, shoulders_scale_m, arm_scale_m;
  F head_mass, upper_trunk_mass, middle_trunk_mass, upper_arm_mass, forearm_mass, thigh_mass, shank_mass, foot_mass;
  F woman, child;  // parts of a woman's and of a child's step in the person's, 0 to 1
  F stoop_rad;     // bend of the thoracic column beyond a young adult's
};

/// Skeleton of one person, host side, made once at spawn by `make_body` (mobil/anthropometry.h). Every segment's origin
/// is its proximal joint (thigh – hip centre, shank – knee, foot – ankle, toes – ball of the foot, pelvis – midpoint of
/// the hip centres, patella – its centre). In the anatomical position all rotations are identity, +Y up, +Z forward, +X
/// left.
struct Body {
  BodyRequest request;
  BodyComposition composition;
  BodySize<float> size;
  /// Origin of each segment in its parent's frame, m; for the pelvis, its height over the ground when standing.
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

/// Request for a body, without its sizes and limbs.
template <class F>
struct Physique {
  F endo, meso, ecto;  // Biotype
  UInt32<F> build;     // build_word
};
inline constexpr std::uint32_t constitutions = static_cast<std::uint32_t>(Constitution::heavy) + 1;
inline constexpr std::uint32_t both_sexes = static_cast<std::uint32_t>(Sex::woman) + 1;
/// Returns an age of 0 to 1000 years rounded to half years, as bodies are made and stored.
constexpr float half_years(float age_y) {
  return 0.5F * static_cast<float>(static_cast<std::uint32_t>(2 * age_y + 0.5F));
}
/// Returns constitution, sex and age in one word. The age is one that `check_body` (mobil/anthropometry.h) accepts.
constexpr std::uint32_t build_word(Constitution constitution, Sex sex, float age_y) {
  const float age = half_years(age_y);
  const std::uint32_t halves = age == usual_age_y ? 0 : static_cast<std::uint32_t>(2 * age);
  return static_cast<std::uint32_t>(constitution) +
         constitutions * (static_cast<std::uint32_t>(sex) + both_sexes * halves);
}
constexpr Constitution constitution_of(std::uint32_t build) {
  return static_cast<Constitution>(build % constitutions);
}
constexpr Sex sex_of(std::uint32_t build) {
  return static_cast<Sex>(build / constitutions % both_sexes);
}
/// Returns the age, years. An invalid word, for example from a file, gives an age that `check_body` refuses.
constexpr float age_of(std::uint32_t build) {
  const std::uint32_t halves = build / constitutions / both_sexes;
  return halves == 0 ? usual_age_y : 0.5F * static_cast<float>(halves);
}

}  // namespace mobil::inline v0_3
