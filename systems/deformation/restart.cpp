#include "systems/deformation/restart.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include <mobil/rows.h>

namespace mobil::inline v0_3 {
namespace {

/// Returns the lanes whose reports are not finite, as bits. Reports contain sums over all displacements and velocities.
std::uint32_t ill_lanes(const BellyReport<Lanes<float>>& report) {
  std::array<std::uint32_t, lane_count> not_zero;  // x - x is 0, or NaN where x is not finite
  std::uint32_t any = 0;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const float sum = report.kinetic_energy_j[lane] + report.strain_energy_j[lane] + report.volume_ratio[lane];
    not_zero[lane] = std::bit_cast<std::uint32_t>(sum - sum);
    any |= not_zero[lane];
  }
  if (any == 0) return 0;
  std::uint32_t lanes = 0;
  for (std::size_t lane = 0; lane < lane_count; ++lane) lanes |= (not_zero[lane] != 0 ? 1U : 0U) << lane;
  return lanes;
}

float finite_or_zero(float x) {
  return std::isfinite(x) ? x : 0;
}

void draw_out(std::uint32_t lanes, const MuscleTemplate& shape, const EndDrive<Lanes<float>>& end, float tick_s,
              BellyReport<Lanes<float>>& report, float* displacement, float* velocity) {
  const Cells& cells = shape.mesh.cells;
  const float* const rest = shape.kernel.rest_m.data();
  const bool held = shape.options.far_end == FarEnd::held;
  const float far = rest[3 * std::size_t{first_insertion_node(cells)} + 2];
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    const float elongation = held ? finite_or_zero(end.to[lane]) : 0;
    put_row(BellyReport<float>{elongation, 0, 1, 0, 0}, report, lane);
    const float speed = held ? finite_or_zero((end.to[lane] - end.from[lane]) / tick_s) : 0;
    for (std::size_t n = plane_nodes(cells); n < node_count(cells); ++n) {
      const float share = rest[3 * n + 2] / far;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t at = (3 * n + axis) * lane_count + lane;
        displacement[at] = axis == 2 ? share * elongation : 0.0F;
        if (velocity != nullptr) velocity[at] = axis == 2 ? share * speed : 0.0F;
      }
    }
  }
}

}  // namespace

std::uint32_t restart_bellies(const MuscleTemplate& shape, const Rows& rows, const EndDrive<Lanes<float>>& end,
                              float tick_s, BellyReport<Lanes<float>>& report, float* displacement, float* velocity) {
  const std::uint32_t lanes = ill_lanes(report);
  if (lanes == 0) return 0;
  draw_out(lanes, shape, end, tick_s, report, displacement, velocity);
  return count_rows(lanes, rows);
}

std::uint32_t count_rows(std::uint32_t lanes, const Rows& rows) {
  return static_cast<std::uint32_t>(std::popcount(lanes & ((1U << rows.live) - 1U)));
}

}  // namespace mobil::inline v0_3
