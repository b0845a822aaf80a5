// The state of a simulation as bytes, and back.
#include "systems/snapshot/simulation_snapshot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <utility>

#include "systems/snapshot/simulation_snapshot_work.h"

namespace mobil {
namespace {

bool has_rows(const Module& module, const World& world) {
  for (const Table& table : world.tables()) {
    if (table.row_count() == 0) continue;
    for (const KeyPart& part : module.parts) {
      if (find_part(table.key(), part.id) != nullptr) return true;
    }
  }
  return false;
}

SavedModule pack(const Module& module) {
  SavedModule saved{};
  module.name.copy(saved.name, sizeof(saved.name));
  saved.version = module.version;
  return saved;
}

/// How long the front's lists are. Marks resources that tables with rows have.
FrontHeader count(const World& world, const People& people, std::size_t fading, std::span<const Module> modules,
                  std::vector<std::uint8_t>& used) {
  FrontHeader header{};
  for (const Module& module : modules) header.modules += has_rows(module, world) ? 1 : 0;
  for (const PersonRecord& person : people.all()) {
    if (!world.alive(person.entity)) continue;  // their host took them away through the world
    ++header.people;
    header.muscles += static_cast<std::uint32_t>(person.muscles.size());
  }
  header.choices = static_cast<std::uint32_t>(people.choices().size());
  header.fading = static_cast<std::uint32_t>(fading);
  used.assign(world.resource_count(), 0);
  for (const Table& table : world.tables()) {
    if (table.row_count() == 0) continue;
    for (const KeyPart& part : table.key()) {
      if (part.kind == PartKind::shared) used[part.value] = 1;
    }
  }
  header.resources = static_cast<std::uint32_t>(std::count(used.begin(), used.end(), 1));
  return header;
}

std::size_t front_bytes(const FrontHeader& header) {
  return sizeof(FrontHeader) + header.modules * sizeof(SavedModule) + header.resources * sizeof(SavedResource) +
         header.choices * sizeof(SavedChoice) + header.people * sizeof(SavedPerson) +
         header.muscles * sizeof(SavedMuscle) + header.fading * sizeof(SavedFading);
}

SavedPerson pack(const PersonRecord& person) {
  const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
  const BodyRequest& body = person.body;
  return {person.entity.index,
          person.entity.generation,
          bits(body.height_m),
          bits(body.mass_kg),
          bits(body.biotype.endo),
          bits(body.biotype.meso),
          bits(body.biotype.ecto),
          static_cast<std::uint32_t>(body.constitution),
          person.posed,
          person.choice,
          static_cast<std::uint32_t>(person.muscles.size())};
}

/// All but the muscles.
PersonRecord unpack(const SavedPerson& saved) {
  const auto number = [](std::uint32_t bits) { return std::bit_cast<float>(bits); };
  PersonRecord person;
  person.entity = {saved.index, saved.generation};
  person.body = {number(saved.height),
                 number(saved.mass),
                 {number(saved.endo), number(saved.meso), number(saved.ecto)},
                 static_cast<Constitution>(saved.constitution)};
  person.posed = saved.posed != 0;
  person.choice = saved.choice;
  return person;
}

OwnMuscle unpack(const SavedMuscle& saved) {
  return {static_cast<Muscle>(saved.muscle), {saved.entity[0], saved.entity[1]}};
}

/// Whether only values need to be put back.
bool same_people(const SavedFront& saved, const People& present) {
  if (saved.people.size() != present.all().size() || saved.choices.size() != present.choices().size()) return false;
  for (std::size_t i = 0; i < saved.choices.size(); ++i) {
    if (!(saved.choices[i] == pack(present.choices()[i]))) return false;
  }
  for (std::size_t i = 0; i < saved.people.size(); ++i) {
    const SavedPerson person = saved.people[i];
    const PersonRecord& now = present.all()[i];
    if (now.entity != Entity{person.index, person.generation} || now.muscles.size() != person.muscles) return false;
  }
  return true;
}

/// Everybody anew. Errors: a choice that is there twice.
Result<void> make_people(const SavedFront& saved, People& people) {
  people = People();
  for (std::size_t i = 0; i < saved.choices.size(); ++i) {
    if (people.number_of(*unpack(saved.choices[i])) != i)
      return fail("the snapshot does not agree with itself (a choice of muscles); give one that `save` made");
  }
  std::uint32_t end = 0;
  for (std::size_t i = 0; i < saved.people.size(); ++i) end = std::max(end, saved.people[i].index + 1);
  people.reserve(saved.people.size(), end);
  for (std::size_t i = 0, muscle = 0; i < saved.people.size(); ++i) {
    const SavedPerson of = saved.people[i];
    PersonRecord person = unpack(of);
    for (std::uint32_t m = 0; m < of.muscles; ++m) person.muscles.push_back(unpack(saved.muscles[muscle++]));
    people.add(std::move(person));
  }
  if (people.all().size() != saved.people.size())
    return fail("the snapshot does not agree with itself (somebody is there twice); give one that `save` made");
  return {};
}

void put_values(const SavedFront& saved, People& people) {
  for (std::size_t i = 0, muscle = 0; i < saved.people.size(); ++i) {
    PersonRecord& person = people.all()[i];
    PersonRecord as_saved = unpack(saved.people[i]);
    as_saved.muscles.swap(person.muscles);
    for (OwnMuscle& own : as_saved.muscles) own = unpack(saved.muscles[muscle++]);
    person = std::move(as_saved);
  }
}

bool same_fading(const SavedFront& saved, const std::deque<MuscleWork::Fading>& present) {
  if (saved.fading.size() != present.size()) return false;
  for (std::size_t i = 0; i < present.size(); ++i) {
    if (saved.fading[i].muscle != present[i].muscle || saved.fading[i].ends != present[i].ends) return false;
  }
  return true;
}

}  // namespace

Result<SavedFront> read_front(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  SavedFront front;
  FrontHeader& header = front.header;
  if (reader.take(header)) {
    front.modules = reader.take_many<SavedModule>(header.modules);
    front.resources = reader.take_many<SavedResource>(header.resources);
    front.choices = reader.take_many<SavedChoice>(header.choices);
    front.people = reader.take_many<SavedPerson>(header.people);
    front.muscles = reader.take_many<SavedMuscle>(header.muscles);
    front.fading = reader.take_many<SavedFading>(header.fading);
  }
  if (!reader.whole())
    return fail("the snapshot does not agree with itself (the sizes of its lists); give one that `save` made");
  return front;
}

std::optional<SavedResource> find_resource(const SavedFront& front, std::uint64_t number) {
  std::size_t low = 0, high = front.resources.size();
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    const SavedResource resource = front.resources[middle];
    if (resource.number == number) return resource;
    (resource.number < number ? low : high) = resource.number < number ? middle + 1 : middle;
  }
  return std::nullopt;
}

