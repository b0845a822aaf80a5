// The world compared with a plain map of the same entities after every change.
#include <mobil/engine/world.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "tests/engine/engine_counting_memory.h"

namespace mobil::engine_world_test {
template <class F>
struct Size {
  F height_m;
  UInt32<F> bits;
};
template <class F>
struct Arms {
  Vec3<F> elbow_m[2];
  Quat<F> turn;
};
struct Nodes {};
struct Substeps {};
struct Mesh {
  int cells;
};

constexpr std::uint32_t node_words = 5;

bool same(const void* a, const void* b, std::size_t bytes) {
  return std::memcmp(a, b, bytes) == 0;
}

/// The expected state of one entity.
struct Person {
  std::optional<Size<float>> size;
  std::optional<Arms<float>> arms;
  std::optional<std::array<float, node_words>> nodes;
  std::optional<std::uint64_t> substeps;
  std::optional<int> cells;
};

/// One random change: its kind, person and number.
struct Change {
  unsigned what, whom, number;
};

class Pair {
 public:
  Pair() {
    for (int cells : {0, 1, 2}) meshes_.push_back(world_.share(std::make_shared<const Mesh>(Mesh{cells})));
  }

  void apply(const Change& change) {
    const unsigned n = change.number;
    if (change.what < 4 || handles_.empty()) return create(change.what % 4, n);
    const Entity e = handles_[change.whom % handles_.size()];
    const auto at = model_.find(key(e));
    const bool there = at != model_.end();
    Person* p = there ? &at->second : nullptr;
    switch (change.what) {
      case 4:
        expect(world_.destroy(e), there ? Status::ok : Status::stale_entity);
        if (there) model_.erase(at);
        break;
      case 5:
        change_part(
            p, &Person::size, size(n), [&](auto& s) { return world_.add(e, s); }, false);
        break;
      case 6:
        change_part(
            p, &Person::size, size(n), [&](auto& s) { return world_.set(e, s); }, true);
        break;
      case 7:
        change_part(
            p, &Person::arms, arms(n), [&](auto& a) { return world_.add(e, a); }, false);
        break;
      case 8:
        change_part(
            p, &Person::arms, arms(n), [&](auto& a) { return world_.set(e, a); }, true);
        break;
      case 9:
        change_part(
            p, &Person::nodes, {}, [&](auto&) { return world_.add(e, FieldWidth<Nodes>{node_words}); }, false);
        break;
      case 10:
        change_part(
            p, &Person::nodes, nodes(n), [&](auto& f) { return world_.set_field<Nodes>(e, f); }, true);
        break;
      case 11:
        change_part(
            p, &Person::substeps, n % 3, [&](auto& v) { return world_.add(e, TagValue<Substeps>{v}); }, false);
        break;
      case 12:
        change_part(
            p, &Person::substeps, n % 3, [&](auto& v) { return world_.set(e, TagValue<Substeps>{v}); }, true);
        break;
      case 13:
        change_part(
            p, &Person::cells, static_cast<int>(n % 3), [&](auto& m) { return world_.add(e, mesh(m)); }, false);
        break;
      case 14:
        change_part(
            p, &Person::cells, static_cast<int>(n % 3), [&](auto& m) { return world_.set(e, mesh(m)); }, true);
        break;
      case 15:
        remove_part(p, &Person::size, world_.remove<Size>(e));
        break;
      case 16:
        remove_part(p, &Person::arms, world_.remove<Arms>(e));
        break;
      case 17:
        remove_part(p, &Person::nodes, world_.remove<Nodes>(e));
        break;
      case 18:
        remove_part(p, &Person::substeps, world_.remove<Substeps>(e));
        break;
      case 19:
        remake(p, e, n);
        break;
      default:
        remove_part(p, &Person::cells, world_.remove<Mesh>(e));
    }
  }

