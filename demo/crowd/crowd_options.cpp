#include "demo/crowd/crowd_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <tuple>

#include <mobil/mpi_transport.h>
#include "demo/crowd/crowd_picture.h"
#include "demo/program/nearest_name.h"
#include "demo/program/units.h"

namespace mobil {
namespace {

/// A number without a unit has this one.
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
          fmt::format("--effects '{}': '{}' is none of muscles, forces, inertia, line-motion, activation, avoidance; "
                      "or give none alone",
                      text, name));
    }
    chosen.*found->on = true;
  }
  if ((chosen.inertia || chosen.line_motion || chosen.activation) && !chosen.muscles)
    return fail(fmt::format("--effects '{}': inertia, line-motion and activation are of muscles; add muscles", text));
  return chosen;
}

/// What a scene for other programs needs, before minutes of work are done for nothing.
Result<void> read_crowd_exports(const CrowdText& text, CrowdOptions& options, OptionReader& read) {
  options.export_s = read(read_value("--export-seconds", with_unit(text.export_seconds, "s"), Quantity::time, 0.1, 60));
  if (text.exports.empty()) return {};
  options.exports.assign(text.exports.begin(), text.exports.end());
  if (options.raise) return fail("--raise: measures alone; leave --export out");
  if (options.crowd.churn_per_s > 0 || options.crowd.burst > 0)
    return fail("--export: nobody may leave while it is recorded; leave --churn and --burst out");
  const double poses = static_cast<double>(options.crowd.people) * options.export_s * 30;
  if (poses > static_cast<double>(max_recorded_poses)) {
    return fail(
        fmt::format("--export: {} people for {} s are more than the {} poses that a scene may have; "
                    "lower --people or --export-seconds",
                    options.crowd.people, options.export_s, max_recorded_poses));
  }
  return check_crowd_exports(options.exports);
}

/// Those of whom most sleep.
Result<void> read_alive(const CrowdText& text, CrowdOptions& options, OptionReader& read) {
  if (text.alive.empty()) return {};
  const CrowdText usual;
  AliveRequest alive;
  alive.alive = read(read_count("--people", text.alive, 100, max_alive));
  alive.in_view = read(read_count("--in-view", text.in_view, 1, max_crowd));
  if (text.in_view == usual.in_view) alive.in_view = std::min(alive.in_view, alive.alive / 10);
  if (alive.in_view > alive.alive / 4)
    return fail(fmt::format("--in-view {}: is more than a quarter of those alive", alive.in_view));
  alive.threads = options.crowd.threads;
  alive.seed = options.crowd.seed;
  alive.baked = options.crowd.baked;
  alive.muscles = options.crowd.effects.muscles;
  options.alive = alive;
  return {};
}

/// What makes a run another one: who they are and what is simulated of them.
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
  return crowd.all_seen ? about + " --all-seen" : about;
}

/// Several shards or ranks, and runs that are saved.
Result<void> read_city(const CrowdText& text, CrowdOptions& options, OptionReader& read) {
  const bool ranks = started_as_rank();
  std::uint64_t shards = !text.resume.empty() ? 0 : ranks ? usual_shards : 1;
  if (!text.shards.empty()) shards = read(read_count("--shards", text.shards, 1, max_shards));
  if (!text.save.empty() && !text.resume.empty())
    return fail("--save: a run that goes on by --resume saves where it was; leave --save out");
  const bool several = ranks || shards > 1 || !text.save.empty() || !text.resume.empty();
  options.city = several || options.alive;
  const CrowdText usual;
  for (const auto& [name, given, usually] : {std::tuple("--save-every", &text.save_every, &usual.save_every),
                                             std::tuple("--balance-every", &text.balance_every, &usual.balance_every),
                                             std::tuple("--silence", &text.silence, &usual.silence)}) {
    if (!several && *given != *usually)
      return fail(fmt::format("{}: is of several shards or ranks; give --shards, or run under mpirun", name));
  }
  if (!options.city) return {};
  if (options.crowd.effects.avoidance)
    return fail("--effects avoidance: is of a crowd in one piece; leave --shards, --save, --resume and mpirun out");
  if (options.raise) return fail("--raise: tries crowds in one piece; leave --shards, --save, --resume and mpirun out");
  if (!options.exports.empty())
    return fail("--export: is of a crowd in one piece; leave --shards, --save, --resume and mpirun out");
  if (options.frames > 0)
    return fail("--frames: are of a crowd in one piece; leave --shards, --save, --resume and mpirun out");
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
  // A rank is a process beside others: it has one thread where nobody says otherwise.
  if (ranks && text.threads == usual.threads) {
    options.crowd.threads = 1;
    if (options.alive) options.alive->threads = 1;
  }
  return {};
}

constexpr const char *of_people = "People", *of_muscles = "Muscles", *of_results = "Results",
                     *of_ranks = "Several ranks";

