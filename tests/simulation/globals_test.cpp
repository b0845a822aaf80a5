// State values that belong to no entity: in the state hash and in snapshots once they differ from their first value.
#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <mobil/engine/module.h>
#include <mobil/engine/phase.h>
#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include "tests/simulation/reseal.h"

namespace mobil::globals_test {
namespace {

struct Weather {
  float wind_m_s = 1;
  std::uint32_t gusts = 0;
};
bool is_sound(const Weather& weather) {
  return weather.wind_m_s >= 0 && weather.wind_m_s < 60;
}

/// Returns a module with a wind that grows in each tick.
Module weather(const std::string& name = "weather", std::uint32_t version = 1) {
  return {.name = name,
          .version = version,
          .globals = {global_part<Weather, &is_sound>()},
          .before = {{"gusts", [](const Frame& frame) {
                        auto& now = frame.world.global<Weather>();
                        now.wind_m_s += 0.5F;
                        ++now.gusts;
                      }}}};
}

std::vector<std::byte> saved(const Simulation& simulation) {
  std::vector<std::byte> bytes(simulation.snapshot_bytes());
  EXPECT_TRUE(simulation.save(bytes));
  return bytes;
}

TEST(Globals, AreInTheHashOnceTheyChange) {
  Simulation plain, windy({.modules = {weather()}});
  EXPECT_EQ(plain.state_hash(), windy.state_hash());
  const std::uint64_t sum = windy.state_sum();
  plain.tick();
  windy.tick();
  EXPECT_NE(plain.state_hash(), windy.state_hash());
  EXPECT_EQ(windy.state_sum(), sum);
}

TEST(Globals, AreRestoredFromSnapshots) {
  Simulation windy({.modules = {weather()}}), other({.modules = {weather()}});
  const auto calm = saved(windy);
  windy.tick(3);
  const auto bytes = saved(windy);
  other.tick(7);
  ASSERT_TRUE(other.restore(bytes));
  EXPECT_EQ(other.world().global<Weather>().gusts, 3U);
  EXPECT_EQ(other.state_hash(), windy.state_hash());
  windy.tick(2), other.tick(2);
  EXPECT_EQ(other.state_hash(), windy.state_hash());
  ASSERT_TRUE(other.restore(calm));  // saved at its first value
  EXPECT_EQ(other.world().global<Weather>().gusts, 0U);
  EXPECT_EQ(other.world().global<Weather>().wind_m_s, 1);
}

TEST(Globals, UnknownOrUnsoundOnesAreRefused) {
  Simulation windy({.modules = {weather()}}), plain, newer({.modules = {weather("weather", 2)}});
  windy.tick(2);
  auto bytes = saved(windy);
  for (Simulation* const other : {&plain, &newer}) {
    const std::uint64_t before = other->state_hash();
    const auto done = other->restore(bytes);
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().message.find("weather"), std::string::npos) << done.error().message;
    EXPECT_EQ(other->state_hash(), before);
  }
  windy.tick(200);
  const auto done = windy.restore(saved(windy));
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("Weather"), std::string::npos) << done.error().message;
}

TEST(Globals, InForgedSnapshotsAreHarmless) {
  Simulation windy({.modules = {weather()}});
  windy.tick(2);
  const auto good = saved(windy);
  for (std::size_t at = 0; at < good.size(); ++at) {
    auto bytes = good;
    bytes[at] ^= std::byte{0x55};
    if (!reseal_snapshot(bytes)) continue;
    if (windy.restore(bytes)) {
      EXPECT_TRUE(is_sound(windy.world().global<Weather>()));
    }
  }
  ASSERT_TRUE(windy.restore(good));
  EXPECT_EQ(windy.world().global<Weather>().gusts, 2U);
}

TEST(Globals, UnnamedOnesAreALogicError) {
  Simulation plain;
  try {
    (void)plain.world().global<Weather>();
    ADD_FAILURE();
  } catch (const std::logic_error& error) {
    EXPECT_NE(std::string(error.what()).find("Weather"), std::string::npos);
  }
}

TEST(Globals, BelongToOneModule) {
  const auto made = Simulation::make({.modules = {weather("a"), weather("b")}});
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("Weather"), std::string::npos) << made.error().message;
}

}  // namespace
}  // namespace mobil::globals_test
