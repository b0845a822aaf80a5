#pragma once
// The tables of a world that have one of some parts. Tables come and stay, so each is looked at once.

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

  /// Takes in the world's new tables. The same world each time.
  const std::pmr::vector<Table*>& find(World& world) {
    for (; seen_ < world.tables().size(); ++seen_) {
      Table& table = world.tables()[seen_];
      const auto has = [&](std::uint64_t part) { return find_component(table.key(), part) != nullptr; };
      if (std::ranges::any_of(parts_, has)) found_.push_back(&table);
    }
    return found_;
  }
  /// Those found so far. Takes no memory.
  const std::pmr::vector<Table*>& found() const { return found_; }
  /// Whether one of them has rows.
  bool any_rows(World& world) {
    return std::ranges::any_of(find(world), [](const Table* table) { return table->row_count() > 0; });
  }

 private:
  std::pmr::vector<std::uint64_t> parts_;
  std::pmr::vector<Table*> found_;
  std::size_t seen_ = 0;
};

}  // namespace mobil::inline v0_3