  void compare() {
    for (const Entity e : handles_) compare(e);
    std::size_t rows = 0;
    std::set<std::vector<std::pair<std::uint64_t, std::uint64_t>>> keys;
    for (const Table& table : world_.tables()) {
      rows += table.row_count();
      compare(table);
      auto& parts = *keys_.emplace(&table, parts_of(table)).first;
      RC_ASSERT(parts.second == parts_of(table));  // a table keeps its components and its address
      RC_ASSERT(keys.insert(parts.second).second);
    }
    RC_ASSERT(rows == model_.size());
  }

  std::size_t requests() const { return memory_.requests; }
  CountingMemory& memory() { return memory_; }

 private:
  using Key = std::pair<std::uint32_t, std::uint32_t>;
  static Key key(Entity e) { return {e.index, e.generation}; }
  static void expect(Status got, Status wanted) { RC_ASSERT(static_cast<int>(got) == static_cast<int>(wanted)); }

  static Size<float> size(unsigned n) {
    return {static_cast<float>(n) * 0.5F, 0x7f800001U + n};
  }  // a signalling NaN's bits
  static Arms<float> arms(unsigned n) {
    const float x = static_cast<float>(n);
    return {{{x, x + 1, x + 2}, {-x, -x - 1, -x - 2}}, {x * 2, x * 3, x * 4, x * 5}};
  }
  static std::array<float, node_words> nodes(unsigned n) {
    const float x = static_cast<float>(n);
    return {x, 1 - x, 2 * x, 3 - x, 4 * x};
  }
  Shared<Mesh> mesh(int cells) const { return meshes_[static_cast<std::size_t>(cells)]; }

  void create(unsigned kind, unsigned n) {
    Person p;
    Entity e;
    if (kind == 0) {
      e = world_.create();
    } else if (kind == 1) {
      e = world_.create(*(p.size = size(n)));
    } else if (kind == 2) {
      p.nodes.emplace();
      e = world_.create(TagValue<Substeps>{*(p.substeps = n % 3)}, *(p.size = size(n)), FieldWidth<Nodes>{node_words});
    } else {
      e = world_.create(*(p.arms = arms(n)), mesh(*(p.cells = static_cast<int>(n % 3))), *(p.size = size(n)));
    }
    RC_ASSERT(model_.emplace(key(e), p).second);
    handles_.push_back(e);
  }

  template <class T, class F>
  void change_part(Person* person, std::optional<T> Person::*part, std::type_identity_t<T> value, F change,
                   bool must_be_there) {
    const Status status = change(value);
    if (person == nullptr) return expect(status, Status::stale_entity);
    const bool there = (person->*part).has_value();
    if (there != must_be_there) return expect(status, there ? Status::already_there : Status::missing);
    expect(status, Status::ok);
    person->*part = value;
  }

  template <class T>
  void remove_part(Person* person, std::optional<T> Person::*part, Status status) {
    if (person == nullptr) return expect(status, Status::stale_entity);
    expect(status, (person->*part).has_value() ? Status::ok : Status::missing);
    (person->*part).reset();
  }

  /// Removes all other components. A field that stays keeps its values.
  void remake(Person* person, Entity e, unsigned n) {
    const TagValue<Substeps> substeps{n % 3};
    const bool with_nodes = n % 2 == 0;
    const Status status = with_nodes ? world_.remake(e, size(n), substeps, FieldWidth<Nodes>{node_words})
                                     : world_.remake(e, size(n), substeps, mesh(static_cast<int>(n % 3)));
    if (person == nullptr) return expect(status, Status::stale_entity);
    expect(status, Status::ok);
    Person made;
    made.size = size(n);
    made.substeps = n % 3;
    if (with_nodes) {
      made.nodes = person->nodes.value_or(std::array<float, node_words>{});
    } else {
      made.cells = static_cast<int>(n % 3);
    }
    *person = made;
  }

