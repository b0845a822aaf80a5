#pragma once
// Choice of a walker's step at a heel strike: the cheapest of those that are clear of all reservations.

#include <array>
#include <cstdint>
#include <span>

#include <mobil/components/gait.h>
#include <mobil/systems/avoidance/obstacles.h>
#include "systems/avoidance/reservations.h"
#include "systems/avoidance/trials.h"

namespace mobil::inline v0_3 {

/// Input of a choice. Reservations of two people can come nearer than both radii by `overlap_m`.
struct Surroundings {
  const ReservationBook& book;
  std::span<const BoxedWall> walls;
  std::span<const Disc> discs;
  float overlap_m;
};

/// A walker's choice: the trial and its gait request, or `as_reserved` if another walker goes first. Also contains the
/// resulting way, at the book's instants.
struct Chosen {
  std::size_t trial = reserved;
  TrialKind kind = TrialKind::stay;
  bool under_way = false;  // a step aside is under way: nothing is requested
  Gait<float> gait{}, as_reserved{};
  float duration_s = 0;
  std::array<float, way_samples> x_m{}, z_m{};
  GroundBox box{};
};

/// Chooses a walker's next step. Callable from any thread.
void choose_step(const Surroundings& around, const Striker& striker, Chosen& out);

/// Returns true if the two ways come nearer than `apart_m`.
bool meet(const Chosen& a, const Chosen& b, float apart_m);

}  // namespace mobil::inline v0_3
