#include "systems/gait/fat_motion.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "engine/wide_exp-inl.h"
#include "engine/wide_geometry-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

/// Change of a damped spring's position and speed over a tick.
struct Swing {
  Wide place, place_of_speed, speed_of_place, speed;
};
Swing swing_of(const Wide& thickness, float tick_s) {
  const Wide circular = 2 * std::numbers::pi_v<float> * fat_hz * sqrt(wide(fat_hz_thickness_m) / thickness);
  const Wide damped = circular * std::sqrt(1 - fat_damping * fat_damping), decay = circular * fat_damping;
  const Wide left = exp(-(decay * tick_s));
  Wide sine, cosine;
  sin_cos(min(damped * tick_s, 900.0F), sine, cosine);
  const Wide a_speed = left * sine / damped, c = left * cosine;
  return {fma(decay, a_speed, c), a_speed, -(circular * circular * a_speed), fnma(decay, a_speed, c)};
}

void fat_block(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose, FatWobble<Lanes<float>>& fat,
               float tick_s) {
  WideVec at[fat_regions];
  const Wide known = load(fat.known);
  WideMask goes_on = known > 0.5F;
  constexpr float farthest = fat_fastest_m_s * fat_fastest_m_s;
  for (std::size_t r = 0; r < fat_regions; ++r) {
    const FatPoint& of = fat_points[r];
    const WideVec from = load(pose.position_m[index(of.from)]);
    at[r] = fma(wide(of.part), load(pose.position_m[index(of.to)]) - from, from);
    const WideVec way = at[r] - load(fat.carried_m[r]);
    goes_on = goes_on & (dot(way, way) < farthest * tick_s * tick_s);
  }
  const WideMask swings = goes_on & (known > 1.5F);
  const Wide none = wide(0.0F);
  const Wide fat_kg = load(size.mass_kg) * load(size.fat_share);
  const Wide over_usual = fat_kg / (usual_fat_index * load(size.height_m) * load(size.height_m));
  Swing swing{};
  for (std::size_t r = 0; r < fat_regions; ++r) {
    if (r == 0 || fat_points[r].thickness_m != fat_points[r - 1].thickness_m)
      swing = swing_of(clamp(over_usual * fat_points[r].thickness_m, thinnest_fat_m, thickest_fat_m), tick_s);
    const auto move = [&](const Wide& now, Lanes<float>& carried, Lanes<float>& beside, Lanes<float>& speed) HWY_ATTR {
      const Wide pace = (now - load(carried)) * (1 / tick_s);
      const Wide place = load(beside), faster = load(speed) - pace;
      const Wide next = fma(swing.place, place, swing.place_of_speed * faster);
      const Wide next_speed = fma(swing.speed_of_place, place, fma(swing.speed, faster, pace));
      store(select(swings, next, none), beside);
      store(select(swings, next_speed, select(goes_on, pace, none)), speed);
      store(now, carried);
    };
    move(at[r].x, fat.carried_m[r].x, fat.beside_m[r].x, fat.speed_m_s[r].x);
    move(at[r].y, fat.carried_m[r].y, fat.beside_m[r].y, fat.speed_m_s[r].y);
    move(at[r].z, fat.carried_m[r].z, fat.beside_m[r].z, fat.speed_m_s[r].z);
  }
  store(select(goes_on, wide(2.0F), wide(1.0F)), fat.known);
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(fat_block);
}

std::array<float, fat_regions> fat_thickness_m(const BodySize<float>& size) {
  const float fat_kg = size.mass_kg * size.fat_share;
  const float over_usual = fat_kg / (usual_fat_index * size.height_m * size.height_m);
  std::array<float, fat_regions> thickness{};
  for (std::size_t r = 0; r < fat_regions; ++r)
    thickness[r] = std::clamp(over_usual * fat_points[r].thickness_m, thinnest_fat_m, thickest_fat_m);
  return thickness;
}

void fat_motion(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose, FatWobble<Lanes<float>>& fat,
                float tick_s) {
  HWY_DYNAMIC_DISPATCH(fat_block)(size, pose, fat, tick_s);
}

std::array<Vec3<float>, fat_regions> shown_fat(const BodySize<float>& size, const FatWobble<float>& fat) {
  const auto thickness = fat_thickness_m(size);
  std::array<Vec3<float>, fat_regions> shown{};
  for (std::size_t r = 0; r < fat_regions; ++r) {
    const auto& [x, y, z] = fat.beside_m[r];
    const float most = fat_reach * thickness[r];
    const float part = most / std::sqrt(most * most + x * x + y * y + z * z);
    shown[r] = {part * x, part * y, part * z};
  }
  return shown;
}

}  // namespace mobil::inline v0_3
#endif
