#pragma once
// Fixed-length ticks from frames of any length.

#include <cstdint>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// The current tick: its length, s, and its number from 0 on.
struct Tick {
  float dt_s = 0;
  std::uint32_t index = 0;
};

/// Ticks that result from a frame.
struct Ticks {
  std::uint32_t count = 0;  ///< ticks to run now
  double dropped_s = 0;     ///< discarded time: what the frame exceeds the maximum by, s
  double alpha = 0;         ///< position of the frame's end in the next tick, in [0, 1), for PoseWriter
  bool valid = true;        ///< false if the frame was negative or not finite; then all of it was discarded
};

/// A fixed-timestep clock. It counts in integer units of 2⁻⁵⁰ s and does not drift: the sum of all frames, each rounded
/// once to a unit, is exactly the ticks returned, the remainder and the discarded time.
class Clock {
 public:
  /// 60 ticks a second; time of a frame beyond 0.25 s is discarded.
  Clock() = default;

  /// Ranges: tick 1e-5–1 s, longest frame from one tick to 60 s.
  static Result<Clock> make(double tick_s, double max_frame_s = 0.25);

  /// Adds a frame's time, s, and returns the ticks to run now. A negative or non-finite time is discarded.
  Ticks advance(double seconds);

  /// Adds ticks of `advance` that did not run to the next frame.
  void give_back(std::uint32_t ticks) { remainder_ += ticks * tick_; }

  /// Length of a tick, s.
  double tick_s() const { return to_seconds(tick_); }
  /// Returns the maximum number of ticks a frame.
  std::uint32_t max_ticks() const { return static_cast<std::uint32_t>((max_frame_ + tick_ - 1) / tick_); }
  /// Returns the time that does not yet amount to a tick.
  double remainder_s() const { return to_seconds(remainder_); }

  /// Tick and remainder in units of 2⁻⁵⁰ s, for saving and restoring; the remainder is from 0 to below a tick.
  std::int64_t tick_units() const { return tick_; }
  std::int64_t remainder_units() const { return remainder_; }
  void set_remainder_units(std::int64_t units) { remainder_ = units; }

 private:
  static double to_seconds(std::int64_t units) { return static_cast<double>(units) * 0x1p-50; }

  std::int64_t tick_ = (1LL << 50U) / 60;  // 1/60 s to the nearest unit
  std::int64_t max_frame_ = 1LL << 48U;    // 0.25 s
  std::int64_t remainder_ = 0;
};

}  // namespace mobil::inline v0_3
