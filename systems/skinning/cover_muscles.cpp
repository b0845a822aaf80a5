#include "systems/skinning/cover_muscles.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/skinning/cover_muscles.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>

#include "engine/fused-inl.h"
#include "systems/skinning/eight-inl.h"
#include "systems/skinning/leg_rings.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {
namespace {

constexpr EightTag tag;
using V = hn::Vec<EightTag>;
using IntTag = hn::RebindToSigned<EightTag>;

HWY_INLINE V set(float x) {
  return hn::Set(tag, x);
}

/// The angle of (x, z) from the z axis towards the x axis in turns, 0 to 1, to 10⁻⁴ of one.
HWY_INLINE V turn_of(const V& x, const V& z) {
  constexpr float turn = 1 / (2 * std::numbers::pi_v<float>);
  const V ax = hn::Abs(x), az = hn::Abs(z);
  const V r = hn::Div(hn::Min(ax, az), hn::Max(hn::Max(ax, az), set(1e-20F))), s = hn::Mul(r, r);
  V angle = mul_add(s, set(-0.0464964749F * turn), set(0.15931422F * turn));
  angle = mul_add(s, mul_add(s, angle, set(-0.327622764F * turn)), set(turn));
  angle = hn::Mul(r, angle);
  angle = hn::IfThenElse(hn::Gt(ax, az), hn::Sub(set(0.25F), angle), angle);
  angle = hn::IfThenElse(hn::Lt(z, hn::Zero(tag)), hn::Sub(set(0.5F), angle), angle);
  return hn::IfThenElse(hn::Lt(x, hn::Zero(tag)), hn::Sub(set(1), angle), angle);
}

struct CoverPoint {
  V x, y, z;
};
/// Where a vertex is on the leg: to the side and to the front of its line (m), and how far down it.
struct OnLeg {
  V side, front, s;
};

/// A vector's part along an axis of a ring.
HWY_INLINE V along_axis(const JointRings& bend, std::size_t axis, std::size_t ring, const CoverPoint& p) {
  const auto of = [&](std::size_t c) HWY_ATTR { return set(bend.axis[axis][c][ring]); };
  return mul_add(p.z, of(2), mul_add(p.y, of(1), hn::Mul(p.x, of(0))));
}

/// From a joint's centre.
HWY_INLINE CoverPoint from_centre(const JointRings& bend, const CoverPoint& p) {
  const Vec3<float>& c = bend.centre_m;
  return {hn::Sub(p.x, set(c.x)), hn::Sub(p.y, set(c.y)), hn::Sub(p.z, set(c.z))};
}

/// Where points from a joint's centre are in the ring that they lie in: the first where their height is not above the
/// ring's own.
HWY_INLINE CoverPoint in_bend(const JointRings& bend, const hn::Mask<EightTag>& there, const CoverPoint& p) {
  constexpr IntTag whole;
  hn::Vec<IntTag> ring = hn::Set(whole, 1);
  auto above = there;  // all rings so far
  for (std::size_t k = 1; k < bend_rings; ++k) {
    above = hn::And(above, hn::Gt(along_axis(bend, 1, k, p), set(bend.height_m(k))));
    if (hn::AllFalse(tag, above)) break;
    ring = hn::IfThenElse(hn::RebindMask(whole, above), hn::Set(whole, static_cast<std::int32_t>(k) + 1), ring);
  }
  const auto along = [&](std::size_t axis) HWY_ATTR {
    const auto of = [&](std::size_t c) HWY_ATTR { return hn::GatherIndex(tag, bend.axis[axis][c].data(), ring); };
    return mul_add(p.z, of(2), mul_add(p.y, of(1), hn::Mul(p.x, of(0))));
  };
  return {along(0), hn::Max(set(bend.low_m), hn::Min(set(bend.high_m), along(1))), along(2)};
}

HWY_INLINE OnLeg choose(const hn::Mask<EightTag>& which, const OnLeg& yes, const OnLeg& no) {
  return {hn::IfThenElse(which, yes.side, no.side), hn::IfThenElse(which, yes.front, no.front),
          hn::IfThenElse(which, yes.s, no.s)};
}

/// Vertices in the rings that they lie in: of thigh or shank, or of a joint between.
HWY_INLINE OnLeg on_leg(const LegRings& rings, const CoverPoint& p) {
  constexpr std::size_t above = bend_rings, below = 0;
  const JointRings& knee = rings.knee;
  const CoverPoint from = from_centre(knee, p);
  const auto down = [&](float joint_s, const V& y, float length_m)
                        HWY_ATTR { return neg_mul_add(y, set(1 / length_m), set(joint_s)); };
  const auto straight = [&](std::size_t ring, const V& s) HWY_ATTR {
    return OnLeg{along_axis(knee, 0, ring, from), along_axis(knee, 2, ring, from), s};
  };
  const V high = along_axis(knee, 1, above, from), low = along_axis(knee, 1, below, from);
  const OnLeg thigh = straight(above, down(1, high, rings.thigh_m)),
              shank = straight(below, down(1, low, rings.shank_m));
  // Where a knee is bent beyond a right angle, the one whose line is nearer.
  const auto square = [](const OnLeg& at) HWY_ATTR { return mul_add(at.front, at.front, hn::Mul(at.side, at.side)); };
  const auto may_be_shank = hn::Le(low, set(knee.low_m));
  const auto is_thigh =
      hn::AndNot(hn::And(may_be_shank, hn::Lt(square(shank), square(thigh))), hn::Ge(high, set(knee.high_m)));
  const auto is_shank = hn::AndNot(is_thigh, may_be_shank);
  OnLeg at = choose(is_thigh, thigh, shank);
  if (const auto is_knee = hn::Not(hn::Or(is_thigh, is_shank)); HWY_UNLIKELY(!hn::AllFalse(tag, is_knee))) {
    const CoverPoint bent = in_bend(knee, is_knee, from);
    const V s =
        hn::IfThenElse(hn::Gt(bent.y, hn::Zero(tag)), down(1, bent.y, rings.thigh_m), down(1, bent.y, rings.shank_m));
    at = choose(is_knee, {bent.x, bent.z, s}, at);
  }
  if (const auto is_hip = hn::And(is_thigh, hn::Gt(high, set(rings.thigh_m + rings.hip.low_m)));
      HWY_UNLIKELY(!hn::AllFalse(tag, is_hip))) {
    const CoverPoint bent = in_bend(rings.hip, is_hip, from_centre(rings.hip, p));
    at = choose(is_hip, {bent.x, bent.z, down(0, bent.y, rings.thigh_m)}, at);
  }
  // Behind the ankle skin bends below the grid.
  if (const auto is_ankle = hn::And(hn::And(is_shank, hn::Lt(low, set(rings.ankle.high_m - rings.shank_m))),
                                    hn::Gt(at.front, hn::Zero(tag)));
      HWY_UNLIKELY(!hn::AllFalse(tag, is_ankle))) {
    const CoverPoint bent = in_bend(rings.ankle, is_ankle, from_centre(rings.ankle, p));
    at = choose(is_ankle, {bent.x, bent.z, down(2, bent.y, rings.shank_m)}, at);
  }
  return at;
}

// A grid with room on either side of each station for the neighbours of its first and last angle.
constexpr std::size_t margin = 8, wide_angles = leg_angles + 2 * margin;
struct WideGrid {
  alignas(64) float value[leg_stations * wide_angles];

