// Reach of muscles at the points of a leg's grid, several vertices at a time. For inclusion inside Highway's targets
// only.

#if defined(MOBIL_SYSTEMS_SKINNING_MUSCLE_REACH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_SKINNING_MUSCLE_REACH_INL_H_
#undef MOBIL_SYSTEMS_SKINNING_MUSCLE_REACH_INL_H_
#else
#define MOBIL_SYSTEMS_SKINNING_MUSCLE_REACH_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>

#include "engine/fused-inl.h"
#include "systems/surfaces/leg_rings.h"
#include "systems/surfaces/ring_grid-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Size of a batch of vertices. Passes over a batch avoid waiting: from one vertex to where it raises the grid is a
/// dependency chain of some 200 cycles.
inline constexpr std::size_t cover_batch = 256;

/// Place of a batch's vertices on the leg: to the side and to the front of its line (m), and how far down it.
struct OnLeg {
  alignas(64) float side[cover_batch], front[cover_batch], s[cover_batch];
};

/// Joint in whose bend a vertex is.
enum class LegBend : std::int32_t { none, hip, knee, ankle };

struct CoverPoint {
  CoverV x, y, z;
};

/// Vertices of a batch, world, m.
struct CoverBatch {
  alignas(64) float x[cover_batch], y[cover_batch], z[cover_batch];
  alignas(64) std::int32_t bend[cover_batch];  // LegBend

  HWY_INLINE CoverPoint at(std::size_t first) const {
    constexpr CoverTag tag;
    return {hn::Load(tag, x + first), hn::Load(tag, y + first), hn::Load(tag, z + first)};
  }
};

/// Returns a vector's component along an axis.
HWY_INLINE CoverV along_axis(const CoverPoint& p, const CoverV& x, const CoverV& y, const CoverV& z) {
  return mul_add(p.z, z, mul_add(p.y, y, hn::Mul(p.x, x)));
}
HWY_INLINE CoverV along_axis(const CoverPoint& p, const Vec3<float>& axis) {
  return along_axis(p, splat(axis.x), splat(axis.y), splat(axis.z));
}
/// Returns the component along one axis of a ring.
HWY_INLINE CoverV along_axis(const CoverPoint& p, const JointRings& bend, std::size_t axis, std::size_t ring) {
  const auto& of = bend.axis[axis];
  return along_axis(p, splat(of[0][ring]), splat(of[1][ring]), splat(of[2][ring]));
}
/// Returns the component along one axis of each vertex' own ring.
HWY_INLINE CoverV along_axis(const CoverPoint& p, const JointRings& bend, std::size_t axis,
                             const hn::Vec<CoverIntTag>& ring) {
  const auto of = [&](std::size_t c) HWY_ATTR {
    constexpr CoverTag tag;
    const float* const all = bend.axis[axis][c];
    if constexpr (cover_lanes == bend_rings) {
      return hn::TableLookupLanes(hn::Load(tag, all), hn::IndicesFromVec(tag, ring));
    } else {
      return hn::GatherIndex(tag, all, ring);
    }
  };
  return along_axis(p, of(0), of(1), of(2));
}

/// Returns a place relative to a joint's centre.
HWY_INLINE CoverPoint from_centre(const JointRings& bend, const CoverPoint& p) {
  const Vec3<float>& c = bend.centre_m;
  return {hn::Sub(p.x, splat(c.x)), hn::Sub(p.y, splat(c.y)), hn::Sub(p.z, splat(c.z))};
}

