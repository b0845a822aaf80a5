#pragma once
// Who belongs to whom: the reverse of a component that names an owner. Each entity has one owner at most; an owner's
// members are in ascending order of their indices, whatever order they came in.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <vector>

namespace mobil::inline v0_3 {

/// By entity index. Nothing here takes memory but `reserve`.
class Members {
 public:
  /// The index that no entity has.
  static constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

  explicit Members(std::pmr::memory_resource* memory) : links_(memory) {}

  /// Room for indices below `end`.
  void reserve(std::size_t end) {
    if (end > links_.capacity()) links_.reserve(std::max(end, 2 * links_.capacity()));
  }
  /// Indices below `end` can be asked for; there must be room.
  void grow(std::size_t end) {
    if (end > links_.size()) links_.resize(end);
  }
  void clear() { links_.clear(); }

  /// The first member of an owner, the member behind another, and the owner of a member; `nobody` where there is none.
  std::uint32_t first(std::uint32_t owner) const { return owner < links_.size() ? links_[owner].first : nobody; }
  std::uint32_t next(std::uint32_t member) const { return links_[member].next; }
  std::uint32_t owner(std::uint32_t member) const { return member < links_.size() ? links_[member].owner : nobody; }

  /// Makes `member` one of `owner`; it leaves the owner that it had.
  void link(std::uint32_t owner, std::uint32_t member) {
    if (links_[member].owner == owner) return;
    unlink(member);
    std::uint32_t* at = &links_[owner].first;
    while (*at < member) at = &links_[*at].next;
    links_[member].owner = owner;
    links_[member].next = *at;
    *at = member;
  }
  /// Takes a member from its owner; does nothing where it has none.
  void unlink(std::uint32_t member) {
    if (member >= links_.size() || links_[member].owner == nobody) return;
    std::uint32_t* at = &links_[links_[member].owner].first;
    while (*at != member) at = &links_[*at].next;
    *at = links_[member].next;
    links_[member].owner = links_[member].next = nobody;
  }
  /// Its members have no owner any more.
  void release(std::uint32_t owner) {
    while (first(owner) != nobody) unlink(first(owner));
  }

 private:
  struct Link {
    std::uint32_t owner = nobody, first = nobody, next = nobody;
  };
  std::pmr::vector<Link> links_;
};

}  // namespace mobil::inline v0_3
