#pragma once
// One bound surface as the kernels place it, and one vertex at a time by the formula. Normals are in double precision.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/muscle.h>
#include <mobil/components/pose.h>
#include <mobil/components/surface.h>
#include <mobil/engine/geometry.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include <mobil/systems/surfaces/write_vertices.h>
#include "systems/surfaces/place_vertices.h"

namespace mobil {

inline SkinMaps maps_of(const SurfaceRest& rest, Side side, const Pose<float>& pose, const LineOfAction<float>& line) {
  const auto now = [&](const SurfaceEnd& end) {
    const std::size_t s = index(end.bone[side]);
    return RigidPose{pose.position_m[s], pose.rotation[s]};
  };
  return skin_maps(rest, side, now(rest.origin), now(rest.insertion), line);
}

/// Returns the vertices placed by the kernels. `u`: displacements, three a node.
inline std::vector<Vec3<float>> skinned(const MuscleSurface& surface, Side side, const Body& body,
                                        const Pose<float>& pose, const LineOfAction<float>& line,
                                        const std::vector<float>& u) {
  const auto packed = pack_surface(surface, body, static_cast<std::uint32_t>(u.size() / 3));
  if (!packed) {
    ADD_FAILURE() << packed.error().message;
    return {};
  }
  std::vector<Eight> places(packed->places() / 2);
  float* const place = places.data()->lane;
  place_vertices(*packed, maps_of(packed->rest, side, pose, line), u.data(), side, place);
  std::vector<Vec3<float>> out(packed->vertices());
  write_vertices(packed->rings, {}, place, 1, {std::as_writable_bytes(std::span(out)).data(), nullptr, 12, 0});
  return out;
}

inline std::vector<float> displacements(const NodalView& view) {
  std::vector<float> u;
  for (std::size_t w = 0; w < 3 * std::size_t{view.nodes}; ++w) u.push_back(view.first[w * lane_count]);
  return u;
}

/// Evaluates p = lattice · frame(rest_in_lattice + Σ wᵢ uᵢ) + origin · T_origin(p₀) + insertion · T_insertion(p₀), in
/// the kernels' order of operations.
inline std::vector<Vec3<float>> skinned_one_by_one(const MuscleSurface& surface, Side side, const Body& body,
                                                   const Pose<float>& pose, const LineOfAction<float>& line,
                                                   const std::vector<float>& u) {
  const SkinMaps maps = maps_of(surface_rest(surface, body), side, pose, line);
  const auto carried = [](const AffineMap& m, const float* p, int r) {
    return std::fma(p[0], m.column[0][r], p[1] * m.column[1][r]) + std::fma(p[2], m.column[2][r], m.column[3][r]);
  };
  std::vector<Vec3<float>> out;
  for (std::size_t v = 0; v < surface.mesh.position.size(); ++v) {
    const VertexBinding& b = surface.binding[v];
    const Vec3<float>& at = surface.mesh.position[v];
    const float p[3] = {at.x, at.y, at.z};
    float q[3] = {}, place[3];
    if (b.lattice != 0) {
      const Vec3<float>& rest = surface.rest_in_lattice[v];
      const float from[3] = {rest.x, rest.y, rest.z};
      for (std::size_t c = 0; c < 3; ++c) {
        float sum[2];
        for (std::size_t i = 0; i < 8; ++i) {
          const float node = u[3 * std::size_t{b.node[i]} + c];
          sum[i % 2] = i < 2 ? b.node_weight[i] * node : std::fma(b.node_weight[i], node, sum[i % 2]);
        }
        q[c] = from[c] + (sum[0] + sum[1]);
      }
    }
    for (int r = 0; r < 3; ++r) {
      float bones = std::fma(b.origin, carried(maps.origin, p, r), b.insertion * carried(maps.insertion, p, r));
      if (b.origin_held > 0 || b.insertion_held > 0) {
        bones = std::fma(b.insertion_held, carried(maps.insertion_held, p, r), bones);
        bones = std::fma(b.origin_held, carried(maps.origin_held, p, r), bones);
      }
      place[r] = std::fma(b.lattice, carried(maps.frame, q, r), bones);
    }
    out.push_back({side == Side::left ? -place[0] : place[0], place[1], place[2]});
  }
  return out;
}

/// Returns means of the triangles' normals weighted by their areas; up for vertices without triangles.
inline std::vector<Vec3<double>> triangle_normals(std::span<const Vec3<float>> position,
                                                  std::span<const std::uint32_t> triangle) {
  using namespace geometry;
  std::vector<Vec> normal(position.size());
  for (std::size_t t = 0; t < triangle.size(); t += 3) {
    const Vec a = to_double(position[triangle[t]]);
    const Vec n = cross(to_double(position[triangle[t + 1]]) - a, to_double(position[triangle[t + 2]]) - a);
    for (std::size_t k = 0; k < 3; ++k) normal[triangle[t + k]] = normal[triangle[t + k]] + n;
  }
  for (Vec& n : normal) n = length(n) > 1e-18 ? normalised(n) : Vec{0, 1, 0};
  return normal;
}

}  // namespace mobil