/// Places the vertices at thigh and shank, in whole registers; those in a joint's bend are only marked.
HWY_NOINLINE inline void place_straight(const LegRings& rings, const float* vertices, std::size_t count, OnLeg& at,
                                        CoverBatch& batch) {
  constexpr CoverTag tag;
  constexpr CoverIntTag whole;
  constexpr std::size_t last = bend_rings - 1;
  const JointRings& knee = rings.knee;
  const CoverV over_thigh = splat(1 / rings.thigh_m), over_shank = splat(1 / rings.shank_m);
  for (std::size_t first = 0; first < count; first += cover_lanes) {
    CoverPoint p;
    hn::LoadInterleaved3(tag, vertices + 3 * first, p.x, p.y, p.z);
    const CoverPoint from = from_centre(knee, p);
    const CoverV high = along_axis(from, knee, 1, last), low = along_axis(from, knee.below[1]);
    const CoverV thigh_side = along_axis(from, knee, 0, last), thigh_front = along_axis(from, knee, 2, last);
    const CoverV shank_side = along_axis(from, knee.below[0]), shank_front = along_axis(from, knee.below[2]);
    // If the knee is bent beyond a right angle, the segment with the nearer line counts.
    const auto square = [](const CoverV& a, const CoverV& b) HWY_ATTR { return mul_add(a, a, hn::Mul(b, b)); };
    const CoverMask may_be_shank = hn::Le(low, splat(knee.low_m));
    const CoverMask is_thigh =
        hn::AndNot(hn::And(may_be_shank, hn::Lt(square(shank_front, shank_side), square(thigh_front, thigh_side))),
                   hn::Ge(high, splat(knee.high_m)));
    const CoverMask is_shank = hn::AndNot(is_thigh, may_be_shank), is_knee = hn::Not(hn::Or(is_thigh, is_shank));
    const CoverMask is_hip = hn::And(is_thigh, hn::Gt(high, splat(rings.thigh_m + rings.hip.low_m)));
    // Behind the ankle skin bends below the grid.
    const CoverMask is_ankle = hn::And(hn::And(is_shank, hn::Lt(low, splat(rings.ankle.high_m - rings.shank_m))),
                                       hn::Gt(shank_front, hn::Zero(tag)));
    const CoverV thigh_s = neg_mul_add(high, over_thigh, splat(1)), shank_s = neg_mul_add(low, over_shank, splat(1));
    hn::Store(hn::IfThenElse(is_thigh, thigh_side, shank_side), tag, at.side + first);
    hn::Store(hn::IfThenElse(is_thigh, thigh_front, shank_front), tag, at.front + first);
    hn::Store(hn::IfThenElse(is_thigh, thigh_s, shank_s), tag, at.s + first);
    const auto is = [&](const CoverMask& which, LegBend bend) HWY_ATTR {
      return hn::IfThenElseZero(hn::RebindMask(whole, which), hn::Set(whole, static_cast<std::int32_t>(bend)));
    };
    hn::Store(hn::Or(is(is_knee, LegBend::knee), hn::Or(is(is_hip, LegBend::hip), is(is_ankle, LegBend::ankle))), whole,
              batch.bend + first);
    hn::Store(p.x, tag, batch.x + first);
    hn::Store(p.y, tag, batch.y + first);
    hn::Store(p.z, tag, batch.z + first);
  }
}

/// Places the vertices in a joint's bend, each in the first ring that it is not above. `joint_s` is the joint's place
/// down the leg; `above_m` and `below_m` are the lengths of the segments that it joins.
HWY_NOINLINE inline void place_bent(const JointRings& bend, LegBend which, const CoverBatch& batch, std::size_t count,
                                    float joint_s, float above_m, float below_m, OnLeg& at) {
  constexpr CoverTag tag;
  constexpr CoverIntTag whole;
  for (std::size_t first = 0; first < count; first += cover_lanes) {
    const CoverMask there = hn::RebindMask(
        tag, hn::Eq(hn::Load(whole, batch.bend + first), hn::Set(whole, static_cast<std::int32_t>(which))));
    if (hn::AllFalse(tag, there)) continue;
    const CoverPoint p = from_centre(bend, batch.at(first));
    hn::Vec<CoverIntTag> ring = hn::Zero(whole);
    CoverMask above = there;  // all rings so far
    for (std::size_t k = 0; k + 1 < bend_rings; ++k) {
      above = hn::And(above, hn::Gt(along_axis(p, bend, 1, k), splat(bend.height_m[k])));
      if (hn::AllFalse(tag, above)) break;
      ring = hn::IfThenElse(hn::RebindMask(whole, above), hn::Set(whole, static_cast<std::int32_t>(k) + 1), ring);
    }
    const CoverV height = hn::Max(splat(bend.low_m), hn::Min(splat(bend.high_m), along_axis(p, bend, 1, ring)));
    const auto down = [&](float length_m) HWY_ATTR { return neg_mul_add(height, splat(1 / length_m), splat(joint_s)); };
    const auto set = [&](const CoverV& value, float* to) HWY_ATTR {
      hn::Store(hn::IfThenElse(there, value, hn::Load(tag, to + first)), tag, to + first);
    };
    set(along_axis(p, bend, 0, ring), at.side);
    set(along_axis(p, bend, 2, ring), at.front);
    set(hn::IfThenElse(hn::Gt(height, hn::Zero(tag)), down(above_m), down(below_m)), at.s);
  }
}

