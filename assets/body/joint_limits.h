#pragma once
// Joint limits. Angles in degrees from the anatomical position, in which palms face forward.
//
// Sources.
//   [A] American Academy of Orthopaedic Surgeons: Joint Motion, Method of Measuring and Recording, 1965.
//   [R] Roaas & Andersson: Normal range of motion of the hip, knee and ankle joints in male subjects, 30–40 years of
//       age, Acta Orthop. Scand. 53, 1982 (means).
//   [B] Baumbach et al.: The influence of knee position on ankle dorsiflexion, BMC Musculoskelet. Disord. 15, 2014:
//       under the body's weight with the knee bent (25° with the knee straight). [A] has 20° without the weight, less
//       than walkers need. Plantarflexion: [A].
//   [W] White & Panjabi: Clinical Biomechanics of the Spine, 2nd ed., 1990, representative values. The book gives the
//       whole range from extension to flexion; its even division over both is ours.
//   [O] our choice, for joints that no source tabulates as defined here.

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include <mobil/components/segments.h>

namespace mobil::inline v0_3 {

/// One motion of the joint at a segment's origin (right side; the left mirrors it), from `low` to `high`. The first
/// word of `motion` names the positive direction, the word after the dash the negative one.
struct JointLimit {
  Segment segment;
  std::string_view joint, motion;
  double low_deg, high_deg;
  std::string_view source;
};

inline constexpr std::array<JointLimit, 22> limb_limits = {{
    {Segment::thigh_right, "hip", "flexion-extension", -30, 120, "A"},
    {Segment::thigh_right, "hip", "abduction-adduction", -30, 45, "A"},
    {Segment::thigh_right, "hip", "internal-external rotation", -45, 45, "A"},
    {Segment::shank_right, "knee", "flexion-extension", -1.6, 143.8, "R"},
    {Segment::foot_right, "ankle", "dorsiflexion-plantarflexion", -50, 39, "B"},
    {Segment::foot_right, "hindfoot", "inversion-eversion", -15, 35, "A"},
    {Segment::toes_right, "metatarsophalangeal", "extension-flexion", -45, 70, "A"},
    {Segment::clavicle_right, "sternoclavicular", "elevation-depression", -5, 45, "O"},
    {Segment::clavicle_right, "sternoclavicular", "protraction-retraction", -15, 15, "O"},
    {Segment::upper_arm_right, "shoulder", "flexion-extension", -60, 180, "A"},
    {Segment::upper_arm_right, "shoulder", "abduction-adduction", -75, 180, "A"},
    {Segment::upper_arm_right, "shoulder", "internal-external rotation", -90, 70, "A"},
    {Segment::forearm_right, "elbow", "flexion-extension", 0, 150, "A"},
    // Measured from thumbs up: 80° to either side. The anatomical position is fully supinated.
    {Segment::forearm_right, "forearm", "pronation", 0, 160, "A"},
    {Segment::hand_right, "wrist", "flexion-extension", -70, 80, "A"},
    {Segment::hand_right, "wrist", "ulnar-radial deviation", -20, 30, "A"},
    {Segment::fingers_right, "metacarpophalangeal", "flexion-extension", -45, 90, "A"},
    {Segment::thumb_right, "thumb", "abduction-adduction", 0, 70, "A"},
    {Segment::thumb_right, "thumb", "flexion-extension", -20, 15, "A"},
    {Segment::head, "atlanto-occipital", "flexion-extension", -12.5, 12.5, "W"},
    {Segment::head, "atlanto-occipital", "lateral bending", -5, 5, "W"},
    {Segment::head, "atlanto-occipital", "rotation", -5, 5, "W"},
}};

/// Limits of one joint of the column, between a vertebra and the one below (the sacrum for L5), degrees [W]. Flexion
/// and extension are the whole range, bending and rotation that to one side.
struct VertebraLimit {
  double flexion_extension, lateral_bending, rotation;
};
/// L5 up to C1, as the segments are numbered.
inline constexpr std::array<VertebraLimit, 24> vertebra_limits = {{
    {17, 3, 1}, {16, 6, 2}, {15, 8, 2}, {14, 6, 2},  {12, 6, 2},                             // L5–S1 to L1–L2
    {12, 8, 2}, {12, 9, 2}, {9, 7, 2},  {6, 6, 4},   {6, 6, 6},   {6, 6, 7},                 // T12–L1 to T7–T8
    {5, 6, 7},  {4, 6, 8},  {4, 6, 8},  {4, 5, 8},   {4, 6, 8},   {4, 5, 9},                 // T6–T7 to T1–T2
    {9, 4, 2},  {17, 7, 6}, {20, 8, 7}, {20, 11, 7}, {15, 11, 7}, {10, 10, 3}, {20, 5, 40},  // C7–T1 to C1–C2
}};

}  // namespace mobil::inline v0_3
