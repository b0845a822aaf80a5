// Figure 14: the hamstrings' mesh at three moments of the cycle, with the force of the line of action as input and the
// displacement as output. Figure 15: muscle lengths over the gait cycle, compared with published lengths.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include <mobil/engine/world.h>
#include <mobil/muscle_table.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "assets/fem/muscle_template.h"
#include "demo/lab/compare/compare_judge.h"
#include "demo/lab/compare/compare_reference.h"
#include "demo/lab/compare/compare_walk.h"
#include "demo/lab/paper/paper.h"
#include "demo/pictures/cycle_plot.h"

namespace mobil {
namespace {

using namespace geometry;

constexpr double step_s = 0.001, sample_s = 0.005;
constexpr const char *input_colour = "#c1762c", *output_colour = "#2f6db3", *mesh_colour = "#8c2b22",
                     *back_colour = "#e3c9c5", *rest_colour = "#222";
constexpr double panel_width = 290, panel_height = 120, panel_mm = 390;  // across a panel

struct Row {
  double percent, time_s, pull_n, displacement_mm;
  std::vector<Vec3<double>> node;  // where they are, m, muscle frame
};

/// Nodes at rest in `rest`, m; nodes around the far face in `far_outline`, with the first again at the end.
struct Mesh {
  std::vector<Quad> boundary;
  std::vector<Vec3<double>> rest;
  std::vector<std::uint32_t> far_outline;
};

struct Moment {
  char name;
  const char* what;
  std::size_t row;
};

std::vector<Vec3<double>> places(const HexahedralMesh& mesh, const BellyScale<float>& scale) {
  const double across = static_cast<double>(scale.across), along = static_cast<double>(scale.along);
  std::vector<Vec3<double>> at;
  for (const auto& node : mesh.node) at.push_back({across * node.x, across * node.y, along * node.z});
  return at;
}

Mesh mesh_at_rest(const HexahedralMesh& mesh, const BellyScale<float>& scale) {
  Mesh own{boundary_quads(mesh.cells), places(mesh, scale), {}};
  const auto [nx, ny, nz] = mesh.cells;
  for (std::uint32_t i = 0; i < nx; ++i) own.far_outline.push_back(node_index(mesh.cells, i, 0, nz));
  for (std::uint32_t j = 0; j < ny; ++j) own.far_outline.push_back(node_index(mesh.cells, nx, j, nz));
  for (std::uint32_t i = nx; i > 0; --i) own.far_outline.push_back(node_index(mesh.cells, i, ny, nz));
  for (std::uint32_t j = ny + 1; j-- > 0;) own.far_outline.push_back(node_index(mesh.cells, 0, j, nz));
  return own;
}

/// Returns the row of the node in the middle of the far face, and of the whole mesh.
Row row_now(const Simulation& simulation, Entity muscle, const BellyScale<float>& scale, double phase) {
  const auto& mesh = simulation.world().shared<MuscleTemplate>(muscle)->mesh;
  const NodalView moved = nodal_displacement(simulation.world(), muscle);
  const auto u = [&](std::uint32_t node, std::size_t axis) {
    return static_cast<double>(moved.first[(3 * std::size_t{node} + axis) * lane_count]);
  };
  Row row{100 * phase,
          simulation.time_s(),
          -static_cast<double>(simulation.get<LineOfAction>(muscle)->force_n),
          millimetres * u(insertion_centre(mesh.cells).front(), 2),
          {}};
  row.node = places(mesh, scale);
  for (std::uint32_t n = 0; n < node_count(mesh.cells); ++n) {
    row.node[n] = row.node[n] + Vec3<double>{u(n, 0), u(n, 1), u(n, 2)};
  }
  return row;
}

/// Returns the longest, the shortest, and the moment half-way between them, in order of time.
std::vector<Moment> moments_of(const std::vector<Row>& rows) {
  const auto ends = std::ranges::minmax_element(rows, {}, &Row::displacement_mm);
  const auto first = std::min(ends.min, ends.max), last = std::max(ends.min, ends.max);
  const double middle = (ends.min->displacement_mm + ends.max->displacement_mm) / 2;
  const auto between = std::ranges::min_element(
      first, last, {}, [middle](const Row& row) { return std::abs(row.displacement_mm - middle); });
  const auto what = [&](auto at) { return at == ends.min ? "shortest" : at == ends.max ? "longest" : "half-way"; };
  std::vector<Moment> moments;
  for (const auto at : {first, between, last}) {
    moments.push_back({"ABC"[moments.size()], what(at), static_cast<std::size_t>(at - rows.begin())});
  }
  return moments;
}

/// A view from the side of the leg, somewhat from the front and above; right and up in mm.
struct View {
  Vec3<double> viewer = normalised(Vec3<double>{-1, 0.35, -0.30});
  Vec3<double> along = normalised(cross(Vec3<double>{0, 1, 0}, viewer)), up = cross(viewer, along);

