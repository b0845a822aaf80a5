#include "demo/lab/gait_fit/excitation_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string_view>

#include <mobil/assets/files/csv_table.h>
#include "assets/muscles/excitation_curves.h"
#include "demo/lab/compare/reference_tables.h"
#include "engine/eigen.h"

namespace mobil {
namespace {

constexpr std::string_view table_name = "bovi2011_emg.csv";

/// The table's classes and their speeds over √(g · leg). It gives speed over height, 0.83 free; the others are the
/// middles of its classes (under 0.6, 0.6 to 0.8, 0.8 to 1, over 1), of the open ones a guess. Height 1.47 m, leg 0.53
/// of it.
struct SpeedClass {
  std::string_view name;
  double heights_per_s;
};
constexpr std::array<SpeedClass, 5> speed_classes = {
    {{"very_slow", 0.5}, {"slow", 0.7}, {"free", 0.83}, {"medium", 0.9}, {"fast", 1.15}}};

double over_leg(double heights_per_s) {
  constexpr double height = 1.47, leg = 0.53 * height;
  return heights_per_s * height / std::sqrt(9.81 * leg);
}

/// One measured point: where, how fast, which row.
struct Point {
  double cycle, speed;
  std::size_t row, speed_class;
};

Eigen::RowVectorXd amounts(const Point& point) {
  Eigen::RowVectorXd row(3 * excitation_terms);
  for (std::size_t i = 0; i < excitation_terms; ++i) {
    const std::size_t harmonic = (i + 1) / 2;
    const double angle = 2 * std::numbers::pi * static_cast<double>(harmonic) * point.cycle;
    const double wave = i % 2 == 1 ? std::cos(angle) : i == 0 ? 1 : std::sin(angle);
    for (int power = 0; power < 3; ++power)
      row[static_cast<Eigen::Index>(3 * i) + power] = wave * std::pow(point.speed, power);
  }
  return row;
}

double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd x = a.array() - a.mean(), y = b.array() - b.mean();
  return x.dot(y) / (x.norm() * y.norm());
}

}  // namespace

Result<ExcitationFit> fit_excitation() {
  const auto tables = reference_tables();
  const auto found = std::ranges::find(tables, table_name, &ReferenceTable::name);
  if (found == tables.end()) return fail(fmt::format("{} is not among the program's tables", table_name));
  constexpr std::array<std::string_view, 2> required = {"task", "percent_gait"};
  const auto table = parse_csv(found->text, table_name, required);
  if (!table) return tl::unexpected(table.error());

  std::vector<Point> points;
  for (std::size_t r = 0; r < table->row.size(); ++r) {
    const auto named = std::ranges::find(speed_classes, cell(*table, r, "task"), &SpeedClass::name);
    const auto percent = number(cell(*table, r, "percent_gait"));
    if (named == speed_classes.end() || !percent) return fail(fmt::format("{}: line {}", table_name, table->line[r]));
    if (*percent >= 100) continue;  // 0 again
    points.push_back(
        {*percent / 100, over_leg(named->heights_per_s), r, static_cast<std::size_t>(named - speed_classes.begin())});
  }
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd design(count, 3 * excitation_terms);
  for (Eigen::Index p = 0; p < count; ++p) design.row(p) = amounts(points[static_cast<std::size_t>(p)]);
  const auto solver = design.colPivHouseholderQr();

  ExcitationFit fit;
  auto to = std::back_inserter(fit.source);
  fmt::format_to(to, "// Written by `mobil fit-gait --excitation --out assets/muscles/excitation_curves.inl`.\n");
  for (std::size_t column = required.size(); column < table->header.size(); ++column) {
    Eigen::VectorXd measured(count);
    for (Eigen::Index p = 0; p < count; ++p) {
      const auto value = number(table->row[points[static_cast<std::size_t>(p)].row][column]);
      if (!value) return fail(fmt::format("{}: a number is missing in {}", table_name, table->header[column]));
      measured[p] = *value;
    }
    const Eigen::VectorXd terms = solver.solve(measured), fitted = design * terms;
    fmt::format_to(to, "{{\"{}\", {{{{\n", table->header[column]);
    for (Eigen::Index i = 0; i < terms.size(); i += 3)
      fmt::format_to(to, "    {{{:.4f}F, {:.4f}F, {:.4f}F}},\n", terms[i], terms[i + 1], terms[i + 2]);
    fmt::format_to(to, "}}}}}},\n");
    fmt::format_to(std::back_inserter(fit.quality), "{:<22}", table->header[column]);
    for (std::size_t c = 0; c < speed_classes.size(); ++c) {
      std::vector<Eigen::Index> of;
      for (Eigen::Index p = 0; p < count; ++p)
        if (points[static_cast<std::size_t>(p)].speed_class == c) of.push_back(p);
      fmt::format_to(std::back_inserter(fit.quality), "  {} r {:.3f}", speed_classes[c].name,
                     correlation(measured(of), fitted(of)));
    }
    fit.quality += '\n';
  }
  return fit;
}

}  // namespace mobil
