#pragma once
// The accuracy table's part of muscles that pull: people walk with each level of their lod_table, beside tissue at
// finite strain whose fibres pull (assets/finite/finite_motion.h).

#include "assets/finite/finite_motion.h"
#include "demo/lab/effects/accuracy_measure.h"

namespace mobil {

/// Loads on a belly at a tick's end: shortening over the mesh's length, activation, what pushes its mass.
struct WalkLoad {
  double shortening = 0, activation = 0;
  FinitePush push;
};

/// Moves a belly through a tick whose shortening and push change linearly; its activation is that of `to`. Takes
/// `steps` equal steps, each halved where it fails; throws Stopped where a 256th of a tick fails.
void follow_tick(const FiniteBelly& belly, double tick_s, double foundation_hz, const WalkLoad& from,
                 const WalkLoad& to, int steps, FiniteScratch& scratch, FiniteMotion& motion);

/// As accuracy_plan, for a shorter time, since a muscle's walk takes half a minute of a core: groups in two bodies;
/// members in one, for those of the calf err by up to 1.6 times as much as their group.
std::array<AccuracyPlan, 2> active_plans();

/// Rows without inertia and with, the right leg's. Where nonlinear tissue is: its static shape as the tables are made
/// from, and what inertia adds to that on 4×4×16 elements.
std::vector<AccuracyRow> measure_active_errors(const AccuracyPlan& plan);

}  // namespace mobil
