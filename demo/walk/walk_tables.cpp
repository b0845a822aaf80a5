#include "demo/walk/walk_tables.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>

#include <mobil/components/activation.h>
#include <mobil/muscle_table.h>

namespace mobil {
namespace {

constexpr std::string_view side_name[2] = {"right", "left"};
constexpr float degrees = 180.0F / std::numbers::pi_v<float>;

}  // namespace

MotionTable::MotionTable(bool reserves) {
  text = "time_s,phase_right,phase_left,com_x_m,com_y_m,com_z_m,pelvis_rotation_deg,pelvis_list_deg,pelvis_tilt_deg";
  for (const auto side : side_name) {
    for (const auto* angle :
         {"hip_flexion", "knee_flexion", "ankle_dorsiflexion", "shoulder_flexion", "elbow_flexion"}) {
      text += fmt::format(",{}_{}_deg", angle, side);
    }
    text += fmt::format(
        ",grf_vertical_{0}_n,grf_anterior_{0}_n,hip_moment_{0}_nm,knee_moment_{0}_nm,ankle_moment_{0}_nm", side);
    for (const auto* point : {"heel", "toe"}) {
      for (const char axis : {'x', 'y', 'z'}) text += fmt::format(",{}_{}_{}_m", point, axis, side);
    }
  }
  if (reserves) {
    for (const auto side : side_name)
      text += fmt::format(
          ",hip_reserve_{0}_nm,knee_reserve_{0}_nm,ankle_reserve_{0}_nm,muscles_at_most_{0},hip_abduction_reserve_{0}_"
          "nm,"
          "hip_rotation_reserve_{0}_nm",
          side);
  }
  for (const auto side : side_name)
    text += fmt::format(",hip_abduction_{0}_nm,hip_rotation_{0}_nm,free_moment_{0}_nm", side);
  text += '\n';
}

void MotionTable::add(const MotionRow& row, const std::optional<WalkForces>& forces) {
  const auto& [time_s, heading_rad, angles, feet, com] = row;
  const float ahead_x = std::sin(heading_rad), ahead_z = std::cos(heading_rad);
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},{:.4f},{:.4f}", time_s, feet.phase[Side::right],
                 feet.phase[Side::left], com.position_m.x, com.position_m.y, com.position_m.z,
                 angles.pelvis_rotation * degrees, angles.pelvis_list * degrees, angles.pelvis_tilt * degrees);
  for (std::size_t side = 0; side < 2; ++side) {
    for (const float angle : {angles.hip_flexion[side], angles.knee_flexion[side], angles.ankle_dorsiflexion[side],
                              angles.shoulder_flexion[side], angles.elbow_flexion[side]}) {
      fmt::format_to(out, ",{:.4f}", angle * degrees);
    }
    if (forces) {
      const Vec3<float>& force = forces->ground.force_n[side];
      const JointMoments<float>& moments = forces->moments;
      fmt::format_to(out, ",{:.3f},{:.3f},{:.4f},{:.4f},{:.4f}", force.y, ahead_x * force.x + ahead_z * force.z,
                     moments.hip_nm[side], moments.knee_nm[side], moments.ankle_nm[side]);
    } else {
      text += ",,,,,";
    }
    for (const auto& point : {feet.heel_m[side], feet.toe_m[side]}) {
      fmt::format_to(out, ",{:.6f},{:.6f},{:.6f}", point.x, point.y, point.z);
    }
  }
  if (forces && forces->reserve) {
    const auto& reserve = forces->reserve;
    for (std::size_t side = 0; side < 2; ++side) {
      const LegMoments<float>& left = reserve->left_nm[side];
      fmt::format_to(out, ",{:.4f},{:.4f},{:.4f},{},{:.4f},{:.4f}", left.hip, left.knee, left.ankle,
                     reserve->at_most[side], left.hip_abduction, left.hip_rotation);
    }
  }
  for (std::size_t side = 0; side < 2; ++side) {
    if (forces) {
      fmt::format_to(out, ",{:.4f},{:.4f},{:.4f}", forces->moments.hip_abduction_nm[side],
                     forces->moments.hip_rotation_nm[side], forces->ground.free_moment_nm[side]);
    } else {
      text += ",,,";
    }
  }
  text += '\n';
}

std::string method_label(const LegMuscles& muscles) {
  const std::string_view method = method_name[static_cast<std::size_t>(muscles.method)];
  return fmt::format("{}{}", method, muscles.drive == Drive::force ? "_force" : "");
}

MuscleTable::MuscleTable(bool pulls_)
    : text(
          "time_s,side,group,line_length_m,rest_length_m,line_ratio,stiffness_n_per_m,force_n,belly_elongation_m,"
          "volume_ratio,kinetic_energy_j,strain_energy_j,method,end_residual_m,line_speed_m_s,"
          "hip_flexion_arm_m,knee_flexion_arm_m,ankle_dorsiflexion_arm_m"),
      pulls(pulls_) {
  if (pulls) text += ",excitation,activation,fibre_length_m,tendon_length_m,pennation_deg,muscle_force_n";
  text += '\n';
}

void MuscleTable::add(const MuscleTableRow& row) {
  auto out = std::back_inserter(text);
  const LineOfAction<float>& line = row.line;
  fmt::format_to(out, "{:.6f},{},{},{:.6f},{:.6f},{:.6f},{:.4f},{:.6f}", row.time_s, side_name[row.side],
                 muscle_name(row.muscle), line.length_m, line.rest_length_m, line.length_m / line.rest_length_m,
                 line.stiffness_n_per_m, line.force_n);
  if (const auto& belly = row.belly) {
    const float end_m = pulls ? row.pull.belly_m : line.length_m - line.rest_length_m;
    fmt::format_to(out, ",{:.6f},{:.6f},{:.6e},{:.6e},{},{:.6f}", belly->elongation_m, belly->volume_ratio,
                   belly->kinetic_energy_j, belly->strain_energy_j, row.method, belly->elongation_m - end_m);
  } else {
    fmt::format_to(out, ",,,,,{},", row.method);
  }
  fmt::format_to(out, ",{:.6f},{:.6f},{:.6f},{:.6f}", row.motion.speed_m_s, row.motion.hip_flexion_arm_m,
                 row.motion.knee_flexion_arm_m, row.motion.ankle_dorsiflexion_arm_m);
  if (pulls) {
    const auto& [excitation, activation] = row.activation;
    const auto& [fibre, tendon, pennation, force, belly, slack] = row.pull;
    fmt::format_to(out, ",{:.4f},{:.4f},{:.6f},{:.6f},{:.3f},{:.3f}", excitation, activation, fibre, tendon,
                   pennation * degrees, force);
  }
  text += '\n';
}

}  // namespace mobil
