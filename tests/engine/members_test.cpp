// Owners and members compared with a plain model, while rows are created, changed and destroyed.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <map>
#include <vector>

#include <mobil/engine/world.h>
#include "engine/snapshot.h"
#include "engine/state_hash.h"

namespace mobil::members_test {
template <class F>
struct Keeper {
  UInt32<F> index, generation, number;
};
template <class F>
struct Weight {
  F kg;
};

struct Model {
  World world;
  std::vector<Entity> alive;
  std::map<std::uint32_t, Entity> keeper;  // by index, including owners that are gone

  Model() { world.set_owner_part(component_id<Keeper>()); }

  Entity some(std::uint32_t draw) const { return alive.empty() ? Entity{} : alive[draw % alive.size()]; }
  void check() const {
    std::map<std::uint32_t, std::vector<Entity>> members;
    for (const Entity one : alive) {
      const auto at = keeper.find(one.index);
      const bool kept = at != keeper.end() && world.alive(at->second) && at->second != one;
      EXPECT_EQ(world.owner_of(one), kept ? at->second : Entity{});
      if (kept) members[at->second.index].push_back(one);
    }
    for (const Entity one : alive) {
      std::vector<Entity> told;
      world.each_member(one, [&](Entity member) { told.push_back(member); });
      auto due = members[one.index];
      std::ranges::sort(due, {}, &Entity::index);
      EXPECT_EQ(told, due);
      EXPECT_EQ(world.first_member(one), due.empty() ? Entity{} : due.front());
    }
  }
};

Keeper<float> kept_by(Entity owner, std::uint32_t number) {
  return {owner.index, owner.generation, number};
}

TEST(Members, MatchTheModelThroughAnyHistory) {
  rc::check([] {
    Model model;
    World& world = model.world;
    const auto steps = *rc::gen::container<std::vector<std::uint32_t>>(60, rc::gen::arbitrary<std::uint32_t>());
    for (const std::uint32_t draw : steps) {
      const Entity owner = model.some(draw / 8), one = model.some(draw / 4096);
      switch (draw % 8) {
        case 0:
          model.alive.push_back(world.create(Weight<float>{1}));
          break;
        case 1:
        case 2: {
          std::vector<Entity> made(1 + draw % 5);
          std::vector<Keeper<Lanes<float>>> rows(1);
          for (std::size_t i = 0; i < made.size(); ++i) {
            rows[0].index[i] = owner.index;
            rows[0].generation[i] = owner.generation;
          }
          world.create_many(std::vector<PartValue>{{component_id<Keeper>(), rows.data()}}, made);
          for (const Entity entity : made) {
            model.alive.push_back(entity);
            model.keeper[entity.index] = owner;
          }
          break;
        }
        case 3:  // another owner, or one for the first time
          if (!world.alive(one)) break;
          if (world.add(one, kept_by(owner, 1)) == Status::already_there) world.set(one, kept_by(owner, 2));
          model.keeper[one.index] = owner;
          break;
        case 4:
          if (world.remove<Keeper>(one) == Status::ok) model.keeper.erase(one.index);
          break;
        case 5:
        case 6:
          if (world.destroy(one) != Status::ok) break;
          std::erase(model.alive, one);
          model.keeper.erase(one.index);
          break;
        default: {
          std::vector<Entity> gone;
          for (std::size_t i = 0; i < model.alive.size(); i += 3) gone.push_back(model.alive[i]);
          EXPECT_EQ(world.destroy_many(gone), Status::ok);
          for (const Entity entity : gone) {
            std::erase(model.alive, entity);
            model.keeper.erase(entity.index);
          }
        }
      }
      model.check();
    }
    RC_ASSERT(!testing::Test::HasFailure());
  });
}

TEST(Members, AreRebuiltFromASnapshot) {
  Model model;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const Entity owner = model.some(i * 7);
    model.alive.push_back(model.world.create(kept_by(owner, i)));
    model.keeper[model.alive.back().index] = owner;
    if (i % 6 == 5) {
      model.keeper.erase(model.alive[i % 4].index);
      EXPECT_EQ(model.world.destroy(model.alive[i % 4]), Status::ok);
      model.alive.erase(model.alive.begin() + i % 4);
    }
  }
  model.check();
  const auto nothing = [](const Archetype&) { return std::uint64_t{0}; };
  const SnapshotLayout layout = WorldSnapshot::layout(model.world, nothing);
  std::vector<std::byte> bytes(layout.bytes());
  WorldSnapshot::save(model.world, layout, bytes, {}, nothing);
  const std::uint64_t before = state_hash(model.world, {});
  const Entity late = model.world.create(kept_by(model.alive[3], 99));
  EXPECT_NE(state_hash(model.world, {}), before);
  const auto open = open_snapshot(bytes, {});
  ASSERT_TRUE(open);
  const auto saved = WorldSnapshot::read(*open);
  ASSERT_TRUE(saved);
  WorldSnapshot snapshot;
  ASSERT_TRUE(snapshot.prepare(model.world, *saved, {}, {}, nothing, [](const Archetype&) { return Result<void>(); }));
  snapshot.commit(model.world, *saved, {});
  EXPECT_FALSE(model.world.alive(late));
  EXPECT_EQ(state_hash(model.world, {}), before);
  model.check();
}

TEST(Snapshot, OmittedComponentsMatchThoseTheReaderRebuilds) {
  World world;
  world.create(Weight<float>{70}, kept_by({}, 1), TagValue<Model>{3});
  const auto nothing = [](const Archetype&) { return std::uint64_t{0}; };
  const auto weight = [](const Archetype&) { return type_id<Weight<float>>(); };
  const auto keeper = [](const Archetype&) { return type_id<Keeper<float>>(); };
  const auto no_column = [](const Archetype&) { return type_id<Model>(); };
  const struct {
    LeftOut by_writer, by_reader;
    bool agree;
  } cases[] = {{nothing, nothing, true}, {weight, weight, true},  {nothing, weight, false},
               {weight, nothing, false}, {weight, keeper, false}, {no_column, no_column, true}};
  for (const auto& [by_writer, by_reader, agree] : cases) {
    const SnapshotLayout layout = WorldSnapshot::layout(world, by_writer);
    std::vector<std::byte> bytes(layout.bytes());
    WorldSnapshot::save(world, layout, bytes, {}, by_writer);
    const auto open = open_snapshot(bytes, {});
    ASSERT_TRUE(open);
    const auto saved = WorldSnapshot::read(*open);
    ASSERT_TRUE(saved);
    WorldSnapshot snapshot;
    const auto any_key = [](const Archetype&) { return Result<void>(); };
    EXPECT_EQ(snapshot.prepare(world, *saved, {}, {}, by_reader, any_key).has_value(), agree);
  }
}

TEST(Members, HashCountsOwnersIndependentOfHandles) {
  World one, other;
  one.set_owner_part(component_id<Keeper>());
  other.set_owner_part(component_id<Keeper>());
  const Entity a = one.create(Weight<float>{1}), b = one.create(Weight<float>{2});
  one.create(kept_by(a, 5));
  one.create(kept_by(b, 6));
  const Entity spare = other.create(Weight<float>{9}), d = other.create(Weight<float>{2});
  other.create(kept_by(d, 6));
  other.destroy(spare);
  const Entity c = other.create(Weight<float>{1});
  const Entity moved = other.create(kept_by(c, 5));
  EXPECT_EQ(state_hash(one, {}), state_hash(other, {}));
  other.set(moved, kept_by(d, 5));  // the same rows with another owner
  EXPECT_NE(state_hash(one, {}), state_hash(other, {}));
}

}  // namespace mobil::members_test
