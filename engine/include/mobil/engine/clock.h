#pragma once
// Time in ticks of fixed length, out of frames of any length.

#include <cmath>
#include <cstdint>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// The tick under way: its length, s, and its number from 0 on.
struct Tick {
  float dt_s = 0;
  std::uint32_t index = 0;
};

/// What a frame amounts to.
struct Ticks {
  std::uint32_t count = 0;  ///< ticks to run now
  double dropped_s = 0;     ///< time that will never be run: what the frame had beyond the longest allowed
  double alpha = 0;         ///< how far into the next tick the frame ends, in [0, 1): PoseWriter writes poses there
  bool valid = true;        ///< false when the frame was negative or not finite; then all of it was dropped
};

/// A fixed-timestep clock. It counts in whole units of 2⁻⁵⁰ s, so that nothing drifts: what was fed is always exactly
/// the ticks given out, the remainder and what was dropped, each frame rounded to a unit once.
class Clock {
 public:
  /// 60 ticks a second; of a frame longer than 0.25 s the rest is dropped.
  Clock() = default;

  /// Ranges: tick 1e-5–1 s, longest frame from one tick to 60 s.
  static Result<Clock> make(double tick_s, double max_frame_s = 0.25) {
    if (!(tick_s >= 1e-5 && tick_s <= 1)) {
      return fail("clock: a tick of " + std::to_string(tick_s) + " s is out of range; choose 0.00001 to 1 s");
    }
    if (!(max_frame_s >= tick_s && max_frame_s <= 60)) {
      return fail("clock: a longest frame of " + std::to_string(max_frame_s) +
                  " s is out of range; choose from one tick to 60 s");
    }
    Clock clock;
    clock.tick_ = to_units(tick_s);
    clock.max_frame_ = to_units(max_frame_s);
    return clock;
  }

  /// Feeds the time of a frame, s: the ticks to run now, and what is left over. A negative or non-finite time is
  /// dropped.
  Ticks advance(double seconds) {
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

  /// Ticks that `advance` gave out and that did not run: the next frame has them.
  void give_back(std::uint32_t ticks) { remainder_ += ticks * tick_; }

  /// Length of a tick, s.
  double tick_s() const { return to_seconds(tick_); }
  /// The most ticks that a frame amounts to.
  std::uint32_t max_ticks() const { return static_cast<std::uint32_t>((max_frame_ + tick_ - 1) / tick_); }
  /// Time fed that has not made a whole tick yet.
  double remainder_s() const { return to_seconds(remainder_); }

  /// The same in units of 2⁻⁵⁰ s, to be kept and put back: from 0 to below a tick.
  std::int64_t tick_units() const { return tick_; }
  std::int64_t remainder_units() const { return remainder_; }
  void set_remainder_units(std::int64_t units) { remainder_ = units; }

 private:
  static std::int64_t to_units(double seconds) { return std::llround(std::ldexp(seconds, 50)); }
  static double to_seconds(std::int64_t units) { return std::ldexp(static_cast<double>(units), -50); }

  std::int64_t tick_ = to_units(1.0 / 60);
  std::int64_t max_frame_ = to_units(0.25);
  std::int64_t remainder_ = 0;
};

}  // namespace mobil::inline v0_3
