#include "systems/snapshot/snapshot_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/components/leg_muscles.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/interrupt.h>
#include "engine/snapshot.h"
#include "systems/muscles/muscle_parts.h"

namespace mobil::inline v0_3 {
namespace {

/// Returns which words of a table's rows are floats: the float words of components, and all words of fields. (Of fields
/// with two numbers a word, the upper number is checked.)
std::vector<bool> float_words(const SavedWorld& world, std::uint32_t table, std::span<const Module> modules) {
  const SavedTable of = world.tables[table];
  std::vector<bool> found(of.words, false);
  for (const Module& module : modules) {
    for (const ComponentId& part : module.parts) {
      const std::uint32_t first = world.column(table, part.id);
      if (first == Table::no_column) continue;
      const std::uint64_t words = part.kind == PartKind::field ? world.part(table, part.id)->value : part.value;
      for (std::uint32_t w = 0; w < words; ++w) found[first + w] = part.is_float == nullptr || part.is_float[w];
    }
  }
  return found;
}

/// Estimates the steps a tick of an explicit belly of a choice, for a belly 4 cm across with cubic elements.
double likely_steps(const LegMuscles& choice, double tick_s) {
  const Material& m = choice.material;
  const double modulus = m.young_pa * (1 - m.poisson) / ((1 + m.poisson) * (1 - 2 * m.poisson));
  const double element_m = 0.04 / std::max({choice.cells[0], choice.cells[1], 1U});
  const double half_1_s = std::sqrt(modulus / m.density_kg_m3) / element_m;  // half of the highest frequency
  const double damped = choice.stiffness_damping_s * half_1_s;
  return tick_s * half_1_s * (std::sqrt(1 + damped * damped) + damped);
}

}  // namespace

Result<void> check_modules(const Records<SavedModule>& all_saved, const SavedWorld& world,
                           std::span<const Module> modules) {
  for (std::size_t i = 0; i < all_saved.size(); ++i) {
    const SavedModule saved = all_saved[i];
    const std::string_view name(saved.name, strnlen(saved.name, sizeof(saved.name)));
    const auto same = [&](const Module& module) {
      return std::string_view(module.name).substr(0, sizeof(saved.name)) == name;
    };
    const auto at = std::find_if(modules.begin(), modules.end(), same);
    if (at == modules.end()) {
      return fail("the snapshot has rows of a module named '" + std::string(name) +
                  "', which this simulation does not have; give it to SimulationOptions::modules");
    }
    if (at->version != saved.version) {
      return fail("the snapshot was made with version " + std::to_string(saved.version) + " of module '" +
                  std::string(name) + "', and this program has version " + std::to_string(at->version) +
                  "; restore it with the program that made it");
    }
  }
  for (std::uint32_t t = 0; t < world.tables.size(); ++t) {
    for (const Module& module : modules) {
      bool has = false;
      for (const ComponentId& known : module.parts) {
        const auto part = world.part(t, known.id);
        has = has || part;
        if (part && (part->kind != static_cast<std::uint32_t>(known.kind) ||
                     ((known.kind == PartKind::component || known.kind == PartKind::published) &&
                      part->value != known.value))) {
          return fail("the snapshot's " + std::string(known.name) +
                      " is laid out otherwise than this program's; restore it with the program that made it");
        }
      }
      if (!has || !module.check_rows) continue;
      if (auto sound = module.check_rows(world, t); !sound) return sound;
    }
  }
  return {};
}

Result<void> check_numbers(const SavedWorld& world, std::span<const Module> modules, const Jobs& jobs) {
  for (std::uint32_t t = 0; t < world.tables.size(); ++t) {
    const SavedTable table = world.tables[t];
    const std::vector<bool> is_float = float_words(world, t, modules);
    const std::size_t block_bytes = std::size_t{table.words} * lane_count * sizeof(std::uint32_t);
    const std::size_t blocks = (table.rows + lane_count - 1) / lane_count;
    std::atomic<bool> finite = true;
    in_parallel(jobs, blocks, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        check_interrupt();
        const std::byte* const block = &world.blocks[table.first_block_byte + b * block_bytes];
        for (std::size_t w = 0; w < is_float.size(); ++w) {
          if (!is_float[w]) continue;
          std::uint32_t lane[lane_count], worst = 0;
          std::memcpy(lane, block + w * sizeof lane, sizeof lane);
          for (const std::uint32_t bits : lane) worst = std::max(worst, bits & 0x7fffffffU);
          if (worst >= 0x7f800000U) finite = false;
        }
      }
    });
    if (!finite) return damaged("a number that is not finite");
  }
  return {};
}

Result<void> check_key(const Archetype& key, const World& world, const ResourceList& resources,
                       std::span<const Module> modules) {
  const auto recipe = [&](std::uint64_t id) -> const Recipe* {
    const ComponentId* const part = find_component(key, id);
    return part == nullptr ? nullptr : &resources.known()[part->value].recipe;
  };
  const ComponentId* const muscle = find_component(key, type_id<Muscle>());
  for (const ComponentId& part : key) {
    if (part.kind != PartKind::shared) continue;
    const Recipe& of = resources.known()[part.value].recipe;
    if (of.kind == ResourceKind::named || of.kind == ResourceKind::choice) continue;
    if (muscle == nullptr || of.muscle != muscle->value) return damaged("the parts of a muscle");
  }
  const Recipe* const solver = recipe(type_id<BellySolver>());
  const Recipe* const shape = recipe(type_id<MuscleTemplate>());
  if (solver != nullptr && (shape == nullptr || !(solver->choice == shape->choice)))
    return damaged("the parts of a muscle");
  for (const Module& module : modules) {
    if (!module.check_key) continue;
    if (auto ok = module.check_key(key, world); !ok) return ok;
  }
  return {};
}

Result<void> check_steps(const Archetype& key, const World& world, double tick_s, std::size_t most) {
  const auto kind = muscle_kind(key, world);
  double steps = kind ? kind->steps : 0;
  const ComponentId* const part = find_component(key, type_id<LegMuscles>());
  const auto* const choice = part == nullptr ? nullptr : static_cast<const LegMuscles*>(world.resource(part->value));
  if (choice != nullptr && choice->muscles.any()) {
    if (!check_choice(*choice, tick_s)) return damaged("a choice of muscles");
    steps = std::max(
        steps, choice->dt_s ? static_cast<double>(steps_of(tick_s, *choice->dt_s)) : likely_steps(*choice, tick_s));
  }
  if (steps <= static_cast<double>(most)) return {};
  return fail(
      fmt::format("a muscle of the snapshot takes {:.0f} steps a tick, and at most {} are allowed; raise"
                  " RestoreLimits::steps",
                  steps, most));
}

}  // namespace mobil::inline v0_3
