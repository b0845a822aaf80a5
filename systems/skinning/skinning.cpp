#include "systems/skinning/skinning.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/skinning/skinning.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef MOBIL_SYSTEMS_SKINNING_AFFINE
#define MOBIL_SYSTEMS_SKINNING_AFFINE
namespace mobil {
namespace {

/// Columns of a rotation, then the translation; four floats each so that they fill a register.
struct Affine {
  alignas(16) float column[4][4];
};

}  // namespace
}  // namespace mobil
#endif

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// One vertex at a time, x y z in the lanes of one 128-bit register (in four of a target that has none).
using Tag = hn::CappedTag<float, 4>;
constexpr Tag tag;
constexpr std::size_t lanes = hn::MaxLanes(Tag{}), parts = 4 / lanes;
struct Four {
  hn::Vec<Tag> part[parts];
};

HWY_INLINE Four load(const float* p) {
  Four r;
  for (std::size_t i = 0; i < parts; ++i) r.part[i] = hn::Load(tag, p + i * lanes);
  return r;
}
HWY_INLINE void store(const Four& a, float* p) {
  for (std::size_t i = 0; i < parts; ++i) hn::Store(a.part[i], tag, p + i * lanes);
}
/// s·a + b
HWY_INLINE Four multiply_add(float s, const Four& a, const Four& b) {
  Four r;
  for (std::size_t i = 0; i < parts; ++i) r.part[i] = hn::MulAdd(hn::Set(tag, s), a.part[i], b.part[i]);
  return r;
}
HWY_INLINE Four multiply(float s, const Four& a) {
  Four r;
  for (std::size_t i = 0; i < parts; ++i) r.part[i] = hn::Mul(hn::Set(tag, s), a.part[i]);
  return r;
}
HWY_INLINE Four add(const Four& a, const Four& b) {
  Four r;
  for (std::size_t i = 0; i < parts; ++i) r.part[i] = hn::Add(a.part[i], b.part[i]);
  return r;
}

struct Map {
  Four x, y, z, at;
};
HWY_INLINE Map load(const Affine& a) {
  return {load(a.column[0]), load(a.column[1]), load(a.column[2]), load(a.column[3])};
}
HWY_INLINE Four apply(const Map& m, float x, float y, float z) {
  return add(multiply_add(x, m.x, multiply(y, m.y)), multiply_add(z, m.z, m.at));
}

/// Nodes up to this many are copied together first, which one lane of a block is not.
constexpr std::size_t gathered_nodes = 4096;

/// `node(n)`: the displacement of node n and a zero.
template <class Node>
HWY_INLINE void skin_vertices(const MuscleSurface& s, const Affine (&maps)[3], const Node& node, float sign,
                              std::span<Vec3<float>> out) {
  const Map frame = load(maps[0]), origin = load(maps[1]), insertion = load(maps[2]);
  alignas(16) float u[4], place[4];
  for (std::size_t v = 0; v < out.size(); ++v) {
    const VertexBinding& b = s.binding[v];
    Four even = multiply(b.node_weight[0], node(b.node[0])), odd = multiply(b.node_weight[1], node(b.node[1]));
    for (int i = 2; i < 8; i += 2) {
      even = multiply_add(b.node_weight[i], node(b.node[i]), even);
      odd = multiply_add(b.node_weight[i + 1], node(b.node[i + 1]), odd);
    }
    store(add(even, odd), u);
    const Vec3<float>&q = s.rest_in_cage[v], &p = s.mesh.position[v];
    const Four bones =
        multiply_add(b.origin, apply(origin, p.x, p.y, p.z), multiply(b.insertion, apply(insertion, p.x, p.y, p.z)));
    store(multiply_add(b.cage, apply(frame, q.x + u[0], q.y + u[1], q.z + u[2]), bones), place);
    out[v] = {sign * place[0], place[1], place[2]};
  }
}

