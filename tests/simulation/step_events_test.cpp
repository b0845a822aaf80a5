// Step events: each once, at its instant, at the position of the foot, for any watched people, threads and tick length.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <random>
#include <tuple>
#include <vector>

#include <mobil/components/step_plan.h>
#include <mobil/engine/geometry.h>
#include <mobil/engine/world.h>
#include <mobil/pose_writer.h>
#include <mobil/simulation.h>
#include <mobil/systems/people/step_event.h>
#include "systems/people/pose_measures.h"
#include "tests/engine/wilful_pool.h"
#include "tests/labels.h"
#include "tests/simulation/people.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::step_events_test {
using geometry::operator-;

constexpr double tick_s = 1.0 / 60;
constexpr double fine_s = 1.0 / 240;  // feet are flat for some hundredths of a second

/// Requests over more than ten seconds: faster, turns, a stop, a turn in place, a step aside, a start.
void ask(Simulation& simulation, Entity person, int tick) {
  const auto at = [&](double seconds) { return tick == static_cast<int>(std::lround(seconds / fine_s)); };
  Result<void> done;
  if (at(1.5)) done = simulation.turn_to(person, 1.2F);
  if (at(3)) done = simulation.change_gait(person, {.speed_m_s = 1.7F});
  if (at(4)) done = simulation.turn_to(person, -0.4F);
  if (at(5.5)) done = simulation.change_gait(person, {.speed_m_s = 0.0F});
  if (at(9.5)) done = simulation.turn_to(person, 0.5F);
  if (at(12)) done = simulation.step_aside(person, 0.15F, 0.05F);
  if (at(14)) done = simulation.change_gait(person, {.speed_m_s = 1.2F});
  EXPECT_TRUE(done);
}
constexpr int play_ticks = 16 * 240;

/// Returns a pose between two ticks.
Pose<float> pose_at(const Simulation& simulation, Entity person, double ahead_s) {
  struct Placed {
    float at[3], turn[4];
  };
  std::vector<Placed> rows(segment_count);
  PoseWriter writer;
  EXPECT_TRUE(writer.write(simulation.world(), {&person, 1}, ahead_s, {}, {std::as_writable_bytes(std::span(rows))}));
  Pose<float> pose;
  for (std::size_t s = 0; s < segment_count; ++s) {
    pose.position_m[s] = {rows[s].at[0], rows[s].at[1], rows[s].at[2]};
    pose.rotation[s] = {rows[s].turn[0], rows[s].turn[1], rows[s].turn[2], rows[s].turn[3]};
  }
  return pose;
}

double lowest(const Feet<float>& feet, Side side) {
  return std::min({feet.heel_m[side].y, feet.toe_m[side].y, feet.tip_m[side].y});
}
bool flat(const Feet<float>& feet, Side side) {
  return std::max(std::abs(feet.heel_m[side].y), std::abs(feet.tip_m[side].y)) < 5e-5;
}
Vec3<float> ankle(const Pose<float>& pose, Side side) {
  return pose.position_m[index(side == Side::right ? Segment::foot_right : Segment::foot_left)];
}
/// Returns the heading of a flat foot.
double points(const Feet<float>& feet, Side side) {
  const Vec3<float> along = feet.tip_m[side] - feet.heel_m[side];
  return std::atan2(along.x, along.z);
}

struct Told {
  int strikes = 0, offs = 0, stops = 0, starts = 0;
  double place_m = 0, heading_rad = 0, down_m = 0, off_m = 0, lifted_m = 1;
};

