#pragma once
// Muscles of the right leg whose activation makes the moments of a walk (ExcitationSource::moments), compared with
// electromyograms and with the forces on instrumented implants.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/components/activation.h>
#include "demo/lab/compare/compare_walk.h"
#include "demo/lab/compare/joint_contact.h"

namespace mobil {

inline constexpr std::array<std::string_view, leg_moment_count> leg_moment_name = {
    "hip extension", "hip abduction", "hip inward rotation", "knee extension", "plantarflexion"};
inline constexpr std::array<std::string_view, leg_joint_count> leg_joint_name = {"hip", "knee", "ankle"};

/// Activation that the moments ask of a muscle.
struct MuscleCurve {
  Muscle muscle;
  CycleCurve activation;
};

/// One stride of the right leg. Moments in N m/kg, contact forces in body weights.
struct MuscleStride {
  double speed_m_s, cycle_s;
  std::array<CycleCurve, leg_moment_count> moment, left;  // asked; not made by the muscles
  std::array<CycleCurve, leg_joint_count> contact;
  std::vector<MuscleCurve> muscle;  // every single muscle

  /// Returns the root mean square of the rest of a moment over that of the moment.
  double residual(std::size_t moment_number) const;
  /// Returns the largest contact force in the cycle.
  double peak(std::size_t joint) const;
};

/// Walks until steady and then one more stride. Errors: a body or gait out of range.
MuscleStride walk_muscles(const BodyRequest& body, const GaitRequest& gait);

/// An electromyogram over the cycle, whose size has no meaning.
struct Emg {
  std::string source;
  Muscle muscle;
  MeasuredCurve curve;
};
/// Returns the tables in the program: Santuz, 13 muscles at 1.4 m/s, and Bovi et al. 2011, 6 muscles at free speed. The
/// force follows an electromyogram by 75 ms, by which the curves are delayed in a cycle of `cycle_s`.
std::vector<Emg> delayed_emg(double cycle_s);

/// Returns the correlation with the muscle's activation.
double emg_correlation(const MuscleStride& stride, const Emg& emg);

/// Peak force on an instrumented implant in walking, body weights. Without a speed it is that of the person's choice.
struct ImplantPeak {
  LegJointIndex joint;
  double speed_m_s, peak;
  std::string_view source;
};
std::span<const ImplantPeak> implant_peaks();

/// Strides at increasing speeds. Electromyograms are compared with the one whose speed is `emg_speed_m_s`.
inline constexpr std::array<float, 4> muscle_speeds_m_s = {0.8F, 1.1F, 1.4F, 1.8F};
inline constexpr float emg_speed_m_s = 1.4F;
struct MuscleComparison {
  std::vector<MuscleStride> strides;
  std::vector<Emg> emg;
  const MuscleStride& at(float speed_m_s) const;
};
MuscleComparison compare_muscles(const BodyRequest& body, const GaitStyle& style);

/// Return a table for people, the entry of compare.json, and the plot muscle_forces.svg.
std::string muscle_text(const MuscleComparison& comparison);
std::string muscle_json(const MuscleComparison& comparison);
std::string muscle_plot(const MuscleComparison& comparison);

}  // namespace mobil
