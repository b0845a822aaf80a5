// A system of one's own: when and where each foot strikes with its heel, lies flat, lifts its heel and leaves the
// ground, as sounds, dust and footprints need it. A component keeps the last of each of these for either foot of each
// walker; after a tick the host collects what is new.
//
// Prints what happens, and exits with 1 where a foot does not go through all four, in their order, as often as it
// steps.

#include <array>
#include <cstdio>
#include <map>
#include <utility>
#include <vector>

#include <mobil/each.h>
#include <mobil/schedule.h>
#include <mobil/simulation.h>

using mobil::Lanes, mobil::Whole;

enum Event : std::uint32_t { heel_strike, foot_flat, heel_off, toe_off };
constexpr std::array names = {"heel strike", "foot flat", "heel off", "toe off"};

/// By event and side (0 right, 1 left): the tick in which it was last, from 1 on (0: never), and where the heel or the
/// toes were then (m, on the ground). And which of heel and toes are down.
template <class F>
struct FootEvents {
  Whole<F> tick[4][2];
  F x_m[4][2], z_m[4][2];
  Whole<F> heel_down[2], toes_down[2];
};

/// What touches is down below the first height and up above the second, so that nothing is reported twice.
constexpr float down_m = 0.006F, up_m = 0.012F;

/// Reads what kinematics wrote, and so runs after it.
void listen(const mobil::Feet<Lanes<float>>& feet, mobil::Tick tick, FootEvents<Lanes<float>>& events) {
  const auto look = [&](std::uint32_t& down, const mobil::Vec3<Lanes<float>>& at, std::size_t lane, std::size_t side,
                        Event comes, Event goes) {
    const float height = at.y[lane];
    const bool now = down != 0 ? height < up_m : height < down_m;
    if (now == (down != 0)) return;
    down = now ? 1 : 0;
    const Event event = now ? comes : goes;
    events.tick[event][side][lane] = tick.index + 1;
    events.x_m[event][side][lane] = at.x[lane];
    events.z_m[event][side][lane] = at.z[lane];
  };
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t lane = 0; lane < mobil::lane_count; ++lane) {
      look(events.heel_down[side][lane], feet.heel_m[side], lane, side, heel_strike, heel_off);
      look(events.toes_down[side][lane], feet.tip_m[side], lane, side, foot_flat, toe_off);
    }
  }
}

mobil::Module footsteps_module() {
  return {.name = "footsteps",
          .parts = {mobil::component_part<FootEvents>()},
          .systems = [](mobil::ScheduleBuilder& systems) { systems.add("footsteps", &listen); }};
}

struct Footstep {
  mobil::Entity walker;
  Event event;
  std::uint32_t side;
  float x_m, z_m;
};

/// What happened in the tick that ran last.
std::vector<Footstep> footsteps_of(const mobil::Simulation& simulation) {
  std::vector<Footstep> all;
  simulation.each([&](const mobil::Rows& rows, const FootEvents<Lanes<float>>& events) {
    for (std::size_t lane = 0; lane < rows.live; ++lane) {
      for (const Event event : {heel_strike, foot_flat, heel_off, toe_off}) {
        for (std::uint32_t side = 0; side < 2; ++side) {
          if (events.tick[event][side][lane] != simulation.ticks()) continue;
          all.push_back({rows.entity[lane], event, side, events.x_m[event][side][lane], events.z_m[event][side][lane]});
        }
      }
    }
  });
  return all;
}

int main() {
  mobil::Simulation simulation({.modules = {footsteps_module()}});
  std::vector<mobil::SpawnRequest> people(3);
  for (std::size_t i = 0; i < people.size(); ++i) {
    people[i].gait.speed_m_s = 1.0F + 0.3F * static_cast<float>(i);
    people[i].x_m = static_cast<float>(i);
  }
  std::vector<mobil::Entity> walkers(people.size());
  if (const auto spawned = simulation.spawn(people, walkers); !spawned) {
    std::fprintf(stderr, "%s\n", spawned.error().message.c_str());
    return 2;
  }
  for (const mobil::Entity walker : walkers) simulation.add(walker, FootEvents<float>{});

  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Footstep>> heard;  // by walker and side
  for (int tick = 0; tick < 240; ++tick) {
    simulation.tick();
    for (const Footstep& step : footsteps_of(simulation)) {
      std::printf("tick %3u: walker %u, %s %-11s at x = %5.2f m, z = %5.2f m\n", simulation.ticks(), step.walker.index,
                  step.side == 0 ? "right" : "left ", names[step.event], static_cast<double>(step.x_m),
                  static_cast<double>(step.z_m));
      heard[{step.walker.index, step.side}].push_back(step);
    }
  }
  for (const mobil::Entity walker : walkers) {
    std::size_t strikes = 0;
    for (std::uint32_t side = 0; side < 2; ++side) {
      const auto& steps = heard[{walker.index, side}];
      for (std::size_t i = 0; i < steps.size(); ++i) {
        if (steps[i].event == heel_strike) ++strikes;
        if (i > 1 && steps[i].event != (steps[i - 1].event + 1) % 4) return 1;  // the first two tell how it stood
      }
    }
    const std::size_t steps = simulation.get<mobil::GaitState>(walker)->steps;
    if (steps < 4 || strikes + 2 < steps || strikes > steps + 2) return 1;
  }
  return 0;
}
