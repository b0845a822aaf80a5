#include "demo/lab/frontier/frontier_finite.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include <mobil/muscle_table.h>
#include "assets/fem/axial_stiffness.h"
#include "assets/fem/stiffness_terms.h"
#include "assets/finite/control_points.h"
#include "assets/finite/shape_tables.h"
#include "systems/muscles/belly_library.h"

namespace mobil {
namespace {

constexpr Cells control = {2, 2, 8};
constexpr std::array shortenings = {-0.175, -0.075, 0.075, 0.175};
constexpr std::array activations = {0.02, 0.1, 0.5};

/// Three displacements a control point, m, of a belly shortened and activated so.
using Way = std::function<std::vector<double>(double shortening, double activation)>;

/// Linear statics of the control mesh itself, held sideways as they are by default.
Result<Way> linear(Muscle muscle, const HexahedralMesh& mesh, double poisson, Element element) {
  Material material;
  material.poisson = poisson;
  const auto terms = assemble(mesh, material, element);
  if (!terms) return tl::unexpected(terms.error());
  const double length = mesh.node.back().z - mesh.node.front().z;
  return Way([shape = static_stretch(*terms, 1, 1, foundation_of({}, muscle)).displacement, length](double shortening,
                                                                                                    double) {
    std::vector<double> moved = shape;
    for (double& u : moved) u *= -shortening * length;
    return moved;
  });
}

Way tabled(Muscle muscle, const HexahedralMesh& mesh) {
  return [table = shape_table(muscle), mesh](double shortening, double activation) {
    return shape_at(table, body_coefficients(table, 1), mesh, shortening, activation);
  };
}

double across(const std::vector<double>& u) {
  double sum = 0;
  for (std::size_t i = 0; i < u.size(); ++i) sum += i % 3 < 2 ? u[i] * u[i] : 0;
  return std::sqrt(sum);
}

FiniteError error_of(std::string name, const Way& way, const HexahedralMesh& mesh,
                     const std::vector<ShapeSample>& samples) {
  FiniteError error{std::move(name)};
  for (const ShapeSample& sample : samples) {
    std::vector<double> off = way(sample.shortening, sample.activation);
    error.volume = std::max(error.volume, std::abs(enclosed_volume(mesh, off) - 1));
    for (std::size_t i = 0; i < off.size(); ++i) off[i] -= sample.displacement_m[i];
    for (std::size_t i = 0; i < off.size(); i += 3)
      error.farthest_m = std::max(error.farthest_m, std::hypot(off[i], off[i + 1], off[i + 2]));
    const double part = across(off) / across(sample.displacement_m);
    error.rms += part * part / static_cast<double>(samples.size());
    error.worst = std::max(error.worst, part);
  }
  error.rms = std::sqrt(error.rms);
  return error;
}

/// Means of squares and worst of all muscles.
FiniteFrontier together(const std::vector<FiniteFrontier>& muscles) {
  FiniteFrontier all{"all", {}};
  for (std::size_t w = 0; w < muscles.front().ways.size(); ++w) {
    FiniteError sum{muscles.front().ways[w].way};
    for (const FiniteFrontier& one : muscles) {
      const FiniteError& way = one.ways[w];
      sum.rms += way.rms * way.rms / static_cast<double>(muscles.size());
      sum.worst = std::max(sum.worst, way.worst);
      sum.farthest_m = std::max(sum.farthest_m, way.farthest_m);
      sum.volume = std::max(sum.volume, way.volume);
    }
    sum.rms = std::sqrt(sum.rms);
    all.ways.push_back(sum);
  }
  return all;
}

}  // namespace

Result<std::vector<FiniteFrontier>> measure_finite(void (*progress)(std::string_view what, double part)) {
  std::vector<FiniteFrontier> all;
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    const auto muscle = static_cast<Muscle>(m);
    progress(muscles()[m].name, static_cast<double>(m) / static_cast<double>(muscles().size()));
    const auto samples = shape_samples(sampled_belly(muscle), 1, shortenings, activations);
    if (!samples) return tl::unexpected(samples.error());
    const HexahedralMesh mesh = finite_mesh(muscle, control);
    const auto paper = linear(muscle, mesh, Material{}.poisson, Element::full);
    if (!paper) return tl::unexpected(paper.error());
    const auto stiff = linear(muscle, mesh, 0.49, Element::bbar);
    if (!stiff) return tl::unexpected(stiff.error());
    all.push_back({std::string(muscles()[m].name),
                   {error_of("linear, Poisson's ratio 1/3", *paper, mesh, *samples),
                    error_of("linear, 0.49, B-bar", *stiff, mesh, *samples),
                    error_of("finite shape", tabled(muscle, mesh), mesh, *samples)}});
  }
  all.push_back(together(all));
  return all;
}

std::string finite_text(const std::vector<FiniteFrontier>& muscles) {
  std::string text = fmt::format(
      "81 control points against nonlinear statics on 6x6x24 elements, extrapolated; shortened by -17.5 to 17.5 %,\n"
      "activation 0.02 to 0.5. Displacement across off, of its own: rms and worst; farthest point off; volume off\n\n"
      "{:<27}{:<29}{:>7}{:>8}{:>9}{:>9}\n",
      "muscle", "shown by", "rms", "worst", "mm", "volume");
  for (const FiniteFrontier& one : muscles) {
    for (const FiniteError& way : one.ways) {
      fmt::format_to(std::back_inserter(text), "{:<27}{:<29}{:>5.1f} %{:>6.1f} %{:>9.2f}{:>7.2f} %\n",
                     &way == &one.ways.front() ? one.muscle : "", way.way, 100 * way.rms, 100 * way.worst,
                     1e3 * way.farthest_m, 100 * way.volume);
    }
  }
  return text;
}

std::string finite_csv(const std::vector<FiniteFrontier>& muscles) {
  std::string text = "muscle,way,across_rms,across_worst,farthest_m,volume_off\n";
  for (const FiniteFrontier& one : muscles) {
    for (const FiniteError& way : one.ways) {
      fmt::format_to(std::back_inserter(text), "{},\"{}\",{:.5f},{:.5f},{:.6f},{:.6f}\n", one.muscle, way.way, way.rms,
                     way.worst, way.farthest_m, way.volume);
    }
  }
  return text;
}

}  // namespace mobil
