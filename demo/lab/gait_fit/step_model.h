#pragma once
// A steady walk of two equal steps in double precision: positions over the cycle of the right leg, and the forces for
// them. The form of its curves makes it twice continuously differentiable through heel strike and toe-off.
//
// Right leg's cycle from its heel strike; the left leg is half a cycle later, mirrored. World axes: x to the left, y
// up, z forward, the origin at the right foothold (the ground under the ankle of the flat foot, on the walking line).
// All forces and moments are per kg of body.

#include <array>
#include <cstddef>

#include <mobil/components/lanes.h>
#include <mobil/components/step_shape.h>
#include "assets/gait/step_table.h"
#include "demo/lab/gait_fit/upper_body.h"

namespace mobil {

/// Steps are fitted for people with legs of this scale.
inline constexpr double fitted_height_m = 1.75;

/// Sizes of a leg, m, masses as parts of the body's, and the body above.
struct StepBody {
  double height, leg;  // hip to ground
  double thigh, shank, ankle_height, heel_back, ball_forward, toe_joint_height, toes_length, hip_half_spacing;
  double heel_radius;  // a foot rolls on the rim of its heel
  double thigh_mass, shank_mass, foot_mass;
  UpperBody upper;
  ArmBody arm;
};
/// Returns the typical man, woman or child of 7 years, with legs of that scale.
StepBody step_body(StepKind kind, double leg_scale_m);

/// Constants of a fit. Angles in rad.
struct StepTask {
  StepBody body;
  double speed_m_s, step_length_m;
  double double_support;  // of the cycle
  double half_width_m, toe_out;
  double pelvis_rotation, pelvis_list, pelvis_tilt, pelvis_tilt_wave;
  /// Each arm follows the opposite leg's line from hip to ankle, from `leg_back` to `leg_forward`.
  double leg_back, leg_forward, arm_back, arm_forward, elbow_back, elbow_forward;
};

inline constexpr std::size_t cycle_samples = 200;
using Samples = std::array<double, cycle_samples>;

/// The right leg at equal intervals from its heel strike.
struct StepCycle {
  Samples hips_forward, hips_up, hips_left, trunk;
  Samples pitch, stance_pitch;  // of the foot; and as if it were always in stance
  Samples ankle_forward, ankle_up, ankle_out;
  Samples thigh, shank, tilt;  // angles: in the leg's plane, and of the pelvis
  Samples hip, knee, ankle;    // flexion, dorsiflexion; the hip from the tilted pelvis
  Samples slack;               // how much shorter than straight the leg is, m
  Samples pad_up, pad_forward;
  std::array<bool, cycle_samples> swings;
  Samples swung;                              // 0 to 1 over the swing
  Samples heel_clear, ball_clear, toe_clear;  // over the ground
  Samples centre_up;                          // of mass
  Samples total_forward, total_up;            // ground reaction of both feet, N/kg
  Samples share, pressure;                    // of the right foot: of the weight; centre of pressure ahead of the ankle
  Samples pressure_aside;                     // required distance from between the feet's lines, to the left, m
  Samples wanted_pressure;                    // of both feet, as the motion requires
  Samples lacking;                            // distance of that ahead of `pressure`, m
  Samples borne;        // centre of pressure of the right foot ahead of the ankle, used by the forces
  Samples forward, up;  // ground reaction of the right foot, body weights
  Samples hip_moment, knee_moment, ankle_moment;  // N m/kg, extensor and plantarflexor positive
};

/// Evaluates a step. Both feet's centres of pressure are shifted by `lacking`, so that no moment is left unbalanced.
void evaluate_step(const StepTask& task, const StepShape& shape, StepCycle& cycle);

/// Returns a shape to start from.
StepShape first_shape(const StepTask& task);

}  // namespace mobil
