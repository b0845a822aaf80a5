#pragma once
// Bodies, gaits and actions of a crowd, drawn from a seed and a person's number only. They do not depend on the size of
// the crowd, the order of spawning or the number of threads.

#include <cstddef>
#include <cstdint>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/engine/error.h>

namespace mobil {

/// SplitMix64 of Steele, Lea & Flood, the same on every machine. `stream`: one of a person's many sequences.
class CrowdRandom {
 public:
  CrowdRandom(std::uint64_t seed, std::uint64_t person, std::uint64_t stream);

  /// Returns a uniform number in [low, high).
  float even(float low, float high);
  /// Returns a nearly normal number, cut at 2.5 deviations: a sum of twelve uniform ones, the same on every machine.
  float bell(float mean, float deviation);
  /// Returns an integer from 0 to count − 1.
  std::size_t below(std::size_t count);

 private:
  std::uint64_t next();
  float unit();

  std::uint64_t state_;
};

struct CrowdPerson {
  BodyRequest body;
  GaitRequest gait;
};

/// Returns a random person. Nearly normal, with mean ± standard deviation and cut at 2.5 deviations: height 1.72 ± 0.09
/// m, body mass index 24 ± 3 kg/m², biotype 3-4-3 ± 0.7 each, speed 1.35 ± 0.15 m/s. Uniform: the constitution, and
/// gait parameters within a tenth of their defaults (a two-hundredth for the mid-stance hip height). Asymmetries are 0.
/// `draw` selects another person for the same number.
CrowdPerson crowd_person(std::uint64_t seed, std::uint64_t number, std::uint32_t draw);

/// Returns the first such person from `draw` on who can walk, and sets `draw`. Errors: none in twenty draws.
Result<CrowdPerson> crowd_walker(std::uint64_t seed, std::uint64_t number, std::uint8_t& draw);

/// Returns a speed from the crowd's distribution, m/s.
float crowd_speed(CrowdRandom& random);

/// A person's initial place, in fractions of the area's side from its middle (−0.5 to 0.5), and heading about +Y, rad.
struct CrowdPlace {
  float across, along, heading_rad;
};
CrowdPlace crowd_place(std::uint64_t seed, std::uint64_t number);

/// A person's next change, `after_s` after the last one: a turn by `turn_rad` (0 for none), and the new `speed_m_s` (0
/// to stop, below 0 for no change).
struct CrowdChange {
  float after_s = 0, turn_rad = 0, speed_m_s = -1;
};

/// Returns change `k` of a person, from 0, after 4 to 26 s (the first after 0 to 15 s), uniform. Half are turns (0 ±
/// 50°), one in eight is a stop, after which the person walks again in 2 to 8 s, and the others set the speed.
CrowdChange crowd_change(std::uint64_t seed, std::uint64_t number, std::uint32_t k, bool stopped);

}  // namespace mobil
