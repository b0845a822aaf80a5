#include "demo/lab/compare/compare_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <system_error>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/assets/files/csv_table.h>
#include "demo/lab/compare/reference_tables.h"
#include "demo/program/must.h"

namespace mobil {
namespace {

namespace fs = std::filesystem;

/// Columns of a quantity in a set's tables.
struct CurveColumn {
  std::size_t file;
  std::string_view mean, sd;
};

/// Differences between the tables of sets. Quantities without a file were not measured.
struct SetLayout {
  std::array<std::string_view, 3> file;  // angles, ground reaction, moments
  std::string_view class_column;
  std::array<std::string_view, speed_class_count> class_name;  // empty: not measured
  std::array<CurveColumn, gait_quantity_count> column;
};

constexpr SetLayout schwartz_layout = {{"schwartz2008_angles", "schwartz2008_grf", "schwartz2008_moments_powers"},
                                       "speed_class",
                                       {"very_slow", "slow", "free", "fast", "very_fast"},
                                       {{{0, "hip_flexion_deg", "hip_flexion_sd"},
                                         {0, "knee_flexion_deg", "knee_flexion_sd"},
                                         {0, "ankle_dorsiflexion_deg", "ankle_dorsiflexion_sd"},
                                         {1, "vertical_BW", "vertical_sd"},
                                         {1, "foreaft_BW", "foreaft_sd"},
                                         {2, "hip_extensor_Nm_kg", "hip_moment_sd"},
                                         {2, "knee_extensor_Nm_kg", "knee_moment_sd"},
                                         {2, "ankle_plantarflexor_Nm_kg", "ankle_moment_sd"}}}};
constexpr SetLayout pinzone_layout = {
    {"pinzone2014", "", "pinzone2014"}, "speed_class", {"", "", "free", "", ""}, schwartz_layout.column};
constexpr SetLayout winter_layout = {{"winter_joint_angles", "winter_grf", "winter_joint_moments"},
                                     "cadence_class",
                                     {"", "slow", "natural", "fast", ""},
                                     {{{0, "hip_flexion_deg", "hip_sd"},
                                       {0, "knee_flexion_deg", "knee_sd"},
                                       {0, "ankle_dorsiflexion_deg", "ankle_sd"},
                                       {1, "vertical_BW", "vertical_sd"},
                                       {1, "foreaft_BW", "foreaft_sd"},
                                       {2, "hip_extensor_Nm_kg", "hip_sd"},
                                       {2, "knee_extensor_Nm_kg", "knee_sd"},
                                       {2, "ankle_plantarflexor_Nm_kg", "ankle_sd"}}}};

constexpr std::string_view schwartz_steps = "schwartz2008_spatiotemporal";
constexpr std::string_view winter_speeds = "com_vertical_excursion_computed.csv";

/// Leg lengths of the people measured, m. That of Schwartz's children is estimated from their mean age of 10.5 years
/// (0.71 to 0.77 would change their moments by 4 %). That of Winter's and
/// Orendurff's adults belongs to a height of 1.75 m.
constexpr double children_leg_m = 0.74, adults_leg_m = 1.75 * fraction::hip_height;
/// Pinzone's first centre: mean leg length and speed over √(g · leg length) of 81 children of 5 to 17 years.
constexpr double pinzone_leg_m = 0.750, pinzone_speed = 0.431, pinzone_max_age_y = 17;

/// Returns the table of a class of a set. The slowest and the fastest of Schwartz were published separately.
std::string table_name(std::string_view file, std::size_t speed_class) {
  const bool extreme = speed_class == compared_class::very_slow || speed_class == compared_class::very_fast;
  return fmt::format("{}{}.csv", file, extreme ? "_extremes" : "");
}

/// Tables of the folder, or the built-in ones of the same name.
class Tables {
 public:
  explicit Tables(const std::optional<fs::path>& folder) : folder_(folder) {}