SnapshotWork& Simulation::snapshot_work() const {
  if (snapshots_ == nullptr) snapshots_ = std::make_shared<SnapshotWork>();
  snapshots_->resources.learn(world_, bellies_, modules_);
  return *snapshots_;
}

std::size_t Simulation::snapshot_bytes() const {
  SnapshotLayout layout = WorldSnapshot::layout(world_);
  layout.front = front_bytes(count(world_, people_, work_->fading.size(), modules_, snapshot_work().used));
  return layout.bytes();
}

Result<std::size_t> Simulation::save(std::span<std::byte> out) const {
  SnapshotWork& work = snapshot_work();
  FrontHeader header = count(world_, people_, work_->fading.size(), modules_, work.used);
  header.tick_units = clock_.tick_units();
  header.remainder_units = clock_.remainder_units();
  header.tick = tick_;
  SnapshotLayout layout = WorldSnapshot::layout(world_);
  layout.front = front_bytes(header);
  if (out.size() < layout.bytes())
    return fail(fmt::format("save: the snapshot takes {} bytes, and there is room for {}; give snapshot_bytes()",
                            layout.bytes(), out.size()));
  ByteWriter writer(&out[layout.front_at()]);
  writer.put(header);
  for (const Module& module : modules_) {
    if (has_rows(module, world_)) writer.put(pack(module));
  }
  for (std::uint32_t number = 0; number < work.used.size(); ++number) {
    if (work.used[number] == 0) continue;
    const auto& [recipe, fingerprint] = work.resources.known()[number];
    if (recipe.kind == ResourceKind::unknown)
      return fail(
          "save: an entity has a shared resource that no module names; list it in a module's resources, or take it"
          " off all that have it");
    writer.put(SavedResource{recipe, fingerprint, number, 0});
  }
  for (const LegMuscles& choice : people_.choices()) writer.put(pack(choice));
  for (const PersonRecord& person : people_.all()) {
    if (world_.alive(person.entity)) writer.put(pack(person));
  }
  for (const PersonRecord& person : people_.all()) {
    if (!world_.alive(person.entity)) continue;
    for (const OwnMuscle& own : person.muscles) {
      writer.put(SavedMuscle{static_cast<std::uint32_t>(own.muscle), {own.entity[0], own.entity[1]}});
    }
  }
  for (const auto& [muscle, ends] : work_->fading) writer.put(SavedFading{muscle, ends});
  WorldSnapshot::save(world_, layout, out.first(layout.bytes()), jobs_);
  return layout.bytes();
}

