#include "systems/gait/gait.h"

#include <fmt/format.h>

#include <cmath>

namespace mobil {
namespace {

bool inside(double value, double low, double high) {
  return value >= low && value <= high;
}

}  // namespace

Result<Gait> resolve_gait(const Body& body, const GaitRequest& request) {
  for (const GaitParameter& p : gait_parameters) {
    const float value = request.style.*p.value;
    if (!inside(value, p.low, p.high))
      return fail(fmt::format("gait: {} = {} is outside {}–{}; choose a value within that range", p.name, value, p.low,
                              p.high));
  }
  const double height = body.request.height_m;
  const double leg = body.thigh_length_m + body.shank_length_m;
  const double scale = std::sqrt(leg / 0.90);
  const double law = 0.004 * 60.0 * height;  // step length over step frequency in Hz
  const auto& [speed_asked, length_asked, frequency_asked, style] = request;

  auto positive = [](const std::optional<float>& value) { return !value || (*value > 0.0F && *value < 1e6F); };
  if (!positive(speed_asked) || !positive(length_asked) || !positive(frequency_asked))
    return fail("gait: speed, step length and step frequency must be positive numbers; leave out what is to follow");
  double speed, length;
  if (speed_asked && length_asked) {
    speed = *speed_asked;
    length = *length_asked;
    if (frequency_asked && !(std::fabs(length * *frequency_asked / speed - 1.0) < 0.01))
      return fail(
          fmt::format("gait: speed {} m/s is not step length {} m times step frequency {} Hz = {:.3g} m/s; "
                      "leave one of the three out",
                      speed, length, *frequency_asked, length * *frequency_asked));
  } else if (frequency_asked && (speed_asked || length_asked)) {
    speed = speed_asked ? *speed_asked : *length_asked * *frequency_asked;
    length = speed / *frequency_asked;
  } else if (length_asked || frequency_asked) {
    length = length_asked ? *length_asked : law * *frequency_asked;
    speed = length * length / law;
  } else {
    speed = speed_asked ? *speed_asked : 5.0 / 3.6;
    length = std::sqrt(law * speed);
  }

  if (!inside(speed, 0.3 * scale, 2.3 * scale))
    return fail(
        fmt::format("gait: a speed of {:.3g} m/s is outside {:.2f}–{:.2f} m/s for a height of {:.2f} m; choose "
                    "a speed within that range",
                    speed, 0.3 * scale, 2.3 * scale, height));
  if (!inside(length, 0.25 * leg, 1.25 * leg))
    return fail(
        fmt::format("gait: a step length of {:.3g} m is outside {:.2f}–{:.2f} m for a height of {:.2f} m; "
                    "choose a step length within that range, or another step frequency",
                    length, 0.25 * leg, 1.25 * leg, height));
  const double frequency = speed / length;
  if (!inside(frequency, 0.5 / scale, 3.0 / scale))
    return fail(
        fmt::format("gait: a step frequency of {:.3g} Hz is outside {:.2f}–{:.2f} Hz for a height of {:.2f} m; "
                    "choose speed and step length nearer to each other",
                    frequency, 0.5 / scale, 3.0 / scale, height));
  Gait gait;
  gait.speed_m_s = static_cast<float>(speed);
  gait.step_length_m = static_cast<float>(length);
  gait.step_frequency_hz = static_cast<float>(frequency);
  // Bruderlin & Calvert's fall of double support with cadence, set to a tenth of the cycle at 5 km/h.
  const double percent = (27.2 - 0.16 * 60.0 * frequency * std::sqrt(height / 1.8)) * style.double_support_scale;
  gait.double_support_cycle = static_cast<float>(std::fmin(std::fmax(percent, 6.0), 18.0) / 100.0);
  gait.style = style;
  return gait;
}

}  // namespace mobil
