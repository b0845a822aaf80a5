#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "engine/wide-inl.h"
#include "systems/avoidance/preference.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

constexpr float of_facing = 0.3F;
/// Cost scale of a meeting; look-ahead, s; offset of the time to a meeting, which bounds its cost, s.
constexpr float of_meeting = 1.5F, looks_ahead_s = 6.0F, soonest_s = 0.3F;

void cost_block(const Onward<Lanes<float>>& ways, float speed, float heading_sine, float heading_cosine,
                Lanes<float>& cost) {
  Wide s, c;
  sin_cos(load(ways.heading_rad), s, c);
  const Wide reached = load(ways.speed_m_s);
  const Wide off_x = fma(reached, s, wide(-speed * heading_sine)),
             off_z = fma(reached, c, wide(-speed * heading_cosine));
  store(fma(off_x, off_x, off_z * off_z) + of_facing * (1.0F - (s * heading_sine + c * heading_cosine)), cost);
}

void velocity_block(const Lanes<float>& speed, const Lanes<float>& heading, float x, float z, Lanes<float>& cost) {
  Wide s, c;
  sin_cos(load(heading), s, c);
  const Wide off_x = fma(load(speed), s, wide(-x)), off_z = fma(load(speed), c, wide(-z));
  store(fma(off_x, off_x, off_z * off_z), cost);
}

void foresight_block(const Onward<Lanes<float>>& ways, const Passer& p, Lanes<float>& cost) {
  Wide s, c;
  sin_cos(load(ways.heading_rad), s, c);
  const Wide speed = load(ways.speed_m_s), time = load(ways.duration_s);
  const Wide vx = fma(speed, s, wide(-p.x_m_s)), vz = fma(speed, c, wide(-p.z_m_s));
  const Wide rx = fma(time, wide(p.x_m_s), wide(p.x_m)) - load(ways.x_m);
  const Wide rz = fma(time, wide(p.z_m_s), wide(p.z_m)) - load(ways.z_m);
  const Wide nears = fma(rx, vx, rz * vz), squared = fma(vx, vx, vz * vz) + 1e-4F;
  const Wide apart = fma(rx, rx, rz * rz) - p.apart_m * p.apart_m, under = nears * nears - squared * apart;
  const Wide until = select(apart < 0.0F, wide(0.0F), (nears - sqrt(max(under, 0.0F))) / squared);
  const Wide soon = max(until, 0.0F) + soonest_s;
  const Wide meets = of_meeting * max(1.0F - soon * (1.0F / looks_ahead_s), 0.0F) / (soon * soon);
  store(load(cost) + select((nears > 0.0F) & ((apart < 0.0F) | (under > 0.0F)), meets, wide(0.0F)), cost);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {

HWY_EXPORT(cost_block);
HWY_EXPORT(velocity_block);
HWY_EXPORT(foresight_block);

void cost_of_ways(const Onward<Lanes<float>>& ways, float speed_m_s, GroundPoint toward, Lanes<float>& cost) {
  HWY_DYNAMIC_DISPATCH(cost_block)(ways, speed_m_s, toward.x_m, toward.z_m, cost);
}

void off_velocity(const Lanes<float>& speed_m_s, const Lanes<float>& heading_rad, float x_m_s, float z_m_s,
                  Lanes<float>& cost) {
  HWY_DYNAMIC_DISPATCH(velocity_block)(speed_m_s, heading_rad, x_m_s, z_m_s, cost);
}

void add_foresight(const Onward<Lanes<float>>& ways, const Passer& passer, Lanes<float>& cost) {
  HWY_DYNAMIC_DISPATCH(foresight_block)(ways, passer, cost);
}

}  // namespace mobil::inline v0_3
#endif
