#pragma once
// What `mobil muscle` does with a request: steps the belly and keeps the far face's motion.

#include <mobil/basis_writer.h>
#include "demo/lab/muscle/muscle_options.h"

namespace mobil {

struct MuscleRun {
  std::string csv;  // time_s,u_x_m,u_y_m,u_z_m: the centre of the far face, one row a step from t = 0
  double peak_m = 0, peak_time_s = 0;
  std::optional<double> lost_at_s;  // when the displacement ceased to be a number; the table ends there
  BasisRecording recording;         // of a modal belly for which a GLB is asked
};

/// From rest at t = 0. Row n is the state at n·Δt. Fails where the double-precision belly cannot be made.
Result<MuscleRun> run_muscle(const MuscleRequest& request);

}  // namespace mobil
