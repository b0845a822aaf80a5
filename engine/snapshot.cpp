#include "engine/snapshot.h"

#include <algorithm>
#include <cstring>
#include <string>

#include <mobil/engine/interrupt.h>

namespace mobil::inline v0_3 {

tl::unexpected<Error> damaged(std::string_view what) {
  return fail("the snapshot does not agree with itself (" + std::string(what) + "); give one that `save` made");
}

namespace {

struct WorldHeader {
  std::uint64_t entities;
  std::uint32_t tables, parts, slots, first_free;
};

constexpr std::size_t block_bytes(std::uint32_t words) {
  return std::size_t{words} * lane_count * sizeof(float);
}
constexpr std::size_t blocks_of(std::uint32_t rows) {
  return (std::size_t{rows} + lane_count - 1) / lane_count;
}

/// Calls `piece(table, block, first byte in it, bytes)` for each piece of bytes [begin, end) of all blocks.
template <class F>
void for_pieces(const Records<SavedTable>& tables, std::size_t begin, std::size_t end, const F& piece) {
  std::size_t low = 0, high = tables.size();
  while (high - low > 1) {  // finds the last table that begins at or before `begin`
    const std::size_t middle = (low + high) / 2;
    (tables[middle].first_block_byte <= begin ? low : high) = middle;
  }
  for (std::size_t t = low; t < tables.size() && begin < end; ++t) {
    const SavedTable table = tables[t];
    const std::size_t size = block_bytes(table.words), first = table.first_block_byte;
    const std::size_t last = std::min(end, first + size * blocks_of(table.rows));
    while (begin < last) {
      const std::size_t block = (begin - first) / size, from = (begin - first) % size;
      const std::size_t bytes = std::min(size - from, last - begin);
      piece(t, block, from, bytes);
      begin += bytes;
    }
  }
}

WordGap gap_of(const Table& table, std::uint64_t left_out) {
  const ComponentId* const part = left_out == 0 ? nullptr : find_component(table.key(), left_out);
  if (part == nullptr || !has_column(part->kind)) return {};
  return {table.column(left_out), static_cast<std::uint32_t>(part->value)};
}
std::uint32_t words_saved(const Table& table, const LeftOut& left_out) {
  return table.words() - gap_of(table, left_out(table.key())).words;
}

/// Calls `copy(byte in the table's block, bytes since `from`, count)` on both sides of a gap, for saved bytes from
/// `from` on.
template <class Copy>
void across_gap(const WordGap& gap, std::size_t from, std::size_t bytes, const Copy& copy) {
  const std::size_t gap_at = block_bytes(gap.first), before = from < gap_at ? std::min(bytes, gap_at - from) : 0;
  if (before > 0) copy(from, std::size_t{0}, before);
  if (before < bytes) copy(from + before + block_bytes(gap.words), before, bytes - before);
}

Result<void> check_tables(const SavedWorld& saved, std::size_t blocks_bytes) {
  std::uint64_t part = 0, entity = 0, byte = 0;
  for (std::size_t t = 0; t < saved.tables.size(); ++t) {
    const SavedTable table = saved.tables[t];
    if (table.first_part != part || table.first_entity != entity || table.first_block_byte != byte || table.rows == 0 ||
        table.parts > saved.parts.size() - part) {
      return damaged("a table's place");
    }
    std::uint64_t words = 0, before = 0, left_out = 0;
    for (std::uint32_t i = 0; i < table.parts; ++i) {
      const SavedPart p = saved.parts[table.first_part + i];
      if ((i != 0 && p.id <= before) || p.kind > static_cast<std::uint32_t>(PartKind::published) || p.left_out > 1 ||
          (p.left_out == 1 && !has_column(static_cast<PartKind>(p.kind))))
        return damaged("a table's key");
      before = p.id;
      if (!has_column(static_cast<PartKind>(p.kind))) continue;
      if (p.value > blocks_bytes) return damaged("a column's width");
      left_out += p.left_out;
      if (p.left_out == 0) words += p.value;
    }
    if (left_out > 1) return damaged("a table's key");
    if (words != table.words || table.rows > saved.entities.size()) return damaged("a table's size");
    part += table.parts;
    entity += table.rows;
    if (words != 0 && blocks_of(table.rows) > (blocks_bytes - byte) / block_bytes(table.words))
      return damaged("a table's blocks");
    byte += blocks_of(table.rows) * block_bytes(table.words);
  }
  if (part != saved.parts.size() || entity != saved.entities.size() || byte != blocks_bytes)
    return damaged("the tables' sizes");
  return {};
}

/// Checks that rows and alive slots name each other one to one, and that free slots form one list.
Result<void> check_register(const SavedWorld& saved) {
  for (std::size_t t = 0; t < saved.tables.size(); ++t) {
    const SavedTable table = saved.tables[t];
    for (std::uint32_t row = 0; row < table.rows; ++row) {
      const auto slot = saved.find(saved.entities[table.first_entity + row]);
      if (!slot || slot->table != t || slot->row != row) return damaged("whose a row is");
    }
  }
  std::size_t alive = 0, listed = 0, retired = 0;
  for (std::size_t i = 0; i < saved.slots.size(); ++i) {
    const SavedSlot slot = saved.slots[i];
    if (slot.table != SavedWorld::nobody && slot.generation == 0) return damaged("a handle");
    alive += slot.table != SavedWorld::nobody ? 1 : 0;
    retired += slot.table == SavedWorld::nobody && slot.generation == 0 ? 1 : 0;
  }
  for (std::uint32_t next = saved.first_free; next != SavedWorld::nobody; ++listed) {
    if (next >= saved.slots.size() || listed > saved.slots.size())
      return damaged("the list of free handles");
    const SavedSlot slot = saved.slots[next];
    if (slot.table != SavedWorld::nobody || slot.generation == 0) return damaged("a free handle");
    next = slot.row;
  }
  if (alive != saved.entities.size() || alive + listed + retired != saved.slots.size())
    return damaged("the number of handles");
  return {};
}

}  // namespace

std::optional<SavedSlot> SavedWorld::find(Entity entity) const {
  if (entity.index >= slots.size()) return std::nullopt;
  const SavedSlot slot = slots[entity.index];
  if (slot.generation != entity.generation || slot.table >= tables.size()) return std::nullopt;
  return slot;
}

std::optional<SavedPart> SavedWorld::part(std::uint32_t table, std::uint64_t id) const {
  const SavedTable of = tables[table];
  for (std::uint32_t i = 0; i < of.parts; ++i) {
    const SavedPart p = parts[of.first_part + i];
    if (p.id == id) return p;
  }
  return std::nullopt;
}

std::uint32_t SavedWorld::column(std::uint32_t table, std::uint64_t id) const {
  const SavedTable of = tables[table];
  std::uint64_t word = 0;
  for (std::uint32_t i = 0; i < of.parts; ++i) {
    const SavedPart p = parts[of.first_part + i];
    const bool column = has_column(static_cast<PartKind>(p.kind)) && p.left_out == 0;
    if (p.id == id) return column ? static_cast<std::uint32_t>(word) : Table::no_column;
    if (column) word += p.value;
  }
  return Table::no_column;
}

std::uint32_t SavedWorld::word(std::uint32_t table, std::uint32_t row, std::uint32_t column_word) const {
  const SavedTable of = tables[table];
  const std::size_t block = of.first_block_byte + row / lane_count * block_bytes(of.words);
  std::uint32_t value;
  std::memcpy(&value, &blocks[block + (std::size_t{column_word} * lane_count + row % lane_count) * 4], 4);
  return value;
}

SnapshotLayout WorldSnapshot::layout(const World& world, const LeftOut& left_out) {
  SnapshotLayout layout;
  layout.world = sizeof(WorldHeader) + world.entities_.slots_.size() * sizeof(SavedSlot);
  for (const Table& table : world.tables_) {
    if (table.row_count() == 0) continue;
    layout.world += sizeof(SavedTable) + table.key().size() * sizeof(SavedPart) + table.row_count() * sizeof(Entity);
    layout.blocks += table.block_count() * block_bytes(words_saved(table, left_out));
  }
  return layout;
}

void WorldSnapshot::save(const World& world, const SnapshotLayout& layout, std::span<std::byte> out, const Jobs& jobs,
                         const LeftOut& left_out) {
  const auto& slots = world.entities_.slots_;
  ByteWriter writer(&out[layout.world_at()]);
  WorldHeader header{0, 0, 0, static_cast<std::uint32_t>(slots.size()), world.entities_.first_free_};
  for (const Table& table : world.tables_) {
    if (table.row_count() == 0) continue;
    ++header.tables;
    header.parts += static_cast<std::uint32_t>(table.key().size());
    header.entities += table.row_count();
  }
  writer.put(header);
  const std::byte* const tables_at = writer.at();
  SavedTable saved{};
  for (const Table& table : world.tables_) {
    if (table.row_count() == 0) continue;
    saved.parts = static_cast<std::uint32_t>(table.key().size());
    saved.rows = table.row_count();
    saved.words = words_saved(table, left_out);
    writer.put(saved);
    saved.first_part += saved.parts;
    saved.first_entity += saved.rows;
    saved.first_block_byte += table.block_count() * block_bytes(saved.words);
  }
  for (const Table& table : world.tables_) {
    if (table.row_count() == 0) continue;
    const std::uint64_t follows = left_out(table.key()), without = gap_of(table, follows).words == 0 ? 0 : follows;
    for (const ComponentId& part : table.key())
      writer.put(SavedPart{part.id, part.value, static_cast<std::uint32_t>(part.kind), part.id == without ? 1U : 0U});
  }
  // Slots store their table's number among those with rows.
  std::byte* const slots_at = writer.at();
  for (const EntityRegister::Slot& slot : slots)
    writer.put(SavedSlot{slot.generation, slot.location.table, slot.location.row});
  std::uint32_t number = 0;
  for (const Table& table : world.tables_) {
    if (table.row_count() == 0) continue;
    for (std::uint32_t row = 0; row < table.row_count(); ++row) {
      const std::size_t at = table.entities(0)[row].index * sizeof(SavedSlot) + offsetof(SavedSlot, table);
      std::memcpy(slots_at + at, &number, sizeof(number));
    }
    writer.put(table.entities(0), table.row_count());
    ++number;
  }
  struct Blocks {
    const World& world;
    Records<SavedTable> tables;
    std::byte* out;
    const LeftOut& left_out;
  } blocks{world, {tables_at, header.tables}, &out[0] + layout.blocks_at(), left_out};
  seal_snapshot(
      layout, out, jobs,
      [](void* context, std::size_t begin, std::size_t end) {
        const auto& to = *static_cast<const Blocks*>(context);
        std::size_t with_rows = 0, at = 0;
        const Table* table = nullptr;
        WordGap gap;
        for_pieces(to.tables, begin, end, [&](std::size_t t, std::size_t block, std::size_t from, std::size_t bytes) {
          for (; with_rows <= t; ++at) {
            if (to.world.tables()[at].row_count() == 0) continue;
            table = &to.world.tables()[at];
            ++with_rows;
            gap = with_rows > t ? gap_of(*table, to.left_out(table->key())) : WordGap{};
          }
          const auto* const in = reinterpret_cast<const std::byte*>(table->block(block));
          across_gap(gap, from, bytes, [&](std::size_t at_block, std::size_t done, std::size_t some) {
            std::memcpy(to.out + begin + done, in + at_block, some);
          });
          begin += bytes;
        });
      },
      &blocks);
}

Result<SavedWorld> WorldSnapshot::read(const OpenSnapshot& snapshot) {
  ByteReader reader(snapshot.world);
  WorldHeader header{};
  SavedWorld saved;
  if (reader.take(header)) {
    saved.tables = reader.take_many<SavedTable>(header.tables);
    saved.parts = reader.take_many<SavedPart>(header.parts);
    saved.slots = reader.take_many<SavedSlot>(header.slots);
    saved.entities = reader.take_many<Entity>(header.entities);
  }
  if (!reader.whole()) return damaged("the sizes of its lists");
  saved.first_free = header.first_free;
  saved.blocks = snapshot.blocks;
  if (auto ok = check_tables(saved, snapshot.blocks.size()); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_register(saved); !ok) return tl::unexpected(ok.error());
  return saved;
}

Result<ComponentId> WorldSnapshot::known_part(const World& world, const SavedPart& part,
                                              std::span<const ComponentId> known,
                                              std::span<const SharedNumber> shared) const {
  const auto kind = static_cast<PartKind>(part.kind);
  const ComponentId* like = nullptr;
  for (const ComponentId& one : known) {
    if (one.id == part.id) like = &one;
  }
  for (auto table = world.tables().begin(); like == nullptr && table != world.tables().end(); ++table)
    like = find_component(table->key(), part.id);
  if (like == nullptr)
    return fail("the snapshot has a component, field or tag that this program does not know (number " +
                std::to_string(part.id) +
                "); restore it with the program that made it, or make an entity with all of your own first");
  if (like->kind != kind || ((kind == PartKind::component || kind == PartKind::published) && like->value != part.value))
    return fail("the snapshot's " + std::string(like->name) + " is laid out otherwise than this program's (" +
                std::to_string(part.value) + " words a row, not " + std::to_string(like->value) +
                "); restore it with the program that made it");
  if (kind != PartKind::shared) return ComponentId{part.id, kind, part.value, like->name};
  for (const SharedNumber& number : shared) {
    if (number.id == part.id && number.saved == part.value)
      return ComponentId{part.id, kind, number.present, like->name};
  }
  return damaged("a shared resource that it does not describe");
}

Result<void> WorldSnapshot::prepare(World& world, const SavedWorld& saved, std::span<const ComponentId> known,
                                    std::span<const SharedNumber> shared, const LeftOut& left_out,
                                    const std::function<Result<void>(const Archetype&)>& check) {
  table_.resize(saved.tables.size());
  gap_.assign(saved.tables.size(), {});
  saved_.assign(world.tables_.size(), SavedWorld::nobody);
  for (std::uint32_t t = 0; t < table_.size(); ++t) {
    const SavedTable from = saved.tables[t];
    key_.clear();
    for (std::uint32_t i = 0; i < from.parts; ++i) {
      auto part = known_part(world, saved.parts[from.first_part + i], known, shared);
      if (!part) return tl::unexpected(part.error());
      key_.push_back(*part);
    }
    const std::uint64_t without = left_out(key_);
    for (std::uint32_t i = 0; i < from.parts; ++i) {
      const SavedPart part = saved.parts[from.first_part + i];
      const bool column = has_column(static_cast<PartKind>(part.kind)) && part.value != 0;
      if (part.left_out != (part.id == without && column ? 1U : 0U))
        return damaged("which columns are left out");
    }
    const std::uint64_t hash = key_hash(key_);
    std::uint32_t at = 0;
    for (; at < world.table_hash_.size(); ++at) {
      if (world.table_hash_[at] == hash && world.tables_[at].key() == key_) break;
    }
    if (at == world.table_hash_.size()) {
      if (auto sound = check(key_); !sound) return sound;
      at = world.table_of(key_);
      saved_.resize(world.tables_.size(), SavedWorld::nobody);
    }
    if (saved_[at] != SavedWorld::nobody) return damaged("two tables of one key");
    saved_[at] = t;
    table_[t] = at;
    Table& table = world.tables_[at];
    table.reserve(from.rows);
    // Fresh pages cost more than their copy in commit, which cannot be interrupted.
    for (std::size_t b = table.block_count(); b < (from.rows + lane_count - 1) / lane_count; ++b) {
      check_interrupt();
      std::fill_n(table.block(b), std::size_t{table.words()} * lane_count, 0.0F);
    }
    gap_[t] = gap_of(world.tables_[at], without);
  }
  world.entities_.slots_.reserve(saved.slots.size());
  world.members_.reserve(saved.slots.size());
  return {};
}

void WorldSnapshot::commit(World& world, const SavedWorld& saved, const Jobs& jobs) const noexcept {
  for (std::uint32_t at = 0; at < world.tables_.size(); ++at) {
    Table& table = world.tables_[at];
    table.rows_ = 0;
    if (saved_[at] != SavedWorld::nobody) {
      const SavedTable from = saved.tables[saved_[at]];
      table.rows_ = from.rows;
      for (std::uint32_t row = 0; row < from.rows; ++row)
        table.entities_[row] = saved.entities[from.first_entity + row];
      const std::size_t end = table.block_count() * lane_count;
      std::fill(table.entities_.begin() + from.rows, table.entities_.begin() + static_cast<std::ptrdiff_t>(end),
                table.entities_[end - lane_count]);
    }
    table.trim();
  }
  auto& slots = world.entities_.slots_;
  slots.resize(saved.slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const SavedSlot slot = saved.slots[i];
    const std::uint32_t table = slot.table == SavedWorld::nobody ? SavedWorld::nobody : table_[slot.table];
    slots[i] = {slot.generation, {table, slot.row}};
  }
  world.entities_.first_free_ = saved.first_free;
  struct Blocks {
    World& world;
    const SavedWorld& saved;
    const std::vector<std::uint32_t>& table;
    const std::vector<WordGap>& gap;
  } blocks{world, saved, table_, gap_};
  constexpr std::size_t piece_bytes = SnapshotLayout::chunk_bytes;
  const auto copy = [](void* context, std::size_t begin, std::size_t end) {
    const auto& to = *static_cast<const Blocks*>(context);
    const SavedWorld& from = to.saved;
    begin *= piece_bytes;
    end = std::min(end * piece_bytes, from.blocks.size());
    const std::byte* in = from.blocks.data() + begin;
    for_pieces(from.tables, begin, end, [&](std::size_t t, std::size_t block, std::size_t first, std::size_t bytes) {
      auto* const out = reinterpret_cast<std::byte*>(to.world.tables()[to.table[t]].block(block));
      across_gap(to.gap[t], first, bytes, [&](std::size_t at_block, std::size_t done, std::size_t some) {
        std::memcpy(out + at_block, in + done, some);
      });
      in += bytes;
    });
  };
  const std::size_t pieces = (saved.blocks.size() + piece_bytes - 1) / piece_bytes;
  try {
    run_in_parallel(jobs, pieces, copy, &blocks);
  } catch (...) {  // jobs must not throw, but a host's can
    copy(&blocks, 0, pieces);
  }
  relate_all(world);
}

void WorldSnapshot::relate_all(World& world) noexcept {
  if (world.owner_part_ == 0) return;
  world.members_.clear();
  world.members_.grow(world.entities_.size());
  for (auto index = static_cast<std::uint32_t>(world.entities_.size()); index-- > 0;) {  // inserts at the front
    const Entity entity = world.entities_.at(index);
    if (world.alive(entity)) world.relate(entity);
  }
}

void WorldSnapshot::give_up(World& world) noexcept {
  for (Table& table : world.tables_) table.trim();
}

}  // namespace mobil::inline v0_3