  void add(const Vec3<double>& p, PlotLine& line) const {
    line.x.push_back(millimetres * dot(p, along));
    line.y.push_back(millimetres * dot(p, up));
  }
  bool faced(const Quad& quad, const std::vector<Vec3<double>>& node) const {
    return dot(cross(node[quad[2]] - node[quad[0]], node[quad[3]] - node[quad[1]]), viewer) > 0;
  }
};

void break_line(PlotLine& line) {
  line.x.push_back(std::numeric_limits<double>::quiet_NaN());
  line.y.push_back(std::numeric_limits<double>::quiet_NaN());
}

/// Adds the far face's outline at rest and the edges of the boundary. Edges of faces turned to the viewer are above the
/// others.
void draw_mesh(const Mesh& mesh, const std::vector<Vec3<double>>& node, PlotPanel& panel) {
  const View view;
  PlotLine rest{{}, {}, rest_colour, "far end at rest", 1.5, true}, front{{}, {}, mesh_colour, "", 0.8, false},
      back{{}, {}, back_colour, "", 0.5, false};
  for (const std::uint32_t n : mesh.far_outline) view.add(mesh.rest[n], rest);
  for (const Quad& quad : mesh.boundary) {
    PlotLine& line = view.faced(quad, node) ? front : back;
    for (std::size_t i = 0; i <= 4; ++i) view.add(node[quad[i % 4]], line);
    break_line(line);
  }
  panel.lines.push_back(std::move(back));
  panel.lines.push_back(std::move(front));
  panel.lines.push_back(std::move(rest));
}

/// Returns the mean of the lowest and the highest node at rest, mm.
double middle_height(const Mesh& mesh) {
  PlotLine all;
  for (const auto& p : mesh.rest) View{}.add(p, all);
  const auto [low, high] = std::ranges::minmax(all.y);
  return (low + high) / 2;
}

PlotPanel curve_panel(const std::vector<Row>& rows, double Row::*quantity, const Moment& moment, const char* colour,
                      std::string title, std::string unit) {
  PlotPanel panel;
  panel.title = std::move(title);
  panel.x = {"", 0, 100};
  panel.y.label = std::move(unit);
  PlotLine all{{}, {}, colour, "", 0.7, true}, until{{}, {}, colour, "", 2, false};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    all.x.push_back(rows[i].percent);
    all.y.push_back(rows[i].*quantity);
    if (i > moment.row) continue;
    until.x.push_back(rows[i].percent);
    until.y.push_back(rows[i].*quantity);
  }
  const auto [low, high] = std::ranges::minmax(all.y);
  panel.y.low = low - 0.1 * (high - low);
  panel.y.high = high + 0.25 * (high - low);  // room for the points' names
  panel.lines = {std::move(all), std::move(until)};
  const Row& now = rows[moment.row];
  panel.points.push_back({{now.percent}, {now.*quantity}, {std::string(1, moment.name)}, "#111", ""});
  return panel;
}

PlotFigure figure_of(const std::vector<Row>& rows, const Mesh& mesh, const std::vector<Moment>& moments) {
  PlotFigure figure{"Hamstrings at three moments of the gait cycle: 525 nodes, 320 hexahedra, CAA, steps of 1 ms",
                    "1.80 m, 80 kg, 5 km/h. The far end is pulled by the spring force of the line of action.", 3,
                    panel_width, panel_height};
  for (const Moment& moment : moments) {
    const Row& now = rows[moment.row];
    const bool top = moment.name == 'A', bottom = moment.name == 'C';
    PlotPanel input = curve_panel(rows, &Row::pull_n, moment, input_colour,
                                  top ? "Input: force of the line of action" : "", "pull (N)");
    PlotPanel output = curve_panel(rows, &Row::displacement_mm, moment, output_colour,
                                   top ? "Output: displacement of the far end" : "", "along the line (mm)");
    PlotPanel shape;
    shape.title = fmt::format("{}: {:.0f} % of the cycle, {}", moment.name, now.percent, moment.what);
    draw_mesh(mesh, now.node, shape);
    const double middle = middle_height(mesh), half = panel_mm * panel_height / panel_width / 2;
    shape.x = {bottom ? "mm" : "", -0.05 * panel_mm, 0.95 * panel_mm};
    shape.y = {"mm", middle - half, middle + half};
    if (bottom) input.x.label = output.x.label = "% of the gait cycle";
    figure.panels.push_back(std::move(input));
    figure.panels.push_back(std::move(shape));
    figure.panels.push_back(std::move(output));
  }
  return figure;
}

std::string csv_of(const std::vector<Row>& rows) {
  std::string text = "percent_gait,time_s,pull_n,displacement_mm\n";
  for (const Row& row : rows) {
    fmt::format_to(std::back_inserter(text), "{:.4f},{:.6f},{:.6f},{:.6f}\n", row.percent, row.time_s, row.pull_n,
                   row.displacement_mm);
  }
  return text;
}

/// A published length, and our muscles whose mean length is compared with it.
struct Compared {
  std::string_view published, title;
  std::array<std::string_view, 3> ours;
};
constexpr std::array compared = {
    Compared{"hamstrings", "hamstrings", {"semimembranosus", "semitendinosus", "biceps_femoris_long_head"}},
    Compared{"rectus_femoris", "rectus femoris", {"rectus_femoris"}},
    Compared{"gastrocnemius", "gastrocnemius", {"gastrocnemius_medial", "gastrocnemius_lateral"}},
    Compared{"soleus", "soleus", {"soleus"}},
    Compared{"tibialis_anterior", "tibialis anterior", {"tibialis_anterior"}}};

struct Walk {
  std::string published, title;
  PaperCycle ours;
  std::vector<PublishedLength> theirs;
};

Walk walk_at(double speed_m_s, std::string published, std::string title) {
  CycleRequest request{paper_body(), paper_gait(), only({}), {}, {}};
  request.muscles->cells = {2, 2, 2};  // only their lines are used
  request.gait.speed_m_s = static_cast<float>(speed_m_s);
  for (const Compared& what : compared) {
    for (const std::string_view name : what.ours) {
      if (const auto muscle = find_muscle(name)) request.muscles->muscles.set(static_cast<std::size_t>(*muscle));
    }
  }
  auto ours = walk_cycle(request);
  auto theirs = read_published_lengths(published);
  return Walk{std::move(published), fmt::format("{}, {:.2f} m/s", title, speed_m_s), std::move(ours),
              std::move(theirs)};
}

/// Returns the mean of the muscles' lengths, each relative to its own in the anatomical position.
CycleCurve our_length(const PaperCycle& walk, const Compared& what) {
  CycleCurve sum{};
  double count = 0;
  for (const std::string_view name : what.ours) {
    const auto muscle = find_muscle(name);
    if (!muscle) continue;
    const MuscleCycle& own = walk.muscle(*muscle);
    for (std::size_t i = 0; i < cycle_points; ++i) sum[i] += own.length_m[i] / own.rest_length_m;
    ++count;
  }
  for (double& v : sum) v /= count;
  return sum;
}

struct Agreement {
  std::string published, walk, muscle;
  CycleCurve ours;
  const MeasuredCurve* theirs;
  bool has_band;

