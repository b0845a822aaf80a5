// The order of systems and their parameters. Neither threads nor blocks affect the result.
#include <mobil/schedule.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/schedule_order.h"
#include "tests/labels.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::engine_schedule_test {
template <class F>
struct A {
  F x;
};
template <class F>
struct B {
  F x;
};
template <class F>
struct C {
  F x;
};
template <class F>
struct Friend {
  UInt32<F> index, generation;
};
struct Nodes {};
struct Substeps {};
struct Mesh {
  float gain;
};
using LA = A<Lanes<float>>;
using LB = B<Lanes<float>>;
using LC = C<Lanes<float>>;

void write_a(LA&) {}
void write_b(LB&) {}
void a_to_b(const LA&, LB&) {}
void b_to_c(const LB&, LC&) {}
void c_to_a(const LC&, LA&) {}

std::string order_of(const ScheduleBuilder& builder) {
  const auto schedule = builder.build();
  if (!schedule) return schedule.error().message;
  std::string names;
  for (const System& system : schedule->systems()) names += (names.empty() ? "" : " ") + system.name;
  return names;
}

TEST(EngineSchedule, LookupsAndFieldsCountAsReads) {
  EXPECT_EQ(order_of(ScheduleBuilder().add("look", [](Lookup<A>, LB&) {}).add("write", &write_a)), "write look");
  EXPECT_EQ(order_of(ScheduleBuilder().add("look", [](Field<const Nodes>) {}).add("write", [](Field<Nodes>) {})),
            "write look");
}

std::string passes_of(const ScheduleBuilder& builder) {
  const auto schedule = builder.build();
  std::string text;
  for (const SystemRange& pass : schedule->passes()) {
    for (std::size_t s = pass.first; s < pass.last; ++s) text += schedule->systems()[s].name;
    text += '|';
  }
  return text;
}

TEST(EngineSchedule, SystemsWithoutCrossBlockReadsShareAPass) {
  EXPECT_EQ(passes_of(ScheduleBuilder().add("a", &write_a).add("b", &a_to_b).add("c", &b_to_c)), "abc|");
  const auto look_at_a = [](Lookup<A>, LB&) {};
  EXPECT_EQ(passes_of(ScheduleBuilder().add("a", &write_a).add("b", look_at_a).add("c", &b_to_c)), "a|bc|");
  // no system changes a component that others of the pass can still look up
  EXPECT_EQ(passes_of(ScheduleBuilder().add("a", &write_a).after("b").add("b", look_at_a).add("c", &b_to_c)), "b|ac|");
  EXPECT_EQ(passes_of(ScheduleBuilder()
                          .add("a", &write_a)
                          .add_packed(
                              "p", [](const LA&) { return 1U; }, [](const LA&, LB&) {})
                          .add("c", &b_to_c)),
            "a|p|c|");
}

TEST(EngineSchedule, PreviousReadsBeforeTheWriterAndBreaksACycle) {
  EXPECT_EQ(order_of(ScheduleBuilder().add("a", &write_a).add("p", [](Previous<A>, LB&) {})), "p a");
  ScheduleBuilder circle;
  circle.add("ab", &a_to_b).add("bc", &b_to_c).add("ca", &c_to_a);
  EXPECT_EQ(order_of(circle),
            "schedule: 'ab' waits for 'ca' waits for 'bc' waits for 'ab'; let one read last tick's value (Previous<…>) "
            "or order them with .after(…)");
  ScheduleBuilder open;
  open.add("ab", &a_to_b).add("bc", &b_to_c).add("ca", [](Previous<C>, LA&) {});
  EXPECT_EQ(order_of(open), "ca ab bc");
}

/// Alternative systems can write one component without an order, as long as no table matches two of them.
TEST(EngineSchedule, AlternativesNeedNoOrderUnlessATableHasTwo) {
  const auto both = [] {
    ScheduleBuilder systems;
    systems.add("one", [](LA&, const LB&) {}).one_of("ways").add("two", [](LA&, const LC&) {}).one_of("ways");
    return systems.add("last", &write_a).after("ways");
  };
  EXPECT_EQ(order_of(both()), "one two last");
  EXPECT_NE(order_of(both().add("other", &write_a).one_of("others")).find("both write"), std::string::npos);
  EXPECT_NE(order_of(ScheduleBuilder().add("one", &write_a).after("ways")).find("never added"), std::string::npos);
  World world;
  world.create(A<float>{}, B<float>{});
  world.create(A<float>{}, C<float>{});
  auto schedule = both().build().value();
  schedule.run(world, {});
  world.create(A<float>{}, B<float>{}, C<float>{});
  for (int twice = 0; twice < 2; ++twice) {
    try {
      schedule.run(world, {});
      ADD_FAILURE() << "a table has both";
    } catch (const std::logic_error& error) {
      EXPECT_NE(std::string(error.what()).find("'two'"), std::string::npos) << error.what();
    }
  }
}

