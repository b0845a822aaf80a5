#include "engine/state_hash.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <vector>

#include "engine/row_hash.h"

namespace mobil::inline v0_3 {
namespace {

struct Hashing {
  const World& world;
  IgnoredWords owner;                    // handles
  std::vector<std::size_t> first_block;  // by table; the last entry is the total
  std::vector<std::uint64_t> seed;       // by table
  std::vector<std::uint64_t> row;        // sixteen a block
  std::atomic<std::uint64_t> sum = 0;    // of entities without an owner

  explicit Hashing(const World& of) : world(of), owner{of.owner_part(), 0, 2} {
    std::size_t blocks = 0;
    for (const Table& table : world.tables()) {
      first_block.push_back(blocks);
      blocks += table.block_count();
      seed.push_back(key_hash(world, table.key()));
    }
    first_block.push_back(blocks);
    row.resize(blocks * lane_count);
  }

  /// Returns the table of a block, counted over all tables.
  std::size_t table_of(std::size_t block) const {
    const auto after = std::upper_bound(first_block.begin(), first_block.end(), block);
    return static_cast<std::size_t>(after - first_block.begin()) - 1;
  }

  template <class F>
  void each_table(std::size_t begin, std::size_t end, F f) const {
    for (std::size_t table = table_of(begin); begin < end; ++table) {
      const std::size_t first = first_block[table], to = std::min(end, first_block[table + 1]);
      if (to == begin) continue;
      f(table, begin - first, to - first);
      begin = to;
    }
  }

  void hash_blocks(std::size_t begin, std::size_t end) {
    each_table(begin, end, [&](std::size_t table, std::size_t from, std::size_t to) {
      hash_rows(world.tables()[table], from, to, seed[table], {&owner, 1},
                &row[(first_block[table] + from) * lane_count]);
    });
  }

  std::uint64_t hash_of(Entity entity) const {
    const auto* at = world.locate(entity);
    return row[first_block[at->table] * lane_count + at->row];
  }

  std::uint64_t hash_with_members(Entity entity) const {
    std::uint64_t members = 0;  // in any order
    world.each_member(entity, [&](Entity member) { members += hash_with_members(member); });
    return mix64(mix64(hash_of(entity)) ^ members);
  }

  void add_entities(std::size_t begin, std::size_t end) {
    std::uint64_t all = 0;
    each_table(begin, end, [&](std::size_t t, std::size_t from, std::size_t to) {
      const Table& table = world.tables()[t];
      for (std::size_t b = from; b < to; ++b) {
        for (std::uint32_t lane = 0; lane < table.live(b); ++lane) {
          const Entity entity = table.entities(b)[lane];
          if (world.alive(world.owner_of(entity))) continue;
          all += hash_with_members(entity);
        }
      }
    });
    sum += all;
  }
};

}  // namespace

std::uint64_t key_hash(const World& world, const Archetype& key) {
  std::uint64_t hash = 0;
  for (const ComponentId& part : key) {
    hash = mix64(hash ^ part.id);
    hash = mix64(hash + (part.kind == PartKind::shared ? world.resource_content(part.value) : part.value));
  }
  return hash;
}

std::uint64_t state_hash(const World& world, const Jobs& jobs) {
  Hashing hashing(world);
  const std::size_t blocks = hashing.first_block.back();
  in_parallel(jobs, blocks, [&](std::size_t begin, std::size_t end) { hashing.hash_blocks(begin, end); });
  in_parallel(jobs, blocks, [&](std::size_t begin, std::size_t end) { hashing.add_entities(begin, end); });
  return hashing.sum;
}

std::uint64_t state_hash_of(std::uint64_t sum, std::uint32_t tick) {
  return mix64(sum + mix64(tick));
}

}  // namespace mobil::inline v0_3
