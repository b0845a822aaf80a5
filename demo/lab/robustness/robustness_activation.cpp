// Active muscles at finite strain: permitted requests of hosts, and leg postures that do not occur in walks.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <numbers>

#include <mobil/components/activation.h>
#include <mobil/systems/muscles/person.h>
#include "assets/body/bent_legs.h"
#include "demo/lab/robustness/robustness.h"
#include "demo/lab/robustness/robustness_world.h"

namespace mobil {
namespace {

LegMuscles hosted(Method method) {
  LegMuscles choice;
  choice.method = method;
  choice.modal.cells = {2, 2, 8};
  choice.activation = ExcitationSource::host;
  return choice;
}

/// Worst values of a person's muscles so far; NaN is kept.
struct Worst {
  double moved_m = 0, volume_off = 0, fibre_off = 0, end_off_m = 0;

  void look(const Simulation& simulation, Entity person) {
    for (const MuscleRef& own : simulation.muscles(person)) {
      for (const Entity muscle : own.entity) {
        const auto pull = simulation.get<Musculotendon>(muscle);
        const auto state = simulation.get<Activation>(muscle);
        if (!pull || !state) continue;
        for (const float x : {pull->force_n, pull->fibre_m, pull->tendon_m, pull->belly_m, state->activation})
          keep_worst(fibre_off, std::isfinite(x) ? 0 : NAN);
        if (const auto report = simulation.get<BellyReport>(muscle)) {
          keep_worst(volume_off, std::abs(double{report->volume_ratio} - 1));
          keep_worst(end_off_m, std::abs(double{report->elongation_m} - double{pull->belly_m}));
        }
      }
    }
    keep_worst(moved_m, largest(control_points(simulation, person)));
  }
};

void excite_all(Simulation& simulation, Entity person, float level) {
  for (const MuscleRef& own : simulation.muscles(person)) {
    for (const Side side : {Side::right, Side::left}) must(simulation.set_excitation(person, own.muscle, side, level));
  }
}

/// Stiffness that rises and falls as fast as activation can, at any rate, must not pump up vibrations.
void robustness_tuned(RobustnessRun& run) {
  Worst walking, standing;
  double grown = 0;
  for (const int apart : {1, 2, 3, 5, 8}) {
    Simulation simulation;
    LegMuscles choice = hosted(Method::modal);
    choice.modal.tuned = true;
    choice.inertia = true;
    const auto walker = must(simulation.spawn({}, {.speed_m_s = 1.8F}));
    const auto stands = must(simulation.spawn_posed({}));
    for (const Entity person : {walker, stands}) must(simulation.set_muscles(person, choice));
    const int ticks = run.quick ? 300 : 3600;
    std::array<double, 2> max_j{};  // in the first second, and later
    for (int tick = 0; tick < ticks; ++tick) {
      const float level = tick / apart % 2 == 0 ? 1.0F : 0.0F;
      for (const Entity person : {walker, stands}) excite_all(simulation, person, level);
      simulation.tick();
      walking.look(simulation, walker);
      standing.look(simulation, stands);
      for (const MuscleRef& own : simulation.muscles(stands)) {
        for (const Entity muscle : own.entity)
          keep_worst(max_j[tick >= 60], double{simulation.get<BellyReport>(muscle)->kinetic_energy_j});
      }
    }
    keep_worst(grown, max_j[1] / max_j[0]);
  }
  constexpr const char* name = "tension on and off at 60, 30, 20, 12 and 7.5 times a second";
  run.at_most(name, "control points' displacement walking, m", 0.1, walking.moved_m, "twice what these walks show");
  run.at_most(name, "control points' displacement standing, m", 0.03, standing.moved_m,
              "twice what a contraction takes");
  run.at_most(name, "kinetic energy of who stands after the first second, over that in it", 1, grown,
              "what pumps would grow; the first contraction is the largest");
}

}  // namespace

void robustness_excitation(RobustnessRun& run) {
  Simulation simulation;
  const auto person = must(simulation.spawn({}, {.speed_m_s = 1.3F}));
  must(simulation.set_muscles(person, hosted(Method::explicit_central)));
  for (int tick = 0; tick < 30; ++tick) simulation.tick();
  const auto before = world_words(simulation);
  std::size_t refused = 0, asked = 0;
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()}) {
    for (std::size_t m = 0; m < usual_muscle_count; ++m, ++asked)
      refused += simulation.set_excitation(person, static_cast<Muscle>(m), Side::right, bad) ? 0 : 1;
  }
  run.at_most("excitations that are no numbers", "of them taken", 0, static_cast<double>(asked - refused),
              "each is refused");
  run.at_most("excitations that are no numbers", "words of the world changed", 0,
              static_cast<double>(different_words(before, world_words(simulation))), "a refusal changes nothing");

  Worst worst;
  const int ticks = run.quick ? 600 : 3600;
  for (int tick = 0; tick < ticks; ++tick) {  // on and off, in every tick, while walking
    excite_all(simulation, person, tick % 2 == 0 ? 1.0F : 0.0F);
    simulation.tick();
    worst.look(simulation, person);
    if (tick % 60 == 0) run.progress(0.5 * tick / ticks);
  }
  run.at_most("excitation 0, 1, 0, 1 … from tick to tick", "control points' displacement, m", 0.1, worst.moved_m,
              "twice what these walks show");
  run.at_most("excitation 0, 1, 0, 1 … from tick to tick", "volume shown off rest", 0.06, worst.volume_off,
              "the explicit method's vibration on top of a shape that keeps it within 0.6 %");
  run.at_most("excitation 0, 1, 0, 1 … from tick to tick", "end of the mesh off what the tendon leaves, m", 1e-5,
              worst.end_off_m, "single precision");

  Simulation still;
  const auto stands = must(still.spawn_posed({}));
  must(still.set_muscles(stands, hosted(Method::modal)));
  excite_all(still, stands, 1);
  const int minutes = run.quick ? 1 : 10;
  const auto belly = [&](std::size_t m) {
    return double{still.get<Musculotendon>(still.muscle(stands, static_cast<Muscle>(m), Side::right))->belly_m};
  };
  std::array<double, usual_muscle_count> at_first{};
  Worst held;
  for (int tick = 0; tick < minutes * 3600; ++tick) {
    still.tick();
    if (tick == 600)
      for (std::size_t m = 0; m < at_first.size(); ++m) at_first[m] = belly(m);
    if (tick % 600 == 599) held.look(still, stands);
    if (tick % 600 == 0) run.progress(0.5 + 0.5 * tick / (minutes * 3600.0));
  }
  double crept = 0;
  for (std::size_t m = 0; m < at_first.size(); ++m) keep_worst(crept, std::abs(belly(m) - at_first[m]));
  run.at_most(fmt::format("{} minutes of tetanus", minutes), "bellies creep, m", 1e-6, crept,
              "a steady pull is steady");
  run.at_most(fmt::format("{} minutes of tetanus", minutes), "volume shown off rest", 0.01, held.volume_off,
              "the tables' promise");
  robustness_tuned(run);
}