  double rms() const { return rms_distance(ours, theirs->mean); }
  double alike() const { return correlation(ours, theirs->mean); }
  double inside() const {
    const CurvePair pair{&ours, theirs};
    return inside_bands({&pair, 1});
  }
};

Agreement agreement(const Walk& walk, std::size_t muscle) {
  const MeasuredCurve& theirs = walk.theirs[muscle].curve;
  return {walk.published, walk.title,      std::string(compared[muscle].title), our_length(walk.ours, compared[muscle]),
          &theirs,        theirs.sd[0] > 0};
}

PlotPanel panel_of(const Agreement& pair) {
  PlotPanel panel = cycle_panel(fmt::format("{}: {}", pair.muscle, pair.walk), "length / anatomical");
  const std::string name = "gait2392 on measured angles";
  if (pair.has_band) {
    add_measured(panel, *pair.theirs, name, first_colour, false);
  } else {
    panel.lines.push_back({cycle_percents(), cycle_values(pair.theirs->mean), second_colour,
                           "gait2392 on OpenSim's normal gait", 1.4, true});
  }
  panel.lines.push_back({cycle_percents(), cycle_values(pair.ours), ours_colour, "mobil", 1.8, false});
  return panel;
}

PaperTable table_of(const std::vector<Agreement>& pairs) {
  PaperTable table{"muscle and walk",
                   {{"rms_percent", "rms\n%", 2},
                    {"correlation", "correlation", 3},
                    {"inside_band_percent", "inside\n± 1 SD, %", 0},
                    {"shortest_ours", "shortest\nours", 3},
                    {"shortest_published", "published", 3},
                    {"longest_ours", "longest\nours", 3},
                    {"longest_published", "published", 3}},
                   {}};
  for (const Agreement& pair : pairs) {
    const CycleRange ours = range_of(pair.ours), theirs = range_of(pair.theirs->mean);
    table.row.push_back({fmt::format("{}: {}", pair.muscle, pair.walk),
                         {100 * pair.rms(), pair.alike(), pair.has_band ? 100 * pair.inside() : NAN, ours.low,
                          theirs.low, ours.high, theirs.high}});
  }
  return table;
}

std::string csv_of(const std::vector<Agreement>& pairs) {
  std::string text = "muscle,curve,percent_gait,ours,published,published_sd\n";
  for (const Agreement& pair : pairs) {
    for (std::size_t i = 0; i < cycle_points; ++i) {
      text += fmt::format("{},{},{},{:.5f},{:.5f},{}\n", pair.muscle, pair.published, 2 * i, pair.ours[i],
                          pair.theirs->mean[i], pair.has_band ? fmt::format("{:.5f}", pair.theirs->sd[i]) : "");
    }
  }
  return text;
}

}  // namespace

