#include "demo/lab/paper/paper_cycle.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numbers>
#include <numeric>

#include <mobil/assets/files/csv_table.h>
#include <mobil/engine/geometry.h>
#include <mobil/engine/world.h>
#include <mobil/forces.h>
#include <mobil/renderer.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/render/matrix.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "assets/fem/muscle_template.h"
#include "demo/anatomy/real_figure.h"
#include "demo/lab/compare/compare_walk.h"
#include "demo/lab/compare/reference_tables.h"
#include "demo/program/must.h"
#include "demo/walk/drawn_skin.h"
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

/// Returns the area of the largest section of a mesh, m², at rest if `moved.first` is null. Sections are the mesh's
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
  const double now = largest_section(mesh, plan.scale, nodal_displacement(simulation.world(), muscle));
  return rest_thickness(plan) * std::sqrt(now / largest_section(mesh, plan.scale, {}));
}

void add_rows(const Simulation& simulation, const Person& person, TickRows& rows) {
  const Entity entity = person.entity;
  rows.force.push_back(value(simulation.get<GroundReaction>(entity)->force_n[Side::right].y));
  const auto com = simulation.get<CentreOfMass>(entity)->position_m;
  rows.com_height.push_back(value(com.y));
  rows.com_sideways.push_back(value(com.x));  // walking toward +z
  rows.pelvis.push_back(value(simulation.get<Pose>(entity)->position_m[index(Segment::pelvis)].y));
  rows.knee.push_back(degrees * value(simulation.get<JointAngles>(entity)->knee_flexion[Side::right]));
  rows.muscle.resize(person.muscles.size());
  for (std::size_t m = 0; m < person.muscles.size(); ++m) {
    const MusclePlan& plan = person.muscles[m].plan;
    const auto& muscle = person.muscles[m].entity;
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

PaperCycle sample(const Simulation& simulation, const Person& person, const TickRows& rows) {
  PaperCycle cycle;
  cycle.body = person.body;
  cycle.gait = person.gait;
  cycle.cycle_s = 2 / value(person.gait.step_frequency_hz);
  cycle.stance_s = (0.5 + value(person.gait.double_support_cycle)) * cycle.cycle_s;
  const auto over = [&](const std::vector<double>& values) { return sample_cycle(rows.phase, values); };
  cycle.com_height_m = over(rows.com_height);
  cycle.com_sideways_m = over(rows.com_sideways);
  cycle.pelvis_height_m = over(rows.pelvis);
  cycle.knee_flexion_deg = over(rows.knee);
  cycle.ground_n = sample_cycle(rows.phase, rows.force);
  for (std::size_t m = 0; m < person.muscles.size(); ++m) {
    const MusclePlan& plan = person.muscles[m].plan;
    const Entity muscle = person.muscles[m].entity[Side::right];
    const MuscleRows& own = rows.muscle[m];
    cycle.muscles.push_back({plan, value(simulation.get<LineOfAction>(muscle)->rest_length_m), rest_thickness(plan),
                             over(own.length), over(own.pull), over(own.elongation), over(own.volume),
                             over(own.thickness)});
  }
  return cycle;
}

/// Returns the right leg's edges. Each muscle's right mesh precedes its left one, and all have as many edges.
std::vector<Vec3<float>> right_mesh_edges(const Simulation& simulation, const Person& person) {
  const auto both = mesh_edges(simulation, person);
  std::vector<Vec3<float>> own;
  if (person.muscles.empty()) return own;
  const std::size_t ends = both.size() / (2 * person.muscles.size());
  for (std::size_t first = 0; first < both.size(); first += 2 * ends) {
    own.insert(own.end(), both.begin() + static_cast<long>(first), both.begin() + static_cast<long>(first + ends));
  }
  return own;
}

using namespace geometry;
using capture_math::radians;

constexpr Colour mesh_ink{0.13F, 0.16F, 0.20F};
constexpr float field_deg = 8;  // narrow, so that rows of people look alike

bool in_right_leg(Segment s) {
  return s == Segment::pelvis || (s >= Segment::thigh_right && s <= Segment::toes_right);
}

/// Returns one frame of a walk, ready to be drawn.
WalkRecording part_of(const Actor& actor) {
  const WalkRecording& whole = actor.walk->recording;
  WalkRecording part;
  part.frames = {whole.frames[actor.frame]};
  for (const BoneSurface& bone : whole.bones) {
    const bool drawn =
        actor.bones == Actor::Bones::all || (actor.bones == Actor::Bones::right_leg && in_right_leg(bone.segment));
    if (drawn) part.bones.push_back(bone);
  }
  for (const RecordedMuscle& muscle : whole.muscles) {
    const bool drawn = actor.muscles == Actor::Muscles::both ||
                       (actor.muscles == Actor::Muscles::right && !muscle.name.ends_with("_left"));
    if (drawn) {
      part.muscles.push_back({muscle.name,
                              muscle.segment,
                              muscle.colour,
                              muscle.triangle,
                              {muscle.position_m[actor.frame]},
                              muscle.tissue,
                              muscle.fibres});
    }
  }
  return part;
}

}  // namespace

std::vector<PublishedLength> read_published_lengths(std::string_view walk) {
  const auto tables = reference_tables();
  const auto found = std::ranges::find(tables, lengths_file, &ReferenceTable::name);
  if (found == tables.end())
    throw Stopped(fmt::format("the program was built without assets/reference/{}", lengths_file));
  const auto table = must(parse_csv(found->text, lengths_file, required));
  std::vector<PublishedLength> lengths;
  for (const std::string_view name : length_names) {
    PublishedLength length{std::string(name), {}};
    std::size_t points = 0;
    for (std::size_t r = 0; r < table.row.size(); ++r) {
      if (cell(table, r, "curve") != walk) continue;
      const auto percent = number(cell(table, r, "percent_gait"));
      const auto mean = number(cell(table, r, name));
      if (!percent || !mean || points >= cycle_points || *percent != 2.0 * static_cast<double>(points)) {
        throw Stopped(fmt::format("{} line {}: {} needs every 2 % of the cycle and a number for {}", lengths_file,
                                  table.line[r], walk, name));
      }
      length.curve.mean[points] = *mean;
      length.curve.sd[points] = number(cell(table, r, fmt::format("{}_sd", name))).value_or(0);
      ++points;
    }
    if (points != cycle_points)
      throw Stopped(fmt::format("{}: {} of {} rows of {}", lengths_file, points, cycle_points, walk));
    lengths.push_back(std::move(length));
  }
  return lengths;
}

const MuscleCycle& PaperCycle::muscle(Muscle wanted) const {
  return *std::ranges::find_if(muscles, [wanted](const MuscleCycle& m) { return m.plan.muscle == wanted; });
}

PaperCycle walk_cycle(const CycleRequest& request) {
  SimulationOptions options;
  options.tick_s = cycle_tick_s;
  Simulation simulation(options);
  const auto entity = must(simulation.spawn(request.body, request.gait));
  simulation.enable(entity, Feature::forces);
  if (request.muscles) must(simulation.set_muscles(entity, *request.muscles));
  const Person person = *simulation.person(entity);
  Figure figure;
  if (!request.shown_at.empty())
    figure = must(request.anatomy ? real_figure(person, *request.anatomy, false) : make_figure(person));
  ShownWalk shown{begin_recording(figure, static_cast<float>(cycle_tick_s)), {}};
  TickRows rows;
  std::size_t next = 0;
  over_steady_cycle(simulation, entity, [&](double phase) {
    add_rows(simulation, person, rows);
    rows.phase.push_back(phase);
    for (; next < request.shown_at.size() && phase >= request.shown_at[next]; ++next) {
      record_frame(figure, simulation, person, shown.recording);
      shown.mesh_edge.push_back(right_mesh_edges(simulation, person));
    }
  });
  PaperCycle cycle = sample(simulation, person, rows);
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

Camera camera_at(const Vec3<float>& target, float tall_m, float turn_deg, float rise_deg) {
  const float distance = tall_m / 2 / std::tan(radians(field_deg / 2));
  const float turn = radians(turn_deg), rise = radians(rise_deg);
  Camera camera;
  camera.target = target;
  camera.eye = target + distance * Vec3<float>{-std::cos(turn) * std::cos(rise), std::sin(rise),
                                               std::sin(turn) * std::cos(rise)};
  camera.vertical_fov_deg = field_deg;
  return camera;
}

Vec3<float> across(const Camera& camera) {
  return camera_axes(camera).right;
}

std::vector<Actor> side_by_side(std::span<const PaperCycle> walks, const Camera& camera, float apart_m) {
  std::vector<Actor> actors;
  const float middle = (static_cast<float>(walks.size()) - 1) / 2;
  for (std::size_t i = 0; i < walks.size(); ++i) {
    const float place = apart_m * (static_cast<float>(i) - middle);
    actors.push_back({.walk = &walks[i].shown, .frame = 0, .at = place * across(camera)});
  }
  return actors;
}

Image take_picture(const Stage& stage, std::span<const Actor> actors) {
  auto renderer = must(Renderer::create(stage.width, stage.height));
  RecordedScene drawn;
  std::deque<WalkRecording> part;
  std::vector<Vec3<float>> edges;
  for (const Actor& actor : actors) {
    const WalkRecording& own = part.emplace_back(part_of(actor));
    const Vec3<float> pelvis = own.frames[0].position_m[index(Segment::pelvis)];
    const Vec3<float> shift = actor.at - Vec3<float>{0, 0, pelvis.z};
    add_bones(own, 0, shift, 0, drawn);
    add_muscles(own, 0, shift, drawn);
    if (!actor.mesh) continue;
    for (const auto& p : actor.walk->mesh_edge[actor.frame]) edges.push_back(p + shift);
  }
  std::vector<DrawLines> lines;
  if (!edges.empty()) lines.push_back({.position = edges, .colour = mesh_ink, .width = 1.3F});
  Scene scene;
  scene.camera = stage.camera;
  scene.meshes = drawn.meshes;
  scene.lines = lines;
  scene.light = {-0.55F, 0.80F, 0.45F};
  scene.ground = stage.ground;
  return must(renderer.render(scene));
}

}  // namespace mobil
