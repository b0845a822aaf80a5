// `mobil effects`: the effects that can be simulated, the cost of each, and the cost of a minimal scene.

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/lod.h>
#include <mobil/schedule.h>
#include <mobil/step_report.h>
#include <mobil/systems/muscles/person.h>
#include "demo/lab/effects/accuracy_measure.h"
#include "demo/measure/measure.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/json.h"
#include "demo/program/must.h"
#include "demo/program/progress.h"
#include "demo/walk/figure.h"

namespace mobil {
namespace {

struct Effect {
  std::string name, adds, needs;
  double us = 0;        // a person and tick (of pictures and files: a person and frame), measured in this run
  std::string systems;  // the systems with that time, by their names in the schedule
};

struct EffectAccount {
  std::size_t people = 0;
  std::size_t muscles = 0;  // of each, both legs
  double tick_s = 0;
  std::vector<Effect> effects;
  std::vector<std::string> notes;
};

/// The schedule's own timings of some ticks, by system, s a person and tick.
class Meter {
 public:
  Meter(Simulation& simulation, std::size_t count) : simulation_(simulation), people_(count) {}

  /// Returns the seconds of the systems that `counts` selects, the minimum of a few rounds. Adds names to `names`.
  template <class Counts>
  double operator()(Counts counts, std::string* names = nullptr) {
    constexpr int rounds = 6, ticks = 5;
    for (int i = 0; i < 2; ++i) simulation_.tick();
    double least = INFINITY;
    for (int round = 0; round < rounds; ++round) {
      simulation_.schedule().reset_timings();
      for (int i = 0; i < ticks; ++i) simulation_.tick();
      double sum = 0;
      std::string used;
      for (const SystemReport& system : simulation_.report().systems) {
        if (!counts(system) || system.total_entities == 0) continue;
        sum += system.total_seconds;
        used += (used.empty() ? "" : ", ") + std::string(system.name);
      }
      least = std::min(least, sum);
      if (names != nullptr) *names = used;
    }
    return 1e6 * least / (ticks * static_cast<double>(people_));
  }

