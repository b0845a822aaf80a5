// Bullet's deformable body: five linear corotated tetrahedra a cube, its own explicit step, no collisions.
#include "demo/lab/rivals/rival.h"

#ifdef RIVALS_HAVE_BULLET

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>

#include <cmath>
#include <memory>

#include "demo/lab/rivals/block.h"
#include "demo/lab/rivals/timing.h"

namespace rivals {
namespace {

constexpr double bullet_pull_n = 0.1;  // 1 % of strain

/// A separate world with `bodies` blocks, side by side. Everything except deformation is switched off.
class BulletWorld {
 public:
  /// `damping` is Bullet's own, of the mass, 1/s.
  BulletWorld(int bodies, double damping)
      : dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &constraints_, &configuration_, &deformable_),
        force_(btScalar(0), btScalar(0), btScalar(damping), btScalar(0)) {
    force_.setPoissonRatio(btScalar(poisson));
    force_.m_nu = btScalar(poisson);
    force_.m_E = btScalar(young_pa);
    force_.updateLameParameters();
    constraints_.setDeformableSolver(&deformable_);
    world_.setGravity(btVector3(0, 0, 0));
    world_.setImplicit(false);
    world_.setLineSearch(false);
    world_.setUseProjection(false);
    world_.getWorldInfo().m_gravity.setValue(0, 0, 0);
    for (int b = 0; b < bodies; ++b) add(b);
  }
  ~BulletWorld() {
    for (auto& body : bodies_) world_.removeSoftBody(body.get());
  }
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  /// Applies a total traction to the far face of one body during the next step, N: along z, and a part of it along x.
  void pull(int number, double newton, double dt) {
    for (int i = 0; i < nodes_a_plane; ++i) {
      btSoftBody::Node& node = bodies_[static_cast<std::size_t>(number)]->m_nodes[nodes - nodes_a_plane + i];
      const auto at = 3 * (moving / 3 - nodes_a_plane + i);
      const btVector3 load(btScalar(newton * sideways * block_.share_x[at]), btScalar(0),
                           btScalar(newton * block_.share_z[at + 2]));
      node.m_v += load * (node.m_im * btScalar(dt));
    }
  }
  void step(double dt) { world_.stepSimulation(btScalar(dt), 0); }

  /// Returns the mean displacement of a body's far face along z and along x.
  Eigen::Vector2d far_mean(int number = 0) const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int n = nodes - nodes_a_plane; n < nodes; ++n) {
      const btSoftBody::Node& node = bodies_[static_cast<std::size_t>(number)]->m_nodes[n];
      const double weight = (n % 9 == 4 ? 4 : n % 2 == 0 ? 1 : 2) / 16.0;
      sum += weight * Eigen::Vector2d(node.m_x.z() - 8 * cube_m, node.m_x.x() - start_x(number) - (n % 3 - 1) * cube_m);
    }
    return sum;
  }

 private:
  // In rows about the origin: single precision is too coarse for more distant bodies, which then jump.
  static constexpr int a_row = 32, half_row = a_row / 2;
  static double start_x(int number) { return 4 * cube_m * (number % a_row - half_row); }
  static double start_y(int number) {
    const int row = number / a_row;
    return 4 * cube_m * (row - half_row);
  }

  void add(int number) {
    std::vector<btVector3> at;
    at.reserve(nodes);
    for (int n = 0; n < nodes; ++n) {
      const int plane = n / nodes_a_plane;
      at.emplace_back(btScalar(start_x(number) + (n % 3 - 1) * cube_m),
                      btScalar(start_y(number) + (n / 3 % 3 - 1) * cube_m), btScalar(plane * cube_m));
    }
    auto body = std::make_unique<btSoftBody>(&world_.getWorldInfo(), nodes, at.data(), nullptr);
    // two mirror-image cuts, as a checkerboard, so that neighbours share their faces' diagonals
    static constexpr int even[5][4] = {{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 7, 4, 2}, {1, 2, 4, 7}};
    static constexpr int odd[5][4] = {{1, 3, 0, 5}, {2, 0, 3, 6}, {4, 6, 5, 0}, {7, 5, 6, 3}, {0, 5, 3, 6}};
    int cube = 0;
    for (const Element& e : elements()) {
      const bool is_odd = (cube % 2 + cube / 2 % 2 + cube / 4) % 2 != 0;
      for (const auto& t : is_odd ? odd : even) {
        body->appendTetra(e.node[t[0]], e.node[t[1]], e.node[t[2]], e.node[t[3]]);
      }
      ++cube;
    }
    for (int n = 0; n < nodes; ++n) {
      body->setMass(n, n < nodes_a_plane ? btScalar(0) : btScalar(block_.mass[3 * (n - nodes_a_plane)]));
    }
    body->initializeDmInverse();
    body->m_tetraScratches.resize(body->m_tetras.size());
    body->m_tetraScratchesTn.resize(body->m_tetras.size());
    body->m_cfg.collisions = 0;
    body->m_cfg.drag = 0;
    body->m_cfg.kDP = 0;
    body->setDampingCoefficient(0);
    body->setSelfCollision(false);
    body->setActivationState(DISABLE_DEACTIVATION);
    world_.addSoftBody(body.get(), 0, 0);
    world_.addForce(body.get(), &force_);
    bodies_.push_back(std::move(body));
  }

  const Block block_ = make_block(1, 1);
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btDeformableBodySolver deformable_;
  btDeformableMultiBodyConstraintSolver constraints_;
  btDeformableMultiBodyDynamicsWorld world_;
  btDeformableLinearElasticityForce force_;
  std::vector<std::unique_ptr<btSoftBody>> bodies_;
};

/// Returns true if an undamped body stays within 3 times the static deflection, for two seconds after a sudden pull.
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

/// Finds the largest stable step by bisection, within 1 %.
double bullet_largest_step(double static_m) {
  double low = 0.001, high = 0.008;
  if (!bullet_is_stable(low, static_m)) return 0;
  while (high > 1.01 * low) {
    const double middle = std::sqrt(low * high);
    (bullet_is_stable(middle, static_m) ? low : high) = middle;
  }
  return low;
}

}  // namespace

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
