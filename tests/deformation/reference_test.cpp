// The double-precision solver compared with dense matrices, closed forms and the invariants of its methods.
#include "demo/lab/reference/reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "engine/eigen.h"
#include "tests/fem/oracle.h"
#include "tests/fem/spindle.h"

namespace mobil::reference_test {
using oracle::Matrix;
using oracle::Vector;

constexpr std::array<Method, 3> moving_methods = {Method::explicit_central, Method::implicit_central, Method::newmark};

Mass mass_of(Method method) {
  return method == Method::explicit_central ? Mass::lumped : Mass::consistent;
}

ReferenceBelly make(const HexahedralMesh& mesh, const ReferenceOptions& options) {
  auto belly = ReferenceBelly::make(mesh, assemble(mesh, Material{}).value(), options);
  if (!belly) throw std::runtime_error(belly.error().message);
  return std::move(*belly);
}

Vector copy(std::span<const double> x) {
  return Eigen::Map<const Vector>(x.data(), static_cast<Eigen::Index>(x.size()));
}

/// Free vibration of the moving components: Kφ = ω²Mφ, φᵀMφ = 1.
struct Modes {
  std::vector<Eigen::Index> moving;
  Vector omega;
  Matrix shape;
  Vector load;  // a uniform traction of 1 N on the far face along (0.3, −0.2, 1)

  Modes(const HexahedralMesh& mesh, Mass mass, FarEnd end) : moving(oracle::free_components(mesh.cells, end)) {
    const auto model = oracle::assemble(mesh, Material{});
    const Matrix m = mass == Mass::lumped ? Matrix(model.lumped.asDiagonal()) : model.mass;
    // with M = L·Lᵀ the singular vectors of L⁻¹·K·L⁻ᵀ are its eigenvectors
    const Eigen::LLT<Matrix> cholesky(Matrix(m(moving, moving)));
    const Matrix half = cholesky.matrixL().solve(Matrix(model.stiffness(moving, moving)));
    const Eigen::JacobiSVD<Matrix, Eigen::NoQRPreconditioner> solver(cholesky.matrixL().solve(Matrix(half.transpose())),
                                                                     Eigen::ComputeFullU);
    omega = solver.singularValues().reverse().cwiseSqrt();
    shape = cholesky.matrixU().solve(Matrix(solver.matrixU().rowwise().reverse()));
    const Vector share = oracle::far_shares(mesh);
    Vector full(3 * share.size());
    for (Eigen::Index n = 0; n < share.size(); ++n) full.segment<3>(3 * n) = share(n) * Eigen::Vector3d(0.3, -0.2, 1);
    load = full(moving);
  }
  double limit() const { return 2 / omega.maxCoeff(); }
};

ReferenceLoad traction(double size) {
  return {{0.3 * size, -0.2 * size, size}, {}, {}};
}

/// One belly, computed directly from the equations of deformation.h with dense matrices.
struct Dense {
  ReferenceOptions o;
  HexahedralMesh mesh;
  Matrix mass, elastic, foundation;
  std::vector<Eigen::Index> moving;
  Vector share, u, v;
  Eigen::LDLT<Matrix> factor;

