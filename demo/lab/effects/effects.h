#pragma once
// The cost account: every effect, what it adds to what one sees, what it costs here and now, what it needs.

#include <functional>
#include <string>
#include <vector>

#include <mobil/engine/error.h>

namespace mobil {

struct Effect {
  std::string name, adds, needs;
  double us = 0;        // a human and tick (of pictures and files: a human and frame), measured in this run
  std::string systems;  // whose time that is, as the schedule calls them
};

struct EffectAccount {
  std::size_t humans = 0;
  std::size_t muscles = 0;  // of each, both legs
  double tick_s = 0;
  std::vector<Effect> effects;
  std::vector<std::string> notes;
};

/// Measures by switching each effect on in a crowd of that many and reading Simulation::report(). `progress` is told
/// what is measured. Errors: what the simulation refuses.
Result<EffectAccount> measure_effects(std::size_t humans, const std::function<void(const std::string&)>& progress = {});

std::string effects_table(const EffectAccount& account);
std::string effects_json(const EffectAccount& account);

}  // namespace mobil
