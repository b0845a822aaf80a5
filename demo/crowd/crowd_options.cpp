#include "demo/crowd/crowd_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <tuple>

#include <mobil/mpi_transport.h>
#include <mobil/muscle_table.h>
#include "demo/crowd/crowd_picture.h"
#include "demo/program/muscle_options.h"
#include "demo/program/nearest_name.h"
#include "demo/program/units.h"

namespace mobil {
namespace {

/// Appends the unit to a number without one.
std::string with_unit(const std::string& text, std::string_view unit) {
  const bool bare = !text.empty() && (std::isdigit(static_cast<unsigned char>(text.back())) != 0 || text.back() == '.');
  return bare ? text + std::string(unit) : text;
}

struct NamedEffect {
  std::string_view name;
  bool CrowdEffects::*on;
};
constexpr NamedEffect effects[] = {
    {"muscles", &CrowdEffects::muscles},       {"forces", &CrowdEffects::forces},
    {"inertia", &CrowdEffects::inertia},       {"line-motion", &CrowdEffects::line_motion},
    {"activation", &CrowdEffects::activation}, {"avoidance", &CrowdEffects::avoidance}};

Result<CrowdEffects> read_effects(const std::string& text) {
  CrowdEffects chosen{.muscles = false};
  if (text == "none") return chosen;
  for (const std::string& name : split(text, ',')) {
    const auto found = std::ranges::find(effects, name, &NamedEffect::name);
    if (found == std::end(effects)) {
      return fail(
          fmt::format("--effects '{}': '{}' is not one of muscles, forces, inertia, line-motion, activation, "
                      "avoidance; use these, or only none",
                      text, name));
    }
    chosen.*found->on = true;
  }
  if ((chosen.inertia || chosen.line_motion || chosen.activation) && !chosen.muscles)
    return fail(fmt::format("--effects '{}': inertia, line-motion and activation need muscles; add muscles", text));
  return chosen;
}

/// Reads and checks the options of exports before minutes of work.
Result<void> read_crowd_exports(const CrowdText& text, CrowdOptions& options, OptionReader& read) {
  options.export_s = read(read_value("--export-seconds", with_unit(text.export_seconds, "s"), Quantity::time, 0.1, 60));
  options.root_motion = text.root_motion;
  options.in_place = text.in_place;
  options.z_back = text.axes == z_back_axes;
  if (text.root_motion && text.in_place) return fail("--root-motion and --in-place exclude each other; remove one");
  if (text.exports.empty()) {
    if (text.root_motion || text.in_place || options.z_back)
      return fail(fmt::format("{}: is for exports; add --export FILE.glb, or remove it", text.in_place ? "--in-place"
                                                                                         : text.root_motion
                                                                                             ? "--root-motion"
                                                                                             : "--axes"));
    return {};
  }
  options.exports.assign(text.exports.begin(), text.exports.end());
  if (options.raise) return fail("--raise: cannot export; remove --export");
  if (options.crowd.churn_per_s > 0 || options.crowd.burst > 0)
    return fail("--export: people cannot leave during the recording; remove --churn and --burst");
  const double poses = static_cast<double>(options.crowd.people) * options.export_s * 30;
  if (poses > static_cast<double>(max_recorded_poses)) {
    return fail(
        fmt::format("--export: {} people for {} s exceed the {} poses that a scene can have; "
                    "lower --people or --export-seconds",
                    options.crowd.people, options.export_s, max_recorded_poses));
  }
  return check_crowd_exports(options.exports);
}

/// Reads the options of `mobil city`.
Result<void> read_alive(const CrowdText& text, CrowdOptions& options, OptionReader& read) {
  if (text.alive.empty()) return {};
  const CrowdText usual;
  AliveRequest alive;
  alive.alive = read(read_count("--people", text.alive, 100, max_alive));
  alive.in_view = read(read_count("--in-view", text.in_view, 1, max_crowd));
  if (text.in_view == usual.in_view) alive.in_view = std::min(alive.in_view, alive.alive / 10);
  if (alive.in_view > alive.alive / 4)
    return fail(fmt::format("--in-view {}: is more than a quarter of --people; lower it", alive.in_view));
  alive.threads = options.crowd.threads;
  alive.seed = options.crowd.seed;
  alive.baked = options.crowd.baked;
  alive.muscles = options.crowd.effects.muscles;
  options.alive = alive;
  return {};
}

/// Returns the options that identify a run: its people and simulated effects.
std::string about_run(const CrowdOptions& options) {
  if (options.alive) {
    const AliveRequest& alive = *options.alive;
    return fmt::format("--people {} --in-view {} --seed {}{}", alive.alive, alive.in_view, alive.seed,
                       alive.muscles ? "" : " --effects none");
  }
  const CrowdRequest& crowd = options.crowd;
  std::string about = fmt::format(
      "--people {} --seed {} --tolerance {}mm --near {} --near-tolerance {}mm --churn {} --burst {}", crowd.people,
      crowd.seed, 1e3 * crowd.tolerance_m, crowd.near, 1e3 * crowd.near_tolerance_m, crowd.churn_per_s, crowd.burst);
  if (crowd.budget_s) about += fmt::format(" --budget {}ms", 1e3 * *crowd.budget_s);
  std::string of_effects;
  for (const NamedEffect& effect : effects)
    if (crowd.effects.*effect.on) of_effects += (of_effects.empty() ? "" : ",") + std::string(effect.name);
  about += " --effects " + (of_effects.empty() ? "none" : of_effects);
  if (crowd.muscles != usual_muscles()) about += " --muscles " + muscle_list(crowd.muscles);
  return crowd.all_seen ? about + " --all-seen" : about;
}

/// Reads the options of shards, ranks and saved runs.
Result<void> read_city(const CrowdText& text, CrowdOptions& options, OptionReader& read) {
  const bool ranks = started_as_rank();
  std::uint64_t shards = !text.resume.empty() ? 0 : ranks ? usual_shards : 1;
  if (!text.shards.empty()) shards = read(read_count("--shards", text.shards, 1, max_shards));
  if (!text.save.empty() && !text.resume.empty())
    return fail("--save: a run continued with --resume saves to the same folder; remove --save");
  const bool several = ranks || shards > 1 || !text.save.empty() || !text.resume.empty();
  options.city = several || options.alive;
  const CrowdText usual;
  for (const auto& [name, given, usually] : {std::tuple("--save-every", &text.save_every, &usual.save_every),
                                             std::tuple("--balance-every", &text.balance_every, &usual.balance_every),
                                             std::tuple("--silence", &text.silence, &usual.silence)}) {
    if (!several && *given != *usually)
      return fail(fmt::format("{}: needs several shards or ranks; add --shards, or run under mpirun", name));
  }
  if (!options.city) return {};
  if (options.crowd.effects.avoidance)
    return fail("--effects avoidance: needs an undivided crowd; run without --shards, --save, --resume and mpirun");
  if (options.raise)
    return fail("--raise: needs an undivided crowd; run without --shards, --save, --resume and mpirun");
  if (!options.exports.empty())
    return fail("--export: needs an undivided crowd; run without --shards, --save, --resume and mpirun");
  if (options.frames > 0)
    return fail("--frames: needs an undivided crowd; run without --shards, --save, --resume and mpirun");
  const double tick_s = 1.0 / 60;
  ClusterOptions& cluster = options.cluster;
  const auto ticks = [&](const char* option, const std::string& given, double low) {
    const double seconds = read(read_value(option, with_unit(given, "s"), Quantity::time, low, 3600));
    return static_cast<std::uint32_t>(std::lround(seconds / tick_s));
  };
  cluster.save_every = ticks("--save-every", text.save_every, 0.1);
  cluster.balance_every = ticks("--balance-every", text.balance_every, 0);
  options.silence_s = read(read_value("--silence", with_unit(text.silence, "s"), Quantity::time, 1, 3600));
  cluster.shards = static_cast<std::uint32_t>(shards);
  cluster.resume = !text.resume.empty();
  cluster.folder = cluster.resume ? text.resume : text.save;
  cluster.about = about_run(options);
  // Ranks share the machine, so the default is one thread per rank.
  if (ranks && text.threads == usual.threads) {
    options.crowd.threads = 1;
    if (options.alive) options.alive->threads = 1;
  }
  return {};
}

constexpr const char *of_people = "People", *of_muscles = "Muscles", *of_results = "Results",
                     *of_ranks = "Several ranks";

/// Returns the options common to crowds and cities.
std::vector<Option> common_options(CrowdText& text) {
  return {
      {"--seconds", &text.seconds, "Simulated time to measure, 0.1s to 3600s", of_people},
      {"--threads", &text.threads, "Number of threads, 1 to 256; 0: one per processor", of_people},
      {"--seed", &text.seed, "Seed of the people and of their actions", of_people},
      {"--baked", &text.baked,
       "FILE of `mobil bake`, loaded instead of computing its content (default: a mobil.baked next to the program, or "
       "one that an earlier run has kept in ~/.cache/mobil)",
       of_muscles},
      {"--shards", &text.shards,
       fmt::format("Number of independently simulated parts of the crowd, 1 to {}; under mpirun {}", max_shards,
                   usual_shards),
       of_ranks},
      {"--save", &text.save, "FOLDER for snapshots and commands, accessible to all ranks", of_ranks},
      {"--save-every", &text.save_every, "Simulated time between snapshots, 0.1s to 3600s", of_ranks},
      {"--resume", &text.resume, "Continue from the last snapshot in the FOLDER of a run with --save, and save there",
       of_ranks},
      {"--balance-every", &text.balance_every,
       "Simulated time between moves of shards to less busy ranks, up to 3600s; 0: never", of_ranks},
      {"--silence", &text.silence, "Time after which a silent rank ends the run of all ranks, 1s to 3600s", of_ranks},
      {"--report", &text.report, "JSON FILE for all results", of_results}};
}

std::vector<Option> with_common(std::vector<Option> own, CrowdText& text) {
  const auto common = common_options(text);
  own.insert(own.end(), common.begin(), common.end());
  return own;
}

}  // namespace

std::vector<Option> crowd_options(CrowdText& text) {
  return with_common(
      {{"--people", &text.people, fmt::format("Number of people, 1 to {}, all different", max_crowd), of_people},
       {"--churn", &text.churn, "Number of people replaced per second, spread over its ticks", of_people},
       {"--burst", &text.burst, "Number of people replaced in a single tick of each second", of_people},
       {"--effects", &text.effects,
        "LIST of muscles, forces, inertia, line-motion, activation, avoidance; or none: only walk", of_muscles},
       {"--muscles", &text.muscles,
        "Muscles of both legs: usual (four groups), groups (twelve), all, or names like hamstrings,soleus", of_muscles},
       {"--tolerance", &text.tolerance, "Maximum error of control points, in mm: 0.01mm to 1m", of_muscles},
       {"--near", &text.near, "Number of nearest people that are observed (half of a small crowd)", of_muscles},
       {"--near-tolerance", &text.near_tolerance, "Maximum error of their control points, 0.01mm to 1m", of_muscles},
       {"--all-seen", &text.all_seen, "Compute the control points of all people, not only of the nearest", of_muscles},
       {"--budget", &text.budget, "Processor time for all muscles, in ms per tick: 0.001ms to 10s", of_muscles},
       {"--raise", &text.raise,
        "Raise the number of people from --people until ticks are missed, in runs of --seconds each", of_results},
       {"--capture", &text.capture, "Picture of the crowd at the end, FILE.png; with --frames a folder", of_results},
       {"--frames", &text.frames, "Number of pictures in the folder, 30 per second after the measurement", of_results},
       {"--export", &text.exports,
        "Scene of all people walking after the measurement, FILE.glb or FILE.usda; repeat for both", of_results},
       {"--export-seconds", &text.export_seconds, "Duration of the scene, 0.1s to 60s, 30 poses per second",
        of_results},
       {"--root-motion", &text.root_motion, "Animate people's ways on their roots in exported scenes", of_results},
       {"--in-place", &text.in_place, "Keep each person of an exported scene where they begin", of_results},
       axes_option(text.axes, "exported scenes", of_results)},
      text);
}

std::vector<Option> city_options(CrowdText& text) {
  return with_common(
      {{"--people", &text.alive,
        fmt::format("Number of people, 1 m2 each, 100 to {}; those far from view are asleep", max_alive), of_people},
       {"--in-view", &text.in_view, "Number of people that the flying camera sees", of_people},
       {.name = "--effects",
        .target = &text.effects,
        .help = "Effects of the people in view",
        .group = of_muscles,
        .choices = {"muscles", "none"}},
       {"--capture", &text.capture, "Three pictures, FILE_1.png to FILE_3.png, spread over the run", of_results}},
      text);
}

Result<CrowdOptions> read_crowd_options(const CrowdText& text) {
  CrowdOptions options;
  CrowdRequest& crowd = options.crowd;
  OptionReader read;
  const auto quantity = [&](std::string_view option, const std::string& given, std::string_view unit, Quantity kind,
                            double low,
                            double high) { return read(read_value(option, with_unit(given, unit), kind, low, high)); };
  crowd.people = read(read_count("--people", text.people, 1, max_crowd));
  options.seconds = quantity("--seconds", text.seconds, "s", Quantity::time, 0.1, 3600);
  crowd.threads = static_cast<int>(read(read_count("--threads", text.threads, 0, 256)));
  crowd.seed = read(read_count("--seed", text.seed, 0, 999'999'999'999'999'999));
  crowd.churn_per_s = quantity("--churn", text.churn, "", Quantity::rate, 0, 100'000);
  crowd.burst = read(read_count("--burst", text.burst, 0, crowd.people));
  crowd.effects = read(read_effects(text.effects));
  crowd.muscles = read(read_muscles(text.muscles));
  crowd.tolerance_m = quantity("--tolerance", text.tolerance, "mm", Quantity::length, 1e-5, 1);
  crowd.near_tolerance_m = quantity("--near-tolerance", text.near_tolerance, "mm", Quantity::length, 1e-5, 1);
  crowd.near = read(read_count("--near", text.near, 0, max_crowd));
  if (text.near == CrowdText{}.near) crowd.near = std::min(crowd.near, crowd.people / 2);
  if (!text.budget.empty()) {
    crowd.budget_s = quantity("--budget", text.budget, "ms", Quantity::time, 1e-6, 10);
    if (!crowd.effects.muscles) read.refuse("--budget: needs muscles; add muscles to --effects");
  }
  options.frames = read(read_count("--frames", text.frames, 0, 100'000));
  crowd.all_seen = text.all_seen;
  options.raise = text.raise;
  crowd.baked = text.baked;
  options.report = text.report;
  options.capture = text.capture;
  if (options.frames > 0 && options.capture.empty()) read.refuse("--frames: needs a folder; name it with --capture");
  if (options.frames == 0 && !options.capture.empty() && options.capture.extension() != ".png")
    read.refuse(
        fmt::format("--capture {}: a picture's name must end in .png; for a folder add --frames", text.capture));
  if (options.raise && !options.capture.empty()) read.refuse("--raise: takes no pictures; remove --capture");
  read(read_crowd_exports(text, options, read));
  read(read_alive(text, options, read));
  read(read_city(text, options, read));
  return read.result(std::move(options));
}

}  // namespace mobil
