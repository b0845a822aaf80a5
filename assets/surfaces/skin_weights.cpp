#include <mobil/skin_weights.h>

#include <algorithm>

namespace mobil::inline v0_3 {

JointWeights joint_weights(const SkinMesh& mesh, std::span<const std::uint32_t> vertex, std::span<const float> part) {
  std::array<float, segment_count> share{};
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    const SkinVertex& bound = mesh.vertex[vertex[i]];
    for (std::size_t k = 0; k < SkinVertex::max_frames; ++k) {
      const SkinFrame& frame = mesh.frame[bound.frame[k]];
      share[segment_of(frame.from)] += part[i] * bound.weight[k] * (1 - frame.turn);
      share[segment_of(frame.to)] += part[i] * bound.weight[k] * frame.turn;
    }
  }
  JointWeights made;
  float sum = 0;
  for (std::size_t k = 0; k < made.joint.size(); ++k) {
    const auto heaviest = std::ranges::max_element(share);
    if (*heaviest <= 0) break;
    made.joint[k] = static_cast<std::uint8_t>(heaviest - share.begin());
    made.weight[k] = *heaviest;
    sum += *heaviest;
    *heaviest = 0;
  }
  for (float& w : made.weight) w /= sum;
  return made;
}

SkinWeights skin_weights(const BodySkin& skin, float lengths) {
  const SkinMesh& mesh = skin_mesh(skin.sex, skin.detail);
  const SkinAtlas& atlas = skin_atlas(skin.sex, skin.detail);
  SkinWeights made;
  made.tangent = skin_tangents(skin);
  made.texture = atlas.place;
  made.vertex = atlas.vertex;
  made.triangle = atlas.triangle;
  made.first_triangle = mesh.first_triangle;
  for (const std::uint32_t v : atlas.vertex) {
    const Vec3<float>& at = skin.rest[v];
    made.position.push_back({lengths * at.x, lengths * at.y, lengths * at.z});
    made.normal.push_back(skin.normal[v]);
    made.joints.push_back(joint_weights(mesh, {&v, 1}, std::array{1.0F}));
  }
  for (std::size_t s = 0; s < segment_count; ++s) {
    const Vec3<float>& at = skin.standing.position_m[s];
    made.joint_m[s] = {lengths * at.x, lengths * at.y, lengths * at.z};
  }
  return made;
}

}  // namespace mobil::inline v0_3
