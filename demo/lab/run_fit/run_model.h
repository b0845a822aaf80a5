#pragma once
// A steady run of equal steps in double precision. The ground force of each foot is given, and the centre of mass of
// the 48 segments is its double integral. The hips follow from the centre of mass and the feet. A flight is therefore
// ballistic for every shape.
//
// The right leg's cycle starts at its contact; the left leg is half a cycle later, mirrored. World axes: x to the left,
// y up, z forward, the origin at the right foothold (the ground under the ankle of the flat foot) on the running line.
// All forces and moments are per kg of body.

#include <cstddef>
#include <memory>
#include <vector>

#include <mobil/engine/geometry.h>
#include "assets/gait/run_table.h"
#include "demo/lab/gait_fit/step_model.h"

namespace mobil {

/// The 48 segments of a man, and his leg.
struct RunBody {
  BodyParts parts;
  StepBody size;
};
/// Returns the typical man with legs of that scale.
RunBody run_body(double leg_scale_m);

/// Constants of a running step. Angles rad.
struct RunTask {
  RunBody body;
  double speed_m_s, frequency_hz, duty;
  double half_width_m, toe_out;
  double arm_abduction, forearm_pronation, finger_flexion;
  RunGiven given;
  std::size_t samples;  // of the cycle, even
};
double contact_s(const RunTask& task);
double step_length_m(const RunTask& task);

using RunSamples = std::vector<double>;
using RunVectors = std::vector<Vec3<double>>;

/// The right foot over the cycle.
struct RunFoot {
  RunSamples pitch, stance_pitch;  // and as if it were always in stance
  RunSamples toes;                 // bend of the toes, heel up
  RunSamples pad_up, pad_forward;
  RunVectors ankle;
  RunSamples swung;  // 0 to 1 over the swing
  RunSamples clear;  // lowest of heel, ball and toes, over the ground
};

/// A running step at equal intervals from the right foot's contact. `cycle`: the right leg over the cycle. `step`: the
/// whole body until the left foot's contact, after which it repeats, mirrored.
struct RunCycle {
  RunFoot foot;
  struct {
    RunVectors hips;              // middle of the hips
    RunSamples hip, knee, ankle;  // flexion, dorsiflexion
    RunSamples slack;             // how much shorter than straight the leg is, m
    RunSamples hip_moment, knee_moment, ankle_moment;
  } cycle;
  struct {
    RunVectors centre;   // of mass
    RunVectors force;    // of the right foot, body weights
    RunVectors turning;  // rate of the angular momentum about the centre of mass
    RunSamples trunk, side_lean, shoulders;
    RunSamples wanted, front, back;  // centre of pressure ahead of the foothold: required, and the sole's reach
    RunSamples pitch_lacking;        // moment that no centre of pressure in the sole balances
    RunSamples aside, roll_lacking;  // required distance from the foot's line, to the left; moment beyond the sole
    RunSamples yaw;                  // moment about the vertical that the ground does not give by its force
    RunSamples error;                // of the centre of mass, m, where a leg cannot reach
  } step;
};

/// A pose of the 48 segments: origins in the world and rotations.
struct RunPose {
  std::array<Vec3<double>, segment_count> position;
  std::array<Quat<double>, segment_count> rotation;
};

/// Evaluates steps of one task. The body above the hips is kept from one call to the next while the numbers on which it
/// depends are the same.
class RunModel {
 public:
  explicit RunModel(const RunTask& task);
  ~RunModel();
  RunModel(const RunModel&) = delete;
  RunModel& operator=(const RunModel&) = delete;

  const RunTask& task() const;
  void evaluate(const RunShape& shape, RunCycle& cycle);
  /// Returns the pose of the last evaluated step at a sample before the left foot's contact.
  RunPose pose(std::size_t sample) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mobil
