#include <mobil/systems/cluster/ranks.h>

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include "systems/cluster/balance.h"
#include "tests/cluster/local_run.h"

namespace mobil {
namespace {

std::vector<std::byte> bytes_of(int value, std::size_t times) {
  return std::vector<std::byte>(times, std::byte{static_cast<std::uint8_t>(value)});
}

/// Messages arrive with random delays.
class RanksOf : public testing::TestWithParam<int> {};

TEST_P(RanksOf, ExchangeValues) {
  const int count = GetParam();
  for (const std::uint64_t seed : {0U, 1U, 2U, 3U}) {
    const std::string stopped = on_ranks(
        count,
        [&](Ranks& ranks) {
          const auto own = static_cast<std::uint64_t>(ranks.rank());
          const auto n = static_cast<std::uint64_t>(count);
          std::array<std::uint64_t, 3> values = {own, 1, ~std::uint64_t{0}};
          ranks.sum(values);
          EXPECT_EQ(values[0], n * (n - 1) / 2);
          EXPECT_EQ(values[1], n);
          EXPECT_EQ(values[2], ~n + 1) << "sums are modulo 2^64";
          EXPECT_EQ(ranks.most(1000 - own), 1000U);
          EXPECT_EQ(ranks.share(bytes_of(ranks.rank() + 5, 9)), bytes_of(5, 9)) << "the first rank's";
          const auto all = ranks.gather(bytes_of(ranks.rank(), own + 1));
          ASSERT_EQ(all.size(), ranks.first() ? n : 0);
          for (std::size_t r = 0; r < all.size(); ++r) EXPECT_EQ(all[r], bytes_of(static_cast<int>(r), r + 1));
          for (std::uint32_t tick = 0; tick < 40; ++tick) {
            ranks.at_tick(tick);
            if (ranks.first()) ranks.send_commands(tick, bytes_of(static_cast<int>(tick), tick));
            if (!ranks.first()) {
              const auto commands = ranks.take_commands(tick);
              EXPECT_EQ(std::vector(commands.begin(), commands.end()), bytes_of(static_cast<int>(tick), tick));
            }
          }
          EXPECT_EQ(ranks.sum(1), n);
        },
        seed);
    EXPECT_EQ(stopped, "");
  }
}

TEST_P(RanksOf, AllReceiveTheErrorOfOne) {
  const int count = GetParam();
  const std::string stopped = on_ranks(count, [&](Ranks& ranks) {
    EXPECT_TRUE(ranks.agree({}));
    const Result<void> own = ranks.rank() == count - 1 ? Result<void>(fail("the disk is full")) : Result<void>();
    const auto agreed = ranks.agree(own);
    ASSERT_FALSE(agreed);
    EXPECT_EQ(agreed.error().message, "the disk is full");
  });
  EXPECT_EQ(stopped, "");
}

INSTANTIATE_TEST_SUITE_P(Counts, RanksOf, testing::Values(1, 2, 3, 4, 7, 8));

TEST(Ranks, SilentRankIsNamed) {
  std::atomic<bool> done = false;
  const std::string stopped = on_ranks(
      3,
      [&](Ranks& ranks) {
        for (std::uint32_t tick = 0; tick < 64; ++tick) {
          ranks.at_tick(tick);
          while (ranks.rank() == 2 && tick == 50 && !done) std::this_thread::sleep_for(std::chrono::milliseconds(1));
          if (ranks.first()) ranks.send_commands(tick, {});
          if (!ranks.first()) ranks.take_commands(tick);
        }
        try {
          ranks.sum(1);
        } catch (...) {
          done = true;
          throw;
        }
      },
      0, 0.3);
  EXPECT_TRUE(stopped.starts_with("cluster: rank 2 has been silent for 0.")) << stopped;
  EXPECT_NE(stopped.find("since about tick 48"), std::string::npos) << stopped;
}

TEST(Ranks, RankThatReportsAliveIsWaitedFor) {
  const std::string stopped = on_ranks(
      2,
      [&](Ranks& ranks) {
        ranks.at_tick(0);
        for (int i = 0; ranks.rank() == 1 && i < 100; ++i) {
          std::this_thread::sleep_for(std::chrono::milliseconds(10));
          ranks.alive();
        }
        EXPECT_EQ(ranks.sum(1), 2U);
      },
      0, 0.3);
  EXPECT_EQ(stopped, "");
}

TEST(Ranks, AlteredMessageStopsAllInOneLine) {
  for (const bool cut : {false, true}) {
    LocalRanks local(2);
    auto bytes = seal_message({MessageKind::commands, 0, bytes_of(1, 100)});
    if (cut) bytes.resize(50);
    bytes[40] ^= std::byte{4};
    local[0].send(1, Channel::commands, bytes);
    Ranks other(local[1]);
    try {
      other.take_commands(0);
      ADD_FAILURE();
    } catch (const RanksStopped& why) {
      EXPECT_TRUE(std::string(why.what()).starts_with("cluster: from rank 0: a message was")) << why.what();
    }
    EXPECT_THROW(local[0].take(1, Channel::up, bytes), RanksStopped) << "the first rank stops as well";
  }
}

TEST(Balance, MovesFromTheBusiestToTheIdlestRank) {
  const auto owner = first_owners(8, 2);
  const std::vector<std::uint64_t> even(8, 100);
  EXPECT_TRUE(plan_moves(owner, even, 2).empty());
  const std::vector<std::uint64_t> cost = {100, 10, 100, 10, 100, 10, 100, 10};
  const auto moves = plan_moves(owner, cost, 2);
  ASSERT_FALSE(moves.empty());
  std::array<std::uint64_t, 2> load{};
  auto now = owner;
  for (const ShardMove& move : moves) {
    EXPECT_EQ(now[move.shard], move.from);
    now[move.shard] = move.to;
  }
  for (std::size_t s = 0; s < 8; ++s) load[static_cast<std::size_t>(now[s])] += cost[s];
  EXPECT_EQ(load[0] + load[1], 440U);
  EXPECT_LE(std::max(load[0], load[1]), 240U) << "from 400 to 40";
}

TEST(Balance, OneHeavyShardStays) {
  EXPECT_TRUE(plan_moves(std::vector{0, 1}, std::vector<std::uint64_t>{1000, 1}, 2).empty());
  EXPECT_TRUE(plan_moves(std::vector{0, 1}, std::vector<std::uint64_t>{0, 0}, 2).empty());
}

}  // namespace
}  // namespace mobil
