#pragma once
// motion.csv and muscles.csv: one row a tick (and side and group). Columns are promises to scripts: they stay.

#include <string>
#include <string_view>

#include "components/muscle.h"
#include "components/pose.h"

namespace mobil {

/// motion.csv under way. Ground reactions and joint moments are empty cells: no inverse dynamics is simulated yet.
struct MotionTable {
  MotionTable();
  void add(double time_s, const JointAngles<float>& angles, const Feet<float>& feet, const CentreOfMass<float>& com);
  std::string text;
};

/// muscles.csv under way.
struct MuscleTable {
  MuscleTable();
  void add(double time_s, Side side, MuscleGroup group, const LineOfAction<float>& line,
           const BellyReport<float>& belly, std::string_view method);
  std::string text;
};

}  // namespace mobil
