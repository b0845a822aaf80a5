#include <mobil/people_shard.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include <mobil/lod.h>
#include <mobil/shard_bytes.h>
#include "engine/row_hash.h"

namespace mobil::inline v0_3 {
namespace {

struct Numbered {
  std::uint64_t number;
  Entity entity;
};

/// Fixes the machine factor, so that decisions depend on state alone.
LodOptions choosing(const LegMuscles& muscles) {
  LodOptions options;
  options.machine_factor = 1;
  options.leg_muscles = muscles;
  return options;
}

}  // namespace

PersonCommand come(std::uint64_t number, const BodyRequest& body, float speed_m_s, float x_m, float z_m,
                   float heading_rad) {
  return {number,
          Wish::come,
          0,
          {body.height_m, body.mass_kg, body.biotype.endo, body.biotype.meso, body.biotype.ecto,
           static_cast<float>(body.constitution), static_cast<float>(body.sex), speed_m_s, x_m, z_m, heading_rad,
           body.age_y}};
}
PersonCommand go(std::uint64_t number) {
  return {number, Wish::go, 0, {}};
}
PersonCommand walk(std::uint64_t number, float speed_m_s) {
  return {number, Wish::walk, 0, {speed_m_s}};
}
PersonCommand turn(std::uint64_t number, float heading_rad) {
  return {number, Wish::turn, 0, {heading_rad}};
}
PersonCommand place(std::uint64_t number, float x_m, float z_m, float heading_rad) {
  return {number, Wish::place, 0, {x_m, z_m, heading_rad}};
}
PersonCommand look(const Viewpoint& camera, float tolerance_px, float asleep_beyond_m) {
  const Vec3<float>&at = camera.position_m, &f = camera.forward;
  return {0,
          Wish::look,
          0,
          {at.x, at.y, at.z, f.x, f.y, f.z, camera.half_angle_rad, camera.radians_per_pixel, camera.near_m,
           camera.reach_m, tolerance_px, asleep_beyond_m}};
}

PeopleShard::PeopleShard(std::uint32_t shard, const PeopleShardOptions& options)
    : shard_(shard), options_(options), simulation_(options.simulation) {
  if (!options.muscles) return;
  if (auto done = simulation_.lod().set_options(choosing(*options.muscles)); !done)
    throw std::invalid_argument(done.error().message);
  if (auto done = simulation_.lod().set_scene(options.scene); !done) throw std::invalid_argument(done.error().message);
}

Entity PeopleShard::find(std::uint64_t number) const {
  const auto found = people_.find(number);
  return found == people_.end() ? Entity{} : found->second;
}

Result<void> PeopleShard::apply(std::span<const std::byte> commands) {
  PlainReader reader(commands);
  const auto all = reader.take_many<PersonCommand>(commands.size() / sizeof(PersonCommand));
  if (!reader.whole()) return fail("people's commands are no whole number of commands; make them of PersonCommand");
  for (const PersonCommand& command : all) {
    if (command.wish != Wish::look && shard_of(command.number, options_.shards) != shard_) continue;
    const bool counts = command.wish != Wish::look || shard_ == 0;  // all shards execute `look`, and only one counts it
    refused_ += obey(command) || !counts ? 0 : 1;
  }
  return {};
}

bool PeopleShard::obey(const PersonCommand& command) {
  if (command.wish == Wish::come) return obey_come(command);
  if (command.wish == Wish::look) return obey_look(command);
  const auto found = people_.find(command.number);
  if (found == people_.end()) return false;
  const auto& value = command.value;
  switch (command.wish) {
    case Wish::go:
      simulation_.despawn(found->second);
      people_.erase(found);
      return true;
    case Wish::walk:
      return simulation_.change_gait(found->second, {.speed_m_s = value[0]}).has_value();
    case Wish::turn:
      return simulation_.turn_to(found->second, value[0]).has_value();
    case Wish::place:
      return simulation_.place(found->second, value[0], value[1], value[2]).has_value();
    default:
      return false;
  }
}

bool PeopleShard::obey_come(const PersonCommand& command) {
  if (people_.contains(command.number)) return false;
  const auto& value = command.value;
  const auto is_one_of = [](float given, int count) {
    return given >= 0 && given < static_cast<float>(count) && given == std::floor(given);
  };
  if (!is_one_of(value[5], 4) || !is_one_of(value[6], 2)) return false;
  SpawnRequest request;
  request.body.height_m = value[0];
  request.body.mass_kg = value[1];
  request.body.biotype = {value[2], value[3], value[4]};
  request.body.constitution = static_cast<Constitution>(static_cast<int>(value[5]));
  request.body.sex = static_cast<Sex>(static_cast<int>(value[6]));
  request.gait.speed_m_s = value[7];
  request.x_m = value[8];
  request.z_m = value[9];
  request.heading_rad = value[10];
  if (value[11] != 0) request.body.age_y = value[11];  // 0 in commands recorded before ages
  request.muscles = options_.muscles;
  if (options_.muscles) request.parts = managed_parts();
  Entity entity;
  if (!simulation_.spawn({&request, 1}, {&entity, 1})) return false;
  if (options_.muscles && !simulation_.lod().manage(entity)) {
    simulation_.despawn(entity);
    return false;
  }
  people_.emplace(command.number, entity);
  return true;
}

bool PeopleShard::obey_look(const PersonCommand& command) {
  if (!options_.muscles) return false;
  const auto& value = command.value;
  LodScene needs = options_.scene;
  needs.camera = Viewpoint{.position_m = {value[0], value[1], value[2]},
                           .forward = {value[3], value[4], value[5]},
                           .half_angle_rad = value[6],
                           .radians_per_pixel = value[7],
                           .near_m = value[8],
                           .reach_m = value[9]};
  needs.tolerance_px = value[10];
  needs.asleep_beyond_m = value[11] != 0 ? std::optional(value[11]) : std::nullopt;
  if (!simulation_.lod().set_scene(needs)) return false;
  looked_ = command;
  return true;
}

void PeopleShard::tick() {
  simulation_.tick();
}

/// Adds a hash of each number with its person, so that a swap of two people changes the sum.
std::uint64_t PeopleShard::state_sum() const {
  std::uint64_t sum = simulation_.state_sum();
  for (const auto& [number, entity] : people_) {
    struct {
      float height_m = 0, mass_kg = 0, x_m = 0, z_m = 0, time_s = 0, heading_rad = 0;
    } who;
    if (const auto size = simulation_.get<BodySize>(entity)) {
      who.height_m = size->height_m;
      who.mass_kg = size->mass_kg;
    }
    if (const auto state = simulation_.get<GaitState>(entity)) {
      who.x_m = state->line_x_m;
      who.z_m = state->line_z_m;
      who.time_s = state->time_s;
      who.heading_rad = state->heading_rad;
    }
    sum += mix64(mix64(number) ^ hash_bytes(&who, sizeof who));
  }
  return sum;
}

Result<std::vector<std::byte>> PeopleShard::save() const {
  PlainBytes host;
  host.put(shard_);
  host.put(refused_);
  host.put(std::uint64_t{looked_ ? 1U : 0U});
  host.put(looked_.value_or(PersonCommand{}));
  host.put(std::uint64_t{people_.size()});
  for (const auto& [number, entity] : people_) host.put(Numbered{number, entity});
  return pack_shard(simulation_, host.bytes());
}

Result<void> PeopleShard::restore(std::span<const std::byte> saved) {
  const auto host = unpack_shard(saved, simulation_);
  if (!host) return tl::unexpected(host.error());
  PlainReader reader(*host);
  std::uint32_t shard = 0;
  std::uint64_t looked = 0, count = 0;
  PersonCommand last;
  reader.take(shard);
  reader.take(refused_);
  reader.take(looked);
  reader.take(last);
  reader.take(count);
  const auto people = reader.take_many<Numbered>(static_cast<std::size_t>(count));
  if (!reader.whole() || shard != shard_) return fail("these are the bytes of another shard");
  people_.clear();
  for (const Numbered& one : people) people_.emplace(one.number, one.entity);
  if (looked != 0 && !obey_look(last)) return fail("a shard's view cannot be restored");
  return {};
}

}  // namespace mobil::inline v0_3