  bool in_folder(std::string_view name) const {
    std::error_code ignored;
    return folder_ && fs::is_regular_file(*folder_ / name, ignored);
  }
  CsvTable read(std::string_view name, std::span<const std::string_view> required) const {
    if (in_folder(name)) return must(read_csv((*folder_ / name).string(), required));
    for (const auto& table : reference_tables()) {
      if (table.name == name) return must(parse_csv(table.text, name, required));
    }
    throw Stopped(fmt::format("{} is missing in {}; put the table there, or leave --reference out", name,
                              folder_ ? folder_->string() : "the program"));
  }

 private:
  std::optional<fs::path> folder_;
};

/// Returns a cell that must be a number.
double value(const CsvTable& table, std::size_t row, std::string_view name) {
  if (const auto read = number(number_cell(table, row, name))) return *read;
  throw Stopped(
      fmt::format("{}:{}: {} '{}' is not a number", table.path, table.line[row], name, cell(table, row, name)));
}

CycleCurve read_curve(const CsvTable& table, std::span<const std::size_t> rows, std::string_view name) {
  CycleCurve curve{};
  for (std::size_t i = 0; i < cycle_points; ++i) curve[i] = value(table, rows[i], name);
  return curve;
}

/// Returns the rows of one class, one each 2 % of the cycle.
std::vector<std::size_t> rows_of_class(const CsvTable& table, std::string_view column_name,
                                       std::string_view class_name) {
  std::vector<std::size_t> rows;
  for (std::size_t r = 0; r < table.row.size(); ++r) {
    if (cell(table, r, column_name) == class_name) rows.push_back(r);
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (number(number_cell(table, rows[i], "percent_gait")) != 2.0 * static_cast<double>(i)) rows.clear();
  }
  if (rows.size() == cycle_points) return rows;
  throw Stopped(fmt::format("{}: {} {} needs the {} rows of percent_gait 0, 2, … 100 in order", table.path, column_name,
                            class_name, cycle_points));
}

void read_curves(const Tables& tables, const SetLayout& layout, MeasuredSet& set) {
  for (std::size_t f = 0; f < layout.file.size(); ++f) {
    if (layout.file[f].empty()) continue;
    std::vector<std::string_view> required = {layout.class_column, "percent_gait"};
    for (const auto& column : layout.column) {
      if (column.file == f) required.insert(required.end(), {column.mean, column.sd});
    }
    for (std::size_t c = 0; c < speed_class_count; ++c) {
      if (layout.class_name[c].empty()) continue;
      const auto table = tables.read(table_name(layout.file[f], c), required);
      const auto rows = rows_of_class(table, layout.class_column, layout.class_name[c]);
      for (std::size_t q = 0; q < gait_quantity_count; ++q) {
        if (layout.column[q].file != f) continue;
        set.measured[c][q] = true;
        set.curve[c][q] = {read_curve(table, rows, layout.column[q].mean),
                           read_curve(table, rows, layout.column[q].sd)};
      }
    }
  }
}

void read_schwartz_pelvis(const Tables& tables, MeasuredSet& set) {
  constexpr std::array<std::string_view, 3> names = {"pelvis_tilt_anterior_deg", "pelvis_rotation_forward_deg",
                                                     "pelvis_obliquity_up_deg"};
  const std::array<std::string_view, 5> required = {"speed_class", "percent_gait", names[0], names[1], names[2]};
  for (std::size_t c = 0; c < speed_class_count; ++c) {
    const auto table = tables.read(table_name(schwartz_layout.file[0], c), required);
    const auto rows = rows_of_class(table, "speed_class", schwartz_layout.class_name[c]);
    std::array<CycleCurve, 3> curve;
    for (std::size_t i = 0; i < names.size(); ++i) curve[i] = read_curve(table, rows, names[i]);
    const auto half_range = [](const CycleCurve& of) {
      const auto [low, high] = std::ranges::minmax(of);
      return 0.5 * (high - low);
    };
    set.pelvis_tilt_deg[c] = std::accumulate(curve[0].begin(), curve[0].end() - 1, 0.0) / (cycle_points - 1);
    set.pelvis_rotation_deg[c] = half_range(curve[1]);
    set.pelvis_list_deg[c] = half_range(curve[2]);
  }
}

template <std::size_t N>
std::array<double, N> row_values(const CsvTable& table, std::size_t row, const std::array<std::string_view, N>& names) {
  std::array<double, N> values{};
  for (std::size_t i = 0; i < N; ++i) values[i] = value(table, row, names[i]);
  return values;
}

/// Returns the numbers of the row that has `key` in `key_column`.
template <std::size_t N>
std::array<double, N> row_values(const CsvTable& table, std::string_view key_column, std::string_view key,
                                 const std::array<std::string_view, N>& names) {
  for (std::size_t r = 0; r < table.row.size(); ++r) {
    if (cell(table, r, key_column) == key) return row_values(table, r, names);
  }
  throw Stopped(fmt::format("{}: a row with {} {} is missing", table.path, key_column, key));
}

/// Reads Schwartz's speeds, and his steps as a band. Leg lengths become heights with the leg of a generated body.
void read_schwartz_steps(const Tables& tables, MeasuredSet& set, StepBand& band) {
  constexpr std::array<std::string_view, 6> names = {"speed_dimless",   "step_length_per_leg", "step_length_sd",
                                                     "cadence_dimless", "cadence_sd",          "opposite_foot_off_pct"};
  const std::array<std::string_view, 7> required = {"speed_class", names[0], names[1], names[2],
                                                    names[3],      names[4], names[5]};
  constexpr double leg = fraction::hip_height;
  const double root = std::sqrt(leg);
  for (std::size_t c = 0; c < speed_class_count; ++c) {
    const auto table = tables.read(table_name(schwartz_steps, c), required);
    const auto v = row_values(table, "speed_class", schwartz_layout.class_name[c], names);
    set.speed[c] = v[0];
    set.step_length[c] = v[1];
    set.double_support[c] = 0.01 * v[5];
    band.norm.push_back({v[0] * root, v[1] * leg, v[2] * leg, v[3] / root, v[4] / root});
  }
}

void read_lencioni_steps(const Tables& tables, std::vector<StepBand>& bands) {
  constexpr std::array<std::string_view, 5> names = {"speed_dimless", "step_length_per_height", "step_length_sd",
                                                     "cadence_dimless", "cadence_sd"};
  constexpr std::array<std::string_view, 6> required = {"group", names[0], names[1], names[2], names[3], names[4]};
  const auto table = tables.read("lencioni2019_steps.csv", required);
  for (const std::string_view group : {"adults", "children"}) {
    StepBand band{fmt::format("Lencioni 2019, {}", group), {}};
    for (std::size_t r = 0; r < table.row.size(); ++r) {
      if (cell(table, r, "group") != group) continue;
      const auto v = row_values(table, r, names);
      band.norm.push_back({v[0], v[1], v[2], v[3], v[4]});
    }
    std::ranges::sort(band.norm, {}, &StepNorm::speed);
    bands.push_back(std::move(band));
  }
}

std::vector<ExcursionNorm> read_excursion(const Tables& tables) {
  constexpr std::array<std::string_view, 3> names = {"speed_m_s", "vertical_excursion_m", "vertical_excursion_sd"};
  const auto table = tables.read("centre_of_mass_excursion.csv", names);
  std::vector<ExcursionNorm> norms;
  for (std::size_t r = 0; r < table.row.size(); ++r) {
    const auto v = row_values(table, r, names);
    norms.push_back({v[0], v[1], v[2]});
  }
  std::ranges::sort(norms, {}, &ExcursionNorm::speed_m_s);
  return norms;
}

MeasuredSet read_pinzone(const Tables& tables) {
  MeasuredSet set{.name = "Pinzone 2014", .hip_from_vertical = false, .leg_m = pinzone_leg_m};
  set.max_age_y = pinzone_max_age_y;
  set.speed[compared_class::free] = pinzone_speed;
  read_curves(tables, pinzone_layout, set);
  return set;
}

MeasuredSet read_winter(const Tables& tables) {
  MeasuredSet set{.name = "Winter 1991", .hip_from_vertical = true, .leg_m = adults_leg_m};
  constexpr std::array<std::string_view, 1> speed = {"speed_m_s"};
  const std::array<std::string_view, 2> required = {"source", "speed_m_s"};
  const auto table = tables.read(winter_speeds, required);
  for (std::size_t c = 0; c < speed_class_count; ++c) {
    if (winter_layout.class_name[c].empty()) continue;
    const auto v = row_values(table, "source", fmt::format("winter_{}", winter_layout.class_name[c]), speed);
    set.speed[c] = v[0] / std::sqrt(gravity_m_s2 * set.leg_m);
  }
  read_curves(tables, winter_layout, set);
  return set;
}

/// Throws Stopped for a folder that contains none of the tables.
void check_folder(const Tables& tables, const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw Stopped(
        fmt::format("--reference {}: no such folder; name one with tables of measured walking", folder.string()));
  }
  std::vector<std::string> names;
  for (const auto& file : winter_layout.file) names.push_back(table_name(file, compared_class::slow));
  for (const auto& table : reference_tables()) names.emplace_back(table.name);
  if (std::ranges::any_of(names, [&](std::string_view name) { return tables.in_folder(name); })) return;
  throw Stopped(
      fmt::format("--reference {}: holds none of the tables, such as {}; leave the option out for those that "
                  "the program carries",
                  folder.string(), names[0]));
}

}  // namespace

