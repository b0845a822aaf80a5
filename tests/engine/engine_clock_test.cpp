// The clock's time adds up to the last unit.
#include <mobil/engine/clock.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <clocale>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace mobil::engine_clock_test {
constexpr double unit_s = 0x1p-50;

rc::Gen<double> seconds_between(double low, double high) {
  return rc::gen::map(rc::gen::inRange<std::int64_t>(0, 1'000'000'000'000),
                      [=](std::int64_t i) { return low + (high - low) * static_cast<double>(i) * 1e-12; });
}

RC_GTEST_PROP(EngineClock, TicksRemainderAndDroppedAddUpToTheInput, ()) {
  const double tick_s = *seconds_between(1e-3, 0.1);
  const double max_frame_s = tick_s + *seconds_between(0, 0.5);
  Clock clock = *Clock::make(tick_s, max_frame_s);
  RC_ASSERT(std::fabs(clock.tick_s() - tick_s) <= unit_s);
  long double fed = 0, run = 0, dropped = 0;
  std::size_t feeds = 0;
  for (const double seconds : *rc::gen::container<std::vector<double>>(seconds_between(0, 1))) {
    const Ticks ticks = clock.advance(seconds);
    ++feeds;
    fed += seconds;
    run += static_cast<long double>(ticks.count) * clock.tick_s();
    dropped += ticks.dropped_s;
    RC_ASSERT(ticks.valid);
    RC_ASSERT(ticks.alpha >= 0 && ticks.alpha < 1);
    RC_ASSERT(ticks.alpha == clock.remainder_s() / clock.tick_s());
    RC_ASSERT(ticks.dropped_s == 0 || seconds > max_frame_s - unit_s);
    RC_ASSERT(ticks.count * clock.tick_s() < max_frame_s + tick_s);
    RC_ASSERT(std::fabs(static_cast<double>(fed - run - dropped - clock.remainder_s())) <=
              unit_s * static_cast<double>(feeds));
  }
}

RC_GTEST_PROP(EngineClock, FramesOfWholeUnitsBalanceExactly, ()) {
  Clock clock;
  std::int64_t fed = 0, run = 0;
  const auto units = [](double s) { return static_cast<std::int64_t>(std::ldexp(s, 50)); };
  for (const auto frame :
       *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(0, units(0.25)))) {
    run += clock.advance(std::ldexp(static_cast<double>(frame), -50)).count * units(clock.tick_s());
    fed += frame;
    RC_ASSERT(fed == run + units(clock.remainder_s()));
  }
}

TEST(EngineClock, ADayOfFramesHasNoDrift) {
  Clock clock;
  std::uint64_t ticks = 0;
  for (int i = 0; i < 60 * 86400; ++i) ticks += clock.advance(1.0 / 60).count;
  EXPECT_EQ(ticks, 60U * 86400U);
}

RC_GTEST_PROP(EngineClock, ImpossibleFramesRunNothing, ()) {
  Clock clock;
  clock.advance(*seconds_between(0, 0.2));
  const double before = clock.remainder_s();
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {-*seconds_between(1e-9, 10), -inf, inf, std::nan("")}) {
    const Ticks ticks = clock.advance(bad);
    RC_ASSERT(!ticks.valid);
    RC_ASSERT(ticks.count == 0U);
    RC_ASSERT(ticks.dropped_s == bad || std::isnan(bad));
    RC_ASSERT(std::isnan(ticks.dropped_s) == std::isnan(bad));
    RC_ASSERT(clock.remainder_s() == before);
  }
}

TEST(EngineClock, AHitchOfAnyLengthIsClamped) {
  Clock clock;
  const Ticks ticks = clock.advance(1e12);
  EXPECT_EQ(ticks.count, 15U);
  EXPECT_EQ(ticks.dropped_s, 1e12 - 0.25);
}

TEST(EngineClock, SettingsOutOfRangeAreErrors) {
  for (const double tick : {0.0, -1.0, 2.0, std::nan("")}) EXPECT_FALSE(Clock::make(tick));
  for (const double frame : {0.0, 0.01, 61.0, std::nan("")}) EXPECT_FALSE(Clock::make(0.02, frame));
  EXPECT_TRUE(Clock::make(0.02, 0.02));
}

TEST(EngineClock, MessagesDoNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"C", "de_DE.UTF-8", "fr_FR.UTF-8", "ps_AF.UTF-8"}) {  // the last point has two bytes
    if (std::setlocale(LC_ALL, name) == nullptr) continue;
    EXPECT_NE(Clock::make(1.5).error().message.find("a tick of 1.5 s"), std::string::npos) << name;
    EXPECT_NE(Clock::make(0.02, 0.0125).error().message.find("frame of 0.0125 s"), std::string::npos) << name;
  }
  std::setlocale(LC_ALL, before.c_str());
}
}  // namespace mobil::engine_clock_test
