#include "assets/finite/shape_samples.h"

#include <algorithm>
#include <utility>

#include "assets/finite/control_points.h"

namespace mobil::inline v0_3 {
namespace {

/// A mesh's shapes as control points, with volume not yet kept.
struct ProjectedShapes {
  ControlMesh points;
  std::vector<FiniteState> shapes;  // displacement: of control points
};

Result<ProjectedShapes> projected_shapes(const SampledBelly& belly, const HexahedralMesh& mesh, double ratio,
                                         std::span<const double> shortenings, std::span<const double> activations) {
  auto made = make_finite_belly(scaled(mesh, BellyScale<double>{ratio, 1}), belly.tissue, belly.foundation_hz);
  if (!made) return tl::unexpected(made.error());
  auto points = make_control_mesh(*made, belly.control);
  if (!points) return tl::unexpected(points.error());
  auto shapes = static_shapes(*made, shortenings, activations);
  if (!shapes) return tl::unexpected(shapes.error());
  for (FiniteState& shape : *shapes) shape.displacement_m = nearest_points(*points, shape.displacement_m);
  return ProjectedShapes{std::move(*points), std::move(*shapes)};
}

}  // namespace

Result<std::vector<FiniteState>> static_shapes(const FiniteBelly& belly, std::span<const double> shortenings,
                                               std::span<const double> activations) {
  std::vector<FiniteState> shapes(shortenings.size() * activations.size());
  FiniteScratch scratch = make_scratch(belly);
  FiniteState unstrained = state_at_rest(belly);
  const auto lengthened =
      static_cast<std::size_t>(std::lower_bound(shortenings.begin(), shortenings.end(), 0.0) - shortenings.begin());
  for (std::size_t a = 0; a < activations.size(); ++a) {
    if (auto ok = settle(belly, scratch, unstrained, 0, activations[a]); !ok) return tl::unexpected(ok.error());
    const auto follow = [&](FiniteState& state, std::size_t e) -> Result<void> {
      if (auto ok = settle(belly, scratch, state, shortenings[e], activations[a]); !ok) return ok;
      shapes[a * shortenings.size() + e] = state;
      return {};
    };
    FiniteState state = unstrained;
    for (std::size_t e = lengthened; e < shortenings.size(); ++e) {
      if (auto ok = follow(state, e); !ok) return tl::unexpected(ok.error());
    }
    state = unstrained;
    for (std::size_t e = lengthened; e-- > 0;) {
      if (auto ok = follow(state, e); !ok) return tl::unexpected(ok.error());
    }
  }
  return shapes;
}

Result<std::vector<ShapeSample>> shape_samples(const SampledBelly& belly, double ratio,
                                               std::span<const double> shortenings,
                                               std::span<const double> activations) {
  const double n = belly.coarse.cells[2], m = belly.fine.cells[2];
  if (!(m > n)) return fail("the fine mesh needs more elements along than the coarse one");
  const auto coarse = projected_shapes(belly, belly.coarse, ratio, shortenings, activations);
  if (!coarse) return tl::unexpected(coarse.error());
  const auto fine = projected_shapes(belly, belly.fine, ratio, shortenings, activations);
  if (!fine) return tl::unexpected(fine.error());
  const double beyond = 1 / (m * m / (n * n) - 1);
  std::vector<ShapeSample> samples;
  for (std::size_t s = 0; s < fine->shapes.size(); ++s) {
    const FiniteState& shape = fine->shapes[s];
    ShapeSample sample{shape.shortening, shape.activation, ratio, shape.displacement_m};
    for (std::size_t i = 0; i < sample.displacement_m.size(); ++i) {
      sample.displacement_m[i] += beyond * (shape.displacement_m[i] - coarse->shapes[s].displacement_m[i]);
    }
    if (auto ok = keep_volume(fine->points, sample.displacement_m); !ok) return tl::unexpected(ok.error());
    for (std::size_t i = 0; i < sample.displacement_m.size(); ++i) {
      if (i % 3 < 2) sample.displacement_m[i] /= ratio;
    }
    samples.push_back(std::move(sample));
  }
  return samples;
}

}  // namespace mobil::inline v0_3
