// A custom system: walkers tire. A component stores each walker's fatigue, and a system that runs between those of the
// library lowers the walking speed step by step. The library is unchanged.
//
// Prints each walker's speed, and exits with 1 if the tired walker did not slow down or the other one did.

#include <cmath>
#include <cstdio>

#include <mobil/host_parts.h>
#include <mobil/schedule.h>
#include <mobil/simulation.h>

using mobil::Lanes, mobil::UInt32;

/// Fatigue of a walker, all zero if fresh. `level`: 0 to 1. `left`: remaining fraction of the requested speed, set in
/// the request `revision`. `steps`: steps counted so far.
template <class F>
struct Fatigue {
  F level, left;
  UInt32<F> revision, steps;
};

/// Adds half a percent of fatigue per step at 1 m/s, in proportion to the square of speed. A fully tired walker has
/// half the requested speed. `before` is the state of the previous tick, so that the gait set here is used by the heel
/// strikes of this tick.
void tire(mobil::Previous<mobil::GaitState> before, mobil::Gait<Lanes<float>>& gait, Fatigue<Lanes<float>>& fatigue) {
  for (std::size_t lane = 0; lane < mobil::lane_count; ++lane) {
    if (before->steps[lane] == fatigue.steps[lane]) continue;
    fatigue.steps[lane] = before->steps[lane];
    const bool ours = fatigue.left[lane] > 0 && fatigue.revision[lane] == gait.revision[lane];
    const float asked = gait.speed_m_s[lane] / (ours ? fatigue.left[lane] : 1.0F);
    fatigue.level[lane] = std::fmin(fatigue.level[lane] + 0.005F * gait.speed_m_s[lane] * gait.speed_m_s[lane], 1.0F);
    const float left = 1 - 0.5F * fatigue.level[lane];
    const float slower = asked * left / std::fmax(gait.speed_m_s[lane], 1e-6F);
    gait.speed_m_s[lane] *= slower;  // length and frequency of steps decrease equally
    gait.step_length_m[lane] *= std::sqrt(slower);
    gait.step_frequency_hz[lane] *= std::sqrt(slower);
    fatigue.left[lane] = left;
    fatigue.revision[lane] = ++gait.revision[lane];  // a new request: steps are solved again
  }
}

mobil::Module fatigue_module() {
  return {.name = "fatigue", .parts = {mobil::component_id<Fatigue>()}, .systems = [](mobil::ScheduleBuilder& systems) {
            systems.add("fatigue", &tire);
          }};
}

int main() {
  mobil::Simulation simulation({.modules = {fatigue_module()}});
  mobil::Entity walker[2];
  for (mobil::Entity& one : walker) {
    const auto spawned = simulation.spawn({}, {.speed_m_s = 1.6F});
    if (!spawned) {
      std::fprintf(stderr, "%s\n", spawned.error().message.c_str());
      return 2;
    }
    one = *spawned;
  }
  simulation.parts().add(walker[0], Fatigue<float>{});  // the other one never tires, and costs nothing

  for (int second = 0; second < 40; ++second) {
    for (int tick = 0; tick < 60; ++tick) simulation.tick();
    if (second % 10 != 9) continue;
    std::printf("%2d s  tired %.2f: %.2f m/s   fresh: %.2f m/s\n", second + 1,
                static_cast<double>(simulation.get<Fatigue>(walker[0])->level),
                static_cast<double>(simulation.get<mobil::Gait>(walker[0])->speed_m_s),
                static_cast<double>(simulation.get<mobil::Gait>(walker[1])->speed_m_s));
  }
  const float tired = simulation.get<mobil::CentreOfMass>(walker[0])->position_m.z;
  const float fresh = simulation.get<mobil::CentreOfMass>(walker[1])->position_m.z;
  std::printf("after 40 s the tired one is %.1f m behind\n", static_cast<double>(fresh - tired));
  const bool slowed = simulation.get<mobil::Gait>(walker[0])->speed_m_s < 1.4F;
  const bool stayed = simulation.get<mobil::Gait>(walker[1])->speed_m_s == 1.6F;
  return slowed && stayed && fresh - tired > 2 ? 0 : 1;
}
