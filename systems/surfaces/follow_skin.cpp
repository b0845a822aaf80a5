#include <mobil/systems/surfaces/follow_skin.h>

#include <cmath>
#include <cstddef>

#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

Vec3<float> to_unit(const Vec3<float>& v) {
  const float square = dot(v, v);
  return square > 0 ? 1 / std::sqrt(square) * v : Vec3<float>{0, 1, 0};
}

}  // namespace

void follow_skin(const CustomSkin& own, std::span<const Vec3<float>> skin_position,
                 std::span<const Vec3<float>> skin_normal, std::span<Vec3<float>> position,
                 std::span<Vec3<float>> normal) {
  for (std::size_t v = 0; v < own.vertex.size(); ++v) {
    const SkinFollower& one = own.vertex[v];
    Vec3<float> at{0, 0, 0}, mean{0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      at = at + one.weight[k] * skin_position[one.corner[k]];
      mean = mean + one.weight[k] * skin_normal[one.corner[k]];
    }
    const Vec3<float> out = to_unit(mean), edge = skin_position[one.corner[1]] - skin_position[one.corner[0]];
    const Vec3<float> along = to_unit(edge - dot(edge, out) * out), across = cross(out, along);
    const auto turned = [&](const Vec3<float>& by) { return by.x * along + by.y * across + by.z * out; };
    position[v] = at + turned(one.beside_m);
    normal[v] = turned(one.normal);
  }
}

}  // namespace mobil::inline v0_3