Result<void> Simulation::restore(std::span<const std::byte> in) {
  Result<void> done;
  try {
    done = restore_checked(in);
  } catch (const std::bad_alloc&) {
    done = fail("there is no memory for it; give the simulation more");
  }
  if (done) return {};
  WorldSnapshot::give_up(world_);
  return fail("restore: " + done.error().message);
}

Result<void> Simulation::restore_checked(std::span<const std::byte> in) {
  const auto open = open_snapshot(in, jobs_);
  if (!open) return tl::unexpected(open.error());
  const auto world = WorldSnapshot::read(*open);
  if (!world) return tl::unexpected(world.error());
  const auto front = read_front(open->front);
  if (!front) return tl::unexpected(front.error());
  const FrontHeader& header = front->header;
  if (header.tick_units != clock_.tick_units() || header.remainder_units < 0 ||
      header.remainder_units >= clock_.tick_units()) {
    return fail(fmt::format("the snapshot's ticks are {} s long and this simulation's {} s; make one with that tick_s",
                            std::ldexp(static_cast<double>(header.tick_units), -50), clock_.tick_s()));
  }
  SnapshotWork& work = snapshot_work();
  if (auto ok = check_modules(*front, *world, modules_); !ok) return ok;
  if (auto ok = check_people(*front, *world, people_, work.facts); !ok) return ok;
  work.parts.clear();
  for (const Module& module : modules_) work.parts.insert(work.parts.end(), module.parts.begin(), module.parts.end());
  work.shared.clear();
  for (std::size_t i = 0; i < front->resources.size(); ++i) {
    const SavedResource saved = front->resources[i];
    const auto number = work.resources.number_of(saved, world_, bellies_, modules_);
    if (!number) return tl::unexpected(number.error());
    work.shared.push_back({resource_type(saved.recipe), saved.number, *number});
  }
  const auto check = [this](const TableKey& key) { return check_key(key, world_, snapshots_->resources, modules_); };
  if (auto ok = work.world.prepare(world_, *world, work.parts, work.shared, check); !ok) return ok;
  const bool people_stay = same_people(*front, people_), fading_stays = same_fading(*front, work_->fading);
  if (!people_stay) {
    if (auto ok = make_people(*front, work.people); !ok) return ok;
  }
  if (!fading_stays) {
    work.fading.clear();
    for (std::size_t i = 0; i < front->fading.size(); ++i)
      work.fading.push_back({front->fading[i].muscle, front->fading[i].ends});
  }

  // From here on nothing fails.
  work.world.commit(world_, *world, jobs_);
  if (people_stay) {
    put_values(*front, people_);
  } else {
    std::swap(people_, work.people);
    work.people.clear();
  }
  if (!fading_stays) std::swap(work_->fading, work.fading);
  work_->recent = {};
  tick_ = header.tick;
  clock_.set_remainder_units(header.remainder_units);
  return {};
}

}  // namespace mobil
