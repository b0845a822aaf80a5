// Whether bytes that claim to be people are some.
#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <string>
#include <string_view>

#include "assets/body/anthropometry.h"
#include "components/gait.h"
#include "components/leg_frames.h"
#include "components/pose.h"
#include "systems/deformation/deformation.h"
#include "systems/lines/muscle_lines.h"
#include "systems/snapshot/simulation_snapshot_work.h"

namespace mobil {
namespace {

tl::unexpected<Error> damaged(const char* what) {
  return fail(std::string("the snapshot does not agree with itself (") + what + "); give one that `save` made");
}

bool has_all(const SavedWorld& world, std::uint32_t table, std::initializer_list<std::uint64_t> ids) {
  return std::all_of(ids.begin(), ids.end(), [&](std::uint64_t id) { return world.part(table, id).has_value(); });
}

TableFacts facts_of(const SavedFront& front, const SavedWorld& world, std::uint32_t table) {
  TableFacts facts{};
  const bool person = has_all(world, table, {type_id<BodySize<float>>(), type_id<Pose<float>>()});
  facts.walker =
      person && has_all(world, table,
                        {type_id<Gait<float>>(), type_id<StepPlan<float>>(), type_id<GaitState<float>>(),
                         type_id<JointAngles<float>>(), type_id<Feet<float>>(), type_id<CentreOfMass<float>>()});
  facts.posed = person && !world.part(table, type_id<Gait<float>>());
  facts.owner_column = world.column(table, type_id<MuscleOwner<float>>());
  facts.muscle = most_muscles;
  const auto lines = world.part(table, type_id<MuscleLines>());
  if (!lines) return facts;
  if (const auto resource = find_resource(front, lines->value)) facts.muscle = resource->recipe.muscle;
  return facts;
}

bool same_body(const SavedPerson& saved, const BodyRequest& body) {
  const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
  return saved.height == bits(body.height_m) && saved.mass == bits(body.mass_kg) &&
         saved.endo == bits(body.biotype.endo) && saved.meso == bits(body.biotype.meso) &&
         saved.ecto == bits(body.biotype.ecto) && saved.constitution == static_cast<std::uint32_t>(body.constitution);
}

bool can_live(const SavedPerson& saved, const People& present) {
  const PersonRecord* now = present.find({saved.index, saved.generation});
  if (now != nullptr && same_body(saved, now->body)) return true;
  if (saved.constitution > static_cast<std::uint32_t>(Constitution::heavy)) return false;
  const auto number = [](std::uint32_t bits) { return std::bit_cast<float>(bits); };
  return make_body({number(saved.height),
                    number(saved.mass),
                    {number(saved.endo), number(saved.meso), number(saved.ecto)},
                    static_cast<Constitution>(saved.constitution)})
      .has_value();
}

/// One of a person's muscles, as far as it is alive.
bool is_theirs(const SavedWorld& world, const std::vector<TableFacts>& facts, const SavedMuscle& muscle,
               std::uint32_t side, const SavedPerson& person) {
  const auto slot = world.find(muscle.entity[side]);
  if (!slot) return true;
  const TableFacts& table = facts[slot->table];
  if (table.owner_column == Table::no_column || table.muscle != muscle.muscle) return false;
  const auto word = [&](std::uint32_t w) { return world.word(slot->table, slot->row, table.owner_column + w); };
  return word(0) == person.index && word(1) == person.generation && word(2) == side;
}

}  // namespace

Result<void> check_modules(const SavedFront& front, const SavedWorld& world, std::span<const Module> modules) {
  for (std::size_t i = 0; i < front.modules.size(); ++i) {
    const SavedModule saved = front.modules[i];
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
      for (const KeyPart& known : module.parts) {
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

Result<void> check_people(const SavedFront& front, const SavedWorld& world, const People& present,
                          std::vector<TableFacts>& facts) {
  facts.clear();
  for (std::uint32_t t = 0; t < world.tables.size(); ++t) {
    facts.push_back(facts_of(front, world, t));
  }
  for (std::size_t i = 0; i < front.choices.size(); ++i) {
    if (!unpack(front.choices[i])) return damaged("a choice of muscles");
  }
  std::uint64_t muscle = 0;
  for (std::size_t i = 0; i < front.people.size(); ++i) {
    const SavedPerson person = front.people[i];
    const auto slot = world.find({person.index, person.generation});
    if (!slot || person.posed > 1 || !(person.posed != 0 ? facts[slot->table].posed : facts[slot->table].walker) ||
        person.choice >= front.choices.size()) {
      return damaged("a person");
    }
    if (!can_live(person, present)) return damaged("a person's body");
    if (person.muscles > muscles().size() || muscle + person.muscles > front.muscles.size())
      return damaged("how many muscles a person has");
    std::uint32_t least = 0;
    for (std::uint32_t m = 0; m < person.muscles; ++m) {
      const SavedMuscle own = front.muscles[muscle++];
      if (own.muscle < least || own.muscle >= muscles().size() || !is_theirs(world, facts, own, right, person) ||
          !is_theirs(world, facts, own, left, person)) {
        return damaged("a person's muscle");
      }
      least = own.muscle + 1;
    }
  }
  if (muscle != front.muscles.size()) return damaged("the number of muscles");
  return {};
}

Result<void> check_key(const TableKey& key, const World& world, const ResourceList& resources,
                       std::span<const Module> modules) {
  const auto recipe = [&](std::uint64_t id) -> const Recipe* {
    const KeyPart* const part = find_part(key, id);
    return part == nullptr ? nullptr : &resources.known()[part->value].recipe;
  };
  const KeyPart* const muscle = find_part(key, type_id<Muscle>());
  for (const KeyPart& part : key) {
    if (part.kind != PartKind::shared) continue;
    const Recipe& of = resources.known()[part.value].recipe;
    if (of.kind == ResourceKind::named) continue;
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

}  // namespace mobil
