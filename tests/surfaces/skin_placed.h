#pragma once
// A skin's vertices as the kernels place them.

#include <span>
#include <vector>

#include "assets/skin/body_skin.h"
#include "systems/skinning/place_skin.h"

namespace mobil::skin_test {

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

}  // namespace mobil::skin_test