  float* station(std::size_t i) { return value + i * wide_angles + margin; }
  const float* station(std::size_t i) const { return value + i * wide_angles + margin; }
  /// Closes the rings.
  void close() {
    for (std::size_t i = 0; i < leg_stations; ++i) {
      float* const row = station(i);
      row[-1] = row[leg_angles - 1];
      row[leg_angles] = row[0];
    }
  }
};

/// `op(i, j)` of each station and the first of some angles.
template <class Op>
HWY_INLINE void each_angle(const Op& op) {
  for (std::size_t i = 0; i < leg_stations; ++i)
    for (std::size_t j = 0; j < leg_angles; j += eight_lanes) op(i, j);
}

/// Each point a little nearer to the mean of its four neighbours.
void smooth(WideGrid& grid, WideGrid& next, int rounds) {
  WideGrid *from = &grid, *to = &next;
  for (int round = 0; round < rounds; ++round) {
    from->close();
    each_angle([&](std::size_t i, std::size_t j) HWY_ATTR {
      const float* const here = from->station(i) + j;
      const V above = hn::Load(tag, from->station(i == 0 ? 0 : i - 1) + j),
              below = hn::Load(tag, from->station(std::min(i + 1, leg_stations - 1)) + j);
      const V beside = hn::Add(hn::LoadU(tag, here + 1), hn::LoadU(tag, here - 1));
      hn::Store(mul_add(set(0.125F), hn::Add(hn::Add(above, below), beside), hn::Mul(set(0.5F), hn::Load(tag, here))),
                tag, to->station(i) + j);
    });
    std::swap(from, to);
  }
  if (from != &grid) grid = *from;
}

/// The larger of each point and its eight neighbours.
void spread(WideGrid& grid, WideGrid& work) {
  grid.close();
  each_angle([&](std::size_t i, std::size_t j) HWY_ATTR {
    const float* const here = grid.station(i) + j;
    hn::Store(hn::Max(hn::Load(tag, here), hn::Max(hn::LoadU(tag, here + 1), hn::LoadU(tag, here - 1))), tag,
              work.station(i) + j);
  });
  each_angle([&](std::size_t i, std::size_t j) HWY_ATTR {
    const V above = hn::Load(tag, work.station(i == 0 ? 0 : i - 1) + j),
            below = hn::Load(tag, work.station(std::min(i + 1, leg_stations - 1)) + j);
    hn::Store(hn::Max(hn::Load(tag, work.station(i) + j), hn::Max(above, below)), tag, grid.station(i) + j);
  });
}

/// How far muscles reach at the points of the grid, m. Each row repeats its first two angles at its end, and a row more
/// takes what lies beyond the last station. Vertices side by side raise the same numbers: they take turns with several
/// such tables, so that none waits for the one before.
constexpr std::size_t reach_angles = leg_angles + 2, reach_tables = 4;
struct Reach {
  std::array<float, (leg_stations + 1) * reach_angles> most[reach_tables];
};

/// Two numbers to no less than two others.
HWY_INLINE void raise(float* to, const float* least) {
  const hn::CappedTag<float, 2> two;
  hn::StoreU(hn::Max(hn::LoadU(two, to), hn::LoadU(two, least)), two, to);
}

/// How far muscles reach at each point; those beside it count for less, so that nothing jumps as they pass.
void find_reach(const LegRings& rings, std::span<const Vec3<float>> muscles, Reach& reach) {
  constexpr float beside_m = 0.004F;
  constexpr IntTag whole;
  for (auto& most : reach.most) most.fill(0);
  for (std::size_t first = 0; first < muscles.size(); first += eight_lanes) {
    V x, y, z;
    if (first + eight_lanes <= muscles.size()) {
      hn::LoadInterleaved3(tag, &muscles[first].x, x, y, z);
    } else {
      Vec3<float> last[eight_lanes];
      for (std::size_t i = 0; i < eight_lanes; ++i) last[i] = muscles[std::min(first + i, muscles.size() - 1)];
      hn::LoadInterleaved3(tag, &last->x, x, y, z);
    }
    const OnLeg at = on_leg(rings, {x, y, z});
    const V out = hn::Mul(set(rings.out), at.side), radius = hn::Sqrt(mul_add(at.front, at.front, hn::Mul(out, out)));
    constexpr auto first_s = static_cast<float>(first_leg_s), last_s = static_cast<float>(last_leg_s);
    constexpr float stations = (leg_stations - 1) / (last_s - first_s), most_m = 1;
    const V along = hn::Mul(hn::Sub(at.s, set(first_s)), set(stations));
    // What is not on the grid, not near the leg, or no number reaches nowhere.
    const auto there = hn::And(hn::And(hn::Ge(along, hn::Zero(tag)), hn::Le(along, set(leg_stations - 1))),
                               hn::Le(radius, set(most_m)));
    if (hn::AllFalse(tag, there)) continue;
    const V row = hn::IfThenElseZero(there, along), reaches = hn::IfThenElseZero(there, radius);
    const V round = hn::IfThenElseZero(there, hn::Mul(turn_of(out, at.front), set(leg_angles)));
    const auto i = hn::ConvertTo(whole, row), j = hn::ConvertTo(whole, round);
    const V u = hn::Sub(row, hn::ConvertTo(tag, i)), v = hn::Sub(round, hn::ConvertTo(tag, j));
    const V u1 = hn::Sub(u, set(1)), v1 = hn::Sub(v, set(1));
    const auto counted = [&](const V& a, const V& b)
                             HWY_ATTR { return neg_mul_add(set(beside_m), mul_add(a, a, hn::Mul(b, b)), reaches); };
    alignas(64) float value[4 * eight_lanes];  // of each vertex: this station and the next, two angles of either
    alignas(64) std::int32_t to[eight_lanes];
    const Rows rows = transposed({{counted(u, v), counted(u, v1), counted(u1, v), counted(u1, v1)}});
    for (std::size_t k = 0; k < 4; ++k) store_vertices(tag, rows.row[k], value + 4 * k, 4);
    hn::Store(hn::Add(hn::Mul(i, hn::Set(whole, static_cast<std::int32_t>(reach_angles))), j), whole, to);
    for (std::size_t lane = 0; lane < eight_lanes; ++lane) {
      float* const here = &reach.most[lane % reach_tables][static_cast<std::size_t>(to[lane])];
      raise(here, value + 4 * lane);
      raise(here + reach_angles, value + 4 * lane + 2);
    }
  }
  auto& all = reach.most[0];
  for (std::size_t i = 0; i < leg_stations; ++i) {
    float* const row = &all[i * reach_angles];
    for (std::size_t k = 1; k < reach_tables; ++k) {
      const float* const other = &reach.most[k][i * reach_angles];
      for (std::size_t j = 0; j < leg_angles; j += eight_lanes)
        hn::StoreU(hn::Max(hn::LoadU(tag, row + j), hn::LoadU(tag, other + j)), tag, row + j);
      raise(row + leg_angles, other + leg_angles);
    }
    raise(row, row + leg_angles);
  }
}

/// The larger, rounded over where they differ by less than w (C¹).
HWY_INLINE V rounded_max(const V& a, const V& b, float w) {
  const V d = hn::Sub(a, b), over = hn::Max(hn::Zero(tag), hn::Add(d, set(w)));
  const V between = mul_add(hn::Mul(over, over), set(1 / (4 * w)), b);
  return hn::IfThenElse(hn::Ge(d, set(w)), a, between);
}

void cover(const LegGrid& grid, const LegRings& rings, float lengths, std::span<const Vec3<float>> muscles,
           float* lift_m) {
  constexpr float round_m = 0.004F, thin_m = 0.004F, least_m = 0.0005F;
  // More in the hollow of a bend, where points of the grid lie close together and heights change much between them.
  constexpr float least_m_by_bend = 0.0008F;
  Reach reach;
  find_reach(rings, muscles, reach);
  // Over the skin without muscles.
  WideGrid excess, floor, lacking, work;
  const V scale = set(lengths);
  each_angle([&](std::size_t i, std::size_t j) HWY_ATTR {
    const std::size_t n = i * leg_angles + j;
    const V base = hn::Mul(scale, hn::LoadU(tag, &grid.base[n])), fat = hn::Mul(scale, hn::LoadU(tag, &grid.fat[n])),
            most = hn::LoadU(tag, &reach.most[0][i * reach_angles + j]);
    const auto reached = hn::Gt(most, hn::Zero(tag));
    const V over = hn::Sub(rounded_max(base, hn::Add(most, fat), round_m), base);
    const V hollow = hn::Max(hn::Zero(tag), hn::Mul(set(rings.curved[i]), hn::LoadU(tag, &rings.inner[j])));
    const V over_muscle = mul_add(hollow, set(least_m_by_bend), set(least_m));
    const V least = hn::Sub(hn::Add(mul_add(set(0.5F), hn::Min(fat, set(thin_m)), over_muscle), most), base);
    hn::Store(hn::IfThenElseZero(reached, over), tag, excess.station(i) + j);
    hn::Store(hn::IfThenElse(reached, least, hn::Neg(base)), tag, floor.station(i) + j);
  });
  smooth(excess, work, 4);
  for (int round = 0; round < 3; ++round) {
    each_angle([&](std::size_t i, std::size_t j) HWY_ATTR {
      const V less = hn::Sub(hn::Load(tag, floor.station(i) + j), hn::Load(tag, excess.station(i) + j));
      hn::Store(hn::Max(hn::Zero(tag), less), tag, lacking.station(i) + j);
    });
    spread(lacking, work);
    smooth(lacking, work, 3);
    each_angle([&](std::size_t i, std::size_t j) HWY_ATTR {
      float* const here = excess.station(i) + j;
      hn::Store(hn::Add(hn::Load(tag, here), hn::Load(tag, lacking.station(i) + j)), tag, here);
    });
  }
  const V smaller = set(1 / lengths);
  each_angle([&](std::size_t i, std::size_t j) HWY_ATTR {
    const std::size_t n = i * leg_angles + j;
    const V base = hn::LoadU(tag, &grid.base[n]);
    V h = mul_add(scale, base, hn::Max(hn::Load(tag, excess.station(i) + j), hn::Load(tag, floor.station(i) + j)));
    if (std::abs(rings.curved[i]) > 0.1F) {
      // How far from the line a bent joint has room for skin.
      const V inner = hn::LoadU(tag, &rings.inner[j]);
      const V hollow = hn::Mul(set(rings.curved[i]), inner), room = hn::Div(set(0.92F), hollow);
      const V most = hn::Mul(set(0.8F), room), last = hn::Mul(set(0.2F), room);
      const V beyond = hn::Div(hn::Sub(h, most), last);
      const V squeezed = mul_add(last, hn::Div(beyond, hn::Add(set(1), beyond)), most);
      h = hn::IfThenElse(hn::And(hn::Gt(hollow, set(0.05F)), hn::Gt(h, most)), squeezed, h);
    }
    // As of the skin at rest, which `lengths` makes larger.
    hn::StoreU(hn::Sub(hn::Mul(h, smaller), base), tag, &lift_m[n]);
  });
}

}  // namespace
}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil {
namespace {
HWY_EXPORT(cover);
}

void cover_muscles(const BodySkin& skin, const Pose<float>& pose, float lengths, Side side,
                   std::span<const Vec3<float>> muscles, std::array<float, leg_grid_points>& lift_m) {
  HWY_DYNAMIC_DISPATCH(cover)(skin.leg, leg_rings(skin, pose, lengths, side), lengths, muscles, lift_m.data());
}

}  // namespace mobil
#endif
