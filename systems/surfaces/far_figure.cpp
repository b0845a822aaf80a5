#include <mobil/far_figure.h>

#include <cmath>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {

using namespace geometry;

FarFigure far_figure() {
  FarFigure figure;
  const SkinMesh& mesh = skin_mesh(Sex::man, SkinDetail::distant);
  const BodySkin skin = *make_body_skin(*make_body(far_body), SkinDetail::distant);
  figure.index = mesh.triangle;
  for (std::size_t v = 0; v < mesh.vertex.size(); ++v) {
    const SkinFrame& frame = mesh.frame[mesh.vertex[v].frame[0]];  // the frame with the largest weight is first
    const std::size_t segment = segment_of(frame.turn < 0.5F ? frame.from : frame.to);
    figure.vertex.push_back(
        {skin.rest[v] - skin.standing.position_m[segment], skin.normal[v], static_cast<std::uint16_t>(segment), 0});
  }
  for (std::size_t part = 0; part < skin_parts; ++part) {
    for (std::uint32_t i = 3 * mesh.first_triangle[part]; i < 3 * mesh.first_triangle[part + 1]; ++i)
      figure.vertex[mesh.triangle[i]].part = static_cast<std::uint16_t>(part);
  }
  return figure;
}

Vec3<float> far_scale(float height_m, float mass_kg) {
  const float size = height_m / far_body.height_m, girth = std::sqrt(mass_kg / far_body.mass_kg);
  return {girth, size, girth};
}

}  // namespace mobil::inline v0_3
