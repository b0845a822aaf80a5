#include "systems/surfaces/clear_of_bones.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;
using Point = Vec3<float>;

/// A bone's field for points in the world: cells = rotation⁻¹ (p − position) · scale − corner.
struct FieldInWorld {
  const DistanceField& field;
  RigidPose pose;
  Point scale, corner;  // cells per m along the bone's axes, cells
  Quat<float> back;

  FieldInWorld(const LegBones& bones, Segment segment, const PosedBone& bone, Side side)
      : field(LegBones::field(segment)), pose(bone.pose), back(conjugate(bone.pose.rotation)) {
    const float per_m = static_cast<float>(1 / (bones.m_per_mm() * field.cell)) / bone.lengths;
    scale = {side == Side::left ? -per_m : per_m, per_m / (bone.stretch * static_cast<float>(bones.stretch(segment))),
             per_m};
    corner = to_float((1 / field.cell) * field.corner);
  }
  Point in_cells(const Point& p) const {
    const Point q = rotated(back, p - pose.position_m);
    return {scale.x * q.x - corner.x, scale.y * q.y - corner.y, scale.z * q.z - corner.z};
  }
  Point in_world(const Point& cells) const {
    const Point q{(cells.x + corner.x) / scale.x, (cells.y + corner.y) / scale.y, (cells.z + corner.z) / scale.z};
    return pose.position_m + rotated(pose.rotation, q);
  }
  bool can_touch(const Point& middle, float radius_m) const {
    const Point at = in_cells(middle);
    const float reach = radius_m * std::max(scale.y, scale.z);
    const auto is_near = [&](float v, int cells) { return v > -reach && v < static_cast<float>(cells) + reach; };
    return is_near(at.x, field.count[0]) && is_near(at.y, field.count[1]) && is_near(at.z, field.count[2]);
  }
  bool contains(const Point& c) const {
    const auto is_in = [](float v, int count) { return v >= 0 && v < static_cast<float>(count - 1); };
    return is_in(c.x, field.count[0]) && is_in(c.y, field.count[1]) && is_in(c.z, field.count[2]);
  }
};

struct Depth {
  float distance;  // mm
  Point slope;     // mm per cell
};

/// Returns the field at a point in cells, linear between samples. The point must be in the grid.
Depth depth_at(const DistanceField& field, const Point& c) {
  const int x = static_cast<int>(c.x), y = static_cast<int>(c.y), z = static_cast<int>(c.z);
  const float u = c.x - static_cast<float>(x), v = c.y - static_cast<float>(y), w = c.z - static_cast<float>(z);
  const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
  const auto at = [&](int i, int j, int k) { return field.at(x + i, y + j, z + k); };
  const float a00 = at(0, 0, 0), a10 = at(1, 0, 0), a01 = at(0, 1, 0), a11 = at(1, 1, 0);
  const float b00 = at(0, 0, 1), b10 = at(1, 0, 1), b01 = at(0, 1, 1), b11 = at(1, 1, 1);
  const float a0 = mix(a00, a10, u), a1 = mix(a01, a11, u), b0 = mix(b00, b10, u), b1 = mix(b01, b11, u);
  const float a = mix(a0, a1, v), b = mix(b0, b1, v);
  return {mix(a, b, w),
          {mix(mix(a10 - a00, a11 - a01, v), mix(b10 - b00, b11 - b01, v), w), mix(a1 - a0, b1 - b0, w), b - a}};
}

/// Moves a place out of a bone, along the slope of its field. Returns true if it was inside.
bool move_out(const FieldInWorld& bone, float* p) {
  constexpr float gap_mm = 0.3F, over_mm = 0.05F;
  constexpr int most_steps = 8;
  const auto cell_mm = static_cast<float>(bone.field.cell);
  const float least_steep = 0.5F * cell_mm * cell_mm;  // the middle of a bone is flat
  Point cells = bone.in_cells({p[0], p[1], p[2]});
  bool moved = false;
  for (int step = 0; step < most_steps && bone.contains(cells); ++step) {
    const Depth here = depth_at(bone.field, cells);
    if (here.distance >= gap_mm) break;
    const float steep = std::max(dot(here.slope, here.slope), least_steep);
    cells = cells + ((gap_mm + over_mm - here.distance) / steep) * here.slope;
    moved = true;
  }
  if (!moved) return false;
  const Point out = bone.in_world(cells);
  p[0] = p[3] = out.x;
  p[1] = out.y;
  p[2] = out.z;
  return true;
}

}  // namespace

void keep_clear(const LegBones& bones, const std::array<PosedBone, LegBones::hard.size()>& posed, Side side,
                float* places, std::size_t count) {
  if (count == 0) return;
  Point low{places[0], places[1], places[2]}, high = low;
  for (std::size_t i = 1; i < count; ++i) {
    const float* p = places + 4 * i;
    low = {std::min(low.x, p[0]), std::min(low.y, p[1]), std::min(low.z, p[2])};
    high = {std::max(high.x, p[0]), std::max(high.y, p[1]), std::max(high.z, p[2])};
  }
  const Point middle = 0.5F * (low + high);
  const float radius_m = 0.5F * length(high - low);
  // Places that one bone pushes into another move again.
  bool moved = true;
  for (int pass = 0; pass < 6 && moved; ++pass) {
    moved = false;
    for (std::size_t b = 0; b < posed.size(); ++b) {
      const FieldInWorld own(bones, LegBones::hard[b], posed[b], side);
      if (!own.can_touch(middle, radius_m)) continue;
      for (std::size_t i = 0; i < count; ++i) moved = move_out(own, places + 4 * i) || moved;
    }
  }
}

}  // namespace mobil::inline v0_3
