#pragma once
// How far off each way to deform a muscle is, and what it costs: measured from walks of the library's own
// (`mobil effects --measure`), so that a scene can choose the cheapest that is good enough.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "assets/fem/hexahedral_mesh.h"
#include "components/muscle.h"

namespace mobil {

/// One way to deform a muscle. Of Method::reduced: `vectors` of a mesh of `cells`, extrapolated, `moving` or the static
/// answer alone.
struct Rung {
  std::string_view name;
  Method method = Method::none;
  std::uint32_t vectors = 0;
  bool moving = true;
  Cells cells{};
};

/// The ladder, about from cheap to dear: nothing, static, 4 to 32 vectors of 4×4×16 elements, 32 of 8×8×32, and the
/// paper's choice, explicit on 2×2×8.
inline constexpr std::size_t rung_count = 11;
inline constexpr std::array<Rung, rung_count> rungs = {{
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

/// What changing a muscle's method to that rung takes, both legs', µs of a core of an Intel Xeon of 3 GHz (`mobil bench
/// relevance`): finding a body's motions along many vectors takes most.
inline constexpr std::array<float, rung_count> switch_us = {9, 55, 40, 45, 52, 66, 86, 155, 290, 290, 15};

/// Walks that errors were measured in, as the reference body walks them; others walk as fast in proportion to the root
/// of their height.
enum class SpeedClass : std::uint8_t { slow, free, fast };
inline constexpr std::array<std::string_view, 3> speed_class_name = {"slow", "free", "fast"};
inline constexpr std::array<float, 3> speed_class_m_s = {0.9F, 1.4F, 2.0F};

/// `error_m`: of each rung the 99.9th percentile over ticks of the largest distance of a control point from where a
/// converged reference has it, m, in a body of the reference body's height; others in proportion.
struct AccuracyRow {
  Muscle muscle = Muscle::hamstrings;
  SpeedClass speed = SpeedClass::free;
  bool inertia = false;
  std::array<float, rung_count> error_m{};
};

/// What one muscle of one leg costs in one tick of 1/60 s, µs: its motion; and, on top, its control points where
/// someone looks.
struct RungCost {
  std::array<float, rung_count> state_us{}, points_us{};
};

struct AccuracyTable {
  std::span<const AccuracyRow> rows;
  std::array<RungCost, 2> cost;  // without and with inertia

  /// A muscle's row; of one that was not measured its group's. Null where there is neither.
  const AccuracyRow* find(Muscle muscle, SpeedClass speed, bool inertia) const;
};

/// The one that was measured.
const AccuracyTable& accuracy_table();

}  // namespace mobil
