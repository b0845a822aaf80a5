// A system of one's own: every heel strike with its place, side and tick, as sounds and footprints need it. A component
// keeps the last strike of each walker; after a tick the host collects those that are new.
//
// Prints the strikes, and exits with 1 where they are not as many as the steps walked or do not alternate.

#include <cstdio>
#include <map>
#include <vector>

#include "engine/each.h"
#include "engine/schedule.h"
#include "systems/simulation.h"

using mobil::Lanes, mobil::Whole;

/// A walker's last heel strike: where the heel is then (m, on the ground), which side (0 right, 1 left) and in which
/// tick; and the steps counted so far.
template <class F>
struct HeelStrike {
  F x_m, z_m;
  Whole<F> side, tick, steps;
};

/// Reads what gait and kinematics wrote, and so runs after them.
void listen(const mobil::GaitState<Lanes<float>>& gait, const mobil::Feet<Lanes<float>>& feet, mobil::Tick tick,
            HeelStrike<Lanes<float>>& strike) {
  for (std::size_t lane = 0; lane < mobil::lane_count; ++lane) {
    if (gait.steps[lane] == strike.steps[lane]) continue;
    const std::uint32_t side = gait.stance_side[lane];
    strike.x_m[lane] = feet.heel_m[side].x[lane];
    strike.z_m[lane] = feet.heel_m[side].z[lane];
    strike.side[lane] = side;
    strike.tick[lane] = tick.index;
    strike.steps[lane] = gait.steps[lane];
  }
}

mobil::Module footsteps_module() {
  return {.name = "footsteps",
          .parts = {mobil::component_part<HeelStrike>()},
          .systems = [](mobil::ScheduleBuilder& systems) { systems.add("footsteps", &listen); }};
}

struct Footstep {
  mobil::Entity walker;
  HeelStrike<float> strike;
};

/// Heel strikes of the tick that ran last.
std::vector<Footstep> footsteps_of(const mobil::Simulation& simulation) {
  std::vector<Footstep> all;
  mobil::each_block<HeelStrike>(simulation.world(),
                                [&](const mobil::Rows& rows, const HeelStrike<Lanes<float>>& strike) {
                                  for (std::size_t lane = 0; lane < rows.live; ++lane) {
                                    if (strike.steps[lane] == 0 || strike.tick[lane] + 1 != simulation.ticks())
                                      continue;
                                    all.push_back({rows.entity[lane], *simulation.get<HeelStrike>(rows.entity[lane])});
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
  for (const mobil::Entity walker : walkers) simulation.world().add(walker, HeelStrike<float>{});

  std::map<std::uint32_t, std::vector<HeelStrike<float>>> heard;  // by walker
  for (int tick = 0; tick < 180; ++tick) {
    simulation.tick();
    for (const Footstep& step : footsteps_of(simulation)) {
      std::printf("tick %3u: walker %u, %s heel at x = %5.2f m, z = %5.2f m\n", step.strike.tick, step.walker.index,
                  step.strike.side == 0 ? "right" : "left ", static_cast<double>(step.strike.x_m),
                  static_cast<double>(step.strike.z_m));
      heard[step.walker.index].push_back(step.strike);
    }
  }
  for (const mobil::Entity walker : walkers) {
    const auto& strikes = heard[walker.index];
    if (strikes.size() != simulation.get<mobil::GaitState>(walker)->steps || strikes.size() < 4) return 1;
    for (std::size_t i = 1; i < strikes.size(); ++i) {
      if (strikes[i].side == strikes[i - 1].side || strikes[i].z_m <= strikes[i - 1].z_m) return 1;
    }
  }
  return 0;
}
