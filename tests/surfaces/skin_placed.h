#pragma once
// A skin's vertices, placed by the kernels.

#include <cmath>
#include <span>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/engine/geometry.h>
#include <mobil/systems/surfaces/place_skin.h>

namespace mobil::skin_test {
using namespace geometry;

struct Placed {
  std::vector<Vec3<float>> position, normal;
};

inline Placed place(const BodySkin& skin, const Pose<float>& pose, const SkinCover* cover = nullptr,
                    const FatBeside* fat = nullptr) {
  const SkinMesh& mesh = skin_mesh(skin.sex, skin.detail);
  Placed to{std::vector<Vec3<float>>(skin.rest.size()), std::vector<Vec3<float>>(skin.rest.size())};
  std::vector<FrameMap> maps(mesh.frame.size());
  frame_maps(mesh, skin, pose, 1, {0, 0, 0}, maps);
  constexpr std::size_t stride = sizeof(Vec3<float>);
  place_skin(mesh, skin, maps, cover, fat,
             {std::as_writable_bytes(std::span(to.position)).data(),
              std::as_writable_bytes(std::span(to.normal)).data(), stride, stride});
  return to;
}

/// Returns a standing pose with both knees, hips and elbows bent by the given angles, rad.
inline Pose<float> bent(const Body& body, float knee, float hip, float elbow) {
  const Pose<float> standing = standing_pose(body);
  Pose<float> pose = standing;
  const auto about_x = [](float angle) { return Quat<float>{std::sin(angle / 2), 0, 0, std::cos(angle / 2)}; };
  for (std::size_t s = 0; s < segment_count; ++s) {
    const Segment segment = static_cast<Segment>(s);
    const std::size_t parent = index(segment_parent[s]);
    if (s == parent) continue;
    Quat<float> turn{0, 0, 0, 1};
    if (segment == Segment::thigh_right || segment == Segment::thigh_left) turn = about_x(-hip);
    if (segment == Segment::shank_right || segment == Segment::shank_left) turn = about_x(knee);
    if (segment == Segment::forearm_right || segment == Segment::forearm_left) turn = about_x(-elbow);
    pose.rotation[s] = product(pose.rotation[parent], turn);
    pose.position_m[s] = pose.position_m[parent] + rotated(pose.rotation[parent], body.joint_offset_m[s]);
  }
  return pose;
}

}  // namespace mobil::skin_test