 private:
  Simulation& simulation_;
  std::size_t people_;
};

auto named(std::vector<std::string_view> names) {
  return [names = std::move(names)](const SystemReport& system) {
    return std::ranges::find(names, system.name) != names.end();
  };
}

bool deforms(const SystemReport& system) {
  return is_deformation(system.module);
}

std::string_view level_adds(const LodLevel& level) {
  if (level.method == Method::explicit_central)
    return "81 nodes as in the paper, explicit: kept as the measure of the others";
  if (!level.moving) return "bellies follow their lines, without swing of their own";
  if (level.modes <= 8) return "bellies swing: the slowest waves";
  if (level.modes <= 16) return "waves after each heel strike";
  return "as the fine mesh moves, to a percent or two";
}

/// Measures each effect by switching it on in a crowd of `count` and reading Simulation::report(). `progress` receives
/// the current measurement. Errors: refusals of the simulation.
EffectAccount measure_effects(std::size_t count, const std::function<void(const std::string&)>& progress) {
  Simulation simulation;
  EffectAccount account{count, 2 * usual_muscle_count, simulation.tick_s(), {}, {}};
  std::vector<Entity> people;
  progress("spawning");
  for (std::size_t i = 0; i < count; ++i) {
    const auto person =
        must(simulation.spawn({}, {.speed_m_s = 0.9F + 0.8F * static_cast<float>(i) / static_cast<float>(count)}));
    people.push_back(person);
  }
  Meter meter(simulation, count);
  const auto add = [&](std::string name, std::string adds, std::string needs, double us, std::string systems) {
    account.effects.push_back({std::move(name), std::move(adds), std::move(needs), us, std::move(systems)});
  };
  std::string systems;

  progress("walking");
  for (int i = 0; i < 90; ++i) simulation.tick();  // until people no longer step in time with each other
  double us = meter(named({"gait", "replan", "turn"}), &systems);
  add("gait", "steps: where each foot falls, and when", "spawn()", us, systems);
  us = meter(named({"kinematics", "centre of mass"}), &systems);
  add("kinematics", "the skeleton's 48 segments", "gait, or a host's own poses (spawn_posed())", us, systems);

  for (const Entity person : people) simulation.enable(person, Feature::forces);
  us = meter(named({"forces"}), &systems);
  add("forces", "ground reactions and joint moments (nothing to see)", "kinematics; Feature::forces", us, systems);
  for (const Entity person : people) simulation.enable(person, Feature::forces, false);

  progress("muscles");
  LegMuscles choice;
  choice.method = Method::none;
  for (const Entity person : people) must(simulation.set_muscles(person, choice));
  const auto change_all = [&] {
    for (const Entity person : people) must(simulation.set_muscles(person, choice));
  };
  us = meter(named({"leg frames", "lines of action"}), &systems);
  add("lines of action", "where muscles run, how long they are", "kinematics; set_muscles()", us, systems);

  choice.line_motion = true;
  change_all();
  us = meter(named({"line motion"}), &systems);
  add("line motion", "lengthening speed and moment arms (nothing to see)", "lines; LegMuscles::line_motion", us,
      systems);
  choice.line_motion = false;
  choice.activation = ExcitationSource::phase;
  change_all();
  us = meter(named({"activation"}), &systems);
  add("activation", "muscles pull as the walk asks, tendons stretch", "lines; LegMuscles::activation", us, systems);
  for (const Entity person : people) simulation.enable(person, Feature::forces);
  choice.activation = ExcitationSource::moments;
  change_all();
  us = meter(named({"leg moments"}), &systems);
  add("moments", "muscles share the walk's own moments as costs them least", "activation; forces", us, systems);
  choice.activation = ExcitationSource::none;
  change_all();
  for (const Entity person : people) simulation.enable(person, Feature::forces, false);

  const auto set_all = [&](std::size_t level, bool points, bool tuned = false) {
    MuscleMethod method = level_method(level, points);
    method.modal.tuned = tuned;
    for (const Entity person : people) {
      for (std::size_t g = 0; g < usual_muscle_count; ++g)
        must(simulation.set_method(person, static_cast<Muscle>(g), method));
    }
  };
  constexpr std::size_t shown_level = 5;  // its control points and inertia are reported
  constexpr int fading_ticks = 30;
  const auto settle = [&] {
    for (int i = 0; i < fading_ticks; ++i) simulation.tick();
  };
  double moving_us = 0;
  for (std::size_t r = 1; r < level_count; ++r) {
    if (levels[r].cells == Cells{8, 8, 32}) continue;  // same cost in a tick as the coarser one, and slow to make
    progress(fmt::format("muscles, {}", levels[r].name));
    set_all(r, !levels[r].moving);
    settle();
    us = meter(deforms, &systems);
    if (r == shown_level) moving_us = us;
    const std::string needs = levels[r].moving ? "lines; set_method()" : "lines; set_method(); with control points";
    add(fmt::format("muscles, {}", levels[r].name), std::string(level_adds(levels[r])), needs, us, systems);
  }
  set_all(shown_level, true);
  settle();
  us = meter(deforms, &systems) - moving_us;
  add("control points", fmt::format("81 points a muscle to draw from (of {})", levels[shown_level].name),
      "a muscle that is simulated; ModalOptions::control_points", std::max(us, 0.0), systems);

  progress("finite shape");
  const double points_us = us;
  choice.method = Method::none;
  choice.finite_shape = true;
  change_all();
  set_all(shown_level, true);
  settle();
  us = meter(named({"finite shape, modal"}), &systems) - points_us;  // also places them
  add("finite shape", "bellies keep their volume, and are thick where they pull",
      "control points; LegMuscles::finite_shape", std::max(us, 0.0), systems);
  choice.finite_shape = false;
  choice.activation = ExcitationSource::phase;
  choice.method = Method::none;
  change_all();
  set_all(shown_level, false, true);
  settle();
  us = meter(deforms, &systems) - moving_us;
  add("tuned", fmt::format("who pulls is shaken less, and for a shorter time (of {})", levels[shown_level].name),
      "activation; ModalOptions::tuned", std::max(us, 0.0), systems);

  choice.finite_shape.reset();
  choice.activation = ExcitationSource::none;
  choice.method = Method::none;
  change_all();
  set_all(shown_level, true);
  settle();

  progress("surfaces");
  const Person person = *simulation.person(people.front());
  const auto figure = must(make_figure(person));
  WalkRecording recording = begin_recording(figure, static_cast<float>(simulation.tick_s()));
  const Measured skinned = measure(5, [&] {
    recording.frames.clear();
    for (auto& muscle : recording.muscles) muscle.position_m.clear();
    record_frame(figure, simulation, person, recording);
  });
  std::size_t vertices = 0;
  for (const auto& muscle : recording.muscles) vertices += muscle.position_m.front().size();
  add("surfaces", fmt::format("skin of every muscle, {} vertices", vertices), "control points; SurfaceWriter",
      1e6 * skinned.best_s, "skinning");

  progress("inertia");
  set_all(shown_level, false);
  choice.inertia = true;
  choice.method = Method::none;
  change_all();
  set_all(shown_level, false);
  settle();
  us = meter(named({"frame motion"}), &systems) + meter(deforms) - moving_us;
  add("inertia", fmt::format("gravity and every jolt shake bellies (of {})", levels[shown_level].name),
      "lines; LegMuscles::inertia", std::max(us, 0.0), systems + ", and more of deformation");

  account.notes.emplace_back(
      "pictures and files (capture, export) take what is there when they are asked for, and no part of a tick");
  return account;
}

std::string effects_table(const EffectAccount& account) {
  std::string text =
      fmt::format("{} people, {} muscles each, ticks of {:.4g} s; us a person and tick on one core, here and now\n\n",
                  account.people, account.muscles, account.tick_s);
  std::size_t name = 6, adds = 4;
  for (const Effect& effect : account.effects) {
    name = std::max(name, effect.name.size());
    adds = std::max(adds, effect.adds.size());
  }
  text += fmt::format("{:<{}}  {:>8}  {:<{}}  {}\n", "effect", name, "us", "adds", adds, "needs");
  for (const Effect& effect : account.effects) {
    text +=
        fmt::format("{:<{}}  {:>8.3g}  {:<{}}  {}\n", effect.name, name, effect.us, effect.adds, adds, effect.needs);
  }
  for (const std::string& note : account.notes) text += note + "\n";
  return text;
}

std::string effects_json(const EffectAccount& account) {
  Json json;
  json["people"] = account.people;
  json["muscles"] = account.muscles;
  json["tick_s"] = account.tick_s;
  auto& all = json["effects"] = Json::array();
  for (const Effect& effect : account.effects) {
    all.push_back({{"name", effect.name},
                   {"adds", effect.adds},
                   {"needs", effect.needs},
                   {"us_per_person_and_tick", effect.us},
                   {"systems", effect.systems}});
  }
  return json.dump(2) + "\n";
}

constexpr std::size_t max_people = 100000;

struct EffectsCommand {
  std::size_t people = 300;
  std::string json;
};

void run_effects(const EffectsCommand& text) {
  if (text.people < 1 || text.people > max_people)
    throw Stopped(fmt::format("--people {}: give 1 to {}", text.people, max_people));
  if (!text.json.empty()) must(check_result_place("--json", text.json));
  const auto account = measure_effects(text.people, show);
  show("");
  write_output(effects_table(account));
  if (!text.json.empty()) must(write_result("--json", text.json, effects_json(account)));
}

}  // namespace

Subcommand effects_command() {
  auto text = std::make_shared<EffectsCommand>();
  Subcommand command{.name = "effects"};
  command.footer =
      "Every effect is switched on in a crowd of its own and its systems' time read off the simulation's report: what\n"
      "a scene does not ask for costs nothing. Columns: microseconds a person and tick of 1/60 s on one core (of the\n"
      "least busy moment), what it adds to what one sees, what it needs. Muscles come in levels: a few modes of a\n"
      "fine mesh (modal-N), their static answer alone, or the paper's explicit mesh (full); `mobil frontier` shows\n"
      "how far off each is. Level of detail (mobil/lod.h) chooses among them: from a tolerance in metres, a\n"
      "camera and a tolerance in pixels, or a time budget a tick; its why() gives each muscle's method and the "
      "reason.\n"
      "\n"
      "Examples: mobil effects\n"
      "          mobil effects --json effects.json";
  command.options = {{"--people", &text->people, "How many walk while effects are measured"},
                     {"--json", &text->json, "File for the figures"}};
  command.run = [text] { return exit_status_of("effects", attempt([&] { run_effects(*text); })); };
  return command;
}

}  // namespace mobil