  template <class T>
  static void compare_row(const std::optional<T>& wanted, const tl::expected<T, Status>& got) {
    RC_ASSERT(got.has_value() == wanted.has_value());
    if (wanted) RC_ASSERT(same(&*wanted, &*got, sizeof(T)));
    if (!wanted) expect(got.error(), Status::missing);
  }

  void compare(Entity e) {
    const auto at = model_.find(key(e));
    RC_ASSERT(world_.alive(e) == (at != model_.end()));
    RC_ASSERT(static_cast<bool>(world_.find(e)) == world_.alive(e));
    std::array<float, node_words> field{};
    if (at == model_.end()) {
      expect(world_.get<Size>(e).error(), Status::stale_entity);
      expect(world_.get_field<Nodes>(e, field), Status::stale_entity);
      RC_ASSERT(!world_.has<Size>(e) && !world_.has<Substeps>(e) && world_.shared<Mesh>(e) == nullptr);
      return;
    }
    const Person& p = at->second;
    compare_row(p.size, world_.get<Size>(e));
    compare_row(p.arms, world_.get<Arms>(e));
    RC_ASSERT(world_.has<Size>(e) == p.size.has_value() && world_.has<Nodes>(e) == p.nodes.has_value());
    expect(world_.get_field<Nodes>(e, field), p.nodes ? Status::ok : Status::missing);
    if (p.nodes) RC_ASSERT(field == *p.nodes);
    if (p.nodes) expect(world_.get_field<Nodes>(e, std::span(field).first<2>()), Status::wrong_width);
    RC_ASSERT(world_.get<Substeps>(e).has_value() == p.substeps.has_value());
    if (p.substeps) RC_ASSERT(*world_.get<Substeps>(e) == *p.substeps);
    RC_ASSERT((world_.shared<Mesh>(e) != nullptr) == p.cells.has_value());
    if (p.cells) RC_ASSERT(world_.shared<Mesh>(e)->cells == *p.cells);
    const std::size_t parts =
        p.size.has_value() + p.arms.has_value() + p.nodes.has_value() + p.substeps.has_value() + p.cells.has_value();
    RC_ASSERT(world_.find(e).table->key().size() == parts);
  }

  /// Checks that rows are dense, handles and rows match, and parked lanes copy the block's first lane.
  void compare(const Table& table) {
    RC_ASSERT(table.block_count() == (table.row_count() + 15) / 16);
    for (std::size_t b = 0; b < table.block_count(); ++b) {
      RC_ASSERT(reinterpret_cast<std::uintptr_t>(table.block(b)) % 64 == 0U);
      const std::uint32_t live =
          b + 1 < table.block_count() ? 16 : table.row_count() - static_cast<std::uint32_t>(16 * b);
      RC_ASSERT(table.live(b) == live);
      for (std::uint32_t lane = 0; lane < lane_count; ++lane) {
        const Entity e = table.entities(b)[lane];
        const auto place = std::as_const(world_).find(e);
        RC_ASSERT(place.table == &table && place.row == 16 * b + (lane < live ? lane : 0));
        for (std::uint32_t w = 0; lane >= live && w < table.words(); ++w) {
          RC_ASSERT(same(table.block(b) + 16 * w + lane, table.block(b) + 16 * w, 4));
        }
      }
    }
  }

  static std::vector<std::pair<std::uint64_t, std::uint64_t>> parts_of(const Table& table) {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> parts;
    for (const ComponentId& part : table.key()) parts.emplace_back(part.id, part.value);
    return parts;
  }

