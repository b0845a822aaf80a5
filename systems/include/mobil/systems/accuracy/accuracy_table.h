#pragma once
// Measured errors and costs of each way to deform a muscle, from walks of the library itself (`mobil fit-accuracy`).
// Level of detail uses them to choose the cheapest method that is accurate enough.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/muscle.h>

namespace mobil::inline v0_3 {

/// One way to deform a muscle. Method::modal uses `modes` modes of a mesh of `cells`, extrapolated; if not `moving`, it
/// uses the static solution alone. For active muscles `finite_shape` sets LegMuscles::finite_shape, and `tuned` sets
/// ModalOptions::tuned (tension stiffens the belly).
struct LodLevel {
  std::string_view name;
  Method method = Method::none;
  std::uint32_t modes = 0;
  bool moving = true;
  Cells cells{};
  bool finite_shape = false, tuned = false;
};

/// Levels of inactive muscles, roughly from cheap to dear: none, static, 4 to 32 modes of 4×4×16 elements, 32 modes of
/// 8×8×32, and the paper's choice, explicit central differences on 2×2×8.
inline constexpr std::size_t level_count = 11;
using LodLevels = std::array<LodLevel, level_count>;
inline constexpr LodLevels levels = {{
    {"none", Method::none, 0, true, {}},
    {"static", Method::modal, 12, false, {4, 4, 16}},
    {"modal-4", Method::modal, 4, true, {4, 4, 16}},
    {"modal-6", Method::modal, 6, true, {4, 4, 16}},
    {"modal-8", Method::modal, 8, true, {4, 4, 16}},
    {"modal-12", Method::modal, 12, true, {4, 4, 16}},
    {"modal-16", Method::modal, 16, true, {4, 4, 16}},
    {"modal-24", Method::modal, 24, true, {4, 4, 16}},
    {"modal-32", Method::modal, 32, true, {4, 4, 16}},
    {"modal-32-fine", Method::modal, 32, true, {8, 8, 32}},
    {"full", Method::explicit_central, 0, true, {2, 2, 8}},
}};
/// Levels of active muscles, judged against tissue at finite strain. Modes of a finer mesh, and the explicit mesh,
/// which tension does not stiffen, are not more accurate (`mobil frontier --finite`).
inline constexpr LodLevels active_levels = {{
    {"none", Method::none, 0, true, {}},
    {"linear-static", Method::modal, 12, false, {4, 4, 16}},
    {"linear-4", Method::modal, 4, true, {4, 4, 16}, false, true},
    {"active-static", Method::modal, 12, false, {4, 4, 16}, true},
    {"active-4", Method::modal, 4, true, {4, 4, 16}, true, true},
    {"active-6", Method::modal, 6, true, {4, 4, 16}, true, true},
    {"active-8", Method::modal, 8, true, {4, 4, 16}, true, true},
    {"active-12", Method::modal, 12, true, {4, 4, 16}, true, true},
    {"active-16", Method::modal, 16, true, {4, 4, 16}, true, true},
    {"active-24", Method::modal, 24, true, {4, 4, 16}, true, true},
    {"active-32", Method::modal, 32, true, {4, 4, 16}, true, true},
}};
constexpr const LodLevels& levels_of(bool active) {
  return active ? active_levels : levels;
}

/// Time of changing a muscle's method to a level, both legs, µs on one core of an Intel Xeon at 3 GHz (`mobil bench
/// lod`). With many modes the eigenvectors of the body's modal stiffness take most of it.
inline constexpr std::array<float, level_count> switch_us = {9, 55, 40, 45, 52, 66, 86, 155, 290, 290, 15};
inline constexpr std::array<float, level_count> active_switch_us = {9, 55, 40, 55, 40, 45, 52, 66, 86, 155, 290};

/// Speeds at which errors were measured, for the reference body. Speeds of other bodies are scaled by the square root
/// of height.
enum class SpeedClass : std::uint8_t { slow, free, fast };
inline constexpr std::array<std::string_view, 3> speed_class_name = {"slow", "free", "fast"};
inline constexpr std::array<float, 3> speed_class_m_s = {0.9F, 1.4F, 2.0F};

/// Errors of one muscle. `error_m` is the largest distance of a control point from a converged reference, m, for each
/// level: the 99.9th percentile over ticks, in a body of the reference height. Other bodies have errors in proportion
/// to height. Rows of `active` muscles are for `active_levels`, against nonlinear tissue, rounded up by up to 9 %. For
/// them `volume_off` is the same percentile of the relative change of the enclosed volume from that at rest.
struct AccuracyRow {
  Muscle muscle = Muscle::hamstrings;
  SpeedClass speed = SpeedClass::free;
  bool inertia = false;
  std::array<float, level_count> error_m{};
  bool active = false;
  std::array<float, level_count> volume_off{};
};

/// Cost of one muscle of one leg in a tick of 1/60 s, µs: its motion, and its control points where they are placed.
/// Activation (LegMuscles::activation) is excluded, because it runs at every level.
struct LevelCost {
  std::array<float, level_count> state_us{}, points_us{};
};

struct AccuracyTable {
  std::span<const AccuracyRow> rows;
  std::array<LevelCost, 4> cost;  // without and with inertia; then active, without and with

  const LevelCost& cost_of(bool inertia, bool active) const { return cost[(active ? 2U : 0U) + (inertia ? 1U : 0U)]; }

  /// Returns a muscle's row, or that of its group if the muscle was not measured. Null if neither exists.
  const AccuracyRow* find(Muscle muscle, SpeedClass speed, bool inertia, bool active = false) const;
};

/// Returns the library's measured table.
const AccuracyTable& accuracy_table();

}  // namespace mobil::inline v0_3