TEST(EngineSchedule, AfterOrdersWritersAndOverridesTheRule) {
  EXPECT_EQ(order_of(ScheduleBuilder().add("one", &write_a).add("two", &write_a)),
            "schedule: systems 'one' and 'two' both write " + std::string(type_name<A<float>>()) +
                "; say which comes second with .after(…)");
  EXPECT_EQ(order_of(ScheduleBuilder().add("one", &write_a).after("two").add("two", &write_a).add("read", &a_to_b)),
            "two one read");
  EXPECT_EQ(order_of(ScheduleBuilder().add("write", &write_a).after("read").add("read", &a_to_b)), "read write");
  // through a third one
  EXPECT_EQ(
      order_of(
          ScheduleBuilder().add("one", &write_a).add("mid", &write_b).after("one").add("two", &write_a).after("mid")),
      "one mid two");
}

TEST(EngineSchedule, MistakesAreNamedAtStartUp) {
  EXPECT_EQ(order_of(ScheduleBuilder().add("x", &write_a).add("x", &write_b)),
            "schedule: two systems are named 'x'; rename one");
  EXPECT_EQ(order_of(ScheduleBuilder().add("x", &write_a).after("y")),
            "schedule: system 'x' is to run after 'y', which was never added; add it or drop the after");
  EXPECT_EQ(order_of(ScheduleBuilder().add("x", &write_a).after("x")).substr(0, 32),
            "schedule: 'x' waits for 'x'; let");
  for (const auto& twice :
       {ScheduleBuilder().add("x", [](const LA&, LA&) {}), ScheduleBuilder().add("x", [](Lookup<A>, LA&) {}),
        ScheduleBuilder().add("x", [](Previous<A>, LA&) {})}) {
    EXPECT_NE(order_of(twice).find("'x' takes"), std::string::npos);
  }
}

// --- random systems against trying every order there is ---

bool touches(const System& system, std::uint64_t id, Access::Mode mode) {
  return std::any_of(system.accesses.begin(), system.accesses.end(),
                     [=](const Access& a) { return a.id == id && a.mode == mode; });
}

/// Returns true if the `after` of the systems leads from a to b.
bool leads(const std::vector<System>& systems, std::size_t a, std::size_t b, std::size_t steps = 0) {
  if (steps > systems.size()) return false;
  for (const std::string& name : systems[b].after) {
    if (name == systems[a].name || leads(systems, a, static_cast<std::size_t>(name[0] - 'a'), steps + 1)) return true;
  }
  return false;
}

/// Returns true if a must run before b by the written rules.
bool must_precede(const std::vector<System>& systems, std::size_t a, std::size_t b) {
  if (leads(systems, a, b)) return true;
  if (a == b || leads(systems, b, a)) return false;
  for (std::uint64_t column = 0; column < 3; ++column) {
    const bool a_writes = touches(systems[a], column, Access::Mode::write);
    const bool b_writes = touches(systems[b], column, Access::Mode::write);
    const auto reads = [&](std::size_t s) {
      return touches(systems[s], column, Access::Mode::read) || touches(systems[s], column, Access::Mode::lookup);
    };
    if ((a_writes && reads(b)) || (b_writes && touches(systems[a], column, Access::Mode::previous))) return true;
  }
  return false;
}

