#pragma once
// Which step a walker takes at a heel strike: of those that are clear of everybody's reservations, the one that costs
// least.

#include <array>
#include <cstdint>
#include <span>

#include <mobil/components/gait.h>
#include <mobil/systems/avoidance/obstacles.h>
#include "systems/avoidance/reservations.h"
#include "systems/avoidance/trials.h"

namespace mobil::inline v0_3 {

/// What a choice looks at. Two may overlap by `overlap_m`: that much reservations may come nearer than both radii.
struct Surroundings {
  const ReservationBook& book;
  std::span<const BoxedWall> walls;
  std::span<const Disc> discs;
  float overlap_m;
};

/// What somebody chose: the trial and what to ask of the gait for it, or, if someone else goes first, `as_reserved`;
/// where that leads, at the book's instants.
struct Chosen {
  std::size_t trial = reserved;
  TrialKind kind = TrialKind::stay;
  bool under_way = false;  // of a step aside: nothing is asked
  Gait<float> gait{}, as_reserved{};
  float duration_s = 0;
  std::array<float, way_samples> x_m{}, z_m{};
  GroundBox box{};
};

/// From any thread.
void choose_step(const Surroundings& around, const Striker& striker, Chosen& out);

/// Whether two ways come nearer than that.
bool meet(const Chosen& a, const Chosen& b, float apart_m);

}  // namespace mobil::inline v0_3
