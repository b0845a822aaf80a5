#pragma once
// Runs a request of `mobil muscle`: steps the belly and records the far face's motion.

#include <mobil/basis_writer.h>
#include "demo/lab/muscle/muscle_options.h"

namespace mobil {

struct MuscleRun {
  std::string csv;  // time_s,u_x_m,u_y_m,u_z_m: the centre of the far face, one row a step from t = 0
  double peak_m = 0, peak_time_s = 0;
  std::optional<double> lost_at_s;  // when the displacement ceased to be finite; the table ends there
  BasisRecording recording;         // of a modal belly, if a GLB is requested
};

/// Runs a request from rest at t = 0. Row n is the state at n·Δt. Fails if the double-precision belly cannot be made.
Result<MuscleRun> run_muscle(const MuscleRequest& request);

}  // namespace mobil
