// `mobil crowd` and `mobil city`: many different people who turn, stop, arrive and leave, and the time of a tick.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include <mobil/assets/export/recorded_axes.h>
#include <mobil/assets/export/root_motion.h>
#include <mobil/assets/files/output_file.h>
#include <mobil/local_transport.h>
#include <mobil/mpi_transport.h>
#include <mobil/png.h>
#include "demo/anatomy/real_figure.h"
#include "demo/crowd/city_shard.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/progress.h"
#include "demo/walk/walk_command.h"

namespace mobil {
namespace {

constexpr double picture_s = 1.0 / 30;

Result<void> write_report(const CrowdOptions& options, const std::string& json) {
  if (options.report.empty()) return {};
  return write_result("--report", options.report, json);
}

/// Takes one picture of the crowd, or a sequence while it walks on.
Result<void> take_pictures(const CrowdOptions& options, CrowdScene& scene) {
  if (options.capture.empty()) return {};
  std::optional<OutputFolder> results;
  if (options.frames > 0) {
    auto made = OutputFolder::make(options.capture);
    if (!made) return fail("--capture " + made.error().message);
    results = std::move(*made);
  }
  auto camera = CrowdCamera::create();
  if (!camera) return tl::unexpected(camera.error());
  const std::size_t pictures = std::max<std::size_t>(options.frames, 1);
  const auto ticks_a_picture = static_cast<int>(std::lround(picture_s / scene.simulation().tick_s()));
  Image image;
  for (std::size_t i = 0; i < pictures; ++i) {
    for (int tick = 0; i > 0 && tick < ticks_a_picture; ++tick) {
      if (auto done = scene.decide(); !done) return tl::unexpected(done.error());
      scene.tick();
    }
    if (auto done = camera->take(scene, image); !done) return done;
    const auto file = results ? results->inside() / fmt::format("frame_{:04}.png", i) : options.capture;
    const PngEffort effort = options.frames > 0 ? PngEffort::quick : PngEffort::small;
    if (auto done = write_png(file.string(), image, effort); !done) return fail("--capture " + done.error().message);
    show_progress("pictures", i + 1, pictures);
  }
  show("");
  if (results) {
    if (auto done = results->put("frame_"); !done) return done;
  }
  say_written(options.capture);
  return {};
}

/// Records the crowd from its current state and writes the exports.
Result<void> export_crowd(const CrowdOptions& options, CrowdScene& scene) {
  if (options.exports.empty()) return {};
  auto recording = record_crowd(scene, options.export_s, show_progress);
  show("");
  if (!recording) return tl::unexpected(recording.error());
  if (options.in_place) put_in_place(*recording);
  for (RecordedPerson& person : recording->people)
    if (!options.in_place && !options.root_motion) person.root.clear();
  if (options.z_back) put_z_back(*recording);
  return write_crowd_exports(*recording, options.exports);
}

Result<void> run(const CrowdOptions& options) {
  auto made = CrowdScene::make(options.crowd, show_progress);
  if (!made) return tl::unexpected(made.error());
  CrowdScene& scene = **made;
  const auto ticks = static_cast<std::size_t>(std::max(1L, std::lround(options.seconds / scene.simulation().tick_s())));
  if (options.raise) {
    const auto told = [](const CrowdLimit::Tried& tried) {
      show("");
      print_output("{}\n", tried_line(tried));
    };
    const auto limit = raise_crowd(scene, ticks, max_crowd, told, show_progress);
    show("");
    if (!limit) return tl::unexpected(limit.error());
    write_output(limit_text(*limit));
    return write_report(options, limit_json(*limit, options));
  }
  if (auto done = scene.settle(show_progress); !done) return done;
  const CrowdMemory memory = crowd_memory(scene);
  const CrowdLive live = [](const CrowdRun& so_far, std::size_t of) { show(crowd_live_line(so_far, of)); };
  const auto measured = run_crowd(scene, ticks, true, quiet ? CrowdLive{} : live);
  show("");
  if (!measured) return tl::unexpected(measured.error());
  write_output(crowd_text(*measured, memory, scene));
  if (auto done = write_report(options, crowd_json(*measured, memory, scene, options)); !done) return done;
  if (auto done = take_pictures(options, scene); !done) return done;
  return export_crowd(options, scene);
}

/// Checks output paths before minutes of work.
Result<void> check_places(const CrowdOptions& options) {
  if (!options.report.empty()) {
    if (auto place = check_result_place("--report", options.report); !place) return place;
  }
  if (options.frames == 0 && !options.capture.empty()) return check_result_place("--capture", options.capture);
  return {};
}

/// Runs on each rank; only the first one prints.
int run_ranks(const std::string& command, const CrowdOptions& options) {
  std::unique_ptr<Transport> by_mpi;
  LocalRanks alone;
  if (started_as_rank()) {
    auto made = mpi_transport();
    if (!made) return exit_status_of(command, tl::unexpected(made.error()));
    by_mpi = std::move(*made);
  }
  Ranks ranks(by_mpi ? *by_mpi : alone[0], options.silence_s);
  try {
    const auto done = ranks.agree(ranks.first() ? check_places(options) : Result<void>());
    const auto ran = done ? run_city(options, ranks) : done;
    return ranks.first() ? exit_status_of(command, ran) : ran ? 0 : 2;
  } catch (const RanksStopped& why) {  // in one process
    return exit_status_of(command, fail(why.what()));
  } catch (const std::exception& why) {
    if (!by_mpi) throw;
    ranks.stop(fmt::format("mobil {}: rank {}: {}", command, ranks.rank(), why.what()));
  }
}

int run_command(const CrowdText& text) {
  const auto options = read_crowd_options(text);
  if (!options) return first_by_environment() ? exit_status_of(text.command, tl::unexpected(options.error())) : 2;
  if (options->city) return run_ranks(text.command, *options);
  if (auto done = check_places(*options); !done) return exit_status_of(text.command, done);
  const auto done = run(*options);
  if (!done) show("");
  return exit_status_of(text.command, done);
}

}  // namespace

Subcommand crowd_command() {
  auto text = std::make_shared<CrowdText>();
  Subcommand command{.name = "crowd"};
  command.footer =
      "People are 6 to 90 years old, of both sexes, alone, in pairs and in families of three to five.\n"
      "They differ in stature, mass, speed and style. Members of a party walk side by side, at the usual\n"
      "speed of the slowest. They start anywhere on a square with 2.5 m2 per person. Four times a\n"
      "minute they turn, change speed, or stop and start again. A person's body and actions depend only\n"
      "on --seed and the person's number. The same seed gives the same state_hash for any number of\n"
      "threads, except with --budget, where methods depend on the measured time.\n"
      "The --near people nearest to the middle of one edge are observed: control points of their muscles\n"
      "are computed, within --near-tolerance. Other muscles advance as modes only, within --tolerance.\n"
      "A measured tick contains the host's decisions, the choice of methods and the simulation. A tick is\n"
      "missed if it takes longer, in wall-clock time, than the time it simulates. The exit status is 0\n"
      "even if ticks are missed. Before the measurement come spawning and at least two simulated seconds,\n"
      "until methods have settled. Heap requests are calls of malloc and related functions on all threads.\n"
      "In pictures, people near the camera show the bones and muscles of their legs. In exported scenes\n"
      "all people are dressed, and each has its own skeleton and skin.\n"
      "Under mpirun the crowd is divided into --shards, which are simulated independently, on ranks of one\n"
      "thread each. The state_hash then depends on the number of shards, not on ranks, threads or machines.\n"
      "This includes a killed run that is continued with --resume, on any number of ranks. Each shard\n"
      "chooses its part of the nearest people.\n"
      "\n"
      "Examples: mobil crowd\n"
      "          mobil crowd --people 10000 --churn 100 --report crowd.json\n"
      "          mobil crowd --people 10000 --seconds 5 --raise\n"
      "          mobil crowd --people 2000 --seconds 1 --capture crowd.png\n"
      "          mobil crowd --people 200 --seconds 0.1 --export crowd.glb --export-seconds 5\n"
      "          mpirun -n 4 mobil crowd --people 40000 --save run\n"
      "          mpirun -n 2 mobil crowd --people 40000 --resume run";
  command.options = crowd_options(*text);
  command.empty_refused = true;
  command.run = [text] { return run_command(*text); };
  return command;
}

Subcommand city_command() {
  auto text = std::make_shared<CrowdText>();
  text->command = "city";
  text->alive = "1000000";
  Subcommand command{.name = "city"};
  command.footer =
      "Most people are asleep and take about 100 bytes each. They wake before the camera sees them, exactly\n"
      "where they would be if awake. They turn, stop and start again, asleep or awake. The camera flies at\n"
      "8 m/s, turns at 20 degrees/s and cuts to another place every 10 s. Seeds, state_hash and ranks work\n"
      "as in mobil crowd.\n"
      "\nExamples: mobil city --people 1000000 --in-view 10000 --seconds 60\n"
      "          mpirun -n 4 mobil city --people 10000000 --save run";
  command.options = city_options(*text);
  command.empty_refused = true;
  command.run = [text] { return run_command(*text); };
  return command;
}

std::vector<Subcommand> crowd_commands() {
  return {walk_command(&real_figure), crowd_command(),  city_command(), town_command(), view_command(), bake_command(),
          schedule_command(),         anatomy_command()};
}

}  // namespace mobil