void robustness_contraction(RobustnessRun& run) {
  // Every method, then another in each tick: knees and ankles bent to their limits while all muscles are fully active.
  constexpr std::array methods = {Method::explicit_central, Method::implicit_central, Method::newmark, Method::statics,
                                  Method::modal};
  Worst steady, flickering;
  std::uint32_t slack = 0;
  double min_force_n = 0;
  for (std::size_t m = 0; m <= methods.size(); ++m) {
    const bool flickers = m == methods.size();
    Simulation simulation;
    const auto person = must(simulation.spawn_posed({}));
    must(simulation.set_muscles(person, hosted(flickers ? Method::explicit_central : methods[m])));
    excite_all(simulation, person, 1);
    const Body body = simulation.person(person)->body;
    const int ticks = run.quick ? 120 : 480;
    for (int tick = 0; tick < ticks; ++tick) {
      const auto part = static_cast<float>(0.5 - 0.5 * std::cos(2 * std::numbers::pi * tick / 120));
      const LegBend bend{90 * part, 120 * part, 60 * part - 40};
      must(simulation.set_pose(person, with_bent_legs(body, bend)));
      if (flickers) {
        for (std::size_t g = 0; g < usual_muscle_count; ++g) {
          const Method method = methods[(static_cast<std::size_t>(tick) + g) % methods.size()];
          must(simulation.set_method(person, static_cast<Muscle>(g), {method, {.cells = {2, 2, 8}}}));
        }
      }
      simulation.tick();
      (flickers ? flickering : steady).look(simulation, person);
      for (const MuscleRef& own : simulation.muscles(person)) {
        const auto pull = simulation.get<Musculotendon>(own.entity[Side::right]);
        slack += pull->slack;
        min_force_n = std::min(min_force_n, double{pull->force_n});
      }
      run.progress((static_cast<double>(m) + static_cast<double>(tick) / ticks) / (methods.size() + 1.0));
    }
  }
  run.at_most("squats at full activation, every method", "control points' displacement, m", 0.25, steady.moved_m,
              "lines lengthen by up to 0.2 m");
  run.at_least("squats at full activation, every method", "force, N", 0, min_force_n, "tendons do not push",
               fmt::format("{} times a member's tendon was slack", slack));
  run.at_most("squats at full activation, every method", "volume shown off rest", 0.08, steady.volume_off,
              "vibration on top of what keeps it");
  run.at_most("another method in every tick", "control points' displacement, m", 0.25, flickering.moved_m,
              "lines lengthen by up to 0.2 m");
}

}  // namespace mobil
