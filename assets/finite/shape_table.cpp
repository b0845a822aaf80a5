#include "assets/finite/shape_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "assets/finite/control_points.h"
#include "assets/reduction/dense.h"
#include "assets/reduction/symmetric_eigen.h"
#include "engine/eigen.h"
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::size_t table_terms = shape_amount_count * shape_ratio_terms;

/// Returns the count of numbers of the points before the first that moves, and of those that do.
std::pair<std::size_t, std::size_t> moving_numbers(const Cells& cells) {
  const std::size_t plane = 3 * std::size_t{plane_nodes(cells)};
  return {plane, plane * (cells[2] - 1)};
}

double across_norm(const std::vector<double>& u) {
  double sum = 0;
  for (std::size_t i = 0; i < u.size(); ++i) sum += i % 3 < 2 ? u[i] * u[i] : 0;
  return std::sqrt(sum);
}

}  // namespace

std::vector<std::array<double, shape_amount_count>> body_coefficients(const ShapeTable& table, double ratio) {
  std::vector<std::array<double, shape_amount_count>> rows(table.vector.size());
  double power = 1;
  for (const auto& term : table.coefficient) {
    for (std::size_t v = 0; v < rows.size(); ++v) {
      for (std::size_t f = 0; f < shape_amount_count; ++f) rows[v][f] += power * term[v][f];
    }
    power *= exact::log(ratio);
  }
  return rows;
}

std::vector<double> shape_at(const ShapeTable& table,
                             std::span<const std::array<double, shape_amount_count>> coefficients,
                             const HexahedralMesh& rest, double shortening, double activation) {
  std::vector<double> shape(3 * rest.node.size());
  for (std::size_t n = 0; n < rest.node.size(); ++n) {
    shape[3 * n + 2] = -shortening * (rest.node[n].z - rest.node.front().z);
  }
  const auto amounts = shape_amounts(shortening, activation_root(activation));
  const auto [first, count] = moving_numbers(table.control);
  for (std::size_t v = 0; v < table.vector.size(); ++v) {
    double amount = 0;
    for (std::size_t f = 0; f < shape_amount_count; ++f) amount += coefficients[v][f] * amounts[f];
    for (std::size_t i = 0; i < count; ++i) shape[first + i] += amount * table.vector[v][i];
  }
  return shape;
}

Result<ShapeTable> fit_shape_table(std::span<const ShapeSample> samples, const HexahedralMesh& rest, std::size_t modes,
                                   double along_weight) {
  if (samples.size() <= table_terms) {
    return fail(fmt::format("{} samples do not settle {} coefficients; give more", samples.size(), table_terms));
  }
  if (modes < 1 || modes > table_terms) return fail(fmt::format("{} modes: 1 to {} can be had", modes, table_terms));
  const auto [first, count] = moving_numbers(rest.cells);
  const auto rows = static_cast<Index>(samples.size());
  MatrixXd terms(rows, static_cast<Index>(table_terms)), shapes(rows, static_cast<Index>(count));
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const ShapeSample& sample = samples[s];
    if (sample.displacement_m.size() != 3 * rest.node.size()) {
      return fail(
          fmt::format("sample {} has {} numbers, must have {}", s, sample.displacement_m.size(), 3 * rest.node.size()));
    }
    const auto amounts = shape_amounts(sample.shortening, activation_root(sample.activation));
    double power = 1;
    for (std::size_t t = 0; t < shape_ratio_terms; ++t) {
      for (std::size_t f = 0; f < shape_amount_count; ++f) {
        terms(static_cast<Index>(s), static_cast<Index>(t * shape_amount_count + f)) = power * amounts[f];
      }
      power *= exact::log(sample.ratio);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double height = rest.node[(first + i) / 3].z - rest.node.front().z;
      const double moved = sample.displacement_m[first + i];
      shapes(static_cast<Index>(s), static_cast<Index>(i)) =
          i % 3 == 2 ? along_weight * (moved + sample.shortening * height) : moved;
    }
  }
  const MatrixXd fitted = least_squares(terms, shapes);
  const MatrixXd shown = product(terms, fitted);
  // The first right singular vectors. (Eigen's own decomposition for them takes the compiler 20 s.)
  const MatrixXd most = symmetric_eigen(product(transposed(shown), shown))
                            .vectors.rightCols(static_cast<Index>(modes))
                            .rowwise()
                            .reverse();
  const MatrixXd shares = product(fitted, most);  // terms × modes
  ShapeTable table;
  table.control = rest.cells;
  for (auto& term : table.coefficient) term.resize(modes);
  for (std::size_t v = 0; v < modes; ++v) {
    auto& vector = table.vector.emplace_back(count);
    for (std::size_t i = 0; i < count; ++i) {
      vector[i] = most(static_cast<Index>(i), static_cast<Index>(v)) / (i % 3 == 2 ? along_weight : 1);
    }
    for (std::size_t t = 0; t < shape_ratio_terms; ++t) {
      for (std::size_t f = 0; f < shape_amount_count; ++f) {
        table.coefficient[t][v][f] = shares(static_cast<Index>(t * shape_amount_count + f), static_cast<Index>(v));
      }
    }
  }
  return table;
}

ShapeErrors shape_errors(const ShapeTable& table, const HexahedralMesh& rest, std::span<const ShapeSample> samples) {
  double usual = 0;
  for (const ShapeSample& sample : samples) {
    if (std::abs(std::abs(sample.shortening) - 0.1) < 0.03) usual = std::max(usual, across_norm(sample.displacement_m));
  }
  ShapeErrors errors;
  for (const ShapeSample& sample : samples) {
    const auto shape =
        shape_at(table, body_coefficients(table, sample.ratio), rest, sample.shortening, sample.activation);
    errors.volume = std::max(errors.volume, std::abs(enclosed_volume(rest, shape) - 1));
    std::vector<double> off = shape;
    for (std::size_t i = 0; i < off.size(); ++i) {
      off[i] -= sample.displacement_m[i];
      errors.farthest_m = std::max(errors.farthest_m, std::abs(off[i]));
    }
    const double error = across_norm(off) / std::max(usual, across_norm(sample.displacement_m));
    errors.rms += error * error / static_cast<double>(samples.size());
    errors.worst = std::max(errors.worst, error);
  }
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

}  // namespace mobil::inline v0_3
