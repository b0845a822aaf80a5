#pragma once
// A person from afar as one mesh that is the same for everybody, for a vertex shader to place:
//
//   world = matrix[vertex.segment] · (far_scale(body) ∘ vertex.position)        matrix: PoseForm::matrix of PoseWriter
//
// Uploaded once; what a frame then takes of a person is 48 matrices of 48 bytes.

#include <cstdint>
#include <vector>

#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/components/body.h>

namespace mobil::inline v0_3 {

/// 28 bytes. Position (m) and unit normal in the segment's frame.
struct FarVertex {
  Vec3<float> position, normal;
  std::uint16_t segment, part;  // Segment, SkinPart
};
struct FarFigure {
  std::vector<FarVertex> vertex;
  std::vector<std::uint32_t> index;  // three a triangle, wound outwards
};

/// Whom the mesh is drawn after: the skin of a man (SkinDetail::distant), each vertex on the segment that it follows
/// most, and of the part that comes last where parts meet. The first call takes two seconds.
inline constexpr BodyRequest far_body = {.height_m = 1.75F, .mass_kg = 70};
FarFigure far_figure();
/// By how much someone's vertices are larger along x, y and z: as tall as they are, as wide as their mass makes them,
/// feet included. Normals, which this tilts a little, may be taken as they are. Limbs of their own are not known here:
/// where they are longer there are gaps at the joints.
Vec3<float> far_scale(float height_m, float mass_kg);

}  // namespace mobil::inline v0_3
