#pragma once
// A skeleton made of lofted tubes and ellipsoids, from a body's lengths alone.

#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// One closed surface (of several parts) a segment, in the order of `Segment`, each in its segment's frame, m, wound
/// outwards; the left ones are the right ones' mirror images. Joints lie where the body has them, what is between
/// follows the stature. Ribs hang on their vertebrae, the sternum on T4, the scapula on the clavicle, the fibula on the
/// shank. Names end in _right, _left where there are two. Proportions of the pelvis and the leg are measured (see
/// leg_sections.h), the others are drawn after anatomical plates.
std::vector<BoneSurface> make_bone_surfaces(const Body& body);

}  // namespace mobil::inline v0_3
