#include <mobil/systems/surfaces/cover_muscles.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "engine/fused-inl.h"
#include "systems/surfaces/leg_rings.h"
#include "systems/surfaces/muscle_reach-inl.h"
#include "systems/surfaces/ring_grid-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

constexpr CoverTag tag;

/// Returns a station moved a little towards the mean of its four neighbours.
HWY_INLINE Ring smoothed(const Ring& above, const Ring& here, const Ring& below) {
  const Ring left = before(here), right = after(here);
  return each_part([&](std::size_t p) HWY_ATTR {
    const CoverV sum = hn::Add(hn::Add(above.part[p], below.part[p]), hn::Add(left.part[p], right.part[p]));
    return mul_add(splat(0.125F), sum, hn::Mul(splat(0.5F), here.part[p]));
  });
}
HWY_NOINLINE void smooth(RingGrid& grid) {
  each_station(grid, [&](std::size_t i, const Ring& above, const Ring& here, const Ring& below)
                         HWY_ATTR { grid.set(i, smoothed(above, here, below)); });
}

/// Finds the largest lack of each point and its eight neighbours, at least 0.
HWY_NOINLINE void find_lack(const RingGrid& floor, const RingGrid& excess, RingGrid& lacking) {
  for (std::size_t i = 0; i < leg_stations; ++i) {
    const Ring least = floor.at(i), now = excess.at(i);
    const Ring lack =
        each_part([&](std::size_t p) HWY_ATTR { return hn::Max(hn::Zero(tag), hn::Sub(least.part[p], now.part[p])); });
    const Ring left = before(lack), right = after(lack);
    lacking.set(i, each_part([&](std::size_t p)
                                 HWY_ATTR { return hn::Max(lack.part[p], hn::Max(left.part[p], right.part[p])); }));
  }
  each_station(lacking, [&](std::size_t i, const Ring& above, const Ring& here, const Ring& below) HWY_ATTR {
    lacking.set(i, each_part([&](std::size_t p)
                                 HWY_ATTR { return hn::Max(here.part[p], hn::Max(above.part[p], below.part[p])); }));
  });
}

/// Returns the larger value, rounded where the two differ by less than w (C¹).
HWY_INLINE CoverV rounded_max(const CoverV& a, const CoverV& b, float w) {
  const CoverV d = hn::Sub(a, b), over = hn::Max(hn::Zero(tag), hn::Add(d, splat(w)));
  const CoverV between = mul_add(hn::Mul(over, over), splat(1 / (4 * w)), b);
  return hn::IfThenElse(hn::Ge(d, splat(w)), a, between);
}

void cover(const LegGrid& grid, const LegRings& rings, float lengths, std::span<const Vec3<float>> muscles,
           float* lift_m) {
  constexpr float round_m = 0.004F, thin_m = 0.004F, min_m = 0.0005F;
  // Larger in the hollow of a bend, where points of the grid are close together and heights change much between them.
  constexpr float min_m_by_bend = 0.0008F;
  RingGrid reach;
  find_reach(rings, muscles, reach);
  const CoverV scale = splat(lengths);
  const Ring inner = load_ring(rings.inner.data());
  RingGrid excess, floor, lacking;  // over the skin without muscles
  for (std::size_t i = 0; i < leg_stations; ++i) {
    const Ring base = load_ring(&grid.base[i * leg_angles]), fat = load_ring(&grid.fat[i * leg_angles]),
               reached = reach.at(i);
    Ring over, least;
    for (std::size_t p = 0; p < ring_parts; ++p) {
      const CoverV skin = hn::Mul(scale, base.part[p]), layer = hn::Mul(scale, fat.part[p]), most = reached.part[p];
      const auto there = hn::Gt(most, hn::Zero(tag));
      over.part[p] = hn::IfThenElseZero(there, hn::Sub(rounded_max(skin, hn::Add(most, layer), round_m), skin));
      const CoverV hollow = hn::Max(hn::Zero(tag), hn::Mul(splat(rings.curved[i]), inner.part[p]));
      const CoverV over_muscle = mul_add(hollow, splat(min_m_by_bend), splat(min_m));
      const CoverV thin = mul_add(splat(0.5F), hn::Min(layer, splat(thin_m)), over_muscle);
      least.part[p] = hn::IfThenElse(there, hn::Sub(hn::Add(thin, most), skin), hn::Neg(skin));
    }
    excess.set(i, over);
    floor.set(i, least);
  }
  for (int round = 0; round < 4; ++round) smooth(excess);
  for (int round = 0; round < 3; ++round) {
    find_lack(floor, excess, lacking);
    smooth(lacking);
    smooth(lacking);
    each_station(lacking, [&](std::size_t i, const Ring& above, const Ring& here, const Ring& below) HWY_ATTR {
      const Ring now = excess.at(i), more = smoothed(above, here, below);
      excess.set(i, each_part([&](std::size_t p) HWY_ATTR { return hn::Add(now.part[p], more.part[p]); }));
    });
  }
  const CoverV smaller = splat(1 / lengths);
  for (std::size_t i = 0; i < leg_stations; ++i) {
    const Ring base = load_ring(&grid.base[i * leg_angles]), over = excess.at(i), least = floor.at(i);
    const CoverV curved = splat(rings.curved[i]);
    const bool bent = std::abs(rings.curved[i]) > 0.1F;
    const Ring lift = each_part([&](std::size_t p) HWY_ATTR {
      CoverV h = mul_add(scale, base.part[p], hn::Max(over.part[p], least.part[p]));
      if (bent) {
        // Distance from the line up to which a bent joint has room for skin.
        const CoverV hollow = hn::Mul(curved, inner.part[p]), room = hn::Div(splat(0.92F), hollow);
        const CoverV most = hn::Mul(splat(0.8F), room), last = hn::Mul(splat(0.2F), room);
        const CoverV beyond = hn::Div(hn::Sub(h, most), last);
        const CoverV squeezed = mul_add(last, hn::Div(beyond, hn::Add(splat(1), beyond)), most);
        h = hn::IfThenElse(hn::And(hn::Gt(hollow, splat(0.05F)), hn::Gt(h, most)), squeezed, h);
      }
      // Relative to the skin at rest, which `lengths` scales.
      return hn::Sub(hn::Mul(h, smaller), base.part[p]);
    });
    store_ring(lift, &lift_m[i * leg_angles]);
  }
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(cover);
}

void cover_muscles(const BodySkin& skin, const Pose<float>& pose, float lengths, Side side,
                   std::span<const Vec3<float>> muscles, std::array<float, leg_grid_points>& lift_m) {
  HWY_DYNAMIC_DISPATCH(cover)(skin.leg, leg_rings(skin, pose, lengths, side), lengths, muscles, lift_m.data());
}

}  // namespace mobil::inline v0_3
#endif
