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

/// One way to deform a muscle. Of Method::reduced: `vectors` of a mesh of `cells`, extrapolated, `moving` or the static
/// answer alone. Of muscles that pull: whether control points are those of finite strain (LegMuscles::finite_shape),
/// and whether tension stiffens what moves (ReducedChoice::tuned).
struct Rung {
  std::string_view name;
  Method method = Method::none;
  std::uint32_t vectors = 0;
  bool moving = true;
  Cells cells{};
  bool finite_shape = false, tuned = false;
};

/// A ladder, about from cheap to dear: nothing, static, 4 to 32 vectors of 4×4×16 elements, 32 of 8×8×32, and the
/// paper's choice, explicit on 2×2×8.
inline constexpr std::size_t rung_count = 11;
using Ladder = std::array<Rung, rung_count>;
inline constexpr Ladder rungs = {{
    {"none", Method::none, 0, true, {}},
    {"static", Method::reduced, 12, false, {4, 4, 16}},
    {"reduced-4", Method::reduced, 4, true, {4, 4, 16}},
    {"reduced-6", Method::reduced, 6, true, {4, 4, 16}},
    {"reduced-8", Method::reduced, 8, true, {4, 4, 16}},
    {"reduced-12", Method::reduced, 12, true, {4, 4, 16}},
    {"reduced-16", Method::reduced, 16, true, {4, 4, 16}},
    {"reduced-24", Method::reduced, 24, true, {4, 4, 16}},
    {"reduced-32", Method::reduced, 32, true, {4, 4, 16}},
    {"reduced-32-fine", Method::reduced, 32, true, {8, 8, 32}},
    {"full", Method::ecd, 0, true, {2, 2, 8}},
}};
/// That of people whose muscles pull, beside tissue at finite strain. A finer mesh's vectors and the explicit mesh,
/// which tension does not stiffen, are no nearer to that (`mobil frontier --finite`).
inline constexpr Ladder living_rungs = {{
    {"none", Method::none, 0, true, {}},
    {"linear-static", Method::reduced, 12, false, {4, 4, 16}},
    {"linear-4", Method::reduced, 4, true, {4, 4, 16}, false, true},
    {"living-static", Method::reduced, 12, false, {4, 4, 16}, true},
    {"living-4", Method::reduced, 4, true, {4, 4, 16}, true, true},
    {"living-6", Method::reduced, 6, true, {4, 4, 16}, true, true},
    {"living-8", Method::reduced, 8, true, {4, 4, 16}, true, true},
    {"living-12", Method::reduced, 12, true, {4, 4, 16}, true, true},
    {"living-16", Method::reduced, 16, true, {4, 4, 16}, true, true},
    {"living-24", Method::reduced, 24, true, {4, 4, 16}, true, true},
    {"living-32", Method::reduced, 32, true, {4, 4, 16}, true, true},
}};
constexpr const Ladder& rungs_of(bool living) {
  return living ? living_rungs : rungs;
}

/// What changing a muscle's method to a rung takes, both legs', µs of a core of an Intel Xeon of 3 GHz (`mobil bench
/// relevance`): finding a body's motions along many vectors takes most.
inline constexpr std::array<float, rung_count> switch_us = {9, 55, 40, 45, 52, 66, 86, 155, 290, 290, 15};
inline constexpr std::array<float, rung_count> living_switch_us = {9, 55, 40, 55, 40, 45, 52, 66, 86, 155, 290};

/// Walks that errors were measured in, as the reference body walks them; others walk as fast in proportion to the root
/// of their height.
enum class SpeedClass : std::uint8_t { slow, free, fast };
inline constexpr std::array<std::string_view, 3> speed_class_name = {"slow", "free", "fast"};
inline constexpr std::array<float, 3> speed_class_m_s = {0.9F, 1.4F, 2.0F};

/// `error_m`: of each rung the 99.9th percentile over ticks of the largest distance of a control point from where a
/// converged reference has it, m, in a body of the reference body's height; others in proportion. `living`: of muscles
/// that pull, on their ladder, beside nonlinear tissue, rounded up by up to 9 %; of these `volume_off` too: of the
/// volume that the control points enclose off that at rest, as a part of it, the same percentile.
struct AccuracyRow {
  Muscle muscle = Muscle::hamstrings;
  SpeedClass speed = SpeedClass::free;
  bool inertia = false;
  std::array<float, rung_count> error_m{};
  bool living = false;
  std::array<float, rung_count> volume_off{};
};

/// What one muscle of one leg costs in one tick of 1/60 s, µs: its motion; and, on top, its control points where
/// someone looks. What makes it pull (LegMuscles::activation) is no part: that goes on whatever the rung.
struct RungCost {
  std::array<float, rung_count> state_us{}, points_us{};
};

struct AccuracyTable {
  std::span<const AccuracyRow> rows;
  std::array<RungCost, 4> cost;  // without and with inertia; then living, without and with

  const RungCost& cost_of(bool inertia, bool living) const { return cost[(living ? 2U : 0U) + (inertia ? 1U : 0U)]; }

  /// A muscle's row; of one that was not measured its group's. Null where there is neither.
  const AccuracyRow* find(Muscle muscle, SpeedClass speed, bool inertia, bool living = false) const;
};

/// The one that was measured.
const AccuracyTable& accuracy_table();

}  // namespace mobil::inline v0_3
