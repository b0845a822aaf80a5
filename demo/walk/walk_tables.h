#pragma once
// motion.csv and muscles.csv: one row a tick (and side and group). Columns are promises to scripts: they stay.

#include <optional>
#include <string>
#include <string_view>

#include "components/forces.h"
#include "components/leg_muscles.h"
#include "components/muscle.h"
#include "components/pose.h"

namespace mobil {

/// A walker at a tick.
struct MotionRow {
  double time_s;
  float heading_rad;
  JointAngles<float> angles;
  Feet<float> feet;
  CentreOfMass<float> com;
};

struct WalkForces {
  GroundReaction<float> ground;
  JointMoments<float> moments;
};

/// motion.csv under way. Forces are those of the row's own tick; without them their cells are empty. The ground
/// reaction's anterior part is along the row's heading.
struct MotionTable {
  MotionTable();
  void add(const MotionRow& row, const std::optional<WalkForces>& forces);
  std::string text;
};

/// The method column: ecd, icd, caa, static, reduced or none; where the end is pulled ecd_force and so on.
std::string method_label(const LegMuscles& muscles);

/// muscles.csv under way. A muscle without a belly has empty cells for it.
struct MuscleTable {
  MuscleTable();
  void add(double time_s, Side side, Muscle muscle, const LineOfAction<float>& line, const LineMotion<float>& motion,
           const std::optional<BellyReport<float>>& belly, std::string_view method);
  std::string text;
};

}  // namespace mobil