/// Watches a walk, and the same walk a tick behind, in which poses are evaluated at the events' instants.
Told watch(const SamplePerson& who) {
  Simulation now({.tick_s = fine_s}), before({.tick_s = fine_s});
  const Entity person = *now.spawn(who.body, who.gait), twin = *before.spawn(who.body, who.gait);
  EXPECT_TRUE(now.enable({&person, 1}, Feature::step_events));
  Told told;
  std::array<std::optional<StepEvent>, 2> down;  // not yet compared while flat
  std::array<bool, 2> in_air{};
  std::uint32_t steps = 0;
  for (int t = 0; t < play_ticks; ++t) {
    ask(now, person, t);
    ask(before, twin, t);
    now.tick();
    for (const StepEvent& event : now.events()) {
      EXPECT_EQ(event.person, person);
      EXPECT_EQ(event.tick, now.ticks());
      EXPECT_TRUE(event.part >= 0 && event.part <= 1);
      const auto feet_at = [&](double shifted_s) {
        const double ahead_s = static_cast<double>(event.part) * fine_s + shifted_s;
        return sole_points(who.body.height_m, pose_at(before, twin, std::clamp(ahead_s, 0.0, 0.2)));
      };
      const Side side = event.side;
      const double height_m = std::abs(lowest(feet_at(0), side));
      if (event.kind == StepEventKind::heel_strike) {
        ++told.strikes;
        EXPECT_TRUE(in_air[side] || told.strikes == 1) << "twice, at " << t;
        in_air[side] = false;
        down[side] = event;
        told.down_m = std::max(told.down_m, height_m);
      } else if (event.kind == StepEventKind::toe_off) {
        ++told.offs;
        EXPECT_FALSE(in_air[side]) << "twice, at " << t;
        EXPECT_FALSE(down[side]) << "was never flat";
        in_air[side] = true;
        told.off_m = std::max(told.off_m, height_m);
        told.lifted_m = std::min(told.lifted_m, lowest(feet_at(0.04), side));
      } else {
        EXPECT_FALSE(in_air[0] || in_air[1]);
        event.kind == StepEventKind::stopped ? ++told.stops : ++told.starts;
      }
    }
    before.tick();
    const auto state = *now.get<GaitState>(person);
    steps = state.steps;
    const auto feet = *now.get<Feet>(person);
    const auto pose = *now.get<Pose>(person);
    for (const Side side : {Side::right, Side::left}) {
      if (!down[side] || !flat(feet, side) || in_air[side]) continue;
      Vec3<float> off = ankle(pose, side) - down[side]->place_m;
      off.y = 0;
      told.place_m = std::max(told.place_m, static_cast<double>(geometry::length(off)));
      told.heading_rad = std::max(
          told.heading_rad,
          std::abs(std::remainder(points(feet, side) - static_cast<double>(down[side]->heading_rad), 2 * M_PI)));
      down[side].reset();
    }
  }
  EXPECT_EQ(told.strikes, static_cast<int>(steps));
  EXPECT_EQ(told.offs, told.strikes + (in_air[0] || in_air[1] ? 1 : 0));
  return told;
}

TEST(StepEvents, EachIsReportedOnceAtTheFootsPlace) {
  for (int i = 0; i < 6; ++i) {
    const Told told = watch(sample_person(i));
    std::printf(
        "%d strikes, %d toe-offs, %d stops, %d starts: places %.4f mm, headings %.5f, heels %.2f mm over the "
        "ground, toes %.2f mm, %.1f mm 40 ms after toe-off\n",
        told.strikes, told.offs, told.stops, told.starts, 1e3 * told.place_m, told.heading_rad, 1e3 * told.down_m,
        1e3 * told.off_m, 1e3 * told.lifted_m);
    EXPECT_GT(told.strikes, 20);
    EXPECT_EQ(told.stops, 3);   // after the walk, the turn and the step aside
    EXPECT_EQ(told.starts, 3);  // to turn, aside and to walk
    EXPECT_LT(told.place_m, 1e-4);
    EXPECT_LT(told.heading_rad, 2e-3);
    EXPECT_LT(told.down_m, 9e-3);  // the heel's pad
    EXPECT_LT(told.off_m, 3e-3);
    EXPECT_GT(told.lifted_m, -3e-3);  // toes can brush the ground
  }
}

TEST(StepEvents, InstantMatchesTheClock) {
  Simulation simulation;
  const Entity person = *simulation.spawn({}, {.speed_m_s = 1.3F});
  ASSERT_TRUE(simulation.enable({&person, 1}, Feature::step_events));
  std::optional<double> last;
  double most = 0;
  int strikes = 0;
  for (int t = 0; t < 1200; ++t) {
    simulation.tick();
    const auto plan = *simulation.get<StepPlan>(person);
    for (const StepEvent& event : simulation.events()) {
      const double at_s = (event.tick - 1 + static_cast<double>(event.part)) * tick_s;
      if (event.kind != StepEventKind::heel_strike) continue;
      ++strikes;
      // Time on the clock since the strike.
      EXPECT_NEAR(static_cast<double>(simulation.get<GaitState>(person)->time_s), simulation.time_s() - at_s, 1e-8);
      if (last) most = std::max(most, std::abs(at_s - *last - static_cast<double>(plan.duration_s)));
      last = at_s;
    }
  }
  EXPECT_GT(strikes, 30);
  EXPECT_LT(most, 6e-7);  // a unit of the clock is 0.51 µs
}

using Line = std::tuple<std::uint32_t, float, std::uint32_t, StepEventKind, std::uint32_t, float, float, float>;
std::vector<Line> lines(std::span<const StepEvent> events) {
  std::vector<Line> all;
  for (const StepEvent& e : events)
    all.emplace_back(e.tick, e.part, e.person.index, e.kind, e.side, e.place_m.x, e.place_m.z, e.heading_rad);
  return all;
}

