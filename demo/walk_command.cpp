// `mobil walk`: one person from parameters to motion, muscles, pictures and a scene file.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include "assets/output_file.h"
#include "demo/commands.h"
#include "demo/figure.h"
#include "demo/walk_lines.h"
#include "demo/walk_options.h"
#include "demo/walk_pictures.h"
#include "demo/walk_summary.h"
#include "demo/walk_tables.h"

namespace mobil {
namespace {

constexpr int ticks_per_frame = 2;  // 30 pictures a second

using SteadyClock = std::chrono::steady_clock;
double seconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

/// A bar on a terminal, nothing elsewhere.
void show_progress(const char* what, std::size_t done, std::size_t of) {
  if (isatty(STDERR_FILENO) == 0) return;
  const int full = static_cast<int>(40 * done / of);
  fmt::print(stderr, "\r{} [{:<40}] {}/{}{}", what, std::string(static_cast<std::size_t>(full), '='), done, of,
             done == of ? "\n" : "");
}

struct Walked {
  MotionTable motion;
  MuscleTable muscles;
  WalkRecording recording;
  std::vector<std::vector<Vec3<float>>> action_line, mesh_edge;
  double simulation_s = 0;
};

void write_rows(const Simulation& simulation, const Human& human, std::string_view method, Walked& walked) {
  const double time = simulation.time_s();
  walked.motion.add(time, *simulation.get<JointAngles>(human.entity), *simulation.get<Feet>(human.entity),
                    *simulation.get<CentreOfMass>(human.entity));
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t g = 0; g < human.muscle_plan.size(); ++g) {
      const Entity muscle = human.muscle[g][side];
      walked.muscles.add(time, static_cast<Side>(side), static_cast<MuscleGroup>(g),
                         *simulation.get<LineOfAction>(muscle), *simulation.get<BellyReport>(muscle), method);
    }
  }
}

Walked walk(Simulation& simulation, const Human& human, const Figure& figure, const WalkOptions& options) {
  Walked walked;
  walked.recording = begin_recording(figure, static_cast<float>(ticks_per_frame * simulation.tick_s()));
  const std::string_view method = options.force_driven ? "ecd_force" : "ecd";
  const auto total = static_cast<std::uint32_t>(std::lround(options.seconds / simulation.tick_s()));
  simulation.schedule().reset_timings();
  for (std::uint32_t i = 0; i < total; ++i) {
    const auto start = SteadyClock::now();
    simulation.tick();
    walked.simulation_s += seconds_since(start);
    write_rows(simulation, human, method, walked);
    if (i % ticks_per_frame == 0) {
      show_progress("walking", i + std::size_t{1}, total);
      record_frame(figure, simulation, human, walked.recording);
      if (options.view == View::stick) walked.action_line.push_back(action_lines(simulation, human));
      if (options.view == View::wireframe) walked.mesh_edge.push_back(mesh_edges(simulation, human));
    }
  }
  show_progress("walking", total, total);
  return walked;
}

Result<void> run_walk(const WalkOptions& options) {
  const auto start = SteadyClock::now();
  Simulation simulation;
  const auto entity = simulation.spawn(options.body, options.gait);
  if (!entity) return tl::unexpected(entity.error());
  const auto added = simulation.add_leg_muscles(*entity, options.force_driven ? Drive::force : Drive::displacement);
  if (!added) return added;
  const Human& human = *simulation.human(*entity);
  const auto figure = make_figure(simulation, human, options.anatomy);
  if (!figure) return tl::unexpected(figure.error());
  const bool folder_was_there = std::filesystem::exists(options.out);
  if (auto made = make_output_folder(options.out); !made) return made;

  const Walked walked = walk(simulation, human, *figure, options);
  if (options.frames || options.video) {  // first, as they may lack a driver or a program: then nothing is written
    const WalkDrawing drawing{&walked.recording, &human.body, walked.action_line, walked.mesh_edge};
    const std::size_t frames = walked.recording.frames.size();
    const auto done = write_pictures(drawing, options, [&](std::size_t i) { show_progress("pictures", i, frames); });
    if (!done) {
      std::error_code ignored;
      if (!folder_was_there) std::filesystem::remove(options.out, ignored);  // if it is empty
      return done;
    }
  }
  if (auto done = write_file(options.out / "motion.csv", walked.motion.text); !done) return done;
  if (auto done = write_file(options.out / "muscles.csv", walked.muscles.text); !done) return done;
  const auto exported = write_glb(options.out / "walk.glb", walked.recording);
  if (!exported) return tl::unexpected(exported.error());
  const WalkCost cost{walked.simulation_s, seconds_since(start)};
  const auto summary = summary_json(options, simulation, human, cost, exported->muscles);
  if (auto done = write_file(options.out / "summary.json", summary); !done) return done;

  fmt::print("walked {:.2f} s at {:.2f} m/s, steps of {:.3f} m at {:.2f} Hz\n", simulation.time_s(),
             human.gait.speed_m_s, human.gait.step_length_m, human.gait.step_frequency_hz);
  fmt::print("simulation: {:.1f} us a tick, {:.0f} times faster than real time; everything: {:.1f} s\n",
             1e6 * walked.simulation_s / simulation.ticks(), simulation.time_s() / walked.simulation_s, cost.wall_s);
  fmt::print("look at {}: motion.csv muscles.csv summary.json walk.glb{}{}\n", options.out.string(),
             options.frames ? " frame_*.png" : "", options.video ? " walk.mp4" : "");
  return {};
}

}  // namespace

void add_walk_command(CLI::App& app, int& exit_status) {
  auto* command =
      app.add_subcommand("walk", "One person walks: motion.csv, muscles.csv, summary.json, walk.glb, pictures");
  command->footer(
      "Ground reactions and joint moments in motion.csv are empty cells: they are not simulated yet.\n"
      "Example: mobil walk --height 180cm --mass 80 --constitution athletic --speed 5km/h --video");
  auto text = std::make_shared<WalkText>();
  command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);  // a script may override
  add_walk_options(*command, *text);
  command->callback([text, &exit_status] {
    const auto options = read_walk_options(*text);
    const auto done = options ? run_walk(*options) : Result<void>(tl::unexpected(options.error()));
    if (done) return;
    fmt::print(stderr, "mobil walk: {}\n", done.error().message);
    exit_status = 2;
  });
}

}  // namespace mobil
