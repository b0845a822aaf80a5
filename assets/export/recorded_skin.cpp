#include <mobil/assets/export/recorded_skin.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <unordered_map>

#include <mobil/skin_weights.h>

namespace mobil::inline v0_3 {
namespace {

constexpr std::array<std::string_view, skin_parts> part_name = {"skin",  "legs",   "lips", "hair",
                                                                "shirt", "shorts", "shoes"};

void follow(const JointWeights& joints, SkinnedSurface& surface) {
  surface.joint.push_back(joints.joint);
  surface.weight.push_back(joints.weight);
}

}  // namespace

std::array<Vec3<float>, segment_count> standing_of(const BodySkin& skin) {
  std::array<Vec3<float>, segment_count> standing;
  std::copy_n(skin.standing.position_m, segment_count, standing.begin());
  return standing;
}

std::vector<SkinnedSurface> recorded_skin(const BodySkin& skin, std::size_t first_cloth, const CustomSkin* own) {
  using Triangle = std::array<std::uint32_t, 3>;
  std::set<Triangle> left;
  for (std::size_t t = 0; own != nullptr && t < own->left.size(); t += 3)
    left.insert({own->left[t], own->left[t + 1], own->left[t + 2]});
  const SkinWeights all = skin_weights(skin);
  std::vector<SkinnedSurface> surfaces;
  for (std::size_t part = 0; part < skin_parts; ++part) {
    SkinnedSurface surface;
    surface.name = part_name[part];
    surface.cloth = first_cloth + part;
    std::unordered_map<std::uint32_t, std::uint32_t> number;  // of a vertex of the skin, in this part
    for (std::uint32_t i = 3 * all.first_triangle[part]; i < 3 * all.first_triangle[part + 1]; ++i) {
      const std::uint32_t* const corner = &all.triangle[i - i % 3];
      const Triangle of_mesh{all.vertex[corner[0]], all.vertex[corner[1]], all.vertex[corner[2]]};
      if (own != nullptr && !left.contains(of_mesh)) continue;
      const std::uint32_t v = all.triangle[i];
      const auto [found, is_new] = number.try_emplace(v, static_cast<std::uint32_t>(surface.position.size()));
      if (is_new) {
        surface.position.push_back(all.position[v]);
        surface.normal.push_back(all.normal[v]);
        surface.texture.push_back({all.texture[v].right, all.texture[v].down});
        surface.tangent.push_back(all.tangent[v]);
        follow(all.joints[v], surface);
      }
      surface.triangle.push_back(found->second);
    }
    if (!surface.triangle.empty()) surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

SkinnedSurface recorded_custom_skin(const BodySkin& bare, const CustomSkin& own, std::span<const Vec3<float>> position,
                                    std::span<const Vec3<float>> normal, std::size_t cloth) {
  const SkinMesh& mesh = skin_mesh(bare.sex, bare.detail);
  SkinnedSurface surface;
  surface.name = "own skin";
  surface.cloth = cloth;
  surface.position.assign(position.begin(), position.end());
  surface.normal.assign(normal.begin(), normal.end());
  surface.triangle = own.triangle;
  for (const SkinFollower& one : own.vertex) follow(joint_weights(mesh, one.corner, one.weight), surface);
  return surface;
}

}  // namespace mobil::inline v0_3
