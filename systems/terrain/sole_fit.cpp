#include "systems/terrain/sole_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mobil::inline v0_3 {
namespace {

/// Minimum height of an edge, m. Lower ones count as rough ground.
constexpr float edge_m = 0.025F;
/// Cost of a move by one place, relative to a place of sole that reaches over an edge.
constexpr float of_moving = 0.15F;
/// Step length, relative to height, up to which a foot can move by more than one place: legs reach no further.
constexpr float short_step_h = 0.27F;

using G = SoleGround;
using Edges = std::array<bool, G::places - 1>;  // between each place and the next

/// Cost of an edge just ahead of the toes. It equals that of one just behind them: the next step begins under it.
constexpr float of_edge_ahead = 0.5F;

/// Returns how much of a sole whose heel is at that place reaches over edges, in places.
float overhang(const Edges& edge, std::size_t heel) {
  float over = 0;
  for (std::size_t i = heel; i + 1 < heel + G::under; ++i) {
    const float behind = static_cast<float>(i - heel) + 0.5F;
    if (edge[i]) over += std::min(behind, static_cast<float>(G::under - 1) - behind);
  }
  const std::size_t toes = heel + G::under - 1;
  if (edge[toes]) over += of_edge_ahead;
  return over;
}

/// Returns the fit of a sole whose heel is at that place.
SoleFit fit_at(const SoleGround& ground, std::size_t heel, float height_m) {
  SoleFit fit;
  fit.place = heel + G::ankle - G::moves;
  const float moved_h = (static_cast<float>(heel) - static_cast<float>(G::moves)) * G::apart_h;
  fit.ahead_m = moved_h * height_m;
  const auto plane_m = [&](float ahead_h) {
    return ground.height_m[fit.place] + (ahead_h - G::ahead_h(fit.place)) * height_m * ground.rise[fit.place];
  };
  float raised_m = 0;
  for (std::size_t i = heel; i < heel + G::under; ++i)
    raised_m = std::max(raised_m, ground.height_m[i] - plane_m(G::ahead_h(i)));
  fit.height_m = plane_m(moved_h) + raised_m;
  return fit;
}

}  // namespace

SoleFit fit_sole(const SoleGround& ground, float height_m, float step_length_m) {
  const float apart_m = G::apart_h * height_m;
  Edges edge;
  for (std::size_t i = 0; i + 1 < G::places; ++i) {
    const float along = 0.5F * apart_m * (ground.rise[i] + ground.rise[i + 1]);
    edge[i] = std::fabs(ground.height_m[i + 1] - ground.height_m[i] - along) > edge_m;
  }
  const SoleFit unmoved = fit_at(ground, G::moves, height_m);
  SoleFit best = unmoved;
  float least = std::numeric_limits<float>::max();
  const std::size_t most = step_length_m < short_step_h * height_m ? G::moves : 1;
  for (std::size_t heel = G::moves - most; heel <= G::moves + most; ++heel) {
    const SoleFit fit = fit_at(ground, heel, height_m);
    // The foot stays on the same stair. Otherwise the next step would have two to climb.
    if (std::fabs(fit.height_m - unmoved.height_m - fit.ahead_m * ground.rise[unmoved.place]) > edge_m) continue;
    const float moved = static_cast<float>(heel) - static_cast<float>(G::moves);
    const float cost = overhang(edge, heel) + of_moving * std::fabs(moved);
    if (cost < least) least = cost, best = fit;
  }
  return best;
}

}  // namespace mobil::inline v0_3
