#include "systems/render/vertex_normals.h"

#include <cmath>

#include <mobil/systems/render/matrix.h>

namespace mobil::inline v0_3 {
using namespace capture_math;
using namespace geometry;

void vertex_normals(std::span<const Vec3<float>> position, std::span<const std::uint32_t> triangle,
                    std::vector<Vec3<float>>& normal) {
  normal.assign(position.size(), Vec3<float>{0, 0, 0});
  for (std::size_t i = 0; i + 2 < triangle.size(); i += 3) {
    const std::uint32_t a = triangle[i], b = triangle[i + 1], c = triangle[i + 2];
    const Vec3<float> twice_area = cross(position[b] - position[a], position[c] - position[a]);
    for (const std::uint32_t v : {a, b, c}) normal[v] = normal[v] + twice_area;
  }
  for (auto& n : normal) {
    const float size = length(n);
    n = size > 1e-20F && std::isfinite(size) ? (1 / size) * n : Vec3<float>{0, 1, 0};
  }
}

}  // namespace mobil::inline v0_3
