#include "systems/skinning/place_skin.h"

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "components/segments.h"
#include "engine/geometry.h"

namespace mobil {
namespace {

using namespace geometry;

Quat<float> of_length_1(const Quat<float>& q) {
  const float scale = 1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {scale * q.x, scale * q.y, scale * q.z, scale * q.w};
}

/// The forearm without its turn about its own length (y): the rest of the way from the upper arm.
Quat<float> untwisted(const Quat<float>& upper_arm, const Quat<float>& forearm) {
  const Quat<float> elbow = product(conjugate(upper_arm), forearm);
  if (elbow.y * elbow.y + elbow.w * elbow.w < 1e-8F) return forearm;  // folded back on itself
  return product(forearm, conjugate(of_length_1({0, elbow.y, 0, elbow.w})));
}

struct RestPoint {
  Vec3<float> place, normal;
};

/// A vertex at rest, moved away from its leg's line; its normal tilts as what lifts it slopes.
RestPoint lifted(const BodySkin& skin, const SkinCover& cover, const LegPlace& leg, const RestPoint& rest) {
  const std::size_t side = rest.place.x > 0 ? Side::left : Side::right;
  const std::array<float, leg_grid_points>& grid = cover.lift_m[side];
  const auto i = static_cast<std::size_t>(leg.along), j = static_cast<std::size_t>(leg.round) % leg_angles;
  const std::size_t k = (j + 1) % leg_angles;
  const float u = leg.along - static_cast<float>(i), v = leg.round - std::floor(leg.round);
  const float *row = &grid[i * leg_angles], *next = row + leg_angles;
  const float above = (1 - v) * row[j] + v * row[k], below = (1 - v) * next[j] + v * next[k];
  const float lift = leg.amount * ((1 - u) * above + u * below);
  const float a_station = leg.amount * (below - above);
  const float an_angle = leg.amount * ((1 - u) * (row[k] - row[j]) + u * (next[k] - next[j]));

  const auto at = [&](Segment s) { return skin.standing.position_m[index(on_side(s, side))]; };
  const Vec3<float> hip = at(Segment::thigh_right), knee = at(Segment::shank_right);
  const float x = rest.place.x - hip.x, z = rest.place.z - hip.z, away = std::sqrt(x * x + z * z);
  if (away < 0.01F) return rest;
  constexpr float stations = (leg_stations - 1) / static_cast<float>(LegProfile::last_s - LegProfile::first_s);
  const float down = stations / (rest.place.y > knee.y ? hip.y - knee.y : knee.y - at(Segment::foot_right).y);
  const float turn = an_angle * leg_angles / (2 * std::numbers::pi_v<float> * away);
  const float out = side == Side::right ? 1.0F : -1.0F;  // angles grow to the inner side
  const Vec3<float> normal{rest.normal.x - turn * out * z / away, rest.normal.y + a_station * down,
                           rest.normal.z + turn * out * x / away};
  return {{rest.place.x + lift * x / away, rest.place.y, rest.place.z + lift * z / away}, normal};
}

/// Three floats to wherever they are to lie.
void put(std::byte* to, const Vec3<float>& v) {
  std::memcpy(to, &v, sizeof v);
}

}  // namespace

void frame_maps(const SkinMesh& mesh, const BodySkin& skin, const Pose<float>& pose, float lengths,
                const Vec3<float>& origin_m, std::span<FrameMap> maps) {
  struct Bone {
    Quat<float> rotation;
    Vec3<float> now, rest;
  };
  std::array<Bone, skin_segments> bone;
  for (std::size_t s = 0; s < segment_count; ++s)
    bone[s] = {pose.rotation[s], pose.position_m[s] - origin_m, skin.standing.position_m[s]};
  for (std::size_t side = 0; side < 2; ++side) {
    const Bone& forearm = bone[index(on_side(Segment::forearm_right, side))];
    const Bone& arm = bone[index(on_side(Segment::upper_arm_right, side))];
    bone[untwisted_forearm(side)] = {untwisted(arm.rotation, forearm.rotation), forearm.now, forearm.rest};
  }
  for (std::size_t i = 0; i < mesh.frame.size(); ++i) {
    const SkinFrame& frame = mesh.frame[i];
    const Bone& to = bone[frame.to];
    const Quat<float> q = frame.turn == 0 ? to.rotation : blended(bone[frame.from].rotation, to.rotation, frame.turn);
    const auto [x, y, z] = columns(q);
    FrameMap& map = maps[i];
    map.x = lengths * x;
    map.y = lengths * y;
    map.z = lengths * z;
    map.from = to.now - (to.rest.x * map.x + to.rest.y * map.y + to.rest.z * map.z);
  }
}

void place_skin(const SkinMesh& mesh, const BodySkin& skin, std::span<const FrameMap> maps, const SkinCover* cover,
                const VertexTarget& out) {
  for (std::size_t v = 0; v < mesh.vertex.size(); ++v) {
    const SkinVertex& vertex = mesh.vertex[v];
    FrameMap map = maps[vertex.frame[0]];
    if (vertex.weight[1] != 0) {
      const float first = vertex.weight[0];
      map = {first * map.x, first * map.y, first * map.z, first * map.from};
      for (std::size_t k = 1; k < SkinVertex::most_frames && vertex.weight[k] != 0; ++k) {
        const FrameMap& other = maps[vertex.frame[k]];
        const float weight = vertex.weight[k];
        map.x = map.x + weight * other.x;
        map.y = map.y + weight * other.y;
        map.z = map.z + weight * other.z;
        map.from = map.from + weight * other.from;
      }
    }
    RestPoint rest{skin.rest[v], skin.normal[v]};
    if (const LegPlace& leg = mesh.leg[v]; cover != nullptr && leg.amount > 0) rest = lifted(skin, *cover, leg, rest);
    const Vec3<float>&r = rest.place, &n = rest.normal;
    put(out.position + v * out.position_stride, map.from + r.x * map.x + (r.y * map.y + r.z * map.z));
    if (out.normal == nullptr) continue;
    const Vec3<float> turned = n.x * map.x + n.y * map.y + n.z * map.z;
    put(out.normal + v * out.normal_stride, normalised(turned));
  }
}

void pose_skin(const BodySkin& skin, const Pose<float>& pose, float lengths, const Vec3<float>& origin_m,
               const std::array<std::span<const Vec3<float>>, 2>& muscles, std::span<FrameMap> maps,
               const VertexTarget& out) {
  const SkinMesh& mesh = skin_mesh(skin.sex, skin.detail);
  frame_maps(mesh, skin, pose, lengths, origin_m, maps);
  SkinCover cover;
  bool covers = false;
  for (const Side side : {Side::right, Side::left}) {
    if (muscles[side].empty()) continue;
    covers = true;
    cover_muscles(skin, pose, lengths, side, muscles[side], cover.lift_m[side]);
  }
  place_skin(mesh, skin, maps, covers ? &cover : nullptr, out);
}

}  // namespace mobil
