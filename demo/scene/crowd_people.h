#pragma once
// Who is in a crowd, and what each of them does: drawn from a seed and a person's number alone, so that it is the same
// however large the crowd is, in whatever order people come, on however many threads.

#include <cstddef>
#include <cstdint>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/engine/error.h>

namespace mobil {

/// Steele, Lea & Flood's SplitMix64: the same numbers on every machine. `stream`: one of a person's many.
class CrowdRandom {
 public:
  CrowdRandom(std::uint64_t seed, std::uint64_t person, std::uint64_t stream);

  /// Even within [low, high).
  float even(float low, float high);
  /// A sum of twelve even numbers, which is bell-shaped enough and exact everywhere; cut at 2.5 deviations.
  float bell(float mean, float deviation);
  /// 0 … count − 1.
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

/// Drawn from: height 1.72 ± 0.09 m, body mass index 24 ± 3 kg/m², biotype about 3-4-3 ± 0.7 each, speed 1.35 ± 0.15
/// m/s (mean ± standard deviation, bell-shaped, cut at 2.5 deviations), any constitution, and every gait parameter
/// within a tenth of its default (even), hips in mid-stance within a two-hundredth, asymmetries none. `draw`: another
/// person for the same number.
CrowdPerson crowd_person(std::uint64_t seed, std::uint64_t number, std::uint32_t draw);

/// The first such person from that draw on who can walk so. Errors: none in twenty draws.
Result<CrowdPerson> crowd_walker(std::uint64_t seed, std::uint64_t number, std::uint8_t& draw);

/// m/s, from the crowd's distribution.
float crowd_speed(CrowdRandom& random);

/// Where someone begins: parts of the area's side from its middle, −0.5 to 0.5, and rad about +Y.
struct CrowdPlace {
  float across, along, heading_rad;
};
CrowdPlace crowd_place(std::uint64_t seed, std::uint64_t number);

/// What someone does next: `after_s` after the last change, turn by `turn_rad` (0: not), walk at `speed_m_s` (0: stop;
/// below 0: as before).
struct CrowdChange {
  float after_s = 0, turn_rad = 0, speed_m_s = -1;
};

/// Change `k` of a person, 0 the first. Every 15 s on the mean (even, 4 to 26 s, the first within 15 s) someone turns
/// (about 0 ± 50°), walks at another speed, or, one time in eight, stops for 2 to 8 s; who has stopped goes on.
CrowdChange crowd_change(std::uint64_t seed, std::uint64_t number, std::uint32_t k, bool stopped);

}  // namespace mobil
