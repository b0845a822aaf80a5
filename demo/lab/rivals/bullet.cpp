// Bullet's deformable body: five linear corotated tetrahedra a cube, its own explicit step, no collisions.
#include "demo/lab/rivals/rival.h"

#ifdef RIVALS_HAVE_BULLET

#include <cmath>

#include "demo/lab/rivals/bullet_world.h"
#include "demo/lab/rivals/timing.h"

namespace rivals {

bool bullet_is_stable(double dt, double static_m) {
  BulletWorld world(1, 0);
  for (int n = 0; n * dt < 2; ++n) {
    world.pull(0, bullet_pull_n, dt);
    world.step(dt);
    const double far = world.far_mean().norm();
    if (!(far < 3 * static_m)) return false;
  }
  return true;
}

double bullet_largest_step(double static_m) {
  double low = 0.001, high = 0.008;
  if (!bullet_is_stable(low, static_m)) return 0;
  while (high > 1.01 * low) {
    const double middle = std::sqrt(low * high);
    (bullet_is_stable(middle, static_m) ? low : high) = middle;
  }
  return low;
}

Rival bullet(double dt_s, double limit_s) {
  const Block block = make_block(1, 1);
  const Eigen::Vector2d expected = far_mean(block, deflection(block, bullet_pull_n));
  Rival rival{.name = "bullet", .dt_s = dt_s > 0 ? dt_s : bullet_largest_step(expected.norm()), .repeats = repeats};
  {
    BulletWorld world(1, 6);
    for (int n = 0; n * rival.dt_s < 4; ++n) {
      world.pull(0, bullet_pull_n, rival.dt_s);
      world.step(rival.dt_s);
    }
    const Eigen::Vector2d rest = world.far_mean();
    rival.check = "settled displacement of the far face along the block against trilinear hexahedra (sideways " +
                  std::to_string(rest[1] / expected[1]) + " of theirs)";
    rival.check_error = std::abs(rest[0] / expected[0] - 1);
    rival.holds = rival.check_error < 0.2;
    rival.far_z_m = rest[0];
  }
  for (const int bodies : {1, 16}) {
    BulletWorld world(bodies, 0);
    const int steps = std::max(1, 64 / bodies);
    rival.variants.push_back(timed(bodies == 1 ? "a body a world" : "sixteen bodies a world",
                                   static_cast<double>(steps) * bodies, limit_s, [&] {
                                     for (int n = 0; n < steps; ++n) {
                                       for (int b = 0; b < bodies; ++b) world.pull(b, 0.5 * bullet_pull_n, rival.dt_s);
                                       world.step(rival.dt_s);
                                     }
                                   }));
  }
  return rival;
}

bool has_bullet() {
  return true;
}

}  // namespace rivals

#else

namespace rivals {

Rival bullet(double, double) {
  return {};
}

bool has_bullet() {
  return false;
}

}  // namespace rivals

#endif
