#pragma once
// Published measurements of walking people, with which `mobil compare` compares a walk.

#include <array>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/engine/error.h>
#include "demo/lab/compare/compare_judge.h"

namespace mobil {

inline constexpr double gravity_m_s2 = 9.81;

/// Quantities compared over the cycle: angles in degrees (flexion, dorsiflexion positive), ground reaction of one foot
/// in body weights (up, forward positive), internal moments in N m per kg of body (extensor, plantarflexor positive).
enum class GaitQuantity { hip, knee, ankle, vertical, fore_aft, hip_moment, knee_moment, ankle_moment };
inline constexpr std::size_t gait_quantity_count = 8;
inline constexpr std::array<std::string_view, gait_quantity_count> gait_quantity_name = {
    "hip", "knee", "ankle", "vertical", "fore_aft", "hip_moment", "knee_moment", "ankle_moment"};
constexpr std::size_t index(GaitQuantity quantity) {
  return static_cast<std::size_t>(quantity);
}

constexpr bool is_moment(GaitQuantity quantity) {
  return index(quantity) >= index(GaitQuantity::hip_moment);
}

inline constexpr std::size_t speed_class_count = 5;
namespace compared_class {
enum : std::size_t { very_slow, slow, free, fast, very_fast };
}
inline constexpr std::array<std::string_view, speed_class_count> compared_class_name = {"very slow", "slow", "free",
                                                                                        "fast", "very fast"};

/// One published set of curves, of people with legs (hip to ground) of `leg_m`. `hip_from_vertical`: the thigh's angle
/// is measured from the vertical, otherwise from the tilted pelvis.
struct MeasuredSet {
  std::string name;
  bool hip_from_vertical;
  double leg_m;
  double max_age_y = std::numeric_limits<double>::infinity();  // the oldest people who are compared with it
  std::array<std::array<bool, gait_quantity_count>, speed_class_count> measured{};  // [class][quantity]
  std::array<double, speed_class_count> speed{};                                    // over √(g · leg length)
  /// Step length over leg length, and one double support as a part of the cycle; 0 if the set has none.
  std::array<double, speed_class_count> step_length{}, double_support{};
  /// Mean anterior tilt of the pelvis, half the range of its axial rotation and of its list, degrees.
  std::array<double, speed_class_count> pelvis_tilt_deg{}, pelvis_rotation_deg{}, pelvis_list_deg{};
  std::array<std::array<MeasuredCurve, gait_quantity_count>, speed_class_count> curve{};  // [class][quantity]

  /// Returns true if the set has curves of that class.
  bool has_class(std::size_t speed_class) const;
  /// Returns the speed of a person with such a leg, m/s.
  double speed_m_s(std::size_t speed_class, double person_leg_m) const;
  /// Returns a curve of a person with such a leg who walks alike: forces in body weights are unchanged, moments in N
  /// m/kg scale with the leg.
  MeasuredCurve scaled(std::size_t speed_class, GaitQuantity quantity, double person_leg_m) const;
};

/// Steps at one speed over √(g · height): length over height, frequency times √(height / g); mean and deviation.
struct StepNorm {
  double speed, length, length_sd, cadence, cadence_sd;
};

/// A band of step lengths and cadences against speed, in order of speed.
struct StepBand {
  std::string name;
  std::vector<StepNorm> norm;
  /// Interpolates between the norms; returns nothing beyond the slowest and the fastest.
  std::optional<StepNorm> at(double speed) const;
};

/// Peak to peak rise of the centre of mass over a step, at a speed.
struct ExcursionNorm {
  double speed_m_s, mean_m, sd_m;
};

struct GaitReference {
  std::vector<MeasuredSet> sets;
  std::vector<StepBand> steps;
  std::vector<ExcursionNorm> excursion;  // in order of speed
  double excursion_leg_m;                // of the people measured
  std::string note;                      // missing data, for people; can be empty
};

/// Returns the tables in the program for a person of that age and, with a folder, those of Winter, which cannot be
/// redistributed. These are winter_joint_angles.csv, winter_joint_moments.csv, winter_grf.csv and
/// com_vertical_excursion_computed.csv (rows winter_slow, winter_natural, winter_fast with their speed_m_s). Tables of
/// the folder replace built-in ones of the same name. Errors: no folder, a table that cannot be read or lacks a column
/// or rows, a folder with none of the tables.
Result<GaitReference> read_gait_reference(const std::optional<std::filesystem::path>& folder,
                                          double age_y = static_cast<double>(usual_age_y));

}  // namespace mobil