RC_GTEST_PROP(EngineSchedule, OrderIsTheFirstThatKeepsTheRules, ()) {
  const std::size_t count = *rc::gen::inRange<std::size_t>(1, 6);
  std::vector<System> systems(count);
  for (std::size_t s = 0; s < count; ++s) {
    systems[s].name = static_cast<char>('a' + s);
    for (std::uint64_t column = 0; column < 3; ++column) {
      const int mode = *rc::gen::weightedElement<int>({{6, 0}, {3, 1}, {2, 2}, {1, 3}, {1, 4}});
      systems[s].accesses.push_back({static_cast<Access::Mode>(mode), column, "column"});
    }
    while (*rc::gen::weightedElement<int>({{3, 0}, {1, 1}}) == 1) {
      systems[s].after.emplace_back(1, static_cast<char>('a' + *rc::gen::inRange<std::size_t>(0, count)));
    }
  }
  const auto order = schedule_order(systems);

  bool unordered_writers = false;
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      for (std::uint64_t column = 0; column < 3; ++column) {
        unordered_writers |= touches(systems[a], column, Access::Mode::write) &&
                             touches(systems[b], column, Access::Mode::write) && !leads(systems, a, b) &&
                             !leads(systems, b, a);
      }
    }
  }
  RC_TAG(order ? "order" : unordered_writers ? "unordered writers" : "circle");
  if (unordered_writers) {
    RC_ASSERT(!order);
    RC_ASSERT(order.error().message.find("both write column") != std::string::npos);
    return;
  }
  std::vector<std::size_t> candidate(count);
  std::iota(candidate.begin(), candidate.end(), 0U);
  do {
    bool keeps = true;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j <= i; ++j) keeps &= !must_precede(systems, candidate[i], candidate[j]);
    }
    if (!keeps) continue;
    RC_ASSERT(order.has_value());
    RC_ASSERT(*order == candidate);
    return;
  } while (std::next_permutation(candidate.begin(), candidate.end()));
  RC_ASSERT(!order);
  RC_ASSERT(order.error().message.find("waits for") != std::string::npos);
}

TEST(EngineSchedule, LookupFindsOnlyRows) {
  World world;
  std::vector<Entity> all;
  for (unsigned i = 0; i < 20; ++i) all.push_back(world.create(Friend<float>{i, i + 1}));
  const Entity without = world.create(A<float>{});
  const Lookup<Friend> lookup(world);
  for (unsigned i = 0; i < 20; ++i) {
    const float* row = lookup.find(all[i]);
    ASSERT_NE(row, nullptr);
    std::uint32_t words[2];
    std::memcpy(&words[0], row, 4);
    std::memcpy(&words[1], row + lane_count, 4);
    EXPECT_EQ(words[0], i);
    EXPECT_EQ(words[1], i + 1);
  }
  EXPECT_EQ(lookup.find(without), nullptr);
  EXPECT_EQ(lookup.find(Entity{}), nullptr);
  EXPECT_EQ(world.destroy(all[3]), Status::ok);
  EXPECT_EQ(lookup.find(all[3]), nullptr);
}

TEST(EngineSchedule, DescribesItself) {
  const auto schedule =
      ScheduleBuilder().add("mix", [](const LA&, Lookup<B>, Previous<C>, Field<Nodes>, Rows, float) {}).build();
  EXPECT_EQ(schedule->describe(), "1. mix; reads A; reads last tick's C; looks up B; writes Nodes\n");
}

TEST(EngineSchedule, PassesEachParameter) {
  World world;
  const auto mesh = world.share(std::make_shared<const Mesh>(Mesh{3}));
  std::vector<Entity> all;
  for (unsigned i = 0; i < 21; ++i) {
    all.push_back(world.create(A<float>{static_cast<float>(i)}, B<float>{}, FieldWidth<Nodes>{2},
                               TagValue<Substeps>{4 + i % 2}, mesh));
  }
  const Entity without = world.create(A<float>{100}, B<float>{-1});
  const auto fill = [](Field<Nodes> nodes, const LA& a, const Rows& rows) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      nodes.data[l] = a.x[l];
      nodes.data[lane_count + l] = static_cast<float>(rows.entity[l].index);
    }
  };
  const auto sum = [gain = 2.0F](Field<const Nodes> nodes, TagValue<Substeps> substeps, Shared<Mesh> m, Tick tick,
                                 LB& b) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      b.x[l] = gain * nodes.data[l] + nodes.data[lane_count + l] * m->gain + static_cast<float>(substeps.value) +
               static_cast<float>(nodes.words * tick.index) + tick.dt_s;
    }
  };
  auto schedule = ScheduleBuilder().add("sum", sum).add("fill", fill).build();
  schedule->run(world, {0.5F, 1000});
  for (unsigned i = 0; i < 21; ++i) {
    const auto n = static_cast<float>(i);
    EXPECT_EQ(world.get<B>(all[i])->x,
              2 * n + 3 * static_cast<float>(all[i].index) + static_cast<float>(4 + i % 2) + 2000.5F);
  }
  EXPECT_EQ(world.get<B>(without)->x, -1);
}

