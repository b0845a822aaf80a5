#pragma once
// Parts of entities, and the archetype (key) that they form. There are four kinds.
//   component  Pose<float>                  a row of 4-byte words, the same number in every table;
//   field      FieldWidth<NodalVelocity>    a row of floats, their number fixed by the table's key;
//   tag        TagValue<Substeps>, Shared<Mesh>   one value for the whole table, part of its key;
//   published  Publishes<PublishedLeg>  a struct for other rows within a tick; not state.
// Parts are identified by a hash of their type's full name, which must be unique in a program. Nothing is registered
// or global.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory_resource>
#include <string_view>
#include <type_traits>
#include <vector>

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

namespace spelling {
/// The type's name as the compiler spells it. (In a namespace of its own because gcc leaves out the one it is in.)
template <class T>
constexpr auto type_name() {
  const std::string_view spelled = __PRETTY_FUNCTION__;
  const std::size_t start = spelled.find("T = ") + 4;
  return spelled.substr(start, spelled.size() - 1 - start);
}
}  // namespace spelling
using spelling::type_name;

/// Returns the identity of a type in archetypes, snapshots and state hashes: `T::stable_id`, which survives a change of
/// name; without one FNV-1a of the name, where the library's namespace is `mobil::` in every version.
struct InOurNamespace;
template <class T>
consteval std::uint64_t type_id() {
  static_assert(sizeof(T) > 0, "an incomplete type could not show its stable_id");
  if constexpr (requires { T::stable_id; }) return T::stable_id;
  constexpr std::string_view ours = "mobil::";
  std::string_view versioned = type_name<InOurNamespace>();
  versioned.remove_suffix(std::string_view("InOurNamespace").size());
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto take = [&hash](std::string_view text) {
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  };
  std::string_view left = type_name<T>();
  for (std::size_t at = left.find(versioned); at != std::string_view::npos; at = left.find(versioned)) {
    take(left.substr(0, at));
    take(ours);
    left.remove_prefix(at + versioned.size());
  }
  take(left);
  return hash;
}

/// `shared`: a tag whose value is the index of a resource, valid only in its own world. `published`: data for other
/// rows, which ends with the tick.
enum class PartKind : std::uint8_t { component, field, tag, shared, published };
/// Returns true if a part's words are state of a row.
constexpr bool has_column(PartKind kind) {
  return kind <= PartKind::field;
}

/// Id and kind of one part of a key. `value`: words a row of a component, field or published struct; the value of a
/// tag.
struct ComponentId {
  std::uint64_t id = 0;
  PartKind kind = PartKind::component;
  std::uint64_t value = 0;
  std::string_view name;
  const bool* is_float = nullptr;  // for components, `value` flags: true for words that are floats

  friend bool operator==(const ComponentId& a, const ComponentId& b) {
    return a.id == b.id && a.kind == b.kind && a.value == b.value;
  }
};

/// Parts sorted by id, each id once. Two entities share a table when their keys are equal.
using Archetype = std::pmr::vector<ComponentId>;

/// Returns the first part whose id is not below `id`.
inline Archetype::const_iterator lower_bound(const Archetype& key, std::uint64_t id) {
  return std::lower_bound(key.begin(), key.end(), id,
                          [](const ComponentId& part, std::uint64_t i) { return part.id < i; });
}

/// Returns the part with that id, or null.
inline const ComponentId* find_component(const Archetype& key, std::uint64_t id) {
  const auto at = lower_bound(key, id);
  return at != key.end() && at->id == id ? &*at : nullptr;
}

/// Inserts a part in the order of ids.
inline void insert_component(Archetype& key, const ComponentId& part) {
  key.insert(lower_bound(key, part.id), part);
}

/// A new field: `words` floats a row, initially zero. `Tag` is a plain struct that names it.
template <class Tag>
struct FieldWidth {
  std::uint32_t words = 0;
};

/// A small number that all rows of a table share, named by a plain struct. A system receives it as a parameter of this
/// type.
template <class Tag>
struct TagValue {
  std::uint64_t value = 0;
};

/// An immutable resource that all rows of a table share. `World::share` creates it, and the world owns it. A system
/// receives it as a parameter of this type.
template <class T>
struct Shared {
  const T* resource = nullptr;
  std::uint64_t index = 0;

  const T& operator*() const { return *resource; }
  const T* operator->() const { return resource; }
};

/// Marks a plain struct T that rows publish; a system writes it for all rows in every tick before any lookup. It is not
/// state and does not move with a row. A row's struct is contiguous, so a lookup reads only T's cache lines.
template <class T>
struct Publishes {};