/// Returns the angle of (x, z) from the z axis towards the x axis in turns, 0 to 1, to 10⁻⁴ of a turn.
HWY_INLINE CoverV turn_of(const CoverV& x, const CoverV& z) {
  constexpr CoverTag tag;
  constexpr float turn = 1 / (2 * std::numbers::pi_v<float>);
  const CoverV ax = hn::Abs(x), az = hn::Abs(z);
  const CoverV r = hn::Div(hn::Min(ax, az), hn::Max(hn::Max(ax, az), splat(1e-20F))), s = hn::Mul(r, r);
  CoverV angle = mul_add(s, splat(-0.0464964749F * turn), splat(0.15931422F * turn));
  angle = mul_add(s, mul_add(s, angle, splat(-0.327622764F * turn)), splat(turn));
  angle = hn::Mul(r, angle);
  angle = hn::IfThenElse(hn::Gt(ax, az), hn::Sub(splat(0.25F), angle), angle);
  angle = hn::IfThenElse(hn::Lt(z, hn::Zero(tag)), hn::Sub(splat(0.5F), angle), angle);
  return hn::IfThenElse(hn::Lt(x, hn::Zero(tag)), hn::Sub(splat(1), angle), angle);
}

/// Cells that vertices raise: the grid cell of each vertex, and heights for its four points, m, two at this station and
/// two at the next.
struct RaisedCells {
  alignas(64) std::int32_t cell[cover_batch];
  alignas(64) float min_m[4 * cover_batch];
};

/// Finds raised cells. Vertices next to a point count for less, so that nothing jumps as they pass. Vertices off the
/// grid, far from the leg, or NaN raise nothing.
HWY_NOINLINE inline void find_cells(const OnLeg& at, float out_side, std::size_t count, RaisedCells& raised) {
  constexpr CoverTag tag;
  constexpr CoverIntTag whole;
  constexpr float beside_m = 0.004F, max_m = 1;
  constexpr auto first_s = static_cast<float>(first_leg_s), last_s = static_cast<float>(last_leg_s);
  constexpr float stations = (leg_stations - 1) / (last_s - first_s);
  for (std::size_t first = 0; first < count; first += cover_lanes) {
    const CoverV out = hn::Mul(splat(out_side), hn::Load(tag, at.side + first)),
                 front = hn::Load(tag, at.front + first);
    const CoverV radius = hn::Sqrt(mul_add(front, front, hn::Mul(out, out)));
    const CoverV along = hn::Mul(hn::Sub(hn::Load(tag, at.s + first), splat(first_s)), splat(stations));
    const CoverMask there = hn::And(hn::And(hn::Ge(along, hn::Zero(tag)), hn::Le(along, splat(leg_stations - 1))),
                                    hn::Le(radius, splat(max_m)));
    const CoverV row = hn::IfThenElseZero(there, along), reaches = hn::IfThenElseZero(there, radius);
    const CoverV round = hn::IfThenElseZero(there, hn::Mul(turn_of(out, front), splat(leg_angles)));
    const auto i = hn::ConvertTo(whole, row);
    const auto j = hn::Min(hn::ConvertTo(whole, round), hn::Set(whole, std::int32_t{leg_angles} - 1));
    const CoverV u = hn::Sub(row, hn::ConvertTo(tag, i)), v = hn::Sub(round, hn::ConvertTo(tag, j));
    const CoverV u1 = hn::Sub(u, splat(1)), v1 = hn::Sub(v, splat(1));
    const auto counted = [&](const CoverV& a, const CoverV& b)
                             HWY_ATTR { return neg_mul_add(splat(beside_m), mul_add(a, a, hn::Mul(b, b)), reaches); };
    hn::StoreInterleaved4(counted(u, v), counted(u, v1), counted(u1, v), counted(u1, v1), tag,
                          raised.min_m + 4 * first);
    hn::Store(hn::Add(hn::Mul(i, hn::Set(whole, std::int32_t{leg_angles})), place_in_ring(j)), whole,
              raised.cell + first);
  }
}

