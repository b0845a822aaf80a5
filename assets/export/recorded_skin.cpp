#include <mobil/assets/export/recorded_skin.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <unordered_map>

#include <mobil/skin_atlas.h>

namespace mobil::inline v0_3 {
namespace {

constexpr std::array<std::string_view, skin_parts> part_name = {"skin",  "legs",   "lips", "hair",
                                                                "shirt", "shorts", "shoes"};

using SegmentShares = std::array<float, segment_count>;

/// Adds the shares of a vertex' segments, times `part`.
void add_shares(const SkinMesh& mesh, std::uint32_t vertex, float part, SegmentShares& share) {
  const SkinVertex& hangs = mesh.vertex[vertex];
  for (std::size_t k = 0; k < SkinVertex::max_frames; ++k) {
    const SkinFrame& frame = mesh.frame[hangs.frame[k]];
    share[segment_of(frame.from)] += part * hangs.weight[k] * (1 - frame.turn);
    share[segment_of(frame.to)] += part * hangs.weight[k] * frame.turn;
  }
}

/// Makes the next vertex follow the heaviest of them, heaviest first.
void set_joints(SegmentShares share, SkinnedSurface& surface) {
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

std::vector<SkinnedSurface> recorded_skin(const BodySkin& skin, std::size_t first_cloth, const CustomSkin* own) {
  using Triangle = std::array<std::uint32_t, 3>;
  std::set<Triangle> left;
  for (std::size_t t = 0; own != nullptr && t < own->left.size(); t += 3)
    left.insert({own->left[t], own->left[t + 1], own->left[t + 2]});
  const SkinMesh& mesh = skin_mesh(skin.sex, skin.detail);
  const SkinAtlas& atlas = skin_atlas(skin.sex, skin.detail);
  const std::vector<std::array<float, 4>> tangent = skin_tangents(skin);
  std::vector<SkinnedSurface> surfaces;
  for (std::size_t part = 0; part < skin_parts; ++part) {
    SkinnedSurface surface;
    surface.name = part_name[part];
    surface.cloth = first_cloth + part;
    std::unordered_map<std::uint32_t, std::uint32_t> points;  // of the atlas, of this part
    for (std::uint32_t i = 3 * mesh.first_triangle[part]; i < 3 * mesh.first_triangle[part + 1]; ++i) {
      const std::uint32_t* const corner = &mesh.triangle[i - i % 3];
      if (own != nullptr && !left.contains(Triangle{corner[0], corner[1], corner[2]})) continue;
      const std::uint32_t point = atlas.triangle[i], v = atlas.vertex[point];
      const auto [found, is_new] = points.try_emplace(point, static_cast<std::uint32_t>(surface.position.size()));
      if (is_new) {
        surface.position.push_back(skin.rest[v]);
        surface.normal.push_back(skin.normal[v]);
        surface.texture.push_back({atlas.place[point].right, atlas.place[point].down});
        surface.tangent.push_back(tangent[point]);
        SegmentShares share{};
        add_shares(mesh, v, 1, share);
        set_joints(share, surface);
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
  for (const SkinFollower& one : own.vertex) {
    SegmentShares share{};
    for (std::size_t k = 0; k < 3; ++k) add_shares(mesh, one.corner[k], one.weight[k], share);
    set_joints(share, surface);
  }
  return surface;
}

}  // namespace mobil::inline v0_3
