// A crowd's muscles as Bullet's deformable bodies at sixty ticks a second.
#include "demo/lab/rivals/rival.h"

#ifdef RIVALS_HAVE_BULLET

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "demo/lab/rivals/bullet_world.h"
#include "demo/lab/rivals/timing.h"

namespace rivals {
namespace {

constexpr double tick_s = 1.0 / 60;
constexpr int bodies_a_person = 8;

/// Everybody is pulled otherwise, and otherwise in each tick.
double pull_of(int body, int tick) {
  return bullet_pull_n * strength(body) * (0.5 + 0.5 * std::sin(2 * M_PI * 1.3 * tick * tick_s + body));
}

void one_tick(BulletWorld& world, int tick, int substeps) {
  for (int n = 0; n < substeps; ++n) {
    for (int b = 0; b < world.bodies(); ++b) {
      world.slow(b, 1 - damping_per_s * tick_s / substeps);
      world.pull(b, pull_of(b, tick), tick_s / substeps);
    }
    world.step(tick_s / substeps);
  }
}

}  // namespace

Rival bullet_crowd(int bodies, double limit_s) {
  const Block block = make_block(1, 1);
  const Eigen::Vector2d expected = far_mean(block, deflection(block, bullet_pull_n));
  const int substeps = static_cast<int>(std::ceil(tick_s / bullet_largest_step(expected.norm())));
  Rival rival{.name = "bullet_crowd", .dt_s = tick_s, .repeats = repeats};
  double farthest = 0;
  for (const int together : {bodies_a_person, bodies}) {
    std::vector<std::unique_ptr<BulletWorld>> worlds;
    for (int b = 0; b < bodies; b += together) worlds.push_back(std::make_unique<BulletWorld>(together, 0));
    int tick = 0;
    const auto work = [&] {
      for (auto& world : worlds) one_tick(*world, tick, substeps);
      ++tick;
    };
    while (tick < (limit_s > 0 ? 6 : 1)) work();  // until motion is what it is later
    const std::string name = together == bodies ? "all in one world" : "a world a person";
    rival.variants.push_back(timed(name + ", " + std::to_string(substeps) + " steps a tick", bodies, limit_s, work));
    for (const auto& world : worlds) {
      for (int b = 0; b < together; ++b) {
        const double far = std::abs(world->far_mean(b)[0]);
        if (!(far <= farthest)) farthest = far;  // true of NaN
      }
    }
  }
  rival.check = "farthest far face over the static answer to the strongest pull";
  rival.check_error = farthest / (1.5 * expected[0]);
  rival.holds = rival.check_error < 3;
  return rival;
}

}  // namespace rivals

#else

namespace rivals {

Rival bullet_crowd(int, double) {
  return {};
}

}  // namespace rivals

#endif