/// What a crowd and a city have both.
std::vector<Option> common_options(CrowdText& text) {
  return {
      {"--seconds", &text.seconds, "How long is measured, 0.1s to 3600s of the crowd's time", of_people},
      {"--threads", &text.threads, "Threads that work, 1 to 256; 0: as many as the machine has", of_people},
      {"--seed", &text.seed, "Who they are and what they do", of_people},
      {"--baked", &text.baked,
       "What `mobil bake` wrote, FILE, instead of making it (a mobil.baked beside the program, or what an earlier run "
       "has kept in ~/.cache/mobil, is taken unasked)",
       of_muscles},
      {"--shards", &text.shards,
       fmt::format("Parts of the crowd that are simulated by themselves, 1 to {}; under mpirun {}", max_shards,
                   usual_shards),
       of_ranks},
      {"--save", &text.save, "Snapshots and commands go into this FOLDER, which all ranks must see", of_ranks},
      {"--save-every", &text.save_every, "Time between snapshots, 0.1s to 3600s of the crowd's time", of_ranks},
      {"--resume", &text.resume, "Go on from the last snapshot in the FOLDER of a run with --save, and save there",
       of_ranks},
      {"--balance-every", &text.balance_every,
       "Time after which shards may move to ranks with less to do, up to 3600s; 0: they stay", of_ranks},
      {"--silence", &text.silence, "A rank that says nothing for so long ends the run of all, 1s to 3600s", of_ranks},
      {"--report", &text.report, "JSON FILE for all figures", of_results}};
}

std::vector<Option> with_common(std::vector<Option> own, CrowdText& text) {
  const auto common = common_options(text);
  own.insert(own.end(), common.begin(), common.end());
  return own;
}

}  // namespace

std::vector<Option> crowd_options(CrowdText& text) {
  return with_common(
      {{"--people", &text.people, fmt::format("How many walk, 1 to {}, all different", max_crowd), of_people},
       {"--churn", &text.churn, "How many leave and as many come each second, spread over its ticks", of_people},
       {"--burst", &text.burst, "How many leave and as many come in a single tick of each second", of_people},
       {"--effects", &text.effects,
        "LIST of muscles, forces, inertia, line-motion, activation, avoidance; or none: they only walk", of_muscles},
       {"--tolerance", &text.tolerance, "How far off, in mm, control points may be: 0.01mm to 1m", of_muscles},
       {"--near", &text.near, "How many of the nearest are looked at (half of them in small crowds)", of_muscles},
       {"--near-tolerance", &text.near_tolerance, "The same of those", of_muscles},
       {"--all-seen", &text.all_seen, "Place everybody's control points, not only of those near", of_muscles},
       {"--budget", &text.budget, "Processor time, in ms a tick, that all muscles may take: 0.001ms to 10s",
        of_muscles},
       {"--raise", &text.raise,
        "Raise the number of people from --people until ticks are missed, in runs of --seconds each", of_results},
       {"--capture", &text.capture, "Picture of the crowd at the end, FILE.png; with --frames a folder", of_results},
       {"--frames", &text.frames, "So many pictures, 30 a second from the end on, into the folder", of_results},
       {"--export", &text.exports,
        "FILE.glb or .usda: everybody walking, as a scene for other programs, from the end on; again for both",
        of_results},
       {"--export-seconds", &text.export_seconds, "How long that is, 0.1s to 60s, 30 poses a second", of_results}},
      text);
}

std::vector<Option> city_options(CrowdText& text) {
  return with_common(
      {{"--people", &text.alive,
        fmt::format("How many live on 1 m2 each, 100 to {}; who is far from being seen sleeps", max_alive), of_people},
       {"--in-view", &text.in_view, "How many of those the flying camera sees", of_people},
       {.name = "--effects",
        .target = &text.effects,
        .help = "Those in view have muscles, or only walk",
        .group = of_muscles,
        .choices = {"muscles", "none"}},
       {"--capture", &text.capture, "Three pictures, FILE_1.png and so on, spread over the time", of_results}},
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
  crowd.tolerance_m = quantity("--tolerance", text.tolerance, "mm", Quantity::length, 1e-5, 1);
  crowd.near_tolerance_m = quantity("--near-tolerance", text.near_tolerance, "mm", Quantity::length, 1e-5, 1);
  crowd.near = read(read_count("--near", text.near, 0, max_crowd));
  if (text.near == CrowdText{}.near) crowd.near = std::min(crowd.near, crowd.people / 2);
  if (!text.budget.empty()) {
    crowd.budget_s = quantity("--budget", text.budget, "ms", Quantity::time, 1e-6, 10);
    if (!crowd.effects.muscles) read.refuse("--budget: is of muscles; add muscles to --effects");
  }
  options.frames = read(read_count("--frames", text.frames, 0, 100'000));
  crowd.all_seen = text.all_seen;
  options.raise = text.raise;
  crowd.baked = text.baked;
  options.report = text.report;
  options.capture = text.capture;
  if (options.frames > 0 && options.capture.empty()) read.refuse("--frames: name a folder by --capture");
  if (options.frames == 0 && !options.capture.empty() && options.capture.extension() != ".png")
    read.refuse(
        fmt::format("--capture {}: a picture's name must end in .png; for a folder give --frames too", text.capture));
  if (options.raise && !options.capture.empty()) read.refuse("--raise: measures alone; leave --capture out");
  read(read_crowd_exports(text, options, read));
  read(read_alive(text, options, read));
  read(read_city(text, options, read));
  return read.result(std::move(options));
}

}  // namespace mobil
