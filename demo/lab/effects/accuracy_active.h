#pragma once
// The accuracy table of active muscles. People walk with each level of their lod_table, compared with tissue at finite
// strain with active fibres (assets/finite/finite_motion.h).

#include "assets/finite/finite_motion.h"
#include "demo/lab/effects/accuracy_measure.h"

namespace mobil {

/// Loads on a belly at a tick's end: shortening over the mesh's length, activation, and push on its mass.
struct WalkLoad {
  double shortening = 0, activation = 0;
  FinitePush push;
};

/// Moves a belly through a tick with linear change of shortening and push; its activation is that of `to`. Takes
/// `steps` equal steps and halves each that fails. Throws Stopped if a 256th of a tick fails.
void follow_tick(const FiniteBelly& belly, double tick_s, double foundation_hz, const WalkLoad& from,
                 const WalkLoad& to, int steps, FiniteScratch& scratch, FiniteMotion& motion);

/// Returns plans like accuracy_plan for groups and other muscles, for a shorter time, because a muscle's walk takes
/// half a minute of a core. Groups walk in two bodies. Members walk in one, because those of the calf err by up to 1.6
/// times as much as their group.
std::array<AccuracyPlan, 2> active_plans(const MuscleSet& muscles);

/// Returns rows without inertia and with, of the right leg. The reference is the static shape of nonlinear tissue, from
/// which the tables are made, and the effect of inertia on it with 4×4×16 elements.
std::vector<AccuracyRow> measure_active_errors(const AccuracyPlan& plan);

}  // namespace mobil
