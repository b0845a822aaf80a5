#pragma once
// motion.csv and muscles.csv: one row a tick (and side and group). Columns are promises to scripts: they stay.

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
  std::optional<MomentReserve<float>> reserve{};  // where muscles follow the moments
};

/// motion.csv under way. Forces are those of the row's own tick; without them their cells are empty. The ground
/// reaction's anterior part is along the row's heading. `reserves`: what of the moments the muscles do not make
/// follows.
struct MotionTable {
  explicit MotionTable(bool reserves = false);
  void add(const MotionRow& row, const std::optional<WalkForces>& forces);
  std::string text;
};

/// The method column: explicit-central, implicit-central, newmark, static, modal or none; where the end is pulled
/// explicit-central_force and so on.
std::string method_label(const LegMuscles& muscles);

/// What a row of muscles.csv tells of one muscle.
struct MuscleTableRow {
  double time_s;
  Side side;
  Muscle muscle;
  std::string_view method;
  LineOfAction<float> line;
  LineMotion<float> motion;
  std::optional<BellyReport<float>> belly;
  Activation<float> activation;  // this and the next where the table is about them
  Musculotendon<float> pull;
};

/// muscles.csv under way, with what muscles that pull have besides or without. A muscle without a belly has empty cells
/// for it.
struct MuscleTable {
  explicit MuscleTable(bool pulls);
  void add(const MuscleTableRow& row);
  std::string text;
  bool pulls;
};

}  // namespace mobil