/// A crowd with occasional requests, and the events that it reports.
struct Watched {
  explicit Watched(const SimulationOptions& options, int count = 70, bool watched = true) : simulation(options) {
    std::vector<SpawnRequest> requests(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      SpawnRequest& one = requests[static_cast<std::size_t>(i)];
      one.body = sample_person(i).body;
      one.gait = sample_person(i).gait;
      one.gait.style = snapped(one.gait.style);
      one.x_m = static_cast<float>(i);
    }
    people.resize(requests.size());
    EXPECT_TRUE(simulation.spawn(requests, people));
    if (watched) {
      EXPECT_TRUE(simulation.enable(people, Feature::step_events));
    }
  }
  void ask_some(int tick) {
    std::mt19937 random(static_cast<unsigned>(tick));
    for (const Entity person : people) {
      const auto draw = random() % 100;
      const float part = static_cast<float>(random() % 1000) * 1e-3F;
      if (draw == 0) simulation.change_gait(person, {.speed_m_s = part < 0.3F ? 0.0F : 0.7F + part});
      if (draw == 1) simulation.turn_to(person, 6 * part - 3);
    }
  }
  void tick(int count) {
    for (int i = 0; i < count; ++i) {
      ask_some(static_cast<int>(simulation.ticks()));
      simulation.tick();
      const auto more = lines(simulation.events());
      told.insert(told.end(), more.begin(), more.end());
    }
  }

  Simulation simulation;
  std::vector<Entity> people;
  std::vector<Line> told;
};

TEST(StepEvents, SameOnAnyThreadsAndForAnyWatchedPeople) {
  WilfulPool wilful(3);
  Watched one({.threads = 1}), two({.threads = 2}), cut({.jobs = wilful.jobs()}), nobody({}, 70, false);
  for (Watched* const crowd : {&one, &two, &cut, &nobody}) crowd->tick(300);
  EXPECT_GT(one.told.size(), 70U * 15);
  EXPECT_EQ(one.told, two.told);
  EXPECT_EQ(one.told, cut.told);
  EXPECT_TRUE(std::ranges::is_sorted(
      one.told, {}, [](const Line& l) { return std::tuple(std::get<0>(l), std::get<1>(l), std::get<2>(l)); }));
  EXPECT_TRUE(nobody.told.empty());
  for (std::size_t i = 0; i < one.people.size(); ++i) {
    const auto a = *one.simulation.get<Pose>(one.people[i]), b = *nobody.simulation.get<Pose>(nobody.people[i]);
    EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
  }
}

TEST(StepEvents, FrameReportsAllItsTicks) {
  Watched ticks({.max_frame_s = 1}), frames({.max_frame_s = 1});
  std::vector<Line> told;
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(frames.simulation.advance(15 * tick_s + 1e-9).count, 15U);
    const auto more = lines(frames.simulation.events());
    told.insert(told.end(), more.begin(), more.end());
    for (int t = 0; t < 15; ++t) {
      ticks.simulation.tick();
      const auto one = lines(ticks.simulation.events());
      ticks.told.insert(ticks.told.end(), one.begin(), one.end());
    }
  }
  EXPECT_EQ(told, ticks.told);
  frames.simulation.advance(0);
  EXPECT_TRUE(frames.simulation.events().empty());
}

/// Returns a person's strikes or toe-offs in order: time and place.
std::vector<std::array<double, 3>> feet_of(double length_s, const std::vector<StepEvent>& told, StepEventKind kind) {
  std::vector<std::array<double, 3>> all;
  for (const StepEvent& e : told)
    if (e.kind == kind)
      all.push_back({(e.tick - 1 + static_cast<double>(e.part)) * length_s, static_cast<double>(e.place_m.x),
                     static_cast<double>(e.place_m.z)});
  return all;
}

TEST(StepEvents, TicksOfAnyLengthReportTheSame) {
  const auto walk = [](double length_s) {
    Simulation simulation({.tick_s = length_s, .max_frame_s = 2});
    const Entity person = *simulation.spawn({}, {.speed_m_s = 1.1F});
    EXPECT_TRUE(simulation.enable({&person, 1}, Feature::step_events));
    std::vector<StepEvent> told;
    const auto run = [&](double until_s) {
      while (simulation.time_s() < until_s - 1e-9) {
        simulation.tick();
        told.insert(told.end(), simulation.events().begin(), simulation.events().end());
      }
    };
    // Requested in the middle of a step, so that all start the same step.
    run(4.8);
    EXPECT_TRUE(simulation.change_gait(person, {.speed_m_s = 0.0F}));
    run(9.6);
    EXPECT_TRUE(simulation.change_gait(person, {.speed_m_s = 1.3F}));
    run(14.4);
    return told;
  };
  const auto fine = walk(0.0125);
  for (const double length_s : {0.05, 0.1, 0.2}) {
    const auto coarse = walk(length_s);
    for (const auto kind :
         {StepEventKind::heel_strike, StepEventKind::toe_off, StepEventKind::stopped, StepEventKind::started}) {
      const auto a = feet_of(0.0125, fine, kind), b = feet_of(length_s, coarse, kind);
      ASSERT_EQ(a.size(), b.size()) << length_s << " s, " << static_cast<int>(kind);
      for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_NEAR(a[i][0], b[i][0], 1e-4) << length_s << " s, " << static_cast<int>(kind) << " number " << i;
        EXPECT_NEAR(a[i][2], b[i][2], 1e-4) << length_s << " s, " << static_cast<int>(kind) << " number " << i;
      }
    }
  }
}