void paper_figure14(PaperRun& run) {
  SimulationOptions options;
  options.tick_s = sample_s;
  Simulation simulation(options);
  const auto entity = must(simulation.spawn(paper_body(), paper_gait()));
  LegMuscles choice = only({Muscle::hamstrings});
  choice.drive = Drive::force;
  choice.method = Method::newmark;
  choice.cells = paper_mesh;
  choice.dt_s = step_s;
  must(simulation.set_muscles(entity, choice));
  const Entity muscle = simulation.muscle(entity, Muscle::hamstrings, Side::right);
  const BellyScale<float> scale = simulation.person(entity)->muscles.front().plan.scale;
  std::vector<Row> rows;
  over_steady_cycle(simulation, entity, [&](double phase) {
    if (phase >= 0 && phase <= 1) rows.push_back(row_now(simulation, muscle, scale, phase));
  });
  const auto moments = moments_of(rows);
  PaperTable table{"moment", {{"", "% of\ncycle", 0}, {"", "pull\nN", 2}, {"", "displacement\nmm", 1}}, {}};
  for (const Moment& moment : moments) {
    const Row& row = rows[moment.row];
    table.row.push_back(
        {fmt::format("{}, {}", moment.name, moment.what), {row.percent, row.pull_n, row.displacement_mm}});
  }
  const auto [low, high] = std::ranges::minmax_element(rows, {}, &Row::pull_n);
  run.text =
      table_text(table) + fmt::format(
                              "\nForces of {:.1f} to {:.1f} N move the far end by {:.1f} mm from the shortest to the "
                              "longest.\n",
                              low->pull_n, high->pull_n,
                              std::abs(rows[moments[0].row].displacement_mm - rows[moments[2].row].displacement_mm));
  run.write_csv(csv_of(rows));
  run.write(figure_of(rows, mesh_at_rest(simulation.world().shared<MuscleTemplate>(muscle)->mesh, scale), moments));
}

