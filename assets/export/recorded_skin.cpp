#include "assets/export/recorded_skin.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "assets/skin/skin_atlas.h"

namespace mobil {
namespace {

constexpr std::array<std::string_view, skin_parts> part_name = {"skin",  "legs",   "lips", "hair",
                                                                "shirt", "shorts", "shoes"};

/// The segments that a vertex follows, heaviest first.
void set_joints(const SkinMesh& mesh, const SkinVertex& vertex, SkinnedSurface& surface) {
  std::array<float, segment_count> share{};
  for (std::size_t k = 0; k < SkinVertex::most_frames; ++k) {
    const SkinFrame& frame = mesh.frame[vertex.frame[k]];
    share[segment_of(frame.from)] += vertex.weight[k] * (1 - frame.turn);
    share[segment_of(frame.to)] += vertex.weight[k] * frame.turn;
  }
  auto& joint = surface.joint.emplace_back();
  auto& weight = surface.weight.emplace_back();
  float sum = 0;
  for (std::size_t k = 0; k < joint.size(); ++k) {
    const auto heaviest = std::ranges::max_element(share);
    if (*heaviest <= 0) break;
    joint[k] = static_cast<std::uint8_t>(heaviest - share.begin());
    weight[k] = *heaviest;
    sum += *heaviest;
    *heaviest = 0;
  }
  for (float& w : weight) w /= sum;
}

}  // namespace

std::array<Vec3<float>, segment_count> standing_of(const BodySkin& skin) {
  std::array<Vec3<float>, segment_count> standing;
  std::copy_n(skin.standing.position_m, segment_count, standing.begin());
  return standing;
}

std::vector<SkinnedSurface> recorded_skin(const BodySkin& skin, std::size_t first_cloth) {
  const SkinMesh& mesh = skin_mesh(skin.sex, skin.detail);
  const SkinAtlas& atlas = skin_atlas(skin.sex, skin.detail);
  const std::vector<std::array<float, 4>> tangent = skin_tangents(skin);
  std::vector<SkinnedSurface> surfaces;
  for (std::size_t part = 0; part < skin_parts; ++part) {
    SkinnedSurface surface;
    surface.name = part_name[part];
    surface.cloth = first_cloth + part;
    std::unordered_map<std::uint32_t, std::uint32_t> own;  // the atlas' points of this part
    for (std::uint32_t i = 3 * mesh.first_triangle[part]; i < 3 * mesh.first_triangle[part + 1]; ++i) {
      const std::uint32_t point = atlas.triangle[i], v = atlas.vertex[point];
      const auto [found, is_new] = own.try_emplace(point, static_cast<std::uint32_t>(surface.position.size()));
      if (is_new) {
        surface.position.push_back(skin.rest[v]);
        surface.normal.push_back(skin.normal[v]);
        surface.texture.push_back({atlas.place[point].right, atlas.place[point].down});
        surface.tangent.push_back(tangent[point]);
        set_joints(mesh, mesh.vertex[v], surface);
      }
      surface.triangle.push_back(found->second);
    }
    if (!surface.triangle.empty()) surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

}  // namespace mobil