/// Takes the maximum of the cells around each point.
HWY_NOINLINE inline void take_cells(const float* cell, RingGrid& reach) {
  constexpr CoverTag tag;
  // Values of the station above for this one, at the cells' own angle and at the next.
  Ring above = each_part([](std::size_t) HWY_ATTR { return hn::Zero(CoverTag{}); }), above_next = above;
  for (std::size_t i = 0; i < leg_stations; ++i) {
    Ring own, next, below, below_next;
    for (std::size_t p = 0; p < ring_parts; ++p, cell += 4 * cover_lanes)
      hn::LoadInterleaved4(tag, cell, own.part[p], next.part[p], below.part[p], below_next.part[p]);
    const Ring beside =
        before(each_part([&](std::size_t p) HWY_ATTR { return hn::Max(next.part[p], above_next.part[p]); }));
    reach.set(i, each_part([&](std::size_t p)
                               HWY_ATTR { return hn::Max(hn::Max(own.part[p], above.part[p]), beside.part[p]); }));
    above = below, above_next = below_next;
  }
}

/// Finds how far muscles reach at the points of the grid, m; 0 without muscles.
HWY_NOINLINE inline void find_reach(const LegRings& rings, std::span<const Vec3<float>> muscles, RingGrid& reach) {
  constexpr hn::CappedTag<float, 4> four;
  OnLeg at;
  CoverBatch batch;
  RaisedCells raised;
  alignas(64) std::array<float, 4 * leg_grid_points> cells{};
  for (std::size_t first = 0; first < muscles.size(); first += cover_batch) {
    const std::span some = muscles.subspan(first, std::min(cover_batch, muscles.size() - first));
    const float* vertices = &some.front().x;
    const std::size_t count = (some.size() + cover_lanes - 1) / cover_lanes * cover_lanes;
    Vec3<float> padded[cover_batch];
    if (count != some.size()) {
      std::fill(std::copy(some.begin(), some.end(), padded), padded + count, some.back());
      vertices = &padded->x;
    }
    place_straight(rings, vertices, count, at, batch);
    place_bent(rings.hip, LegBend::hip, batch, count, 0, rings.thigh_m, rings.thigh_m, at);
    place_bent(rings.knee, LegBend::knee, batch, count, 1, rings.thigh_m, rings.shank_m, at);
    place_bent(rings.ankle, LegBend::ankle, batch, count, 2, rings.shank_m, rings.shank_m, at);
    find_cells(at, rings.out, count, raised);
    // Adjacent vertices are in the same cells. Vertices of four parts alternate, so that none waits for another.
    const std::size_t part = count / 4;
    for (std::size_t n = 0; n < part; ++n) {
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t v = n + k * part;
        float* const cell = &cells[4 * static_cast<std::size_t>(raised.cell[v])];
        hn::Store(hn::Max(hn::Load(four, cell), hn::Load(four, raised.min_m + 4 * v)), four, cell);
      }
    }
  }
  take_cells(cells.data(), reach);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