/// Substitute for a component's number type that reveals which words are of that type.
struct FloatWord {
  static constexpr std::uint32_t mark = 0x6d6f6269;
  std::uint32_t bits = mark;
  constexpr FloatWord() = default;
  constexpr FloatWord(float) {}  // accepts a component's default value
};

/// Layout of a component: word w of lane l of a block at block[16·w + l]. Members must be F, UInt32<F>, or arrays and
/// structs of those, which is checked here as far as possible.
template <template <class> class C>
struct ComponentLayout {
  static_assert(std::is_trivially_copyable_v<C<float>> && std::is_trivially_copyable_v<C<Lanes<float>>>,
                "a component is plain data: no pointers that own, no containers, no constructors");
  static_assert(sizeof(C<float>) % 4 == 0 && alignof(C<float>) == 4,
                "a component holds 4-byte words only: F, UInt32<F>, and arrays and structs of those");
  static_assert(
      sizeof(C<Lanes<float>>) == lane_count * sizeof(C<float>),
      "every member of a component must depend on F: write F for float, UInt32<F> for std::uint32_t; an Entity"
      " is two UInt32<F>, index and generation");
  static_assert(alignof(C<Lanes<float>>) == alignof(Lanes<float>), "a component has no alignment of its own");
  static constexpr std::uint32_t words = sizeof(C<float>) / 4;
  static constexpr std::array<bool, words> is_float = [] {
    const auto bits = std::bit_cast<std::array<std::uint32_t, words>>(C<FloatWord>{});
    std::array<bool, words> found{};
    for (std::size_t w = 0; w < words; ++w) found[w] = bits[w] == FloatWord::mark;
    return found;
  }();
};

/// Returns the id of a component.
template <template <class> class C>
constexpr ComponentId component_id() {
  return {type_id<C<float>>(), PartKind::component, ComponentLayout<C>::words, type_name<C<float>>(),
          ComponentLayout<C>::is_float.data()};
}

/// True if T is a component's row.
template <class T>
inline constexpr bool is_row = false;
template <template <class> class C>
inline constexpr bool is_row<C<float>> = true;

/// Rejects types that are not parts.
template <class T>
constexpr ComponentId component_id(const T&) {
  static_assert(!std::is_same_v<T, T>,
                "this is no part of an entity: a component is a template over its number type, `template <class F>"
                " struct Fatigue { F level; };`, given as Fatigue<float>{…}");
  return {};
}
template <template <class> class C>
constexpr ComponentId component_id(const C<float>&) {
  return component_id<C>();
}
template <class Tag>
constexpr ComponentId component_id(const FieldWidth<Tag>& field) {
  return {type_id<Tag>(), PartKind::field, field.words, type_name<Tag>()};
}
template <class Tag>
constexpr ComponentId component_id(const TagValue<Tag>& tag) {
  return {type_id<Tag>(), PartKind::tag, tag.value, type_name<Tag>()};
}
template <class T>
constexpr ComponentId component_id(const Shared<T>& shared) {
  return {type_id<T>(), PartKind::shared, shared.index, type_name<T>()};
}

/// Returns the id of a published struct; T must fill whole cache lines of 64 bytes.
template <class T>
constexpr ComponentId component_id(const Publishes<T>&) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 64 == 0 && alignof(T) <= 64, "whole lines of memory");
  return {type_id<T>(), PartKind::published, sizeof(T) / 4, type_name<T>()};
}

/// A part's id.
template <class P>
inline constexpr std::uint64_t part_id = component_id(P{}).id;

/// A part with its first value, for lists built at run time. `row`: a component's words, in the caller's memory; null
/// for fields and tags.
struct PartValue {
  ComponentId part;
  const void* row = nullptr;
};

/// Returns a part with its value; `row` must outlive the result.
template <template <class> class C>
constexpr PartValue part_value(const C<float>& row) {
  return {component_id<C>(), &row};
}
template <class P>
constexpr PartValue part_value(const P& part) {
  return {component_id(part), nullptr};
}

/// Returns a hash of a key, by which tables are found.
inline std::uint64_t key_hash(const Archetype& key) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const ComponentId& part : key) {
    hash = (hash ^ part.id) * 0x9e3779b97f4a7c15;
    hash = (hash ^ (hash >> 32) ^ part.value) * 0x100000001b3;
  }
  return hash;
}

/// Returns true if all ids differ.
constexpr bool distinct(std::initializer_list<std::uint64_t> ids) {
  for (auto a = ids.begin(); a != ids.end(); ++a) {
    if (std::find(a + 1, ids.end(), *a) != ids.end()) return false;
  }
  return true;
}

}  // namespace mobil::inline v0_3
