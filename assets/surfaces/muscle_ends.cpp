#include "assets/surfaces/muscle_ends.h"

#include <algorithm>
#include <span>

#include <mobil/engine/geometry.h>
#include "assets/surfaces/muscle_room.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

/// Returns the point of the bone's surface that is nearest to `p`.
Vec onto_bone(const LegBones& bones, Segment bone, Vec p) {
  constexpr double enough_m = 2e-4;
  for (int round = 0; round < 6; ++round) {
    const Vec out = bones.outward(bone, p);
    const double off = bones.distance(bone, p);
    if (length(out) == 0) return bones.nearest(bone, p);
    p = p - off * out;
    if (std::abs(off) < enough_m) return p;
  }
  return bones.nearest(bone, p);
}

}  // namespace

void spread_end(const LegBones& bones, Segment bone, TubeEnd end, const TubeLayout& layout, SurfaceMesh& mesh) {
  constexpr double least_reach_m = 0.025, reach_per_radius = 2.5, bevel = 0.6, sink_m = 0.0005;
  const std::size_t n = layout.segments;
  const bool first = end == TubeEnd::origin;
  // rings from the end inwards: the last of the body is the first of these
  const auto ring = [&](std::size_t i) {
    const std::size_t r = first ? layout.cap + i : layout.all_rings() - 1 - layout.cap - i;
    return std::span(mesh.position).subspan(layout.vertex(r), n);
  };
  const Vec centre = ring_middle(ring(0)), next = ring_middle(ring(1));
  const Vec foot = bones.nearest(bone, centre);
  Vec out = bones.outward(bone, foot);
  if (length(out) == 0) out = normalised(centre - foot);
  const Vec beyond = orthogonal(centre - next, out);
  std::vector<Vec> shift;
  double radius = 0;
  for (const auto& p : ring(0)) {
    const Vec arm = to_double(p) - centre;
    const double height = dot(arm, out);
    radius = std::max(radius, length(arm));
    const Vec on_plane = foot + (arm - height * out) + (bevel * height) * beyond;
    shift.push_back(onto_bone(bones, bone, on_plane) - to_double(p));
  }
  const double reach = std::max(least_reach_m, reach_per_radius * radius);
  double along = 0;
  Vec before = centre;
  for (std::size_t i = 0; i < layout.rings / 2; ++i) {
    const auto own = ring(i);
    const Vec middle = ring_middle(own);
    if (i > 0) along += length(middle - before);
    before = middle;
    const double part = 1 - smoothstep(0, reach, along);
    for (std::size_t j = 0; j < n; ++j) own[j] = to_float(to_double(own[j]) + part * shift[j]);
  }
  const Vec pole = foot - sink_m * out;
  const auto edge = ring(0);
  for (std::size_t c = 1; c <= layout.cap; ++c) {
    const std::size_t r = first ? layout.cap - c : layout.all_rings() - 1 - layout.cap + c;
    const double part = static_cast<double>(c) / static_cast<double>(layout.cap + 1);
    for (std::size_t j = 0; j < n; ++j)
      mesh.position[layout.vertex(r) + j] = to_float(to_double(edge[j]) + part * (pole - to_double(edge[j])));
  }
  (first ? mesh.position.front() : mesh.position.back()) = to_float(pole);
}

std::vector<float> held_shares(TubeEnd end, const TubeLayout& layout, std::size_t vertices) {
  std::vector<float> held(vertices, 0.0F);
  const bool first = end == TubeEnd::origin;
  const auto set = [&](std::size_t ring_from_end, float share) {
    const std::size_t r = first ? ring_from_end : layout.all_rings() - 1 - ring_from_end;
    std::fill_n(held.begin() + static_cast<std::ptrdiff_t>(layout.vertex(r)), layout.segments, share);
  };
  (first ? held.front() : held.back()) = 1;
  for (std::size_t i = 0; i <= layout.cap; ++i) set(i, 1);
  set(layout.cap + 1, 0.5F);
  return held;
}

}  // namespace mobil::inline v0_3
