#pragma once
// How far off each way to deform a muscle is, and what it costs: measured from walks of the library's own
// (`mobil fit-accuracy`), so that a scene can choose the cheapest that is good enough.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/muscle.h>

namespace mobil::inline v0_3 {

/// One way to deform a muscle. Of Method::modal: `modes` of a mesh of `cells`, extrapolated, `moving` or the static
/// answer alone. Of muscles that pull: whether control points are those of finite strain (LegMuscles::finite_shape),
/// and whether tension stiffens what moves (ModalOptions::tuned).
struct LodLevel {
  std::string_view name;
  Method method = Method::none;
  std::uint32_t modes = 0;
  bool moving = true;
  Cells cells{};
  bool finite_shape = false, tuned = false;
};

/// A lod_table, about from cheap to dear: nothing, static, 4 to 32 modes of 4×4×16 elements, 32 of 8×8×32, and the
/// paper's choice, explicit on 2×2×8.
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
/// That of people whose muscles pull, beside tissue at finite strain. A finer mesh's modes and the explicit mesh,
/// which tension does not stiffen, are no nearer to that (`mobil frontier --finite`).
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

/// What changing a muscle's method to a level takes, both legs', µs of a core of an Intel Xeon of 3 GHz (`mobil bench
/// lod`): finding a body's motions along many modes takes most.
inline constexpr std::array<float, level_count> switch_us = {9, 55, 40, 45, 52, 66, 86, 155, 290, 290, 15};
inline constexpr std::array<float, level_count> active_switch_us = {9, 55, 40, 55, 40, 45, 52, 66, 86, 155, 290};

/// Walks that errors were measured in, as the reference body walks them; others walk as fast in proportion to the root
/// of their height.
enum class SpeedClass : std::uint8_t { slow, free, fast };
inline constexpr std::array<std::string_view, 3> speed_class_name = {"slow", "free", "fast"};
inline constexpr std::array<float, 3> speed_class_m_s = {0.9F, 1.4F, 2.0F};

/// `error_m`: of each level the 99.9th percentile over ticks of the largest distance of a control point from where a
/// converged reference has it, m, in a body of the reference body's height; others in proportion. `active`: of muscles
/// that pull, on their lod_table, beside nonlinear tissue, rounded up by up to 9 %; of these `volume_off` too: of the
/// volume that the control points enclose off that at rest, as a part of it, the same percentile.
struct AccuracyRow {
  Muscle muscle = Muscle::hamstrings;
  SpeedClass speed = SpeedClass::free;
  bool inertia = false;
  std::array<float, level_count> error_m{};
  bool active = false;
  std::array<float, level_count> volume_off{};
};

/// What one muscle of one leg costs in one tick of 1/60 s, µs: its motion; and, on top, its control points where
/// someone looks. What makes it pull (LegMuscles::activation) is no part: that goes on whatever the level.
struct LevelCost {
  std::array<float, level_count> state_us{}, points_us{};
};

struct AccuracyTable {
  std::span<const AccuracyRow> rows;
  std::array<LevelCost, 4> cost;  // without and with inertia; then active, without and with

  const LevelCost& cost_of(bool inertia, bool active) const { return cost[(active ? 2U : 0U) + (inertia ? 1U : 0U)]; }

  /// A muscle's row; of one that was not measured its group's. Null where there is neither.
  const AccuracyRow* find(Muscle muscle, SpeedClass speed, bool inertia, bool active = false) const;
};

/// The one that was measured.
const AccuracyTable& accuracy_table();

}  // namespace mobil::inline v0_3