void skin(const MuscleSurface& surface, const Affine (&maps)[3], const NodalLane& displacement, float sign,
          std::span<Vec3<float>> out) {
  const float* first = displacement.first;
  const std::size_t stride = displacement.stride, nodes = displacement.nodes;
  if (nodes > gathered_nodes) {
    const auto strided = [=](std::size_t n) HWY_ATTR {
      const float* at = first + 3 * n * stride;
      alignas(16) const float u[4] = {at[0], at[stride], at[2 * stride], 0};
      return load(u);
    };
    skin_vertices(surface, maps, strided, sign, out);
    return;
  }
  alignas(16) float gathered[4 * gathered_nodes];
  for (std::size_t n = 0; n < nodes; ++n) {
    for (std::size_t c = 0; c < 3; ++c) gathered[4 * n + c] = first[(3 * n + c) * stride];
    gathered[4 * n + 3] = 0;
  }
  const float* const together = gathered;
  skin_vertices(
      surface, maps, [=](std::size_t n) HWY_ATTR { return load(together + 4 * n); }, sign, out);
}

}  // namespace
}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cmath>

#include "engine/geometry.h"

namespace mobil {
namespace {

HWY_EXPORT(skin);

RigidPose mirrored(const RigidPose& p) {
  return {geometry::mirrored(p.position_m), geometry::mirrored(p.rotation)};
}

Affine affine(const RigidPose& p) {
  const auto [x, y, z] = geometry::columns(p.rotation);
  const Vec3<float>& at = p.position_m;
  return {{{x.x, x.y, x.z, 0}, {y.x, y.y, y.z, 0}, {z.x, z.y, z.z, 0}, {at.x, at.y, at.z, 0}}};
}

/// The rotation a part of the shorter way from `a` (0) to `b` (1).
Quat<float> between(const Quat<float>& a, const Quat<float>& b, float part) {
  const float same = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
  const float wa = 1 - part, wb = same < 0 ? -part : part;
  const Quat<float> q{wa * a.x + wb * b.x, wa * a.y + wb * b.y, wa * a.z + wb * b.z, wa * a.w + wb * b.w};
  const float n = 1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {n * q.x, n * q.y, n * q.z, n * q.w};
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

}  // namespace

SkinPose skin_pose(const MuscleSurface& surface, Side side, const Body& body, const Pose<float>& pose,
                   const LineOfAction<float>& line) {
  using namespace geometry;
  const auto of_side = [side](Segment s) { return s < Segment::thigh_right ? s : on_side(s, side); };
  const auto rest_of = [&](Segment s) {
    Vec3<float> p = body.joint_offset_m[index(s)];
    while (s != segment_parent[index(s)]) {
      s = segment_parent[index(s)];
      p = p + body.joint_offset_m[index(s)];
    }
    return p;
  };
  const Quat<float> in_image = product(line.rotation, conjugate(surface.rest_rotation));
  const Quat<float> muscle_turn = side == left ? mirrored(in_image) : in_image;
  struct End {
    RigidPose now, rest;
  };
  const auto end = [&](Segment right_segment, const Vec3<float>& attachment, float turn) {
    const Segment s = of_side(right_segment);
    const RigidPose now{pose.position_m[index(s)], pose.rotation[index(s)]}, rest{rest_of(s), {0, 0, 0, 1}};
    if (turn == 0) return End{now, rest};
    const Vec3<float> at = side == left ? mirrored(attachment) : attachment;
    const Vec3<float> carried = now.position_m + rotated(now.rotation, at - rest.position_m);
    return End{{carried, between(now.rotation, muscle_turn, turn)}, {at, rest.rotation}};
  };
  const End origin = end(surface.origin, surface.origin_m, surface.origin_turn),
            insertion = end(surface.insertion, surface.insertion_m, surface.insertion_turn);
  return {{line.start_m, line.rotation}, origin.now, origin.rest, insertion.now, insertion.rest};
}

void skin_surface(const MuscleSurface& surface, const SkinPose& pose, const NodalLane& displacement, bool is_left,
                  std::span<Vec3<float>> out) {
  const auto bone = [is_left](const RigidPose& now, const RigidPose& rest) {
    return is_left ? motion(mirrored(now), mirrored(rest)) : motion(now, rest);
  };
  const Affine maps[3] = {affine(pose.frame), bone(pose.origin_now, pose.origin_rest),
                          bone(pose.insertion_now, pose.insertion_rest)};
  HWY_DYNAMIC_DISPATCH(skin)(surface, maps, displacement, is_left ? -1.0F : 1.0F, out);
}

}  // namespace mobil
#endif
