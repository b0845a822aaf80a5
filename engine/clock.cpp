#include <mobil/engine/clock.h>

#include <cmath>

namespace mobil::inline v0_3 {
namespace {

std::int64_t to_units(double seconds) {
  return std::llround(std::ldexp(seconds, 50));
}

}  // namespace

Result<Clock> Clock::make(double tick_s, double max_frame_s) {
  if (!(tick_s >= 1e-5 && tick_s <= 1)) {
    return fail("clock: a tick of " + decimal(tick_s) + " s is out of range; choose 0.00001 to 1 s");
  }
  if (!(max_frame_s >= tick_s && max_frame_s <= 60)) {
    return fail("clock: a longest frame of " + decimal(max_frame_s) +
                " s is out of range; choose from one tick to 60 s");
  }
  Clock clock;
  clock.tick_ = to_units(tick_s);
  clock.max_frame_ = to_units(max_frame_s);
  return clock;
}

// Not inline: hosts with -ffast-math would not find times that are not finite.
Ticks Clock::advance(double seconds) {
  Ticks ticks;
  if (!(seconds >= 0) || !std::isfinite(seconds)) {
    ticks.valid = false;
    ticks.dropped_s = seconds;
  } else if (seconds > to_seconds(max_frame_)) {
    ticks.dropped_s = seconds - to_seconds(max_frame_);
    remainder_ += max_frame_;
  } else {
    remainder_ += to_units(seconds);
  }
  ticks.count = static_cast<std::uint32_t>(remainder_ / tick_);
  remainder_ %= tick_;
  ticks.alpha = static_cast<double>(remainder_) / static_cast<double>(tick_);
  return ticks;
}

}  // namespace mobil::inline v0_3
