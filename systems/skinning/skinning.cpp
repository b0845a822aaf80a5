#include "systems/skinning/skinning.h"

#include <array>

namespace mobil {
namespace {

/// Columns of a rotation, then the translation; four floats each so that they fill a register.
struct Affine {
  alignas(16) float column[4][4];
};

Quat<float> mirrored_rotation(const Quat<float>& q) {
  return {q.x, -q.y, -q.z, q.w};
}

RigidPose mirrored_pose(const RigidPose& p) {
  return {{-p.position_m.x, p.position_m.y, p.position_m.z}, mirrored_rotation(p.rotation)};
}

Affine affine(const RigidPose& p) {
  const auto [x, y, z, w] = p.rotation;
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y), 0},
           {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x), 0},
           {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y), 0},
           {p.position_m.x, p.position_m.y, p.position_m.z, 0}}};
}

/// now ∘ rest⁻¹.
Affine motion(const RigidPose& now, const RigidPose& rest) {
  const Affine a = affine(now), b = affine(rest);
  Affine m{};
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      for (int k = 0; k < 3; ++k) m.column[c][r] += a.column[k][r] * b.column[k][c];
    }
  }
  for (int r = 0; r < 3; ++r) {
    m.column[3][r] = a.column[3][r];
    for (int k = 0; k < 3; ++k) m.column[3][r] -= m.column[k][r] * b.column[3][k];
  }
  return m;
}

/// to += weight · map(p)
inline void add_mapped(float (&to)[4], float weight, const Affine& map, float x, float y, float z) {
  for (int r = 0; r < 4; ++r) {
    const float mapped = map.column[0][r] * x + map.column[1][r] * y + (map.column[2][r] * z + map.column[3][r]);
    to[r] += weight * mapped;
  }
}

/// Nodes up to this many are copied together first, which one lane of a block is not.
constexpr std::size_t gathered_nodes = 1024;

/// `node(n)`: something to index by 0 to 3, the displacement of node n and a zero.
template <class Node>
void skin(const MuscleSurface& s, const Affine& frame, const Affine& origin, const Affine& insertion, const Node& node,
          float sign, std::span<Vec3<float>> out) {
  for (std::size_t v = 0; v < out.size(); ++v) {
    const VertexBinding& b = s.binding[v];
    alignas(16) float moved[4] = {s.rest_in_cage[v].x, s.rest_in_cage[v].y, s.rest_in_cage[v].z, 0};
    for (int i = 0; i < 8; ++i) {
      const auto u = node(std::size_t{b.node[i]});
      for (std::size_t r = 0; r < 4; ++r) moved[r] += b.node_weight[i] * u[r];
    }
    const Vec3<float>& p = s.mesh.position[v];
    alignas(16) float sum[4] = {0, 0, 0, 0};
    add_mapped(sum, b.cage, frame, moved[0], moved[1], moved[2]);
    add_mapped(sum, b.origin, origin, p.x, p.y, p.z);
    add_mapped(sum, b.insertion, insertion, p.x, p.y, p.z);
    out[v] = {sign * sum[0], sum[1], sum[2]};
  }
}

}  // namespace

SkinPose skin_pose(const MuscleSurface& surface, Side side, const Body& body, const Pose<float>& pose,
                   const LineOfAction<float>& line) {
  const auto of_side = [side](Segment s) { return s < Segment::thigh_right ? s : on_side(s, side); };
  const auto now = [&](Segment s) { return RigidPose{pose.position_m[index(s)], pose.rotation[index(s)]}; };
  const auto rest = [&](Segment s) {
    RigidPose p{body.joint_offset_m[index(s)], {0, 0, 0, 1}};
    while (s != segment_parent[index(s)]) {
      s = segment_parent[index(s)];
      const Vec3<float>& offset = body.joint_offset_m[index(s)];
      p.position_m = {p.position_m.x + offset.x, p.position_m.y + offset.y, p.position_m.z + offset.z};
    }
    return p;
  };
  const Segment origin = of_side(surface.origin), insertion = of_side(surface.insertion);
  return {{line.start_m, line.rotation}, now(origin), rest(origin), now(insertion), rest(insertion)};
}

void skin_surface(const MuscleSurface& surface, const SkinPose& pose, const NodalLane& displacement, bool mirrored,
                  std::span<Vec3<float>> out) {
  const auto bone = [mirrored](const RigidPose& now, const RigidPose& rest) {
    return mirrored ? motion(mirrored_pose(now), mirrored_pose(rest)) : motion(now, rest);
  };
  const Affine frame = affine(pose.frame), origin = bone(pose.origin_now, pose.origin_rest),
               insertion = bone(pose.insertion_now, pose.insertion_rest);
  const float sign = mirrored ? -1.0F : 1.0F;
  const auto [first, stride, nodes] = displacement;
  if (nodes > gathered_nodes) {
    const auto strided = [first = first, stride = stride](std::size_t n) {
      const float* u = first + 3 * n * stride;
      return std::array<float, 4>{u[0], u[stride], u[2 * stride], 0};
    };
    skin(surface, frame, origin, insertion, strided, sign, out);
    return;
  }
  alignas(16) float gathered[4 * gathered_nodes];
  for (std::size_t n = 0; n < nodes; ++n) {
    for (std::size_t c = 0; c < 3; ++c) gathered[4 * n + c] = first[(3 * n + c) * stride];
    gathered[4 * n + 3] = 0;
  }
  skin(
      surface, frame, origin, insertion, [&](std::size_t n) { return &gathered[4 * n]; }, sign, out);
}

}  // namespace mobil
