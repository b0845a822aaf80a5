#include "assets/surfaces/carried_skin.h"

#include <array>
#include <cmath>

#include <mobil/anthropometry.h>
#include <mobil/assets/surfaces/body_form.h>
#include <mobil/engine/geometry.h>
#include "assets/body/body_scales.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;
using enum Segment;

/// A body's segment in the meshing pose.
struct Carrier {
  Vec origin, scale;
  double turn;  // about z, rad
};
using Carriers = std::array<Carrier, segment_count>;

Vec turned(const Vec& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

Carriers carriers(const Body& body) {
  const auto scales = group_scales(body.size);
  const double wide = 1.75 * form::form_scale(body).head_wide;
  Carriers all{};
  for (std::size_t s = 0; s < segment_count; ++s) {
    Carrier& own = all[s];
    const auto segment = static_cast<Segment>(s);
    const std::size_t parent = index(segment_parent[s]);
    const Vec offset = to_double(body.joint_offset_m[s]);
    own.scale = scaled({1, 1, 1}, scales, segment_groups[s]);
    if (segment >= C7 && segment <= head) own.scale.x = own.scale.z = wide;
    own.origin = offset;
    if (s == parent) continue;
    own.turn = all[parent].turn;
    own.origin = all[parent].origin + turned(offset, own.turn);
    if (segment == upper_arm_right) own.turn = -form::arm_out;
    if (segment == upper_arm_left) own.turn = form::arm_out;
    if (segment == thigh_right) own.turn = -form::leg_out;
    if (segment == thigh_left) own.turn = form::leg_out;
  }
  return all;
}

}  // namespace

std::vector<Vec> carried_skin(const SkinMesh& mesh, Sex sex, const Body& body) {
  const Body usual = *make_body(skin_body(sex));
  const form::FormScale old = form::form_scale(usual), own = form::form_scale(body);
  const Carriers from = carriers(usual), to = carriers(body);
  std::vector<Vec> place;
  place.reserve(mesh.place.size());
  for (const Vec& at : mesh.place) {
    const Vec p{at.x, old.height(own.face_height(old.usual_height(at.y))), at.z};
    const auto moved = [&](std::size_t s) {
      const Vec q = turned(p - from[s].origin, -from[s].turn), by = to[s].scale, of = from[s].scale;
      return to[s].origin + turned({by.x / of.x * q.x, by.y / of.y * q.y, by.z / of.z * q.z}, to[s].turn);
    };
    const SkinVertex& vertex = mesh.vertex[place.size()];
    Vec sum{0, 0, 0};
    for (std::size_t k = 0; k < SkinVertex::max_frames && vertex.weight[k] != 0; ++k) {
      const SkinFrame& frame = mesh.frame[vertex.frame[k]];
      const auto turn = static_cast<double>(frame.turn), weight = static_cast<double>(vertex.weight[k]);
      sum = sum + weight * ((1 - turn) * moved(segment_of(frame.from)) + turn * moved(segment_of(frame.to)));
    }
    place.push_back(sum);
  }
  return place;
}

}  // namespace mobil::inline v0_3