  CountingMemory memory_;
  World world_{&memory_};
  std::vector<Shared<Mesh>> meshes_;
  std::vector<Entity> handles_;  // all handles ever created
  std::map<Key, Person> model_;
  std::map<const Table*, std::vector<std::pair<std::uint64_t, std::uint64_t>>> keys_;
};

rc::Gen<Change> any_change() {
  return rc::gen::construct<Change>(rc::gen::inRange(0U, 21U), rc::gen::arbitrary<unsigned>(),
                                    rc::gen::inRange(0U, 1000U));
}

RC_GTEST_PROP(EngineWorld, MatchesAMapAfterAnyChange, ()) {
  Pair pair;
  for (const Change& change : *rc::gen::container<std::vector<Change>>(any_change())) {
    pair.apply(change);
    pair.compare();
  }
}

RC_GTEST_PROP(EngineWorld, FullBlocksGrowAndShrinkOneAtATime, ()) {
  // few kinds of people, many of each: several blocks, then back to none
  Pair pair;
  const auto crowd = *rc::gen::inRange(17U, 70U);
  for (unsigned i = 0; i < crowd; ++i) pair.apply({2U + i % 2, 0, 3 * i});
  pair.compare();
  for (const Change& change : *rc::gen::container<std::vector<Change>>(rc::gen::construct<Change>(
           rc::gen::element(2U, 4U, 4U, 6U), rc::gen::inRange(0U, crowd), rc::gen::inRange(0U, 9U)))) {
    pair.apply(change);
    pair.compare();
  }
  for (unsigned i = 0; i < crowd; ++i) pair.apply({4, i, 0});
  pair.compare();
}

TEST(EngineWorld, EmptiedTableKeepsAtMostItsFirstMemory) {
  CountingMemory memory;
  World world(&memory);
  std::vector<Entity> all{world.create(Size<float>{})};
  const std::size_t one_block = memory.lent();
  for (int i = 0; i < 1000; ++i) all.push_back(world.create(Size<float>{}));
  EXPECT_GT(memory.lent(), one_block + 4);  // each piece as large as all before
  for (const Entity e : all) EXPECT_EQ(world.destroy(e), Status::ok);
  EXPECT_LE(memory.lent(), one_block + 2);  // the registers' own arrays
}

TEST(EngineWorld, DefaultHandleIsNeverAlive) {
  World world;
  EXPECT_FALSE(world.alive(Entity{}));
  const Entity e = world.create(Size<float>{});
  EXPECT_FALSE(world.alive(Entity{}));
  EXPECT_FALSE(world.alive({e.index + 1, e.generation}));
  EXPECT_EQ(world.destroy(e), Status::ok);
  EXPECT_FALSE(world.alive({e.index, e.generation + 1}));  // not yet given out
}

TEST(EngineWorld, RowsWithTheSameResourceShareATable) {
  World world;
  const auto mesh = std::make_shared<const Mesh>(Mesh{4});
  const Entity a = world.create(world.share(mesh)), b = world.create(world.share(mesh));
  const Entity c = world.create(world.share(std::make_shared<const Mesh>(Mesh{4})));
  EXPECT_EQ(world.find(a).table, world.find(b).table);
  EXPECT_NE(world.find(a).table, world.find(c).table);
  EXPECT_EQ(world.shared<Mesh>(a), mesh.get());
}

TEST(EngineKey, TypesAreIdentifiedByName) {
  EXPECT_TRUE(type_name<Vec3<float>>().starts_with("mobil::"));
  EXPECT_TRUE(type_name<Vec3<float>>().ends_with("Vec3<float>"));
  // The version in the library's namespace is left out, because snapshots and hashes are common to all versions.
  static_assert(type_id<Vec3<float>>() == [] {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : std::string_view("mobil::Vec3<float>"))
      hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    return hash;
  }());
  static_assert(type_id<Size<float>>() != type_id<Arms<float>>());
  static_assert(!distinct({1, 2, 1}) && distinct({1, 2, 3}));
}

TEST(Status, EveryValueHasItsOwnText) {
  std::set<std::string_view> texts;
  for (const Status status : {Status::ok, Status::stale_entity, Status::missing, Status::already_there,
                              Status::wrong_width, Status::not_valid})
    EXPECT_TRUE(texts.insert(status_text(status)).second) << status_text(status);
  EXPECT_FALSE(texts.contains(""));
}
}  // namespace mobil::engine_world_test
