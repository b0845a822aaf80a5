#include "systems/surfaces/far_figure.h"

#include <cmath>

#include "assets/body/anthropometry.h"
#include "engine/geometry.h"

namespace mobil {

using namespace geometry;

FarFigure far_figure() {
  FarFigure figure;
  for (const BoneSurface& part : make_figure_shapes(*make_body(far_body))) {
    const SurfaceMesh& mesh = part.mesh;
    const auto first = static_cast<std::uint32_t>(figure.vertex.size());
    std::vector<Vec3<float>> normal(mesh.position.size(), {0, 0, 0});
    for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
      const std::uint32_t* corner = &mesh.triangle[t];
      const Vec3<float> a = mesh.position[corner[0]];
      const Vec3<float> twice_area = cross(mesh.position[corner[1]] - a, mesh.position[corner[2]] - a);
      for (std::size_t k = 0; k < 3; ++k) {
        normal[corner[k]] = normal[corner[k]] + twice_area;
        figure.index.push_back(first + corner[k]);
      }
    }
    for (std::size_t v = 0; v < normal.size(); ++v) {
      const bool has_one = length(normal[v]) > 0;
      figure.vertex.push_back({mesh.position[v], has_one ? normalised(normal[v]) : Vec3<float>{0, 1, 0},
                               static_cast<std::uint16_t>(part.segment),
                               static_cast<std::uint16_t>(cloth_of(part.segment))});
    }
  }
  return figure;
}

Vec3<float> far_scale(float height_m, float mass_kg) {
  const float size = height_m / far_body.height_m, girth = std::sqrt(mass_kg / far_body.mass_kg);
  return {girth, size, girth};
}

}  // namespace mobil
