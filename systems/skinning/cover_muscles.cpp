#include "systems/skinning/cover_muscles.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/skinning/cover_muscles.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

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

/// A vector's part along an axis of a ring.
HWY_INLINE V along_axis(const LegRings& rings, std::size_t axis, std::size_t ring, const V& x, const V& y, const V& z) {
  const auto of = [&](std::size_t c) HWY_ATTR { return set(rings.axis[axis][c][ring]); };
  return mul_add(z, of(2), mul_add(y, of(1), hn::Mul(x, of(0))));
}

struct InRing {
  V x, y, z;  // to the side, over the knee, to the front, m
};

/// Where vertices are in the rings that they lie in: of the thigh, of the shank, or of the bend between.
HWY_INLINE InRing in_ring(const LegRings& rings, const V& x, const V& y, const V& z) {
  constexpr std::size_t thigh = bend_rings;
  const V high = along_axis(rings, 1, thigh, x, y, z), low = along_axis(rings, 1, 0, x, y, z);
  const V bend = set(rings.bend_m);
  const auto above = hn::Ge(high, bend);
  const auto between = hn::AndNot(above, hn::Gt(low, hn::Neg(bend)));
  const auto of = [&](std::size_t axis) HWY_ATTR {
    return hn::IfThenElse(above, along_axis(rings, axis, thigh, x, y, z), along_axis(rings, axis, 0, x, y, z));
  };
  InRing in{of(0), hn::IfThenElse(above, high, low), of(2)};
  if (HWY_LIKELY(hn::AllFalse(tag, between))) return in;
  // The ring that a vertex lies in: the first where its height over the knee is not above the ring's own.
  constexpr IntTag whole;
  hn::Vec<IntTag> ring = hn::Set(whole, 1);
  auto below = between;
  for (std::size_t k = 1; k < bend_rings; ++k) {
    below = hn::And(below, hn::Gt(along_axis(rings, 1, k, x, y, z), set(rings.height_m(k))));
    if (hn::AllFalse(tag, below)) break;
    ring = hn::IfThenElse(hn::RebindMask(whole, below), hn::Set(whole, static_cast<std::int32_t>(k) + 1), ring);
  }
  const auto bent = [&](std::size_t axis) HWY_ATTR {
    const auto gathered = [&](std::size_t c)
                              HWY_ATTR { return hn::GatherIndex(tag, rings.axis[axis][c].data(), ring); };
    return mul_add(z, gathered(2), mul_add(y, gathered(1), hn::Mul(x, gathered(0))));
  };
  in.x = hn::IfThenElse(between, bent(0), in.x);
  in.y = hn::IfThenElse(between, hn::Max(hn::Neg(bend), hn::Min(bend, bent(1))), in.y);
  in.z = hn::IfThenElse(between, bent(2), in.z);
  return in;
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

/// Of a grid whose rings begin anew behind their last angle, and one station that is never read.
constexpr std::size_t reach_angles = leg_angles + 2;
using Reach = std::array<float, (leg_stations + 1) * reach_angles>;

/// Two numbers to no less than two others.
HWY_INLINE void raise(float* to, const float* least) {
  const hn::CappedTag<float, 2> two;
  hn::StoreU(hn::Max(hn::LoadU(two, to), hn::LoadU(two, least)), two, to);
}

/// How far muscles reach at each point; those beside it count for less, so that nothing jumps as they pass.
void find_reach(const LegRings& rings, std::span<const Vec3<float>> muscles, Reach& reach) {
  constexpr float beside_m = 0.004F;
  constexpr IntTag whole;
  reach.fill(0);
  for (std::size_t first = 0; first < muscles.size(); first += eight_lanes) {
    V x, y, z;
    if (first + eight_lanes <= muscles.size()) {
      hn::LoadInterleaved3(tag, &muscles[first].x, x, y, z);
    } else {
      Vec3<float> last[eight_lanes];
      for (std::size_t i = 0; i < eight_lanes; ++i) last[i] = muscles[std::min(first + i, muscles.size() - 1)];
      hn::LoadInterleaved3(tag, &last->x, x, y, z);
    }
    const InRing at = in_ring(rings, hn::Sub(x, set(rings.knee_m.x)), hn::Sub(y, set(rings.knee_m.y)),
                              hn::Sub(z, set(rings.knee_m.z)));
    const V out = hn::Mul(set(rings.out), at.x);
    const auto is_thigh = hn::Gt(at.y, hn::Zero(tag));
    const V s = neg_mul_add(at.y, hn::IfThenElse(is_thigh, set(1 / rings.thigh_m), set(1 / rings.shank_m)), set(1));
    constexpr auto first_s = static_cast<float>(LegProfile::first_s), last_s = static_cast<float>(LegProfile::last_s);
    constexpr float stations = (leg_stations - 1) / (last_s - first_s);
    const V along = hn::Mul(hn::Sub(s, set(first_s)), set(stations));
    // Nor NaN: what is not on the grid, and who knows where, reaches nowhere.
    const auto there = hn::And(hn::Ge(along, hn::Zero(tag)), hn::Le(along, set(leg_stations - 1)));
    if (hn::AllFalse(tag, there)) continue;
    const V row = hn::IfThenElseZero(there, along);
    const V round = hn::IfThenElseZero(there, hn::Mul(turn_of(out, at.z), set(leg_angles)));
    const V radius = hn::IfThenElseZero(there, hn::Sqrt(mul_add(at.z, at.z, hn::Mul(out, out))));
    const auto i = hn::ConvertTo(whole, row), j = hn::ConvertTo(whole, round);
    const V u = hn::Sub(row, hn::ConvertTo(tag, i)), v = hn::Sub(round, hn::ConvertTo(tag, j));
    const V u1 = hn::Sub(u, set(1)), v1 = hn::Sub(v, set(1));
    const auto counted = [&](const V& a, const V& b)
                             HWY_ATTR { return neg_mul_add(set(beside_m), mul_add(a, a, hn::Mul(b, b)), radius); };
    alignas(64) float value[4 * eight_lanes];  // of each vertex: this station and the next, two angles of either
    alignas(64) std::int32_t to[eight_lanes];
    const Rows rows = transposed({{counted(u, v), counted(u, v1), counted(u1, v), counted(u1, v1)}});
    for (std::size_t k = 0; k < 4; ++k) store_vertices(tag, rows.row[k], value + 4 * k, 4);
    hn::Store(hn::Add(hn::Mul(i, hn::Set(whole, static_cast<std::int32_t>(reach_angles))), j), whole, to);
    for (std::size_t lane = 0; lane < eight_lanes; ++lane) {
      float* const here = &reach[static_cast<std::size_t>(to[lane])];
      raise(here, value + 4 * lane);
      raise(here + reach_angles, value + 4 * lane + 2);
    }
  }
  for (std::size_t i = 0; i < leg_stations; ++i) {
    float* const row = &reach[i * reach_angles];
    row[0] = std::max(row[0], row[leg_angles]);
    row[1] = std::max(row[1], row[leg_angles + 1]);
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
  Reach reach;
  find_reach(rings, muscles, reach);
  // Over the skin without muscles.
  WideGrid excess, floor, lacking, work;
  const V scale = set(lengths);
  each_angle([&](std::size_t i, std::size_t j) HWY_ATTR {
    const std::size_t n = i * leg_angles + j;
    const V base = hn::Mul(scale, hn::LoadU(tag, &grid.base[n])), fat = hn::Mul(scale, hn::LoadU(tag, &grid.fat[n])),
            most = hn::LoadU(tag, &reach[i * reach_angles + j]);
    const auto reached = hn::Gt(most, hn::Zero(tag));
    const V over = hn::Sub(rounded_max(base, hn::Add(most, fat), round_m), base);
    const V least = hn::Sub(hn::Add(mul_add(set(0.5F), hn::Min(fat, set(thin_m)), set(least_m)), most), base);
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
    if (rings.curved[i] > 0.1F) {
      // How far from the line a bent knee has room for skin.
      const V inner = hn::LoadU(tag, &rings.inner[j]);
      const V room = hn::Div(set(0.92F), hn::Mul(set(rings.curved[i]), inner));
      const V most = hn::Mul(set(0.8F), room), last = hn::Mul(set(0.2F), room);
      const V beyond = hn::Div(hn::Sub(h, most), last);
      const V squeezed = mul_add(last, hn::Div(beyond, hn::Add(set(1), beyond)), most);
      h = hn::IfThenElse(hn::And(hn::Gt(inner, set(0.05F)), hn::Gt(h, most)), squeezed, h);
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
