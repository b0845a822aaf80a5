// Far from the origin, for a day, in ticks of any length; level of detail under cameras that flicker and with zero
// budget.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include <mobil/components/fade.h>
#include <mobil/components/step_plan.h>
#include <mobil/engine/geometry.h>
#include <mobil/lod.h>
#include <mobil/step_report.h>
#include "demo/lab/robustness/robustness.h"
#include "demo/lab/robustness/robustness_world.h"

namespace mobil {
namespace {

using namespace geometry;

double distance_m(const Vec3<float>& a, const Vec3<float>& b) {
  return std::hypot(double{a.x} - double{b.x}, double{a.y} - double{b.y}, double{a.z} - double{b.z});
}

/// Returns the distances of all joints from the pelvis.
std::vector<double> shape_of(const Pose<float>& pose) {
  std::vector<double> shape;
  for (const auto& p : pose.position_m) shape.push_back(distance_m(p, pose.position_m[0]));
  return shape;
}

/// Returns the distance between floats of that size.
double spacing_m(double far_m) {
  const auto at = static_cast<float>(far_m);
  return double{std::nextafter(at, std::numeric_limits<float>::infinity())} - double{at};
}

Entity walker(Simulation& simulation, float speed_m_s, bool muscles, Method method = Method::modal) {
  GaitRequest gait;
  gait.speed_m_s = speed_m_s;
  const auto person = must(simulation.spawn({.height_m = 1.75F, .mass_kg = 72}, gait));
  if (!muscles) return person;
  LegMuscles choice;
  choice.method = method;
  choice.modal.cells = {2, 2, 8};
  must(simulation.set_muscles(person, choice));
  return person;
}

std::vector<Entity> rows_of_walkers(Simulation& simulation, int count) {
  std::vector<SpawnRequest> people(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    SpawnRequest& one = people[static_cast<std::size_t>(i)];
    one.body = {.height_m = 1.5F + 0.4F * static_cast<float>(i % 37) / 37, .mass_kg = 60};
    one.body.mass_kg = 22.5F * one.body.height_m * one.body.height_m;
    one.gait.speed_m_s = 0.9F + 0.6F * static_cast<float>(i % 23) / 23;
    one.x_m = 1.2F * static_cast<float>(i % 100);
    one.z_m = 1.5F * static_cast<float>(i / 100);
  }
  std::vector<Entity> made(people.size());
  must(simulation.spawn(people, made));
  return made;
}

}  // namespace

void robustness_far(RobustnessRun& run) {
  constexpr std::array places_m = {100.0, 1e3, 8e3, 64e3, 100e3, 999e3};
  for (const double far_m : places_m) {
    Simulation near, far;
    const auto here = walker(near, 1.3F, true), there = walker(far, 1.3F, true);
    must(far.place(there, static_cast<float>(far_m), static_cast<float>(-far_m), 0));
    double limb_m = 0, points_m = 0;
    for (int tick = 0; tick < 240; ++tick) {
      near.tick();
      far.tick();
      const auto a = shape_of(*near.get<Pose>(here)), b = shape_of(*far.get<Pose>(there));
      for (std::size_t i = 0; i < a.size(); ++i) {
        keep_worst(limb_m, std::abs(a[i] - b[i]));
      }
      keep_worst(points_m, largest_difference(control_points(near, here), control_points(far, there)));
    }
    const double spacing = spacing_m(far_m);
    const std::string tried = fmt::format("{:g} km from the origin along both axes", far_m / 1e3);
    run.at_most(
        tried, "joints' distances from the pelvis off those at the origin, m", 8 * spacing + 1e-5, limb_m,
        fmt::format("floats are {:.2g} m apart there, and a place is a sum of up to thirty along the spine", spacing));
    run.at_most(tried, "control points off those at the origin, m", 4 * spacing + 1e-4, points_m,
                "lines of action are a few roundings off, and bellies follow them");
    must(far.shift_origin(static_cast<float>(far_m), static_cast<float>(-far_m)));
    for (int tick = 0; tick < 240; ++tick) {
      near.tick();
      far.tick();
    }
    run.at_most(tried + ", then the origin moved there and 4 s walked", "control points off those of who never left, m",
                1e-4, largest_difference(control_points(near, here), control_points(far, there)),
                "nothing is left of the way but e^-16 of what it excited");
  }
}

void robustness_day(RobustnessRun& run) {
  const double hours = run.quick ? 0.1 : 24;
  const auto ticks = static_cast<std::uint32_t>(hours * 3600 * 60);
  Simulation awake, asleep;
  const auto walks = walker(awake, 1.4F, false), sleeps = walker(asleep, 1.4F, false);
  for (int tick = 0; tick < 300; ++tick) {
    awake.tick();
    asleep.tick();
  }
  const Vec3<float> from = awake.get<Pose>(walks)->position_m[0];
  const std::uint32_t steps_before = awake.get<GaitState>(walks)->steps;
  must(asleep.set_state({&sleeps, 1}, PersonState::asleep));
  const double duration_s = double{awake.get<StepPlan>(walks)->duration_s};
  for (std::uint32_t tick = 0; tick < ticks; ++tick) {
    awake.tick();
    if (tick % 100000 == 0) run.progress(static_cast<double>(tick) / ticks);
  }
  for (std::uint32_t tick = 0; tick < ticks; ++tick) asleep.tick();
  const Vec3<float> to = awake.get<Pose>(walks)->position_m[0];
  const double walked_m = distance_m(from, to), seconds = ticks / 60.0;
  const std::string tried = fmt::format("{:g} hours of walking, {:.1f} km", hours, walked_m / 1e3);
  run.at_most(tried, "of the way too much or too little", 1e-3, std::abs(walked_m / (1.4 * seconds) - 1),
              "the step's length and duration are what was asked for to single precision; a step more or less");
  run.at_most(tried, "steps too many or too few", 1 + 1e-6 * seconds / duration_s,
              std::abs(awake.get<GaitState>(walks)->steps - steps_before - seconds / duration_s),
              "the clock counts whole units of 2^-15 ticks");
  run.at_most(tried, "off the line aside, m", 1, std::abs(double{to.x} - double{from.x}),
              "a straight line is anchor + k chord, not a sum");
  must(asleep.set_state({&sleeps, 1}, PersonState::full));
  for (int tick = 0; tick < 60; ++tick) {
    awake.tick();
    asleep.tick();
  }
  run.at_most(fmt::format("{:g} hours asleep against the same awake", hours),
              "words of the person that differ, a second after waking", 0,
              static_cast<double>(different_words(person_words(awake, walks), person_words(asleep, sleeps))),
              "clock and place follow in closed form, to the bit");
}

void robustness_ticks(RobustnessRun& run) {
  constexpr double longest_tick_s = 1.0 / 10;
  constexpr std::array rates_hz = {10.0, 20.0, 24.0, 30.0, 50.0, 60.0, 75.0, 90.0, 120.0, 144.0, 240.0, 500.0, 1000.0};
  for (const double rate_hz : rates_hz) {
    double speed_off = 0, worst_m = 0;
    for (const Method method : {Method::explicit_central, Method::newmark, Method::modal}) {
      Simulation simulation({.tick_s = 1 / rate_hz});
      const auto person = walker(simulation, 1.4F, true, method);
      const auto run_s = [&](double seconds) {
        for (int tick = 0; tick < static_cast<int>(seconds * rate_hz); ++tick) {
          simulation.tick();
          keep_worst(worst_m, largest(control_points(simulation, person)));
        }
      };
      run_s(run.quick ? 1 : 2);
      const Vec3<float> from = simulation.get<Pose>(person)->position_m[0];
      const double start_s = simulation.time_s();
      run_s(run.quick ? 2 : 20);
      const Vec3<float> to = simulation.get<Pose>(person)->position_m[0];
      const double speed = distance_m(from, to) / (simulation.time_s() - start_s);
      keep_worst(speed_off, std::abs(speed / 1.4 - 1));
    }
    const std::string tried = fmt::format("{:g} ticks a second", rate_hz);
    run.at_most(tried, "of the speed asked for, off", run.quick ? 0.1 : 0.01, speed_off,
                "a step begins or ends within the time measured");
    run.at_most(tried, "largest displacement of a control point, m", 1 / rate_hz >= longest_tick_s ? 0.15 : 0.1,
                worst_m,
                "twice what this walk shows at 60 ticks a second; steps within a tick stay below critical ones");
  }
}

void robustness_lod(RobustnessRun& run) {
  const int crowd = run.quick ? 60 : 400, updates = run.quick ? 120 : 600;
  struct Scene {
    const char* name;
    int turns_every;  // updates
    bool asleep, compact;
    double budget_s;
  };
  constexpr std::array scenes = {
      Scene{"a camera that turns round in every update", 1, false, false, 0},
      Scene{"a camera that turns round in every update, people out of sight compact", 1, false, true, 0},
      Scene{"a camera that turns round every 20 updates, people out of sight asleep", 20, true, true, 0},
      Scene{"a budget of a nanosecond", 0, false, false, 1e-9},
      Scene{"a budget of a nanosecond and a camera that turns round", 7, false, true, 1e-9}};
  double part = 0;
  for (const Scene& scene : scenes) {
    Simulation simulation;
    const auto people = rows_of_walkers(simulation, crowd);
    LodOptions options;
    options.machine_factor = 1;
    Lod lod = simulation.lod();
    must(lod.set_options(options));
    LodScene needs;
    needs.muscles.reset();
    needs.muscles.set(static_cast<std::size_t>(Muscle::triceps_surae));
    needs.camera = Viewpoint{.position_m = {20, 1.6F, -5}, .near_m = 3, .reach_m = 60};
    needs.compact_unseen = scene.compact;
    if (scene.asleep) needs.asleep_beyond_m = 20;
    if (scene.budget_s > 0) needs.budget_s = scene.budget_s;
    must(lod.set_scene(needs));
    must(lod.manage(people));
    std::size_t refused = 0;
    double worst_m = 0, cheapest_s = 1e9;
    for (int update = 0; update < updates; ++update) {
      if (scene.turns_every > 0 && update % scene.turns_every == 0) {
        needs.camera->forward.z = -needs.camera->forward.z;
        must(lod.set_scene(needs));
      }
      simulation.tick();
      const LodReport& report = lod.report();
      refused += report.refused;
      cheapest_s = std::min(cheapest_s, report.predicted_s);
      for (const Entity person : people) keep_worst(worst_m, largest(control_points(simulation, person)));
    }
    run.at_most(scene.name, "refusals", 0, static_cast<double>(refused),
                "every choice is one that the simulation takes");
    run.at_most(scene.name, "largest displacement of a control point, m", 0.1, worst_m,
                "twice what these walks show: changes of method do not kick");
    std::size_t there = 0;
    for (const Entity person : people) there += simulation.get<Pose>(person).has_value() ? 1 : 0;
    run.at_least(scene.name, "people with a pose", static_cast<double>(crowd), static_cast<double>(there),
                 "awake, compact or asleep, everybody is somewhere");
    run.progress(++part / static_cast<double>(scenes.size()));
  }
}

}  // namespace mobil
