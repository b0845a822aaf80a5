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

/// A person, and the party: the number of its first member, and its size.
struct CrowdPerson {
  BodyRequest body;
  GaitRequest gait;
  std::uint64_t party_first = 0;
  std::uint32_t party_size = 1;
};

/// Returns a random person. Sex, age, stature and party are those of `crowd_block`; stature and body mass index are
/// distributed as in `typical_body`, and below 18 years they correlate by 0.38 at 6 to 0.33 at 12 and 0. The speed is
/// the usual one of sex and age times e^N(0, 0.10), or the party's slowest. Biotype: 3-4-3 ± 0.7 each. Uniform: the
/// constitution, and gait parameters within a tenth of `usual_style` (a two-hundredth for the mid-stance hip height).
/// Asymmetries are 0. `draw` selects another mass, biotype, constitution and style for the same number.
CrowdPerson crowd_person(std::uint64_t seed, std::uint64_t number, std::uint32_t draw);

/// Returns the first such person from `draw` on who can walk, and sets `draw`. Errors: none in twenty draws.
Result<CrowdPerson> crowd_walker(std::uint64_t seed, std::uint64_t number, std::uint8_t& draw);

/// Returns a speed of people with that usual speed, m/s.
float crowd_speed(CrowdRandom& random, float usual_m_s = 1.33F);

/// A person's initial place, in fractions of the area's side from its middle (−0.5 to 0.5), and heading about +Y, rad.
struct CrowdPlace {
  float across, along, heading_rad;
};
CrowdPlace crowd_place(std::uint64_t seed, std::uint64_t number);

/// Offset of a place, m.
struct CrowdOffset {
  float x_m, z_m;
};
/// Returns the offset of a member of a party that walks at that heading, rad. Rows have up to three people, 0.75 m
/// apart. The next row is 1 m behind.
CrowdOffset crowd_abreast(std::uint32_t place, std::uint32_t party_size, float heading_rad);

/// A person's next change, `after_s` after the last one: a turn by `turn_rad` (0 for none), and the new `speed_m_s` (0
/// to stop, below 0 for no change).
struct CrowdChange {
  float after_s = 0, turn_rad = 0, speed_m_s = -1;
};

/// Returns change `k` of a person, from 0, after 4 to 26 s (the first after 0 to 15 s), uniform. Half are turns (0 ±
/// 50°), one in eight is a stop, after which the person walks again in 2 to 8 s, and the others set the speed. Members
/// of a party have the changes of its first member.
CrowdChange crowd_change(std::uint64_t seed, std::uint64_t number, std::uint32_t k, bool stopped,
                         float usual_m_s = 1.33F);

}  // namespace mobil
