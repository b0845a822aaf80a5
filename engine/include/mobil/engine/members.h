#pragma once
// Members of owners: the reverse of a component that names an owner. An entity has at most one owner. An owner's
// members are in ascending order of their indices, regardless of the order of linking.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <vector>

namespace mobil::inline v0_3 {

/// Links by entity index. Only `reserve` allocates.
class Members {
 public:
  /// An index that no entity has.
  static constexpr std::uint32_t nobody = (std::numeric_limits<std::uint32_t>::max)();

  explicit Members(std::pmr::memory_resource* memory) : links_(memory) {}

  /// Makes room for indices below `end`.
  void reserve(std::size_t end) {
    if (end > links_.capacity()) links_.reserve((std::max)(end, 2 * links_.capacity()));
  }
  /// Makes indices below `end` valid; there must be room.
  void grow(std::size_t end) {
    if (end > links_.size()) links_.resize(end);
  }
  void clear() { links_.clear(); }

  /// Return an owner's first member, the member after another, and a member's owner; `nobody` if none exists.
  std::uint32_t first(std::uint32_t owner) const { return owner < links_.size() ? links_[owner].first : nobody; }
  std::uint32_t next(std::uint32_t member) const { return links_[member].next; }
  std::uint32_t owner(std::uint32_t member) const { return member < links_.size() ? links_[member].owner : nobody; }

  /// Links `member` to `owner`, and unlinks it from its previous owner.
  void link(std::uint32_t owner, std::uint32_t member) {
    if (links_[member].owner == owner) return;
    unlink(member);
    std::uint32_t* at = &links_[owner].first;
    while (*at < member) at = &links_[*at].next;
    links_[member].owner = owner;
    links_[member].next = *at;
    *at = member;
  }
  /// Unlinks a member from its owner, if it has one.
  void unlink(std::uint32_t member) {
    if (member >= links_.size() || links_[member].owner == nobody) return;
    std::uint32_t* at = &links_[links_[member].owner].first;
    while (*at != member) at = &links_[*at].next;
    *at = links_[member].next;
    links_[member].owner = links_[member].next = nobody;
  }
  /// Unlinks all members of `owner`.
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
