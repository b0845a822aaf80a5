#pragma once
// A skeleton made of lofted tubes and ellipsoids, from a body's lengths alone.

#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Returns the closed surfaces of each segment's bones, one a bone, in the order of `Segment`, each in its segment's
/// frame, m, wound outwards. The left ones mirror the right ones. Joints are the body's, the shapes between them scale
/// with their segment (`bone_scale`). Ribs are fixed to their vertebrae, the sternum to T4, the scapula to the
/// clavicle, the fibula to the shank. Names of pairs end in _right and _left. Proportions of the pelvis and the leg are
/// measured (see leg_sections.h), the others are drawn after anatomical plates. Bodies with usual proportions share
/// shapes, which take a second at first use.
std::vector<BoneSurface> make_bone_surfaces(const Body& body);

/// Returns the surfaces of a body in usual proportions, in mm of a man of reference_height_mm. The first call takes a
/// second.
const std::vector<BoneSurface>& usual_bones();
/// Returns the value of the limb that a segment is, or `otherwise` for the other segments.
constexpr float value_of(const LimbLengths<float>& limbs, Segment segment, float otherwise) {
  using enum Segment;
  if (segment == thigh_right || segment == thigh_left) return limbs.thigh_m;
  if (segment == shank_right || segment == shank_left) return limbs.shank_m;
  if (segment == upper_arm_right || segment == upper_arm_left) return limbs.upper_arm_m;
  if (segment == forearm_right || segment == forearm_left) return limbs.forearm_m;
  return otherwise;
}
/// Scales of each segment's bones along the axes of its frame, m per mm of that man.
using BoneScales = std::array<Vec3<double>, segment_count>;
/// Returns the scales of a body's bones, which are their segments' own. Ribs are as broad as the shoulders, skull and
/// neck as the skin's head. The pelvis has the legs' scale, and is as broad as the distance of the hips.
BoneScales bone_scales(const Body& body);

}  // namespace mobil::inline v0_3
