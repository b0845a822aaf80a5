#include "systems/gait/gait.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string_view>

#include <mobil/anthropometry.h>
#include <mobil/usual_gait.h>
#include "assets/gait/step_lookup.h"

namespace mobil::inline v0_3 {
namespace {

constexpr double lowest_speed = 0.3;  // m/s for a leg of 0.90 m, scales with the leg's square root

bool inside(double value, double low, double high) {
  return value >= low && value <= high;
}

/// Returns the measured step length at a speed of people with that leg, hip to ground (assets/gait/README.md).
double usual_length_at(double speed_m_s, double leg_m) {
  return usual_step_length(static_cast<float>(speed_m_s / std::sqrt(9.81 * leg_m))) * leg_m;
}

/// Returns the speed at which the increasing function `of` reaches `wanted`.
template <class Of>
double speed_of(double wanted, Of of) {
  double low = 0, high = 10;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (of(middle) < wanted ? low : high) = middle;
  }
  return high;
}

/// A walker's legs, and the factor on the table's usual step length.
struct LegSizes {
  float height_m, scale_m, leg_m, hips_m;
  double step_factor = usual_step_factor(usual_age_y);
};

Result<Gait<float>> resolve(const LegSizes& of, const GaitRequest& request) {
  for (const GaitParameter& p : gait_parameters) {
    const float value = request.style.*p.value;
    if (!inside(value, p.low, p.high))
      return fail(fmt::format("gait: {} = {} is outside {}–{}; choose a value within that range", p.name, value, p.low,
                              p.high));
  }
  const double height = of.height_m, leg = of.leg_m;
  const double scale = std::sqrt(leg / 0.90);
  const double hips = of.hips_m;
  const auto usual_length = [&](double speed_m_s) { return of.step_factor * usual_length_at(speed_m_s, hips); };
  const auto& [speed_asked, length_asked, frequency_asked, style] = request;

  if (speed_asked && *speed_asked == 0.0F && !length_asked && !frequency_asked)
    return complete_gait(of.scale_m, 0, 0, style);
  auto positive = [](const std::optional<float>& value) { return !value || (*value > 0.0F && *value < 1e6F); };
  if (!positive(speed_asked) || !positive(length_asked) || !positive(frequency_asked))
    return fail(
        "gait: speed, step length and step frequency must be positive numbers, or the speed alone 0 to stand; leave "
        "out what is to follow");
  double speed, length;
  if (speed_asked && length_asked) {
    speed = *speed_asked;
    length = *length_asked;
    if (frequency_asked && !(std::fabs(length * *frequency_asked / speed - 1.0) < 0.01))
      return fail(
          fmt::format("gait: speed {:.4g} m/s is not step length {:.4g} m times step frequency {:.4g} Hz = {:.3g} m/s; "
                      "leave one of the three out",
                      speed, length, *frequency_asked, length * *frequency_asked));
  } else if (frequency_asked && (speed_asked || length_asked)) {
    speed = speed_asked ? *speed_asked : *length_asked * *frequency_asked;
    length = speed / *frequency_asked;
  } else if (length_asked || frequency_asked) {
    speed = length_asked ? speed_of(*length_asked, [&](double v) { return usual_length(v); })
                         : speed_of(*frequency_asked, [&](double v) { return v / usual_length(v); });
    length = length_asked ? static_cast<double>(*length_asked) : speed / *frequency_asked;
  } else {
    speed = speed_asked ? *speed_asked : 5.0 / 3.6;
    length = usual_length(speed);
  }

  const double frequency = speed / length;
  struct {
    std::string_view name, unit;
    bool asked;
    double value, low, high;
  } const ranges[] = {
      {"speed", "m/s", speed_asked.has_value(), speed, lowest_speed * scale, 2.3 * scale},
      {"step length", "m", length_asked.has_value(), length, 0.25 * leg, 1.25 * leg},
      {"step frequency", "Hz", frequency_asked.has_value(), frequency, 0.5 / scale, 3.0 / scale},
  };
  for (const bool asked : {true, false}) {  // requested values before derived ones
    for (const auto& r : ranges) {
      if (r.asked != asked || inside(r.value, r.low, r.high)) continue;
      return fail(fmt::format("gait: {} {} of {:.3g} {} is outside {:.2f}–{:.2f} {} for a height of {:.2f} m; {}",
                              asked ? "a" : "what was asked makes a", r.name, r.value, r.unit, r.low, r.high, r.unit,
                              height, asked ? "choose one within that range" : "ask for more usual steps"));
    }
  }
  return complete_gait(of.scale_m, static_cast<float>(speed), static_cast<float>(length), style);
}

}  // namespace

Result<Gait<float>> resolve_gait(const Body& body, const GaitRequest& request, Footwear footwear) {
  return resolve({body.request.height_m, body.size.leg_scale_m, body.thigh_length_m + body.shank_length_m,
                  body.hip_height_m, usual_step_factor(body.request.age_y, footwear)},
                 request);
}

Result<Gait<float>> resolve_gait(const BodySize<float>& size, const GaitRequest& request, float age_y) {
  const double scale = size.leg_scale_m;
  const auto scaled = [&](double part) { return static_cast<float>(part * scale); };
  return resolve({size.height_m, size.leg_scale_m, scaled(fraction::thigh) + scaled(fraction::shank),
                  scaled(fraction::hip_height), usual_step_factor(age_y)},
                 request);
}

Result<Gait<float>> resolve_gait(float height_m, const GaitRequest& request) {
  BodySize<float> size{};
  size.height_m = size.leg_scale_m = height_m;
  return resolve_gait(size, request);
}

float usual_length_m(float leg_scale_m, float speed_m_s) {
  if (speed_m_s == 0) return 0;
  const auto hips_m = static_cast<float>(fraction::hip_height * static_cast<double>(leg_scale_m));
  return static_cast<float>(usual_length_at(static_cast<double>(speed_m_s), static_cast<double>(hips_m)));
}

float lowest_speed_m_s(float leg_scale_m) {
  constexpr auto leg = static_cast<float>(fraction::thigh + fraction::shank);
  return static_cast<float>(lowest_speed) * std::sqrt(leg / 0.9F * leg_scale_m);
}

Gait<float> complete_gait(float leg_scale_m, float speed_m_s, float step_length_m, const GaitStyle& style) {
  Gait<float> gait{};
  gait.style = style;
  if (speed_m_s == 0) return gait;
  const double frequency = static_cast<double>(speed_m_s) / static_cast<double>(step_length_m);
  gait.speed_m_s = speed_m_s;
  gait.step_length_m = step_length_m;
  gait.step_frequency_hz = static_cast<float>(frequency);
  namespace d = double_support_law;
  const double cadence = 60.0 * frequency * std::sqrt(static_cast<double>(leg_scale_m) / 1.8);
  const double percent = (d::at_rest - d::per_cadence * cadence) * static_cast<double>(style.double_support_scale);
  gait.double_support_cycle = static_cast<float>(std::fmin(std::fmax(percent, d::least), d::most) / 100.0);
  return gait;
}

}  // namespace mobil::inline v0_3
