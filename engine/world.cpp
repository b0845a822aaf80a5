#include <mobil/engine/world.h>

#include <algorithm>
#include <utility>

namespace mobil::inline v0_3 {

World::World(std::pmr::memory_resource* memory)
    : memory_(memory),
      entities_(memory),
      tables_(memory),
      table_hash_(memory),
      resources_(memory),
      resource_content_(memory),
      globals_(memory),
      members_(memory),
      scratch_(memory),
      moves_{std::pmr::vector<std::uint32_t>(memory), std::pmr::vector<RowMove>(memory)},
      going_(memory),
      journal_{false, std::pmr::vector<RowAt>(memory), std::pmr::vector<Entity>(memory),
               std::pmr::vector<Entity>(memory)},
      identity_(std::make_shared<const char>()) {}

Place<Table> World::find(Entity entity) {
  const auto* location = entities_.find(entity);
  return location ? Place<Table>{&tables_[location->table], location->row} : Place<Table>{};
}

Place<const Table> World::find(Entity entity) const {
  const auto* location = entities_.find(entity);
  return location ? Place<const Table>{&tables_[location->table], location->row} : Place<const Table>{};
}

std::uint32_t World::table_of(const Archetype& key) {
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
  for (const PartValue& value : parts) insert_component(scratch_, value.part);
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
  relate(entity);
  return entity;
}

Status World::remake_from(Entity entity, std::span<const PartValue> parts) {
  if (!alive(entity)) return Status::stale_entity;
  key_from(parts);
  if (!(scratch_ == find(entity).table->key())) move(entity, scratch_);
  write_from(find(entity), parts);
  relate(entity);
  return Status::ok;
}

void World::key_remade(Entity entity, std::span<const PartValue> parts, std::span<const std::uint64_t> owned) {
  key_from(parts);
  for (const ComponentId& part : find(entity).table->key()) {
    const bool given = find_component(scratch_, part.id) != nullptr;
    if (!given && !std::binary_search(owned.begin(), owned.end(), part.id)) insert_component(scratch_, part);
  }
}

Status World::remake_from(Entity entity, std::span<const PartValue> parts, std::span<const std::uint64_t> owned) {
  if (!alive(entity)) return Status::stale_entity;
  key_remade(entity, parts, owned);
  if (!(scratch_ == find(entity).table->key())) move(entity, scratch_);
  write_from(find(entity), parts);
  relate(entity);
  return Status::ok;
}

void World::reserve_remade(Entity entity, std::span<const PartValue> parts, std::span<const std::uint64_t> owned,
                           std::uint32_t rows) {
  key_remade(entity, parts, owned);
  Table& table = tables_[table_of(scratch_)];
  table.reserve(table.row_count() + rows);
}

Place<Table> World::create_row(const Archetype& key, Entity& entity) {
  const std::uint32_t table = table_of(key);
  tables_[table].reserve_row();
  reserve_entities(1);
  entity = entities_.create();
  const std::uint32_t row = tables_[table].add_row(entity);
  *entities_.find(entity) = {table, row};
  return {&tables_[table], row};
}

Status World::destroy(Entity entity) {
  const auto* location = entities_.find(entity);
  if (location == nullptr) return Status::stale_entity;
  const auto at = *location;
  erase_row(at);
  forget(entity);
  entities_.destroy(entity);
  return Status::ok;
}

void World::erase_row(const EntityRegister::Location& at) {
  const Entity moved = tables_[at.table].remove_row(at.row);
  if (auto* theirs = entities_.find(moved)) theirs->row = at.row;
}

void World::undo_create(std::span<const Entity> entities) {
  for (std::size_t i = entities.size(); i-- > 0;) {
    const auto at = *entities_.find(entities[i]);
    erase_row(at);
    if (!journal_.created.empty()) journal_.created.pop_back();
    forget(entities[i]);
    entities_.undo_create(entities[i]);
  }
}

/// Writes rows after a table's last one; they exist after `append`. Returns the first one's number.
std::uint32_t World::add_rows(std::uint32_t table, std::span<const PartValue> parts, std::uint32_t count,
                              const Jobs& jobs) {
  struct Work {
    Table& table;
    std::span<const PartValue> parts;
    std::uint32_t first, count;
  } work{tables_[table], parts, tables_[table].row_count(), count};
  work.table.reserve(work.first + count);
  const std::size_t first_block = work.first / lane_count;
  const std::size_t blocks = (work.first + count - 1) / lane_count + 1 - first_block;
  const auto write = [](void* context, std::size_t begin, std::size_t end) {
    const auto& of = *static_cast<Work*>(context);
    const std::size_t at = of.first / lane_count;
    of.table.write_new(at + begin, at + end, of.count, of.parts);
  };
  try {
    run_in_parallel(jobs, blocks, write, &work);
  } catch (...) {
    work.table.drop_last(0);
    throw;
  }
  return work.first;
}

void World::create_many(std::span<const PartValue> parts, std::span<Entity> entities, const Jobs& jobs) {
  if (entities.empty()) return;
  key_from(parts);
  const std::uint32_t table = table_of(scratch_);
  reserve_entities(entities.size());
  if (journal_.open) journal_.created.reserve(journal_.created.size() + entities.size());
  std::uint32_t row = add_rows(table, parts, static_cast<std::uint32_t>(entities.size()), jobs);
  for (Entity& entity : entities) {
    entity = entities_.create();
    *entities_.find(entity) = {table, row++};
  }
  tables_[table].append(entities);
  if (journal_.open) journal_.created.insert(journal_.created.end(), entities.begin(), entities.end());
  for (const Entity entity : entities) relate(entity);
}

void World::change_archetype(std::span<const Entity> entities, std::span<const PartValue> parts,
                             std::span<const std::uint64_t> owned, const Jobs& jobs) {
  if (entities.empty()) return;
  key_remade(entities.front(), parts, owned);
  const std::uint32_t to = table_of(scratch_), from = entities_.find(entities.front())->table;
  std::pmr::vector<RowAt>& left = going_;
  left.clear();
  left.reserve(entities.size());
  for (const Entity entity : entities) left.push_back({from, entities_.find(entity)->row});
  // Reserves everything that is needed after rows have moved.
  const std::size_t leaving = journal_.left.size() + entities.size();
  moves_.table.reserve(leaving);
  moves_.move.reserve(leaving);
  if (journal_.open) {
    journal_.left.reserve(leaving);
    journal_.moved.reserve(leaving);
  }
  const std::uint32_t first = add_rows(to, parts, static_cast<std::uint32_t>(entities.size()), jobs);
  const auto is_kept = [&](const ComponentId& part) {
    return has_column(part.kind) && find_component(tables_[from].key(), part.id) != nullptr;
  };
  if (std::ranges::any_of(tables_[to].key(), is_kept)) {
    // Cache lines belong to one block, so no two threads write the same line.
    const std::size_t before = first % lane_count, blocks = (before + entities.size() + lane_count - 1) / lane_count;
    in_parallel(jobs, blocks, [&](std::size_t begin, std::size_t end) {
      const std::size_t last = std::min(end * lane_count - before, entities.size());
      for (std::size_t i = begin == 0 ? 0 : begin * lane_count - before; i < last; ++i)
        tables_[to].copy_new_from(first + static_cast<std::uint32_t>(i), tables_[from], left[i].row);
    });
  }
  tables_[to].append(entities);
  for (std::uint32_t i = 0; i < entities.size(); ++i) *entities_.find(entities[i]) = {to, first + i};
  if (journal_.open) {
    journal_.left.insert(journal_.left.end(), left.begin(), left.end());
    journal_.moved.insert(journal_.moved.end(), entities.begin(), entities.end());
    return;
  }
  std::sort(left.begin(), left.end());
  remove_rows(left, jobs);
}

World::Transaction::Transaction(World& world, const Jobs& jobs)
    : world_(world),
      jobs_(jobs),
      created_(world.journal_.created.size()),
      moved_(world.journal_.moved.size()),
      outer_(!world.journal_.open) {
  world_.journal_.open = true;
}

World::Transaction::~Transaction() {
  if (kept_) return;
  Journal& journal = world_.journal_;
  while (journal.created.size() > created_) {
    const Entity last = journal.created.back();
    world_.undo_create({&last, 1});
  }
  for (std::size_t i = journal.moved.size(); i-- > moved_;) {
    auto& at = *world_.entities_.find(journal.moved[i]);
    world_.erase_row(at);
    at = {journal.left[i].table, journal.left[i].row};
  }
  journal.left.resize(moved_);
  journal.moved.resize(moved_);
  if (outer_) journal.open = false;
}

void World::Transaction::commit() {
  kept_ = true;
  if (!outer_) return;
  Journal& journal = world_.journal_;
  journal.open = false;
  journal.created.clear();
  journal.moved.clear();
  std::sort(journal.left.begin(), journal.left.end());
  world_.remove_rows(journal.left, jobs_);
  journal.left.clear();
}

bool World::alive_once(std::span<const Entity> entities) {
  constexpr std::uint32_t named = 0x80000000;  // flag in a row's number, cleared at the end of this function
  std::size_t count = 0;
  for (; count < entities.size(); ++count) {
    auto* const location = entities_.find(entities[count]);
    if (location == nullptr || (location->row & named) != 0) break;
    location->row |= named;
  }
  for (const Entity entity : entities.first(count)) entities_.find(entity)->row &= ~named;
  return count == entities.size();
}

Status World::destroy_many(std::span<const Entity> entities, const Jobs& jobs) {
  if (!alive_once(entities)) return Status::stale_entity;
  try {
    destroy_together(entities, jobs);
  } catch (...) {  // only removed rows were overwritten
    for (const Entity entity : entities) destroy(entity);
  }
  return Status::ok;
}

void World::destroy_together(std::span<const Entity> entities, const Jobs& jobs) {
  std::pmr::vector<RowAt>& gone = going_;
  gone.clear();
  gone.reserve(entities.size());
  for (const Entity entity : entities) {
    const auto* location = entities_.find(entity);
    gone.push_back({location->table, location->row});
  }
  std::sort(gone.begin(), gone.end());
  remove_rows(gone, jobs);
  for (const Entity entity : entities) {
    forget(entity);
    entities_.destroy(entity);
  }
}

/// Removes sorted rows; their entities' locations are unchanged. The last remaining rows, in their order, replace
/// removed ones.
void World::remove_rows(std::pmr::vector<RowAt>& gone, const Jobs& jobs) {
  const auto end_of_table = [&](auto first) {
    return std::find_if(first, gone.end(), [table = first->table](const RowAt& g) { return g.table != table; });
  };
  Moves& moves = moves_;
  moves.table.clear();
  moves.move.clear();
  moves.table.reserve(gone.size());
  moves.move.reserve(gone.size());
  for (auto first = gone.begin(), end = first; first != gone.end(); first = end) {
    end = end_of_table(first);
    const auto left = static_cast<std::uint32_t>(tables_[first->table].row_count() - (end - first));
    auto later = std::find_if(first, end, [&](const RowAt& g) { return g.row >= left; });
    std::uint32_t from = left;
    for (auto hole = first; hole != end && hole->row < left; ++hole, ++from) {
      for (; later != end && later->row == from; ++later) ++from;
      moves.table.push_back(first->table);
      moves.move.push_back({hole->row, from});
    }
  }
  in_parallel(jobs, moves.move.size(), [&](std::size_t begin, std::size_t end) {
    while (begin < end) {
      std::size_t same = begin + 1;
      while (same < end && moves.table[same] == moves.table[begin]) ++same;
      tables_[moves.table[begin]].copy_rows({&moves.move[begin], same - begin});
      begin = same;
    }
  });
  for (std::size_t i = 0; i < moves.move.size(); ++i) {
    Table& table = tables_[moves.table[i]];
    const RowMove& move = moves.move[i];
    entities_.find(table.entities(move.from / lane_count)[move.from % lane_count])->row = move.to;
    table.rename(move);
  }
  for (auto first = gone.begin(), end = first; first != gone.end(); first = end) {
    end = end_of_table(first);
    tables_[first->table].drop_last(static_cast<std::uint32_t>(end - first));
  }
}

void World::move(Entity entity, const Archetype& key) {
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

Status World::add_parts(Entity entity, std::span<const PartValue> parts) {
  if (!alive(entity)) return Status::stale_entity;
  const Archetype& before = find(entity).table->key();
  const auto is_new = [&](const PartValue& value) { return find_component(before, value.part.id) == nullptr; };
  scratch_ = before;
  for (const PartValue& value : parts) {
    if (is_new(value)) insert_component(scratch_, value.part);
  }
  if (!(scratch_ == before)) move(entity, scratch_);
  for (const PartValue& value : parts) {
    if (is_new(value)) write_from(find(entity), {&value, 1});
  }
  relate(entity);
  return Status::ok;
}

Status World::remove_parts(Entity entity, std::initializer_list<std::uint64_t> ids) {
  if (!alive(entity)) return Status::stale_entity;
  scratch_ = find(entity).table->key();
  std::erase_if(scratch_,
                [&](const ComponentId& part) { return std::find(ids.begin(), ids.end(), part.id) != ids.end(); });
  if (!(scratch_ == find(entity).table->key())) move(entity, scratch_);
  relate(entity);
  return Status::ok;
}

tl::expected<ComponentId, Status> World::part_of(Entity entity, std::uint64_t id) const {
  const auto place = find(entity);
  if (!place) return tl::unexpected(Status::stale_entity);
  const ComponentId* part = find_component(place.table->key(), id);
  if (part == nullptr) return tl::unexpected(Status::missing);
  return *part;
}

Status World::add_part(Entity entity, const ComponentId& part) {
  const auto place = find(entity);
  if (!place) return Status::stale_entity;
  if (find_component(place.table->key(), part.id) != nullptr) return Status::already_there;
  scratch_ = place.table->key();
  insert_component(scratch_, part);
  move(entity, scratch_);
  return Status::ok;
}

Status World::remove_part(Entity entity, std::uint64_t id) {
  const auto part = part_of(entity, id);
  if (!part) return part.error();
  scratch_ = find(entity).table->key();
  scratch_.erase(lower_bound(scratch_, id));
  move(entity, scratch_);
  relate(entity);
  return Status::ok;
}

Status World::replace_tag(Entity entity, const ComponentId& tag) {
  const auto part = part_of(entity, tag.id);
  if (!part) return part.error();
  if (part->kind != tag.kind) return Status::missing;
  if (*part == tag) return Status::ok;
  scratch_ = find(entity).table->key();
  scratch_.erase(lower_bound(scratch_, tag.id));
  insert_component(scratch_, tag);
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

std::uint64_t World::own(std::shared_ptr<const void> resource, std::uint64_t content) {
  for (std::uint64_t i = 0; i < resources_.size(); ++i) {
    if (resources_[i] == resource) return i;
  }
  resource_content_.reserve(resources_.size() + 1);
  resources_.push_back(std::move(resource));
  resource_content_.push_back(content);
  return resources_.size() - 1;
}

/// Links an entity to the owner that its row names. The links were reserved when it was created.
void World::relate(Entity entity) {
  if (owner_part_ == 0) return;
  members_.grow(entities_.size());
  const auto place = find(entity);
  const std::uint32_t column = place.table->column(owner_part_);
  if (column == Table::no_column) return members_.unlink(entity.index);
  Entity owner;
  place.table->read(place.row, column, sizeof(owner) / 4, &owner);
  if (!alive(owner) || owner == entity) return members_.unlink(entity.index);
  members_.link(owner.index, entity.index);
}

void World::forget(Entity entity) {
  if (owner_part_ == 0) return;
  members_.unlink(entity.index);
  members_.release(entity.index);
}

}  // namespace mobil::inline v0_3
