#include "demo/lab/gait_fit/excitation_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string_view>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/files/csv_table.h>
#include <mobil/components/activation.h>
#include <mobil/muscle_table.h>
#include <mobil/simulation.h>
#include "assets/muscles/excitation_curves.h"
#include "demo/lab/compare/reference_tables.h"
#include "demo/program/must.h"
#include "demo/program/progress.h"
#include "engine/eigen.h"

namespace mobil {
namespace {

constexpr std::string_view table_name = "bovi2011_emg.csv";

/// Speed classes of the table, in heights per second. The table gives 0.83 for `free`; the others are the middles of
/// its classes (under 0.6, 0.6 to 0.8, 0.8 to 1, over 1), estimated for the open ones. `over_leg` converts to √(g ·
/// leg), with a height of 1.47 m and a leg of 0.53 of it.
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

/// One measured point: place in the cycle, speed and row.
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

using Terms = Eigen::VectorXd;

/// Writes a curve as source.
void put(std::string& to, std::string_view name, const Terms& terms) {
  fmt::format_to(std::back_inserter(to), "{{\"{}\", {{{{\n", name);
  for (Eigen::Index i = 0; i < terms.size(); i += 3) {
    fmt::format_to(std::back_inserter(to), "    {{{:.4f}F, {:.4f}F, {:.4f}F}},\n", terms[i], terms[i + 1],
                   terms[i + 2]);
  }
  to += "}}},\n";
}

/// Fits the columns of the table of measured envelopes.
void fit_measured(ExcitationFit& fit) {
  const auto tables = reference_tables();
  const auto found = std::ranges::find(tables, table_name, &ReferenceTable::name);
  if (found == tables.end()) throw Stopped(fmt::format("{} is not among the program's tables", table_name));
  constexpr std::array<std::string_view, 2> required = {"task", "percent_gait"};
  const auto table = must(parse_csv(found->text, table_name, required));

  std::vector<Point> points;
  for (std::size_t r = 0; r < table.row.size(); ++r) {
    const auto named = std::ranges::find(speed_classes, cell(table, r, "task"), &SpeedClass::name);
    const auto percent = number(cell(table, r, "percent_gait"));
    if (named == speed_classes.end() || !percent) throw Stopped(fmt::format("{}: line {}", table_name, table.line[r]));
    if (*percent >= 100) continue;  // 0 again
    points.push_back(
        {*percent / 100, over_leg(named->heights_per_s), r, static_cast<std::size_t>(named - speed_classes.begin())});
  }
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd design(count, 3 * excitation_terms);
  for (Eigen::Index p = 0; p < count; ++p) design.row(p) = amounts(points[static_cast<std::size_t>(p)]);
  const auto solver = design.colPivHouseholderQr();

  for (std::size_t column = required.size(); column < table.header.size(); ++column) {
    Eigen::VectorXd measured(count);
    for (Eigen::Index p = 0; p < count; ++p) {
      const auto value = number(table.row[points[static_cast<std::size_t>(p)].row][column]);
      if (!value) throw Stopped(fmt::format("{}: a number is missing in {}", table_name, table.header[column]));
      measured[p] = *value;
    }
    const Eigen::VectorXd terms = solver.solve(measured), fitted = design * terms;
    put(fit.source, table.header[column], terms);
    fmt::format_to(std::back_inserter(fit.quality), "{:<22}", table.header[column]);
    for (std::size_t c = 0; c < speed_classes.size(); ++c) {
      std::vector<Eigen::Index> of;
      for (Eigen::Index p = 0; p < count; ++p)
        if (points[static_cast<std::size_t>(p)].speed_class == c) of.push_back(p);
      fmt::format_to(std::back_inserter(fit.quality), "  {} r {:.3f}", speed_classes[c].name,
                     correlation(measured(of), fitted(of)));
    }
    fit.quality += '\n';
  }
}

/// Excitations of a walk: a row for each tick, a column for each line.
struct SharedWalk {
  std::vector<Point> point;
  std::vector<std::vector<double>> excitation;
};

void add_walk(double speed, std::size_t number, SharedWalk& walk) {
  constexpr int settling = 300, ticks = 600;
  Simulation simulation({.tick_s = 1.0 / 120});
  const double leg_m = fraction::hip_height * reference_body_height_m;
  const Entity person = must(simulation.spawn(
      {.height_m = static_cast<float>(reference_body_height_m), .mass_kg = static_cast<float>(reference_body_mass_kg)},
      {.speed_m_s = static_cast<float>(speed * std::sqrt(9.81 * leg_m))}));
  LegMuscles choice;
  choice.method = Method::none;
  choice.muscles = muscle_members();
  choice.activation = ExcitationSource::moments;
  must(simulation.enable(person, Feature::forces));
  must(simulation.set_muscles(person, choice));
  for (int tick = 0; tick < settling + ticks; ++tick) {
    simulation.tick();
    if (tick < settling) continue;
    walk.point.push_back({double{(*simulation.get<Feet>(person)).phase[Side::right]}, speed, 0, number});
    std::vector<double>& row = walk.excitation.emplace_back();
    for (const MemberMuscle& line : member_muscles()) {
      const Entity muscle = simulation.muscle(person, muscle_of_line(line), Side::right);
      row.push_back(double{(*simulation.get<Activation>(muscle)).excitation});
    }
  }
}

/// Fits the lines whose excitation is not measured.
void fit_shared(ExcitationFit& fit) {
  constexpr std::array<double, 5> speeds = {0.27, 0.355, 0.44, 0.525, 0.61};
  SharedWalk walk;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    show_part("walk", static_cast<double>(i) / speeds.size());
    add_walk(speeds[i], i, walk);
  }
  show("");
  const auto count = static_cast<Eigen::Index>(walk.point.size());
  Eigen::MatrixXd design(count, 3 * excitation_terms);
  for (Eigen::Index p = 0; p < count; ++p) design.row(p) = amounts(walk.point[static_cast<std::size_t>(p)]);
  const auto solver = design.colPivHouseholderQr();
  const auto lines = member_muscles();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (is_measured(lines[i])) continue;
    Eigen::VectorXd shared(count);
    for (Eigen::Index p = 0; p < count; ++p) {
      shared[p] = walk.excitation[static_cast<std::size_t>(p)][i] / double{excitation_scale};
    }
    const Terms terms = solver.solve(shared);
    put(fit.source, lines[i].name, terms);
    fmt::format_to(std::back_inserter(fit.quality), "{:<26} shared r {:.3f}\n", lines[i].name,
                   correlation(shared, design * terms));
  }
}

}  // namespace

ExcitationFit fit_excitation() {
  ExcitationFit fit;
  fit.source = "// Written by `mobil fit-gait --excitation --out assets/muscles/excitation_curves.inl`.\n";
  fit_measured(fit);
  fit_shared(fit);
  return fit;
}

}  // namespace mobil
