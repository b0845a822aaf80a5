#include "demo/lab/paper/paper_cycle.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include <mobil/assets/files/csv_table.h>
#include <mobil/forces.h>
#include "assets/fem/muscle_template.h"
#include "demo/anatomy/real_figure.h"
#include "demo/lab/compare/compare_walk.h"
#include "demo/lab/compare/reference_tables.h"
#include "demo/walk/walk_lines.h"

namespace mobil {
namespace {

constexpr std::string_view lengths_file = "muscle_lengths.csv";
constexpr std::array<std::string_view, 5> length_names = {"hamstrings", "rectus_femoris", "gastrocnemius", "soleus",
                                                          "tibialis_anterior"};
constexpr std::array<std::string_view, 2> required = {"curve", "percent_gait"};

constexpr double cycle_tick_s = 1.0 / 240;
constexpr double degrees = 180 / std::numbers::pi;

double value(float v) {
  return static_cast<double>(v);
}

struct MuscleRows {
  std::vector<double> length, pull, elongation, volume, thickness;
};

struct TickRows {
  std::vector<double> phase, com_height, com_sideways, pelvis, knee;
  std::vector<double> force;
  std::vector<MuscleRows> muscle;
};

/// Area of the largest section of a mesh, m²; `moved` is at rest where its `first` is null. Sections are the mesh's
/// planes of nodes, seen along z.
double largest_section(const HexahedralMesh& mesh, const BellyScale<float>& scale, const NodalView& moved) {
  const auto place = [&](std::uint32_t n) {
    const float* u = moved.first == nullptr ? nullptr : moved.first + std::size_t{3} * n * lane_count;
    const double across = value(scale.across);
    return std::array{across * mesh.node[n].x + (u == nullptr ? 0 : value(u[0])),
                      across * mesh.node[n].y + (u == nullptr ? 0 : value(u[lane_count]))};
  };
  const auto quads = insertion_quads(mesh.cells);  // in the last plane
  double largest = 0;
  for (std::uint32_t plane = 0; plane <= mesh.cells[2]; ++plane) {
    const std::uint32_t below = (mesh.cells[2] - plane) * plane_nodes(mesh.cells);
    double area = 0;
    for (const Quad& quad : quads) {
      const auto a = place(quad[0] - below), b = place(quad[1] - below), c = place(quad[2] - below),
                 d = place(quad[3] - below);
      area += ((c[0] - a[0]) * (d[1] - b[1]) - (c[1] - a[1]) * (d[0] - b[0])) / 2;
    }
    largest = std::max(largest, std::abs(area));
  }
  return largest;
}

double rest_thickness(const MusclePlan& plan) {
  return 2 * std::sqrt(plan.volume_m3 / plan.belly_length_m / std::numbers::pi);
}

double thickness(const Simulation& simulation, const MusclePlan& plan, Entity muscle) {
  const auto& mesh = simulation.world().shared<MuscleTemplate>(muscle)->mesh;
  const double now = largest_section(mesh, plan.scale, simulation.nodal_displacement(muscle));
  return rest_thickness(plan) * std::sqrt(now / largest_section(mesh, plan.scale, {}));
}

void add_rows(const Simulation& simulation, const Human& human, TickRows& rows) {
  const Entity entity = human.entity;
  rows.force.push_back(value(simulation.get<GroundReaction>(entity)->force_n[Side::right].y));
  const auto com = simulation.get<CentreOfMass>(entity)->position_m;
  rows.com_height.push_back(value(com.y));
  rows.com_sideways.push_back(value(com.x));  // walking toward +z
  rows.pelvis.push_back(value(simulation.get<Pose>(entity)->position_m[index(Segment::pelvis)].y));
  rows.knee.push_back(degrees * value(simulation.get<JointAngles>(entity)->knee_flexion[Side::right]));
  rows.muscle.resize(human.muscles.size());
  for (std::size_t m = 0; m < human.muscles.size(); ++m) {
    const MusclePlan& plan = human.muscles[m].plan;
    const auto& muscle = human.muscles[m].entity;
    const auto line = *simulation.get<LineOfAction>(muscle[Side::right]);
    const auto belly = *simulation.get<BellyReport>(muscle[Side::right]);
    MuscleRows& own = rows.muscle[m];
    own.length.push_back(value(line.length_m));
    own.pull.push_back(-value(line.force_n));
    own.elongation.push_back(value(belly.elongation_m));
    own.volume.push_back(value(belly.volume_ratio));
    own.thickness.push_back(thickness(simulation, plan, muscle[Side::right]));
  }
}

PaperCycle sample(const Simulation& simulation, const Human& human, const TickRows& rows) {
  PaperCycle cycle;
  cycle.body = human.body;
  cycle.gait = human.gait;
  cycle.cycle_s = 2 / value(human.gait.step_frequency_hz);
  cycle.stance_s = (0.5 + value(human.gait.double_support_cycle)) * cycle.cycle_s;
  const auto over = [&](const std::vector<double>& values) { return sample_cycle(rows.phase, values); };
  cycle.com_height_m = over(rows.com_height);
  cycle.com_sideways_m = over(rows.com_sideways);
  cycle.pelvis_height_m = over(rows.pelvis);
  cycle.knee_flexion_deg = over(rows.knee);
  cycle.ground_n = sample_cycle(rows.phase, rows.force);
  for (std::size_t m = 0; m < human.muscles.size(); ++m) {
    const MusclePlan& plan = human.muscles[m].plan;
    const Entity muscle = human.muscles[m].entity[Side::right];
    const MuscleRows& own = rows.muscle[m];
    cycle.muscles.push_back({plan, value(simulation.get<LineOfAction>(muscle)->rest_length_m), rest_thickness(plan),
                             over(own.length), over(own.pull), over(own.elongation), over(own.volume),
                             over(own.thickness)});
  }
  return cycle;
}

/// Those of the right leg: every muscle's right mesh comes before its left one, and all have as many edges.
std::vector<Vec3<float>> right_mesh_edges(const Simulation& simulation, const Human& human) {
  const auto both = mesh_edges(simulation, human);
  std::vector<Vec3<float>> own;
  if (human.muscles.empty()) return own;
  const std::size_t ends = both.size() / (2 * human.muscles.size());
  for (std::size_t first = 0; first < both.size(); first += 2 * ends) {
    own.insert(own.end(), both.begin() + static_cast<long>(first), both.begin() + static_cast<long>(first + ends));
  }
  return own;
}

}  // namespace

Result<std::vector<PublishedLength>> read_published_lengths(std::string_view walk) {
  const auto tables = reference_tables();
  const auto found = std::ranges::find(tables, lengths_file, &ReferenceTable::name);
  if (found == tables.end())
    return fail(fmt::format("the program was built without assets/reference/{}", lengths_file));
  const auto table = parse_csv(found->text, lengths_file, required);
  if (!table) return tl::unexpected(table.error());
  std::vector<PublishedLength> lengths;
  for (const std::string_view name : length_names) {
    PublishedLength length{std::string(name), {}};
    std::size_t points = 0;
    for (std::size_t r = 0; r < table->row.size(); ++r) {
      if (cell(*table, r, "curve") != walk) continue;
      const auto percent = number(cell(*table, r, "percent_gait"));
      const auto mean = number(cell(*table, r, name));
      if (!percent || !mean || points >= cycle_points || *percent != 2.0 * static_cast<double>(points)) {
        return fail(fmt::format("{} line {}: {} needs every 2 % of the cycle and a number for {}", lengths_file,
                                table->line[r], walk, name));
      }
      length.curve.mean[points] = *mean;
      length.curve.sd[points] = number(cell(*table, r, fmt::format("{}_sd", name))).value_or(0);
      ++points;
    }
    if (points != cycle_points)
      return fail(fmt::format("{}: {} of {} rows of {}", lengths_file, points, cycle_points, walk));
    lengths.push_back(std::move(length));
  }
  return lengths;
}

const MuscleCycle& PaperCycle::muscle(Muscle wanted) const {
  return *std::ranges::find_if(muscles, [wanted](const MuscleCycle& m) { return m.plan.muscle == wanted; });
}

Result<PaperCycle> walk_cycle(const CycleRequest& request) {
  SimulationOptions options;
  options.tick_s = cycle_tick_s;
  Simulation simulation(options);
  const auto entity = simulation.spawn(request.body, request.gait);
  if (!entity) return tl::unexpected(entity.error());
  simulation.add_forces(*entity);
  if (request.muscles) {
    if (auto added = simulation.add_leg_muscles(*entity, *request.muscles); !added) {
      return tl::unexpected(added.error());
    }
  }
  const Human human = *simulation.human(*entity);
  Figure figure;
  if (!request.shown_at.empty()) {
    auto made = request.anatomy ? real_figure(human, *request.anatomy, false) : make_figure(human);
    if (!made) return tl::unexpected(made.error());
    figure = std::move(*made);
  }
  ShownWalk shown{begin_recording(figure, static_cast<float>(cycle_tick_s)), {}};
  TickRows rows;
  std::size_t next = 0;
  const auto walked = over_steady_cycle(simulation, *entity, [&](double phase) {
    add_rows(simulation, human, rows);
    rows.phase.push_back(phase);
    for (; next < request.shown_at.size() && phase >= request.shown_at[next]; ++next) {
      record_frame(figure, simulation, human, shown.recording);
      shown.mesh_edge.push_back(right_mesh_edges(simulation, human));
    }
  });
  if (!walked) return tl::unexpected(walked.error());
  PaperCycle cycle = sample(simulation, human, rows);
  cycle.shown = std::move(shown);
  return cycle;
}

CycleRange range_of(const CycleCurve& curve) {
  const auto [low, high] = std::ranges::minmax_element(curve);
  const auto percent = [&](auto at) { return 100.0 * static_cast<double>(at - curve.begin()) / (cycle_points - 1); };
  return {*low, *high, percent(low), percent(high)};
}

double mean_of(const CycleCurve& curve) {
  return std::accumulate(curve.begin(), curve.end() - 1, 0.0) / (cycle_points - 1);
}

}  // namespace mobil