bool MeasuredSet::has_class(std::size_t speed_class) const {
  return std::ranges::find(measured[speed_class], true) != measured[speed_class].end();
}

double MeasuredSet::speed_m_s(std::size_t speed_class, double person_leg_m) const {
  return speed[speed_class] * std::sqrt(gravity_m_s2 * person_leg_m);
}

MeasuredCurve MeasuredSet::scaled(std::size_t speed_class, GaitQuantity quantity, double person_leg_m) const {
  MeasuredCurve scaled = curve[speed_class][index(quantity)];
  if (!is_moment(quantity)) return scaled;
  for (double& v : scaled.mean) v *= person_leg_m / leg_m;
  for (double& v : scaled.sd) v *= person_leg_m / leg_m;
  return scaled;
}

std::optional<StepNorm> StepBand::at(double speed) const {
  for (std::size_t i = 0; i + 1 < norm.size(); ++i) {
    const StepNorm &a = norm[i], &b = norm[i + 1];
    if (speed < a.speed || speed > b.speed) continue;
    const double t = (speed - a.speed) / (b.speed - a.speed);
    const auto mix = [t](double from, double to) { return from + t * (to - from); };
    return StepNorm{speed, mix(a.length, b.length), mix(a.length_sd, b.length_sd), mix(a.cadence, b.cadence),
                    mix(a.cadence_sd, b.cadence_sd)};
  }
  return std::nullopt;
}

