#pragma once
// One mesh for all distant people, which a vertex shader places:
//
//   world = matrix[vertex.segment] · (far_scale(body) ∘ vertex.position)      with PoseForm::matrix of PoseWriter
//
// The mesh is uploaded once. A frame then needs 48 matrices of 48 bytes for each person.

#include <cstdint>
#include <vector>

#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/components/body.h>

namespace mobil::inline v0_3 {

/// Vertex of 28 bytes: position (m) and unit normal in the segment's frame.
struct FarVertex {
  Vec3<float> position, normal;
  std::uint16_t segment, part;  // Segment, SkinPart
};
struct FarFigure {
  std::vector<FarVertex> vertex;
  std::vector<std::uint32_t> index;  // three per triangle, wound outwards
};

/// Body of the mesh: a man's skin (SkinDetail::distant). Each vertex is attached to the segment with its largest
/// weight. A vertex on a boundary of parts belongs to the last one. The first call takes two seconds.
inline constexpr BodyRequest far_body = {.height_m = 1.75F, .mass_kg = 70};
FarFigure far_figure();
/// Returns the scale of a person's vertices along x, y and z, from height and from the width that the mass implies,
/// feet included. Normals can be used unchanged, although the scale tilts them slightly. Individual limb lengths
/// (BodyRequest::limbs) are ignored: longer limbs have gaps at the joints.
Vec3<float> far_scale(float height_m, float mass_kg);

}  // namespace mobil::inline v0_3