TEST(StepEvents, CompactPeopleHaveEventsAndSleepersNone) {
  Watched whole({}, 40), mixed({}, 40);
  const std::span small = std::span(mixed.people).first(20), sleepers = std::span(mixed.people).subspan(20, 10);
  for (Watched* const crowd : {&whole, &mixed}) crowd->simulation.tick();
  EXPECT_EQ(*mixed.simulation.set_state(small, PersonState::compact), 20U);
  EXPECT_EQ(*mixed.simulation.set_state(sleepers, PersonState::asleep), 10U);
  const auto compare = [&](int count, bool asleep) {
    for (int t = 0; t < count; ++t) {
      whole.simulation.tick();
      mixed.simulation.tick();
      auto expected = lines(whole.simulation.events());
      if (asleep)
        std::erase_if(expected, [&](const Line& l) {
          return std::ranges::any_of(sleepers, [&](Entity e) { return e.index == std::get<2>(l); });
        });
      EXPECT_EQ(expected, lines(mixed.simulation.events())) << t;
    }
  };
  compare(120, true);
  EXPECT_TRUE(mixed.simulation.set_state(sleepers, PersonState::full));
  compare(120, false);
  EXPECT_TRUE(mixed.simulation.set_state(small, PersonState::full));
  compare(60, false);
  EXPECT_EQ(mixed.simulation.state_hash(), whole.simulation.state_hash());
}

TEST(StepEvents, AreNotStateButContinueFromASnapshot) {
  Watched crowd({}, 30);
  ASSERT_EQ(*crowd.simulation.set_state(std::span(crowd.people).first(5), PersonState::asleep), 5U);
  crowd.tick(100);
  std::vector<std::byte> bytes(crowd.simulation.snapshot_bytes());
  ASSERT_TRUE(crowd.simulation.save(bytes));
  crowd.told.clear();
  crowd.tick(100);
  EXPECT_GT(crowd.told.size(), 100U);
  Watched other({}, 3, false);
  other.people = crowd.people;
  ASSERT_TRUE(other.simulation.restore(bytes));
  EXPECT_TRUE(other.simulation.events().empty());
  other.tick(100);
  EXPECT_EQ(other.told, crowd.told);
  const auto first = crowd.told;
  ASSERT_TRUE(crowd.simulation.restore(bytes));
  EXPECT_TRUE(crowd.simulation.events().empty());
  crowd.told.clear();
  crowd.tick(100);
  EXPECT_EQ(crowd.told, first);
}

TEST(StepEvents, OneInvalidPersonRefusesTheBatch) {
  Watched crowd({}, 4, false);
  Simulation& simulation = crowd.simulation;
  const Entity posed = *simulation.spawn_posed({});
  const std::uint64_t before = simulation.state_hash();
  EXPECT_EQ(simulation.enable(std::array{crowd.people[0], posed}, Feature::step_events), Status::missing);
  EXPECT_EQ(simulation.enable(std::array{crowd.people[0], Entity{}}, Feature::step_events), Status::stale_entity);
  EXPECT_EQ(simulation.enable(std::array{crowd.people[0], crowd.people[0]}, Feature::step_events),
            Status::stale_entity);
  EXPECT_EQ(simulation.state_hash(), before);
  crowd.tick(60);
  EXPECT_TRUE(crowd.told.empty());
  ASSERT_TRUE(simulation.enable(crowd.people, Feature::step_events));
  ASSERT_TRUE(simulation.enable({&crowd.people[0], 1}, Feature::step_events));  // is so already
  crowd.tick(60);
  EXPECT_FALSE(crowd.told.empty());
  ASSERT_TRUE(simulation.enable(crowd.people, Feature::step_events, false));
  crowd.told.clear();
  crowd.tick(60);
  EXPECT_TRUE(crowd.told.empty());
  simulation.tick();
  EXPECT_TRUE(simulation.events().empty());
}

}  // namespace mobil::step_events_test
