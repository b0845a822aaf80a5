#include "systems/surfaces/clear_of_bones.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "systems/surfaces/weights8-inl.h"

#ifndef MOBIL_BONE_GRID
#define MOBIL_BONE_GRID
namespace mobil::inline v0_3 {
namespace {

/// A bone's samples in the world. `to_box` moves points to cells from where the bone begins, `margin` cells inside the
/// grid. Points next to a sample of `close` and more (mm) are outside the bone.
struct BoneGrid {
  AffineMap to_box;
  Vec3<float> box;  // size of the bone, cells
  float margin, close;
  const float* sample;
  std::int32_t count_x, count_y;
};

}  // namespace
}  // namespace mobil::inline v0_3
#endif

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

/// Writes a bit for each place, eight to a byte: 1 if it can be within the bone, by the sample next to it.
void find_near(const BoneGrid& bone, const float* places, std::size_t blocks, std::uint8_t* bits) {
  const EightTag tag;
  const hn::RebindToSigned<EightTag> whole;
  const auto zero = hn::Zero(tag), margin = hn::Set(tag, bone.margin), close = hn::Set(tag, bone.close);
  const auto across = hn::Set(whole, bone.count_x), along = hn::Set(whole, bone.count_x * bone.count_y);
  for (std::size_t b = 0; b < blocks; ++b, places += 4 * block_vertices) {
    EightVec p;
    for (std::size_t i = 0; i < eight_parts; ++i) {
      Rows rows;
      for (std::size_t v = 0; v < 4; ++v) {
        const float* first = places + 4 * (4 * i + v);
        rows.row[v] = load_vertices(tag, first, first + 16);
      }
      const Rows words = transposed(rows);
      p.x.part[i] = words.row[0];
      p.y.part[i] = words.row[1];
      p.z.part[i] = words.row[2];
    }
    const EightVec c = apply<true>(bone.to_box, p);
    std::uint8_t found = 0;
    for (std::size_t i = 0; i < eight_parts; ++i) {
      const auto is_in = [&](const WideEight& v, float high) HWY_ATTR {
        return hn::And(hn::Gt(v.part[i], zero), hn::Lt(v.part[i], hn::Set(tag, high)));
      };
      const auto in_box = hn::And(hn::And(is_in(c.x, bone.box.x), is_in(c.y, bone.box.y)), is_in(c.z, bone.box.z));
      if (hn::AllFalse(tag, in_box)) continue;
      const auto cell = [&](const WideEight& v) HWY_ATTR {
        return hn::ConvertTo(whole, hn::IfThenElseZero(in_box, hn::Add(v.part[i], margin)));
      };
      const auto sample = hn::Add(hn::Add(cell(c.x), hn::Mul(across, cell(c.y))), hn::Mul(along, cell(c.z)));
      const auto near = hn::And(in_box, hn::Lt(hn::GatherIndex(tag, bone.sample, sample), close));
      std::uint8_t own[8] = {};
      hn::StoreMaskBits(tag, near, own);
      found = static_cast<std::uint8_t>(found | (own[0] << (4 * i)));
    }
    bits[b] = found;
  }
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include <mobil/engine/geometry.h>
#include <mobil/systems/surfaces/vertex_rings.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;
using Point = Vec3<float>;
constexpr float gap_mm = 0.3F;  // of places from bones
HWY_EXPORT(find_near);

/// A bone's field for points in the world: cells = rotation⁻¹ (p − position) · scale − corner.
struct FieldInWorld {
  const DistanceField& field;
  RigidPose pose;
  Point scale, corner;  // cells per m along the bone's axes, cells
  BoneGrid grid{};

  FieldInWorld(const LegBones& bones, Segment segment, const PosedBone& bone, Side side)
      : field(LegBones::field(segment)), pose(bone.pose) {
    const Vec by = field.cell * bones.m_per_mm(segment);
    const auto per_m = [&](double cell_m, float own) { return static_cast<float>(1 / cell_m) / own; };
    scale = {per_m(side == Side::left ? -by.x : by.x, bone.scale.x), per_m(by.y, bone.scale.y),
             per_m(by.z, bone.scale.z)};
    corner = to_float((1 / field.cell) * field.corner);
    const std::array<Point, 3> axis = columns(pose.rotation);
    const std::array<float, 3> size = {scale.x, scale.y, scale.z}, first = {corner.x, corner.y, corner.z};
    grid.margin = static_cast<float>(field.band / field.cell);
    for (std::size_t r = 0; r < 3; ++r) {
      const Point row = size[r] * axis[r];
      grid.to_box.column[0][r] = row.x;
      grid.to_box.column[1][r] = row.y;
      grid.to_box.column[2][r] = row.z;
      grid.to_box.column[3][r] = -dot(row, pose.position_m) - first[r] - grid.margin;
    }
    const auto within = [&](int samples) { return static_cast<float>(samples) - 2 * grid.margin; };
    grid.box = {within(field.count[0]), within(field.count[1]), within(field.count[2])};
    grid.close = gap_mm + static_cast<float>(1.74 * field.cell);  // the diagonal of a cell
    grid.sample = field.value.data();
    grid.count_x = field.count[0];
    grid.count_y = field.count[1];
  }
  Point in_cells(const float* p) const {
    const auto& m = grid.to_box.column;
    const auto row = [&](std::size_t r) {
      return m[0][r] * p[0] + m[1][r] * p[1] + m[2][r] * p[2] + m[3][r] + grid.margin;
    };
    return {row(0), row(1), row(2)};
  }
  Point in_world(const Point& cells) const {
    const Point q{(cells.x + corner.x) / scale.x, (cells.y + corner.y) / scale.y, (cells.z + corner.z) / scale.z};
    return pose.position_m + rotated(pose.rotation, q);
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
  constexpr float over_mm = 0.05F;
  constexpr int most_steps = 8;
  const auto cell_mm = static_cast<float>(bone.field.cell);
  const float least_steep = 0.5F * cell_mm * cell_mm;  // the middle of a bone is flat
  Point cells = bone.in_cells(p);
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
  const auto field = [&](std::size_t b) { return FieldInWorld(bones, LegBones::hard[b], posed[b], side); };
  static_assert(LegBones::hard.size() == 5);
  const std::array<FieldInWorld, 5> fields = {field(0), field(1), field(2), field(3), field(4)};
  std::array<std::uint8_t, max_places / block_vertices> bits, moved, looked_at;
  const std::size_t blocks = count / block_vertices;
  std::fill_n(moved.begin(), blocks, std::uint8_t{0xFF});
  bool any = true;
  for (int pass = 0; pass < 6 && any; ++pass) {
    // Places that one bone pushes into another move again.
    std::copy_n(moved.begin(), blocks, looked_at.begin());
    std::fill_n(moved.begin(), blocks, std::uint8_t{0});
    any = false;
    for (const FieldInWorld& own : fields) {
      HWY_DYNAMIC_DISPATCH(find_near)(own.grid, places, blocks, bits.data());
      for (std::size_t block = 0; block < blocks; ++block) {
        for (unsigned left = bits[block] & looked_at[block]; left != 0; left &= left - 1) {
          const auto lane = static_cast<std::size_t>(std::countr_zero(left));
          if (!move_out(own, places + 4 * (block_vertices * block + lane))) continue;
          moved[block] = static_cast<std::uint8_t>(moved[block] | (1U << lane));
          any = true;
        }
      }
    }
  }
}

}  // namespace mobil::inline v0_3
#endif
