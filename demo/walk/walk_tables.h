#pragma once
// motion.csv and muscles.csv, with one row per tick (and side and group). Columns must stay, because scripts use them.

#include <optional>
#include <string>
#include <string_view>

#include <mobil/components/activation.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/components/muscle.h>
#include <mobil/components/pose.h>
#include <mobil/forces.h>

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
  std::optional<MomentReserve<float>> reserve{};  // if muscles follow the moments
};

/// The growing text of motion.csv. Forces are those of the row's own tick; without them their cells are empty. The
/// anterior component of the ground reaction is along the row's heading. `reserves` adds columns for the moments that
/// muscles do not produce.
struct MotionTable {
  explicit MotionTable(bool reserves = false);
  void add(const MotionRow& row, const std::optional<WalkForces>& forces);
  std::string text;
};

/// Returns the text of the method column: the name of the method, such as explicit-central, with the suffix _force if a
/// force pulls the end.
std::string method_label(const LegMuscles& muscles);

/// A row of muscles.csv.
struct MuscleTableRow {
  double time_s;
  Side side;
  Muscle muscle;
  std::string_view method;
  LineOfAction<float> line;
  LineMotion<float> motion;
  std::optional<BellyReport<float>> belly;
  Activation<float> activation;  // this and the next only in tables of active muscles
  Musculotendon<float> pull;
};

/// The growing text of muscles.csv. `pulls` adds the columns of active muscles. Cells of the belly are empty for a
/// muscle without one.
struct MuscleTable {
  explicit MuscleTable(bool pulls);
  void add(const MuscleTableRow& row);
  std::string text;
  bool pulls;
};

}  // namespace mobil