void paper_figure15(PaperRun& run) {
  const auto reference = must(read_gait_reference({}));
  const auto body = must(make_body(paper_body()));
  const MeasuredSet& people = reference.sets.front();
  std::vector<Walk> walks;
  for (std::size_t c = compared_class::slow; c <= compared_class::fast; ++c) {
    run.progress("walking", static_cast<double>(c - compared_class::slow) / 4);
    const std::string name(compared_class_name[c]);
    walks.push_back(walk_at(people.speed_m_s(c, static_cast<double>(body.hip_height_m)), "schwartz_" + name, name));
  }
  walks.push_back(walk_at(static_cast<double>(paper_speed_m_s), "opensim_normal_gait", "OpenSim"));

  std::vector<Agreement> pairs;
  pairs.reserve(walks.size() * compared.size());
  for (const Walk& walk : walks) pairs.push_back(agreement(walk, 0));
  for (std::size_t speed = 0; speed + 1 < walks.size(); ++speed) {
    for (std::size_t m = 1; m < compared.size(); ++m) pairs.push_back(agreement(walks[speed], m));
  }

  PlotFigure figure{"Muscle lengths over the gait cycle, 1.80 m and 80 kg",
                    "Bands: gait2392 (Delp et al. 1990) on angles of Schwartz et al. 2008, their ± 1 SD carried over. "
                    "Hamstrings: mean of semimembranosus, semitendinosus and the long head of biceps femoris.",
                    4, 215, 150};
  for (const Agreement& pair : pairs) figure.panels.push_back(panel_of(pair));
  for (std::size_t i = 0; i < walks.size(); ++i) {  // one scale for all hamstrings
    figure.panels[i].y.low = 0.92;
    figure.panels[i].y.high = 1.14;
  }
  const auto worst = std::ranges::max_element(pairs.begin(), pairs.begin() + 3, {}, &Agreement::rms);
  const auto unlike = std::ranges::min_element(pairs, {}, &Agreement::alike);
  run.text = table_text(table_of(pairs)) +
             fmt::format(
                 "\nThe hamstrings' length at three speeds is within {:.1f} % rms of the published one, with "
                 "correlations of {:.3f}, {:.3f} and {:.3f},\nand {:.0f}, {:.0f} and {:.0f} % of the cycle inside its "
                 "band.\nLeast alike of all: {} ({}), with a correlation of {:.3f}.\n",
                 100 * worst->rms(), pairs[0].alike(), pairs[1].alike(), pairs[2].alike(), 100 * pairs[0].inside(),
                 100 * pairs[1].inside(), 100 * pairs[2].inside(), unlike->muscle, unlike->walk, unlike->alike());
  run.write_csv(csv_of(pairs));
  run.write(figure);
}

}  // namespace mobil
