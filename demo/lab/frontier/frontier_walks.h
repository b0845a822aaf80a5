#pragma once
// What moves and loads muscles in `mobil frontier`: recorded from people who walk, the same for every method.

#include <cstddef>
#include <span>
#include <vector>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/body.h>
#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>

namespace mobil {

inline constexpr double frontier_tick_s = 1.0 / 60;

struct FrontierWalk {
  BodyRequest body;
  float speed_m_s;
};

/// What a belly of each lane feels of its frame at one moment, as FrameLoad.
struct FrontierFrame {
  Vec3<Lanes<float>> constant;
  Mat3<Lanes<float>> gradient;
};

/// Sixteen right legs' bellies of one muscle, a walk each; walks that are fewer are repeated. Displacement of the far
/// end (m) and load of the frame a tick, both linear between ticks. All begin at rest without load: over the first
/// second everything grows smoothly to what it is. From tick `first` on answers are compared.
struct FrontierDrive {
  Muscle muscle;
  std::size_t walks;  // of the lanes, how many are walks of their own
  std::vector<MusclePlan> plan;
  BellyScale<Lanes<float>> scale;
  std::vector<Lanes<float>> end_m;
  std::vector<FrontierFrame> frame;
  std::size_t first;

  std::size_t ticks() const { return end_m.size() - 1; }
  /// At a time between ticks; from and to over the time from `from_s` to `to_s`.
  EndDrive<Lanes<float>> end(double from_s, double to_s) const;
  FrameLoad<Lanes<float>> load(double from_s, double to_s) const;
};

/// Five bodies, light to heavy, at 0.9, 1.4 and 2.0 m/s each, and one more.
std::vector<FrontierWalk> frontier_walks();

/// Of each muscle what up to sixteen walkers' right legs do: `seconds` that are compared, after the beginning. Fails
/// without walks or with more than sixteen, on a body or a speed out of range, or less than a tick's time.
Result<std::vector<FrontierDrive>> record_walks(std::span<const Muscle> muscles, std::span<const FrontierWalk> walks,
                                                double seconds);

}  // namespace mobil
