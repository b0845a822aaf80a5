#include "engine/world.h"

#include <algorithm>
#include <utility>

namespace mobil {

World::World(std::pmr::memory_resource* memory)
    : memory_(memory),
      entities_(memory),
      tables_(memory),
      table_hash_(memory),
      resources_(memory),
      scratch_(memory),
      identity_(std::make_shared<const char>()) {}

Place<Table> World::find(Entity entity) {
  const auto* location = entities_.find(entity);
  return location ? Place<Table>{&tables_[location->table], location->row} : Place<Table>{};
}

Place<const Table> World::find(Entity entity) const {
  const auto* location = entities_.find(entity);
  return location ? Place<const Table>{&tables_[location->table], location->row} : Place<const Table>{};
}

std::uint32_t World::table_of(const TableKey& key) {
  const std::uint64_t hash = key_hash(key);
  for (std::uint32_t index = 0; index < table_hash_.size(); ++index) {
    if (table_hash_[index] == hash && tables_[index].key() == key) return index;
  }
  if (table_hash_.size() == table_hash_.capacity()) table_hash_.reserve(2 * table_hash_.size() + 1);
  tables_.emplace_back(key, memory_);
  table_hash_.push_back(hash);
  return static_cast<std::uint32_t>(table_hash_.size() - 1);
}

void World::key_from(std::span<const PartValue> parts) {
  scratch_.clear();
  for (const PartValue& value : parts) insert_part(scratch_, value.part);
}

void World::write_from(Place<Table> place, std::span<const PartValue> parts) {
  for (const auto& [part, row] : parts) {
    if (row == nullptr) continue;
    place.table->write(place.row, place.table->column(part.id), static_cast<std::uint32_t>(part.value), row);
  }
}

Entity World::create_from(std::span<const PartValue> parts) {
  key_from(parts);
  Entity entity;
  write_from(create_row(scratch_, entity), parts);
  return entity;
}

Status World::remake_from(Entity entity, std::span<const PartValue> parts) {
  if (!alive(entity)) return Status::stale_entity;
  key_from(parts);
  if (!(scratch_ == find(entity).table->key())) move(entity, scratch_);
  write_from(find(entity), parts);
  return Status::ok;
}

Place<Table> World::create_row(const TableKey& key, Entity& entity) {
  const std::uint32_t table = table_of(key);
  tables_[table].reserve_row();
  entity = entities_.create();
  const std::uint32_t row = tables_[table].add_row(entity);
  *entities_.find(entity) = {table, row};
  return {&tables_[table], row};
}

Status World::destroy(Entity entity) {
  const auto* location = entities_.find(entity);
  if (location == nullptr) return Status::stale_entity;
  const std::uint32_t row = location->row;
  const Entity moved = tables_[location->table].remove_row(row);
  if (auto* theirs = entities_.find(moved)) theirs->row = row;
  entities_.destroy(entity);
  return Status::ok;
}

void World::move(Entity entity, const TableKey& key) {
  const std::uint32_t to = table_of(key);
  auto* location = entities_.find(entity);
  Table& source = tables_[location->table];
  Table& target = tables_[to];
  const std::uint32_t old_row = location->row;
  target.reserve_row();
  const std::uint32_t row = target.add_row(entity);
  target.copy_from(row, source, old_row);
  const Entity moved = source.remove_row(old_row);
  if (auto* theirs = entities_.find(moved)) theirs->row = old_row;
  *location = {to, row};
}

Status World::remove_parts(Entity entity, std::initializer_list<std::uint64_t> ids) {
  if (!alive(entity)) return Status::stale_entity;
  scratch_ = find(entity).table->key();
  std::erase_if(scratch_, [&](const KeyPart& part) { return std::find(ids.begin(), ids.end(), part.id) != ids.end(); });
  if (!(scratch_ == find(entity).table->key())) move(entity, scratch_);
  return Status::ok;
}

tl::expected<KeyPart, Status> World::part_of(Entity entity, std::uint64_t id) const {
  const auto place = find(entity);
  if (!place) return tl::unexpected(Status::stale_entity);
  const KeyPart* part = find_part(place.table->key(), id);
  if (part == nullptr) return tl::unexpected(Status::missing);
  return *part;
}

Status World::add_part(Entity entity, const KeyPart& part) {
  const auto place = find(entity);
  if (!place) return Status::stale_entity;
  if (find_part(place.table->key(), part.id) != nullptr) return Status::already_there;
  scratch_ = place.table->key();
  insert_part(scratch_, part);
  move(entity, scratch_);
  return Status::ok;
}

Status World::remove_part(Entity entity, std::uint64_t id) {
  const auto part = part_of(entity, id);
  if (!part) return part.error();
  scratch_ = find(entity).table->key();
  scratch_.erase(lower_bound(scratch_, id));
  move(entity, scratch_);
  return Status::ok;
}

Status World::replace_tag(Entity entity, const KeyPart& tag) {
  const auto part = part_of(entity, tag.id);
  if (!part) return part.error();
  if (part->kind != tag.kind) return Status::missing;
  if (*part == tag) return Status::ok;
  scratch_ = find(entity).table->key();
  scratch_.erase(lower_bound(scratch_, tag.id));
  insert_part(scratch_, tag);
  move(entity, scratch_);
  return Status::ok;
}

Status World::read_field(Entity entity, std::uint64_t id, std::span<float> out) const {
  const auto part = part_of(entity, id);
  if (!part) return part.error();
  if (part->kind != PartKind::field) return Status::missing;
  if (part->value != out.size()) return Status::wrong_width;
  const auto place = find(entity);
  place.table->read(place.row, place.table->column(id), static_cast<std::uint32_t>(out.size()), out.data());
  return Status::ok;
}

Status World::write_field(Entity entity, std::uint64_t id, std::span<const float> in) {
  const auto part = part_of(entity, id);
  if (!part) return part.error();
  if (part->kind != PartKind::field) return Status::missing;
  if (part->value != in.size()) return Status::wrong_width;
  const auto place = find(entity);
  place.table->write(place.row, place.table->column(id), static_cast<std::uint32_t>(in.size()), in.data());
  return Status::ok;
}

std::uint64_t World::own(std::shared_ptr<const void> resource) {
  for (std::uint64_t i = 0; i < resources_.size(); ++i) {
    if (resources_[i] == resource) return i;
  }
  resources_.push_back(std::move(resource));
  return resources_.size() - 1;
}

}  // namespace mobil