  Dense(const HexahedralMesh& rest, const ReferenceOptions& options)
      : o(options), mesh(oracle::scaled(rest, o.across, o.along)), share(oracle::far_shares(mesh)) {
    const auto model = oracle::assemble(mesh, Material{});
    elastic = model.stiffness;
    mass = o.mass == Mass::lumped ? Matrix(model.lumped.asDiagonal()) : model.mass;
    foundation = o.foundation_1_s * o.foundation_1_s * mass;
    for (Eigen::Index i = 2; i < foundation.rows(); i += 3) foundation.row(i).setZero();
    moving = oracle::free_components(mesh.cells, o.end);
    u = v = Vector::Zero(elastic.rows());
    const double dt = o.dt_s, alpha = o.damping_per_s, beta = o.stiffness_damping_s;
    const Matrix what = o.method == Method::statics ? Matrix(elastic + foundation)
                        : o.method == Method::newmark
                            ? Matrix((2 / dt + alpha) * mass + (dt / 2 + beta) * elastic + dt / 2 * foundation)
                            : mass;
    factor.compute(what(moving, moving));
  }
  Vector force(const ReferenceLoad& load) const {
    Vector a(u.size());
    for (std::size_t n = 0; n < mesh.node.size(); ++n) {
      const auto& p = mesh.node[n];
      const auto of = [&](double c, const Vec3<double>& g) { return c + g.x * p.x + g.y * p.y + g.z * p.z; };
      a.segment<3>(3 * static_cast<Eigen::Index>(n)) << of(load.constant.x, load.gradient.x),
          of(load.constant.y, load.gradient.y), of(load.constant.z, load.gradient.z);
    }
    Vector f = mass * a;
    for (Eigen::Index n = 0; o.end != FarEnd::held && n < share.size(); ++n)
      f.segment<3>(3 * n) += share(n) * Eigen::Vector3d(load.end.x, load.end.y, load.end.z);
    return f;
  }
  void set_far(Vector& x, double value) const {
    if (o.end != FarEnd::held) return;
    for (std::uint32_t n = first_insertion_node(mesh.cells); n < node_count(mesh.cells); ++n) x(3 * n + 2) = value;
  }
  void step(const ReferenceLoad& now, const ReferenceLoad& next) {
    const double dt = o.dt_s, alpha = o.damping_per_s, beta = o.stiffness_damping_s;
    const auto solve = [&](const Vector& right) { return Vector(factor.solve(Vector(right(moving)))); };
    if (o.method == Method::statics) {
      u.setZero();
      set_far(u, next.end.z);
      u(moving) = solve(force(next) - elastic * u);
      return;
    }
    Vector far = Vector::Zero(u.size());
    for (Vector* const x : {&v, &far}) set_far(*x, (next.end.z - now.end.z) / dt);
    if (o.method == Method::newmark) {
      far(moving) = solve((force(now) + force(next)) / 2 + 2 / dt * (mass * (v - far)) - alpha * mass * far -
                          elastic * (u + (dt / 2 + beta) * far) - foundation * u);
      u += dt * far;
      v = 2 * far - v;
    } else {
      const Vector right = force(now) - elastic * (u + beta * v) - foundation * u - alpha * mass * far;
      v(moving) = ((1 - alpha * dt / 2) * v(moving) + dt * solve(right)) / (1 + alpha * dt / 2);
      u += dt * v;
    }
    set_far(u, next.end.z);
  }
};

TEST(Reference, EveryMethodFollowsTheDenseModelForAnyDriveAndLoad) {
  const auto mesh = spindle({2, 2, 4});
  for (const Method method : {Method::explicit_central, Method::implicit_central, Method::newmark, Method::statics}) {
    for (const Mass mass : {Mass::lumped, Mass::consistent}) {
      if ((method == Method::explicit_central && mass != Mass::lumped) ||
          (method == Method::implicit_central && mass == Mass::lumped))
        continue;
      for (const FarEnd end : {FarEnd::held, FarEnd::sliding, FarEnd::free}) {
        for (const bool all : {false, true}) {  // all loads and damping terms
          const ReferenceOptions o{method, mass, end, 2e-4, 8, all ? 3e-4 : 0, all ? 44.0 : 0, 0.9, 1.2};
          auto belly = make(mesh, o);
          Dense dense(mesh, o);
          const auto drive = [&](int n) {
            const double s = std::sin(0.03 * n), size = end == FarEnd::held ? 0.01 : 0.3;
            ReferenceLoad load = end == FarEnd::free ? traction(size * s) : ReferenceLoad{{0, 0, size * s}, {}, {}};
            if (!all) return load;
            load.constant = {s, -9.8 * s, 3 * s};
            load.gradient = {{0, 20 * s, -30 * s}, {5 * s, 7, 11 * s}, {-40 * s, 13 * s, 17 * s}};
            return load;
          };
          double error = 0, norm = 0;
          for (int n = 0; n < 400; ++n) {
            belly.step(drive(n), drive(n + 1));
            dense.step(drive(n), drive(n + 1));
            error += (copy(belly.displacement()) - dense.u).squaredNorm();
            norm += dense.u.squaredNorm();
          }
          EXPECT_LT(std::sqrt(error / norm), 1e-10)
              << method_name[static_cast<std::size_t>(method)] << static_cast<int>(end) << all;
        }
      }
    }
  }
}

TEST(Reference, OneModeHasTheTheoreticalPeriodOfEachMethod) {
  const auto mesh = spindle({1, 1, 3});
  for (const Method method : moving_methods) {
    const Modes modes(mesh, mass_of(method), FarEnd::free);
    const double dt = 0.9 * modes.limit();
    for (const Eigen::Index mode : {Eigen::Index{0}, modes.omega.size() / 2, modes.omega.size() - 1}) {
      auto belly = make(mesh, {method, mass_of(method), FarEnd::free, dt});
      const double half = modes.omega(mode) * dt / 2;
      // sin(ω̃Δt/2) = ωΔt/2 for central differences, tan for constant average acceleration
      const double angle = 2 * (method == Method::newmark ? std::atan(half) : std::asin(half));
      Vector shape = Vector::Zero(static_cast<Eigen::Index>(belly.displacement().size()));
      for (std::size_t i = 0; i < modes.moving.size(); ++i) {
        shape(modes.moving[i]) = modes.shape(static_cast<Eigen::Index>(i), mode);
      }
      const double speed = method == Method::newmark ? 0 : (1 - std::cos(angle)) / dt;
      for (Eigen::Index i = 0; i < shape.size(); ++i) {
        belly.displacement()[static_cast<std::size_t>(i)] = shape(i);
        belly.velocity()[static_cast<std::size_t>(i)] = speed * shape(i);
      }
      double worst = 0;
      for (int n = 1; n <= 2000; ++n) {
        belly.step({}, {});
        worst = std::max(worst, (copy(belly.displacement()) - std::cos(n * angle) * shape).norm());
      }
      EXPECT_LT(worst, 1e-8 * shape.norm()) << method_name[static_cast<std::size_t>(method)] << ", mode " << mode;
    }
  }
}

/// Returns the exact displacement at `end_s` under a traction that grows by 1 N/s from rest, C = α·M + β·K, summed over
/// the modes.
Vector exact_ramp(const Modes& modes, double alpha, double beta, double end_s) {
  Vector q(modes.omega.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const double w2 = modes.omega(i) * modes.omega(i), c = alpha + beta * w2, f = modes.shape.col(i).dot(modes.load);
    const double wd = std::sqrt(w2 - c * c / 4), a = f * c / (w2 * w2), b = (c / 2 * a - f / w2) / wd;
    q(i) = f / w2 * (end_s - c / w2) + std::exp(-c * end_s / 2) * (a * std::cos(wd * end_s) + b * std::sin(wd * end_s));
  }
  return modes.shape * q;
}

double ramp_error(const HexahedralMesh& mesh, const Modes& modes, ReferenceOptions options, int steps, double end_s) {
  options.dt_s = end_s / steps;
  auto belly = make(mesh, options);
  belly.start(traction(0));
  for (int n = 0; n < steps; ++n) belly.step(traction(n * options.dt_s), traction((n + 1) * options.dt_s));
  const Vector exact = exact_ramp(modes, options.damping_per_s, options.stiffness_damping_s, end_s);
  return (copy(belly.displacement())(modes.moving) - exact).norm() / exact.norm();
}

TEST(Reference, HalvingTheStepQuartersTheError) {
  const auto mesh = spindle({1, 1, 3});
  const double end_s = 0.4, beta = 1e-5;
  for (const Method method : moving_methods) {
    const Modes modes(mesh, mass_of(method), FarEnd::free);
    for (const double alpha : {0.0, 4.0}) {
      const ReferenceOptions options{method, mass_of(method), FarEnd::free,
                                     0,      alpha,           method == Method::newmark ? beta : 0};
      const int steps = static_cast<int>(std::ceil(end_s / (0.1 * modes.limit())));
      const double coarse = ramp_error(mesh, modes, options, steps, end_s);
      const double fine = ramp_error(mesh, modes, options, 2 * steps, end_s);
      EXPECT_NEAR(coarse / fine, 4, 0.2) << method_name[static_cast<std::size_t>(method)] << ", α " << alpha;
      EXPECT_LT(fine, 1e-3);
    }
  }
}

TEST(Reference, LaggedStiffnessDampingConvergesAtFirstOrder) {
  const auto mesh = spindle({1, 1, 3});
  const Modes modes(mesh, Mass::lumped, FarEnd::free);
  const ReferenceOptions options{Method::explicit_central, Mass::lumped, FarEnd::free, 0, 0, 1e-4};
  const int steps = static_cast<int>(std::ceil(0.4 / (0.1 * modes.limit())));
  const double coarse = ramp_error(mesh, modes, options, steps, 0.4);
  EXPECT_GT(coarse / ramp_error(mesh, modes, options, 2 * steps, 0.4), 1.8);
  EXPECT_LT(coarse, 1e-3);
}

/// Returns the relative range of the energy over a million steps of a belly that was pulled and released.
double energy_drift(Method method, double dt_of_limit, double foundation_1_s) {
  const auto mesh = spindle({1, 1, 2});
  const Modes modes(mesh, mass_of(method), FarEnd::free);
  auto belly = make(mesh, {method, mass_of(method), FarEnd::free, dt_of_limit * modes.limit(), 0, 0, foundation_1_s});
  belly.start(traction(0));
  for (int n = 0; n < 20; ++n) belly.step(traction(0.05 * n), traction(0.05 * (n + 1)));
  const auto energy = [&belly] {
    const auto report = belly.report();
    return report.kinetic_energy_j + report.strain_energy_j;
  };
  belly.step({}, {});
  const double first = energy();
  double low = first, high = first;
  for (int n = 0; n < 1000000; ++n) {
    belly.step({}, {});
    if (n % 997 != 0) continue;
    low = std::min(low, energy());
    high = std::max(high, energy());
  }
  EXPECT_GT(first, 1e-6);
  return (high - low) / first;
}

TEST(ReferenceEnergy, ConstantOverAMillionExplicitSteps) {
  EXPECT_LT(energy_drift(Method::explicit_central, 0.95, 0), 1e-11);
}

TEST(ReferenceEnergy, ConstantOverAMillionImplicitCentralDifferenceSteps) {
  EXPECT_LT(energy_drift(Method::implicit_central, 0.95, 0), 1e-11);
}

TEST(ReferenceEnergy, ConstantOverAMillionAverageAccelerationSteps) {
  EXPECT_LT(energy_drift(Method::newmark, 5, 0), 1e-11);
}

TEST(ReferenceEnergy, IncludesTheFoundation) {
  EXPECT_LT(energy_drift(Method::explicit_central, 0.8, 44), 1e-11);
}

TEST(Reference, StaticSolvesTheDenseSystemAndDampedMotionEndsThere) {
  const auto mesh = spindle({2, 2, 3});
  const auto model = oracle::assemble(mesh, Material{});
  const Modes modes(mesh, Mass::lumped, FarEnd::free);
  const Vector answer = oracle::solve(model.stiffness(modes.moving, modes.moving), modes.load);
  auto still = make(mesh, {Method::statics, Mass::lumped, FarEnd::free});
  still.start(traction(1));
  EXPECT_LT((copy(still.displacement())(modes.moving) - answer).norm(), 1e-9 * answer.norm());
  still.step(traction(0), traction(2));
  EXPECT_LT((copy(still.displacement())(modes.moving) - 2 * answer).norm(), 2e-9 * answer.norm());
  for (const Method method : moving_methods) {
    const Modes own(mesh, mass_of(method), FarEnd::free);
    auto belly = make(mesh, {method, mass_of(method), FarEnd::free, 0.8 * own.limit(), 15, 0});
    belly.start(traction(1));
    for (int n = 0; n < static_cast<int>(4 / (0.8 * own.limit())); ++n) belly.step(traction(1), traction(1));
    EXPECT_LT((copy(belly.displacement())(modes.moving) - answer).norm(), 1e-9 * answer.norm())
        << method_name[static_cast<std::size_t>(method)];
  }
}

TEST(Reference, HeldFaceAndBellyFollowASlowDrive) {
  const auto mesh = spindle({2, 2, 4});
  auto still = make(mesh, {Method::statics, Mass::lumped, FarEnd::held});
  still.start({{0, 0, 0.01}, {}, {}});
  EXPECT_GT(still.report().reaction_n, 0);
  EXPECT_NEAR(still.report().elongation_m, 0.01, 1e-15);
  for (const Method method : moving_methods) {
    auto belly = make(mesh, {method, mass_of(method), FarEnd::held, 5e-4, 30, 0});
    const auto drive = [](int n) { return ReferenceLoad{{0, 0, 0.01 * std::min(1.0, n / 4000.0)}, {}, {}}; };
    belly.start(drive(0));
    for (int n = 0; n < 8000; ++n) {
      belly.step(drive(n), drive(n + 1));
      ASSERT_NEAR(belly.report().elongation_m, drive(n + 1).end.z, 1e-14);
    }
    EXPECT_LT((copy(belly.displacement()) - copy(still.displacement())).norm(), 1e-8);
    EXPECT_NEAR(belly.report().reaction_n / still.report().reaction_n, 1, 1e-8);
  }
}

TEST(Reference, RefusesInvalidOptions) {
  const auto mesh = spindle({1, 1, 2});
  const auto terms = assemble(mesh, Material{}).value();
  const auto refused = [&](const HexahedralMesh& m, const ReferenceOptions& options) {
    return !ReferenceBelly::make(m, assemble(m, Material{}).value(), options);
  };
  EXPECT_TRUE(refused(mesh, {Method::explicit_central, Mass::lumped, FarEnd::free, 0}));
  EXPECT_TRUE(refused(mesh, {Method::newmark, Mass::lumped, FarEnd::free, std::nan("")}));
  EXPECT_TRUE(refused(mesh, {Method::newmark, Mass::lumped, FarEnd::free, 1e-3, -1}));
  EXPECT_TRUE(refused(mesh, {Method::newmark, Mass::lumped, FarEnd::free, 1e-3, 0, 0, 0, 0, 1}));
  EXPECT_TRUE(refused(*make_block({1, 1, 1}, 0.01), {Method::newmark, Mass::lumped, FarEnd::held, 1e-3}));
  EXPECT_FALSE(refused(mesh, {Method::statics, Mass::lumped, FarEnd::free, 0}));
}

}  // namespace mobil::reference_test