Result<GaitReference> read_gait_reference(const std::optional<fs::path>& folder, double age_y) {
  return attempt([&] {
    const Tables tables(folder);
    if (folder) check_folder(tables, *folder);
    GaitReference reference;
    MeasuredSet set{.name = "Schwartz 2008", .hip_from_vertical = false, .leg_m = children_leg_m};
    StepBand band{"Schwartz 2008, children", {}};
    read_schwartz_steps(tables, set, band);
    read_curves(tables, schwartz_layout, set);
    read_schwartz_pelvis(tables, set);
    reference.sets.push_back(std::move(set));
    reference.sets.push_back(read_pinzone(tables));
    std::erase_if(reference.sets, [&](const MeasuredSet& of) { return age_y > of.max_age_y; });
    read_lencioni_steps(tables, reference.steps);
    reference.steps.push_back(std::move(band));
    reference.excursion = read_excursion(tables);
    reference.excursion_leg_m = adults_leg_m;
    if (tables.in_folder(table_name(winter_layout.file[0], compared_class::slow))) {
      reference.sets.push_back(read_winter(tables));
    } else {
      reference.note =
          "Winter's tables are not here (they may not be redistributed; --reference DIR reads them): the band is "
          "Schwartz's alone";
    }
    return reference;
  });
}

}  // namespace mobil
