#pragma once
// What a simulation keeps to itself, its world's structure and what muscles share: for what is the library's own.

#include <mobil/simulation.h>
#include "systems/people/waking.h"

namespace mobil::inline v0_3 {

struct SimulationWorld {
  static World& of(Simulation& simulation) { return *simulation.world_; }
  static BellyLibrary& library(Simulation& simulation) { return *simulation.library_; }
  static const Jobs& jobs(const Simulation& simulation) { return simulation.jobs_; }
  /// As Simulation::sleep, people being named once each, who keep `keeps` of the library's parts besides.
  static std::size_t sleep(Simulation& simulation, std::span<const Entity> people, std::span<const KeyPart> keeps);
  /// People who sleep managed wake, named once each, without muscles; what Relevance decides of them begins anew.
  static Result<void> wake(Simulation& simulation, std::span<const Entity> people, Woken as);
  /// As Simulation::compact and expand, people being named once each.
  static std::size_t compact(Simulation& simulation, std::span<const Entity> people);
  static Result<void> expand(Simulation& simulation, std::span<const Entity> people);
  /// Who of them sleeps wakes, who is compact is whole; all, or nobody. People there, named once each.
  static Result<void> make_whole(Simulation& simulation, std::span<const Entity> people) {
    return simulation.make_whole(people);
  }
  /// The same, and muscles that they are to have later begin.
  static Result<void> make_muscles_whole(Simulation& simulation, std::span<const Entity> people) {
    return simulation.make_muscles_whole(people);
  }
  /// What choosing remembers of a managed person is that of the muscles that are there.
  static void choose_from_now(Simulation& simulation, Entity human);
  /// Of somebody awake and whole: muscles kept on their row (kept_choice) begin.
  static Result<void> begin_kept(Simulation& simulation, Entity human);
  /// Muscles of those who woke so begin, within that of where they would be (Simulation::wake).
  static Result<void> begin_muscles(Simulation& simulation, std::span<const Entity> people, const LegMuscles& choice,
                                    float within_m);
};

/// Whoever changes rows through it keeps people, their muscles and what choosing remembers in step.
inline World& world_of(Simulation& simulation) {
  return SimulationWorld::of(simulation);
}

}  // namespace mobil::inline v0_3
