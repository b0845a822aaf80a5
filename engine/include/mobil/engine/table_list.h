#pragma once
// List of a world's tables that have at least one of some parts. Tables are never removed, so each is checked once.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory_resource>
#include <vector>

#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

class TableList {
 public:
  /// Ids of the parts.
  TableList(std::initializer_list<std::uint64_t> parts, std::pmr::memory_resource* memory)
      : parts_(parts, memory), found_(memory) {}

  /// Adds the world's new tables and returns all. Must be called with the same world each time.
  const std::pmr::vector<Table*>& find(World& world) {
    for (; seen_ < world.tables().size(); ++seen_) {
      Table& table = world.tables()[seen_];
      const auto has = [&](std::uint64_t part) { return find_component(table.key(), part) != nullptr; };
      if (std::ranges::any_of(parts_, has)) found_.push_back(&table);
    }
    return found_;
  }
  /// Returns the tables found so far, without allocating.
  const std::pmr::vector<Table*>& found() const { return found_; }
  /// Returns true if a table of the list has rows.
  bool any_rows(World& world) {
    return std::ranges::any_of(find(world), [](const Table* table) { return table->row_count() > 0; });
  }

 private:
  std::pmr::vector<std::uint64_t> parts_;
  std::pmr::vector<Table*> found_;
  std::size_t seen_ = 0;
};

}  // namespace mobil::inline v0_3
