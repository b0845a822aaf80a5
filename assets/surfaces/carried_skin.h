#pragma once
// The shared skin on another skeleton, before it is drawn onto a body's form.

#include <vector>

#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/components/body.h>

namespace mobil::inline v0_3 {

/// Returns the vertices of a sex's mesh in the meshing pose of a body, each moved and scaled with the segments that
/// carry it.
std::vector<Vec3<double>> carried_skin(const SkinMesh& mesh, Sex sex, const Body& body);

}  // namespace mobil::inline v0_3