TEST(EngineSchedule, PrefetchForALaterSystemIsNotAnAccess) {
  World world;
  const Entity with = world.create(A<float>{1}, FieldWidth<Nodes>{3});
  world.create(A<float>{2});
  std::vector<std::uint32_t> words;
  const float* fetched = nullptr;
  const auto look = [&](const LA&, Later<Nodes> nodes) {
    words.push_back(nodes.words);
    if (nodes.data != nullptr) fetched = nodes.data;
  };
  const float* written = nullptr;
  auto schedule = ScheduleBuilder().add("look", look).add("write", [&](Field<Nodes> to) { written = to.data; }).build();
  schedule->run(world, {});
  std::ranges::sort(words);
  EXPECT_EQ(words, (std::vector<std::uint32_t>{0, 3}));
  EXPECT_EQ(fetched, written);
  EXPECT_EQ(schedule->systems()[0].name, "look") << "who reads a field runs after who writes it";
  EXPECT_TRUE(world.alive(with));
}

TEST(EngineSchedule, SeesNewTablesAndOtherWorlds) {
  const auto count = [](LA& a) {
    for (float& x : a.x.lane) x += 1;
  };
  auto schedule = ScheduleBuilder().add("count", count).build();
  auto world = std::make_unique<World>();
  const Entity first = world->create(A<float>{});
  schedule->run(*world, {});
  const Entity second = world->create(A<float>{}, B<float>{});
  schedule->run(*world, {});
  EXPECT_EQ(world->get<A>(first)->x, 2);
  EXPECT_EQ(world->get<A>(second)->x, 1);
  EXPECT_EQ(world->remove<A>(first), Status::ok);
  schedule->run(*world, {});
  EXPECT_EQ(world->get<A>(second)->x, 2);
  for (int i = 0; i < 5; ++i) {  // very likely at the same address again
    world = std::make_unique<World>();
    const Entity other = world->create(B<float>{}, C<float>{}, A<float>{});
    schedule->run(*world, {});
    EXPECT_EQ(world->get<A>(other)->x, 1);
  }
}

TEST(EngineSchedule, CountsCallsAndTime) {
  auto schedule = ScheduleBuilder().add("a", &write_a).build();
  World world;
  world.create(A<float>{});
  for (int i = 0; i < 3; ++i) schedule->run(world, {});
  EXPECT_EQ(schedule->timing("a")->calls, 3U);
  EXPECT_GE(schedule->timing("a")->seconds, 0.0);
  EXPECT_EQ(schedule->timing("b"), nullptr);
  schedule->reset_timings();
  EXPECT_EQ(schedule->timing("a")->calls, 0U);
}

struct Odd {};
struct Never {};

TEST(EngineSchedule, TalliesAreSumsOfTheTickAndOfAll) {
  World world;
  for (unsigned i = 0; i < 1000; ++i) {
    i % 7 == 0 ? world.create(A<float>{1}, B<float>{}) : world.create(A<float>{static_cast<float>(i % 2)});
  }
  const auto odd = [](const LA& a, const Rows& rows, Tally<Odd> count) {
    for (std::size_t lane = 0; lane < rows.live; ++lane) count.add(a.x[lane] == 1 ? 1 : 0);
  };
  const auto more = [](const LB&, const Rows& rows, Tally<Odd> count) { count.add(10 * rows.live); };
  auto schedule = ScheduleBuilder().add("odd", odd).add("more", more).add("never", [](LC&, Tally<Never>) {}).build();
  ASSERT_TRUE(schedule);
  const std::uint64_t expected = 143 + 429 + 10 * 143;  // every seventh of 0 … 999; the others' odd ones
  const Threads threads(2);
  for (std::uint64_t i = 1; i <= 20; ++i) {
    schedule->run(world, {}, threads.jobs());
    EXPECT_EQ(schedule->tally<Odd>().last, expected);
    EXPECT_EQ(schedule->tally<Odd>().all, i * expected);
    EXPECT_EQ(schedule->tally<Never>().all, 0U);
  }
  schedule->reset_timings();
  EXPECT_EQ(schedule->tally<Odd>().all, 0U);
}
}  // namespace mobil::engine_schedule_test
