#include "demo/walk/walk_command.h"
#include "demo/program/console.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/export/recorded_skin.h>
#include <mobil/assets/files/output_file.h>
#include <mobil/body_composition.h>
#include <mobil/components/activation.h>
#include <mobil/components/fat.h>
#include <mobil/components/step_plan.h>
#include <mobil/engine/world.h>
#include <mobil/pose_writer.h>
#include <mobil/schedule.h>
#include <mobil/systems/gait/shown_fat.h>
#include <mobil/systems/limits/limit_monitor.h>
#include <mobil/systems/limits/style_limits.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/terrain.h>
#include "demo/program/commands.h"
#include "demo/program/progress.h"
#include "demo/walk/drawn_skin.h"
#include "demo/walk/figure.h"
#include "demo/walk/gait_parameters.h"
#include "demo/walk/walk_export.h"
#include "demo/walk/walk_lines.h"
#include "demo/walk/walk_options.h"
#include "demo/walk/walk_pictures.h"
#include "demo/walk/walk_script.h"
#include "demo/walk/walk_summary.h"
#include "demo/walk/walk_tables.h"

namespace mobil {
namespace {

constexpr Vec3<float> ivory{0.80F, 0.74F, 0.60F};  // linear, the writers' colour of bones
constexpr int ticks_per_frame = 2;                 // 30 pictures per second

using SteadyClock = std::chrono::steady_clock;
double seconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

struct Walked {
  MotionTable motion;
  MuscleTable muscles;
  WalkRecording recording, ticks;  // pictures with surfaces; poses and forces of all ticks, if exported
  std::vector<std::vector<Vec3<float>>> action_line, mesh_edge;
  std::vector<FatBeside> fat;
  WalkOutcome outcome;
};

MotionRow motion_row(const Simulation& simulation, Entity entity) {
  return {simulation.time_s(), simulation.get<GaitState>(entity)->heading_rad, *simulation.get<JointAngles>(entity),
          *simulation.get<Feet>(entity), *simulation.get<CentreOfMass>(entity)};
}

/// Returns a person's forces, or nullopt if they are not simulated.
std::optional<WalkForces> walk_forces(const Simulation& simulation, Entity entity) {
  const auto ground = simulation.get<GroundReaction>(entity);
  const auto moments = simulation.get<JointMoments>(entity);
  if (!ground || !moments) return std::nullopt;
  WalkForces forces{*ground, *moments};
  if (const auto reserve = simulation.get<MomentReserve>(entity)) forces.reserve = *reserve;
  return forces;
}

void add_muscle_rows(const Simulation& simulation, const Person& person, std::string_view method, MuscleTable& table) {
  for (const Side side : {Side::right, Side::left}) {
    for (const PersonMuscle& own : person.muscles) {
      const Entity muscle = own.entity[side];
      const auto belly = simulation.get<BellyReport>(muscle);
      MuscleTableRow row{simulation.time_s(),
                         side,
                         own.plan.muscle,
                         method,
                         *simulation.get<LineOfAction>(muscle),
                         *simulation.get<LineMotion>(muscle),
                         belly ? std::optional(*belly) : std::nullopt,
                         {},
                         {}};
      if (table.pulls) {
        row.activation = *simulation.get<Activation>(muscle);
        row.pull = *simulation.get<Musculotendon>(muscle);
      }
      table.add(row);
    }
  }
}

/// Prints one line for each corrected parameter of a requested style, and adds it to `all`.
void tell_style_changes(const BodyRequest& body, const GaitRequest& asked, std::vector<StyleChange>& all) {
  const auto changes = style_changes(body, asked);
  if (!changes) return;
  for (const StyleChange& change : *changes) print_error("note: {}", described(change));
  all.insert(all.end(), changes->begin(), changes->end());
}

/// Records the limit violations of this tick.
void note_limits(const Simulation& simulation, Entity person, std::vector<LimitPassed>& passed) {
  for (const LimitViolation& broken : limit_violations(simulation.world(), person)) {
    auto known = std::ranges::find(passed, broken.bound, [](const LimitPassed& limit) { return limit.furthest.bound; });
    if (known == passed.end()) known = passed.insert(known, {broken, simulation.time_s(), 0, 0});
    if (broken.value > known->furthest.value) known->furthest = broken;
    known->last_s = simulation.time_s();
    ++known->ticks;
  }
}
void tell_limits(const std::vector<LimitPassed>& passed) {
  for (const LimitPassed& limit : passed)
    print_error("note: in {} ticks from {:.2f} s to {:.2f} s {}", limit.ticks, limit.first_s, limit.last_s,
                described(limit.furthest));
}

/// Applies the changes that are due. Errors name the script's line.
Result<void> apply_changes(const std::vector<ScriptedChange>& changes, const std::string& script, Entity entity,
                           Simulation& simulation, WalkOutcome& outcome) {
  std::size_t& applied = outcome.changes;
  const double due = simulation.time_s() + 1e-9;
  for (; applied < changes.size() && changes[applied].time_s <= due; ++applied) {
    const ScriptedChange& change = changes[applied];
    if (change.gait) {
      const auto done = simulation.set_gait(entity, *change.gait);
      if (!done) return fail(fmt::format("--script {} line {}: {}", script, change.line, done.error().message));
      tell_style_changes(simulation.person(entity)->body.request, *change.gait, outcome.style_changes);
    }
    if (change.heading_rad) {
      const auto done = simulation.turn_to(entity, *change.heading_rad);
      if (!done) return fail(fmt::format("--script {} line {}: {}", script, change.line, done.error().message));
    }
    if (change.aside_m) {
      const auto done = simulation.step_aside(entity, change.aside_m->first, change.aside_m->second);
      if (!done) return fail(fmt::format("--script {} line {}: {}", script, change.line, done.error().message));
    }
  }
  return {};
}

/// Begins a recording of every tick.
WalkRecording begin_ticks(const Simulation& simulation, const Person& person) {
  WalkRecording ticks;
  ticks.frame_s = simulation.tick_s();
  ticks.start_s = simulation.time_s() + simulation.tick_s();
  ticks.tip_m.assign(person.body.tip_m.begin(), person.body.tip_m.end());
  return ticks;
}

/// Records the poses around the coming tick.
Result<void> record_around(const Simulation& simulation, Entity entity, PoseWriter& writer, WalkRecording& ticks) {
  std::array<Pose<float>, 2> around;
  const double differences_s[2] = {-motion_difference_s, motion_difference_s};
  for (std::size_t i = 0; i < around.size(); ++i) {
    struct PlaceAndTurn {
      Vec3<float> position_m;
      Quat<float> rotation;
    };
    std::array<PlaceAndTurn, segment_count> written;
    auto done = writer.write(simulation.world(), {&entity, 1}, simulation.tick_s() + differences_s[i], {},
                             {std::as_writable_bytes(std::span(written))});
    if (!done) return done;
    for (std::size_t s = 0; s < segment_count; ++s) {
      around[i].position_m[s] = written[s].position_m;
      around[i].rotation[s] = written[s].rotation;
    }
  }
  ticks.around.push_back(around);
  return {};
}

Result<void> record_tick(const Simulation& simulation, Entity entity, WalkRecording& ticks) {
  ticks.frames.push_back(*simulation.get<Pose>(entity));
  if (const auto ground = simulation.get<GroundReaction>(entity)) ticks.ground.push_back(*ground);
  return record_root(simulation, entity, ticks.root);
}

/// Returns the standing skin, with the anatomy's own skin of the legs if it has one.
Result<DrawnSkin> own_legs(const BodySkin& skin, const Body& body, const Figure& figure) {
  DrawnSkin standing{&skin};
  if (figure.skins.empty()) return standing;
  if (auto done = standing.follow(body, figure.skins, figure.rest_m, true); !done) return tl::unexpected(done.error());
  standing.pose(skin.standing, legs_at_rest(figure.rest_m));
  return standing;
}

/// Adds skin and clothes to a recording.
void record_skin(const DrawnSkin& drawn, WalkRecording& recording) {
  recording.skin = recorded_skin(*drawn.skin, 1, drawn.own ? &*drawn.own : nullptr);
  if (drawn.own)
    recording.skin.push_back(
        recorded_custom_skin(*drawn.bare, *drawn.own, drawn.own_position, drawn.own_normal, 1 + skin_parts));
  recording.colours = {ivory};
  for (const Colour& colour : skin_colours(0)) recording.colours.push_back(linear_colour(colour));
  recording.colours.push_back(recording.colours[1]);  // of the custom skin
}

Result<Walked> walk(Simulation& simulation, const Person& person, const Figure& figure, const WalkOptions& options,
                    const WalkTiming& timing, const std::vector<ScriptedChange>& changes) {
  Walked walked{MotionTable(options.muscles.activation == ExcitationSource::moments),
                MuscleTable(has_activation(options.muscles)),
                {},
                {},
                {},
                {},
                {},
                {}};
  WalkOutcome& outcome = walked.outcome;
  outcome.gait = person.gait;
  outcome.anatomy_said = figure.said;
  tell_style_changes(options.body, options.gait, outcome.style_changes);
  walked.recording = begin_recording(figure, ticks_per_frame * simulation.tick_s());
  const Pose<float> standing = standing_pose(person.body);
  std::ranges::copy(standing.position_m, walked.recording.standing_m.begin());
  std::optional<BodySkin> skin;
  DrawnSkin drawn;
  if (options.skin) {
    auto made = make_body_skin(person.body, SkinDetail::near);
    if (!made) return tl::unexpected(made.error());
    skin = std::move(*made);
    auto own = own_legs(*skin, person.body, figure);
    if (!own) return tl::unexpected(own.error());
    drawn = std::move(*own);
    record_skin(drawn, walked.recording);
  }
  simulation.tick(timing.warm_up_ticks);
  walked.recording.facts =
      recorded_facts(person.body.request, person.gait, simulation.get<GaitState>(person.entity)->heading_rad);
  walked.ticks = begin_ticks(simulation, person);
  walked.ticks.standing_m = walked.recording.standing_m;
  const bool all_ticks = std::ranges::any_of(options.exports, of_every_tick);
  const bool velocities = std::ranges::any_of(options.exports, &needs_velocities);
  PoseWriter writer;
  const std::string method = method_label(options.muscles);
  simulation.schedule().reset_timings();
  std::uint32_t steps_before = simulation.get<GaitState>(person.entity)->steps;
  for (std::uint32_t i = 0; i < timing.ticks; ++i) {
    if (options.script) {
      auto done = apply_changes(changes, options.script->path, person.entity, simulation, outcome);
      if (!done) return tl::unexpected(done.error());
    }
    if (velocities) {
      if (auto done = record_around(simulation, person.entity, writer, walked.ticks); !done)
        return tl::unexpected(done.error());
    }
    const auto start = SteadyClock::now();
    simulation.tick();
    outcome.simulation_s += seconds_since(start);
    const std::uint32_t steps = simulation.get<GaitState>(person.entity)->steps;
    if (steps != steps_before) outcome.clamped_steps += simulation.get<StepPlan>(person.entity)->clamped;
    steps_before = steps;
    note_limits(simulation, person.entity, outcome.limits_passed);
    walked.motion.add(motion_row(simulation, person.entity), walk_forces(simulation, person.entity));
    add_muscle_rows(simulation, person, method, walked.muscles);
    if (all_ticks) {
      if (auto done = record_tick(simulation, person.entity, walked.ticks); !done) return tl::unexpected(done.error());
    }
    if (i % ticks_per_frame == 0) {
      show_progress("walking", i + std::size_t{1}, timing.ticks);
      record_frame(figure, simulation, person, walked.recording);
      if (auto done = record_root(simulation, person.entity, walked.recording.root); !done)
        return tl::unexpected(done.error());
      if (options.fat)
        walked.fat.push_back(
            shown_fat(*simulation.get<BodySize>(person.entity), *simulation.get<FatWobble>(person.entity)));
      if (options.view == WalkView::stick) walked.action_line.push_back(action_lines(simulation, person));
      if (options.view == WalkView::wireframe) walked.mesh_edge.push_back(mesh_edges(simulation, person));
    }
  }
  outcome.ticks = timing.ticks;
  outcome.simulated_s = timing.ticks * simulation.tick_s();
  const auto timings = simulation.schedule().timings();
  outcome.stages.assign(timings.begin(), timings.end());
  show("");
  tell_limits(outcome.limits_passed);
  for (WalkRecording* const one : {&walked.recording, &walked.ticks}) {
    if (options.cycle == 0 || one->frames.empty()) continue;
    if (auto done = close_walk(*one); !done) return tl::unexpected(done.error());
  }
  if (options.skin_anatomy) record_drawn_skin(std::move(drawn), walked.recording);
  return walked;
}

/// Prints the first lines about an anatomy folder.
void print_said(const std::vector<std::string>& said, const WalkOptions& options) {
  constexpr std::size_t most = 3;
  for (std::size_t i = 0; i < std::min(said.size(), most); ++i) print_note("anatomy: {}\n", said[i]);
  if (said.size() <= most) return;
  print_note("anatomy: {} more lines; see mobil anatomy {}\n", said.size() - most, options.anatomy->string());
}

Result<void> write_results(Walked walked, const Simulation& simulation, const Person& person, const Figure& figure,
                           const WalkOptions& options, SteadyClock::time_point start, OutputFolder& results) {
  const auto& folder = results.inside();
  if (options.frames || options.video) {  // first, because a driver or ffmpeg can be missing
    const WalkDrawing drawing{&walked.recording,  &person.body,     &figure,
                              walked.action_line, walked.mesh_edge, walked.fat};
    const std::size_t frames = walked.recording.frames.size();
    auto done = write_pictures(drawing, options, folder, [&](std::size_t i) { show_progress("pictures", i, frames); });
    show("");
    if (!done) return done;
  }
  if (auto done = write_file(folder / "motion.csv", walked.motion.text); !done) return done;
  if (auto done = write_file(folder / "muscles.csv", walked.muscles.text); !done) return done;
  const WalkFiles files = walk_files(std::move(walked.recording), std::move(walked.ticks), options);
  const auto exported = write_glb(folder / "walk.glb", files.skinned());
  if (!exported) return tl::unexpected(exported.error());
  std::string others;
  for (const WalkExport& wanted : options.exports) {
    if (wanted.file == "walk.glb") continue;  // already written
    show(fmt::format("writing {}", wanted.file));
    auto done = write_export(wanted, person.body, files.pictures, files.skinned(), files.ticks, folder);
    show("");
    if (!done) return done;
    others += " " + one_line(wanted.file);
    if (needs_velocities(wanted)) others += " " + one_line(motion_file(wanted));
  }
  WalkOutcome outcome = walked.outcome;
  outcome.wall_s = seconds_since(start);
  const auto summary = summary_json(options, simulation, person, outcome, exported->muscles);
  if (auto done = write_file(folder / "summary.json", summary); !done) return done;
  if (auto done = results.put("frame_"); !done) return done;

  for (const std::string& note : body_notes(person.body)) print_note("note: {}\n", note);
  print_said(outcome.anatomy_said, options);
  print_note("walked {:.2f} s at {:.2f} m/s, steps of {:.3f} m at {:.2f} Hz\n", outcome.simulated_s,
             outcome.gait.speed_m_s, outcome.gait.step_length_m, outcome.gait.step_frequency_hz);
  print_note("simulation: {:.1f} us per tick, {:.0f} times faster than real time; total: {:.1f} s\n",
             1e6 * outcome.simulation_s / outcome.ticks, outcome.simulated_s / outcome.simulation_s, outcome.wall_s);
  say_where(fmt::format("look at {}: motion.csv muscles.csv summary.json walk.glb{}{}{}",
                        one_line(options.out.string()), others, options.frames ? " frame_*.png" : "",
                        options.video ? " walk.mp4" : ""));
  return {};
}

Result<void> run_walk(const WalkOptions& asked, FigureReader read_figure) {
  const auto start = SteadyClock::now();
  WalkOptions options = asked;
  const auto timing = walk_timing(options);
  if (!timing) return tl::unexpected(timing.error());
  Simulation simulation({.tick_s = timing->tick_s});
  const auto entity = simulation.spawn(options.body, options.gait);
  if (!entity) return tl::unexpected(entity.error());
  std::vector<ScriptedChange> changes;
  if (options.script) {
    auto planned = plan_changes(*options.script, simulation.person(*entity)->body, options.gait);
    if (!planned) return fail(fmt::format("--script {}", planned.error().message));
    changes = std::move(*planned);
  }
  if (options.forces) simulation.enable(*entity, Feature::forces);
  if (options.fat) simulation.enable({&*entity, 1}, Feature::fat);
  auto added = simulation.set_muscles(*entity, options.muscles);
  if (!added) return added;
  const Person person = *simulation.person(*entity);
  set_edges(options.ground, person.body.request.height_m, person.gait.step_length_m);
  const auto figure =
      options.anatomy ? read_figure(person, *options.anatomy, options.contact) : make_figure(person, options.contact);
  if (!figure) return tl::unexpected(figure.error());
  auto results = OutputFolder::make(options.out);
  if (!results) return tl::unexpected(results.error());

  if (options.ground.kind != GroundKind::level) {
    const TerrainHeights heights = [&](std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
      for (std::size_t i = 0; i < at.size(); ++i) out[i] = options.ground.at(at[i].x_m, at[i].z_m);
    };
    simulation.terrain().set_heights(heights);
    simulation.terrain().set_options({.slows_down = options.scale_speed});
    if (auto done = simulation.terrain().manage({&*entity, 1}); !done) return done;
  }
  auto walked = walk(simulation, person, *figure, options, *timing, changes);
  const std::size_t applied = walked ? walked->outcome.changes : 0;
  auto done = walked ? write_results(std::move(*walked), simulation, person, *figure, options, start, *results)
                     : Result<void>(tl::unexpected(walked.error()));
  if (!done) show("");
  if (done && changes.size() > applied) {
    print_note("script: {} of {} changes are after the end; increase --seconds to include them\n",
               changes.size() - applied, changes.size());
  }
  return done;
}

}  // namespace

Subcommand walk_command(FigureReader read_figure) {
  auto text = std::make_shared<WalkText>();
  Subcommand command{.name = "walk"};
  command.footer = std::string(walk_muscles_help) + "\n" + std::string(walk_script_help) + "\n\n" + walk_ground_help +
                   "\n\n" + walk_exports_help +
                   "\nExamples: mobil walk --height 180cm --mass 80 --constitution athletic --speed 5km/h --video\n"
                   "          mobil walk --set toe_out_deg=12 --set arm_forward_deg=30 --script turn.csv --seconds 10\n"
                   "          mobil walk --method newmark --inertia --view wireframe --video\n"
                   "          mobil walk --speed 5km/h --export walk.bvh --export walk.usda --export walk.mot --export "
                   "walk.sto\n"
                   "          mobil walk --ground stairs:16cm/30cm --view skin --video";
  command.options = walk_options(*text);
  command.empty_refused = true;
  command.run = [text, read_figure] {
    if (text->list_parameters) {
      write_output(gait_parameter_table());
      return 0;
    }
    const auto options = read_walk_options(*text);
    return exit_status_of("walk", options ? run_walk(*options, read_figure) : tl::unexpected(options.error()));
  };
  return command;
}

std::vector<Subcommand> walk_commands() {
  return {walk_command(nullptr)};
}

}  // namespace mobil
