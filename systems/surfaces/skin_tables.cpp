#include <mobil/skin_tables.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/simulation.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/cover_muscles.h>
#include "assets/body/bent_legs.h"
#include "assets/reduction/dense.h"
#include "assets/reduction/symmetric_eigen.h"
#include "assets/surfaces/coarser_surface.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {
namespace {

/// Returns the n-th number, 0 to 1, of a prime base. With one base per dimension they spread evenly (Halton 1960).
double halton(int n, int base) {
  double part = 1, sum = 0;
  for (; n > 0; n /= base) {
    part /= base;
    sum += part * (n % base);
  }
  return sum;
}

/// Returns the angles of the n-th pose.
LegAngles angles_of(int n) {
  const auto between = [n](float a, float b, int base) {
    return a + static_cast<float>(halton(n + 1, base)) * (b - a);
  };
  const LegAngles &low = min_leg_angles, &high = max_leg_angles;
  return {between(low.hip, high.hip, 2), between(low.knee, high.knee, 3), between(low.ankle, high.ankle, 5)};
}

float degrees(float rad) {
  return rad * 180 / std::numbers::pi_v<float>;
}

/// One person's right leg: the skin's lift by its muscles, pose after pose, as rows of a least-squares fit.
class Fit {
  using Matrix = Eigen::MatrixXd;

 public:
  Fit(BodySurfaces bound, BodySkin skin)
      : bound_(std::move(bound)),
        skin_(std::move(skin)),
        drawn_(bound_.vertices),
        square_(Matrix::Zero(skin_terms, skin_terms)),
        right_(Matrix::Zero(skin_terms, leg_grid_points)) {}

  Result<void> add(const Simulation& simulation, Entity person, double weight) {
    const Person subject = *simulation.person(person);
    std::vector<SurfaceMuscle> muscles;
    for (const PersonMuscle& own : subject.muscles) muscles.push_back({own.plan.muscle, own.entity});
    SurfaceRequest wanted{person, muscles, &bound_};
    wanted.positions.bytes = std::as_writable_bytes(std::span(drawn_));
    if (auto done = writer_.write(simulation.world(), {&wanted, 1}); !done) return done;
    const Pose<float> pose = *simulation.get<Pose>(person);
    std::array<float, leg_grid_points> lift;
    cover_muscles(skin_, pose, 1, Side::right, drawn_, lift);
    const auto value = skin_term_values(leg_angles_of(pose, Side::right));
    const Eigen::Map<const Eigen::Matrix<float, 1, skin_terms>> terms(value.data());
    const Eigen::Map<const Eigen::Matrix<float, 1, leg_grid_points>> lifts(lift.data());
    const Eigen::VectorXd of_terms = terms.cast<double>().transpose(), of_lifts = lifts.cast<double>().transpose();
    add_outer(square_, weight, of_terms, of_terms);
    add_outer(right_, weight, of_terms, of_lifts);
    return {};
  }

  std::unique_ptr<SkinTable> table() const {
    const Matrix fitted = solved(square_, right_);
    // The modes with the smallest residual over all added poses: the fit, in units in which terms have equal weight and
    // are uncorrelated, reduced to its largest singular values.
    const SymmetricEigen terms = symmetric_eigen(square_);
    const Eigen::VectorXd root = terms.values.cwiseMax(0).cwiseSqrt();
    // Terms that no pose has are ignored: their inverse is 0.
    const double least = 1e-9 * root.maxCoeff();
    const Eigen::VectorXd inverse = (root.array() > least).select(root.cwiseInverse(), 0.0);
    const Matrix alike = product(root.asDiagonal() * transposed(terms.vectors), fitted);
    const SymmetricEigen shapes = symmetric_eigen(product(alike, transposed(alike)));
    const Matrix greatest = shapes.vectors.rightCols(skin_modes);
    const Matrix mode = product(transposed(greatest), alike);
    const Matrix weight = product(terms.vectors * inverse.asDiagonal(), greatest);
    auto table = std::make_unique<SkinTable>();
    for (std::size_t m = 0; m < skin_modes; ++m) {
      const auto of = static_cast<Eigen::Index>(m);
      for (std::size_t t = 0; t < skin_terms; ++t)
        table->weight[t][m] = static_cast<float>(weight(static_cast<Eigen::Index>(t), of));
      for (std::size_t p = 0; p < leg_grid_points; ++p)
        table->mode[m][p] = static_cast<float>(mode(of, static_cast<Eigen::Index>(p)));
    }
    return table;
  }

 private:
  BodySurfaces bound_;
  BodySkin skin_;
  std::vector<Vec3<float>> drawn_;
  SurfaceWriter writer_;
  Matrix square_, right_;
};

}  // namespace

Result<std::unique_ptr<SkinTable>> make_skin_table(const BodyRequest& request) {
  constexpr std::array speeds_m_s = {0.7F, 1.0F, 1.3F, 1.6F, 1.9F};
  constexpr int settled = 90, strides = 90, apart = 3, poses = 150;  // ticks; poses
  constexpr double walking = 2, posed = 1;                           // weight of each
  Simulation simulation;
  LegMuscles choice;
  choice.method = Method::statics;
  std::vector<Entity> walkers;
  for (const float speed : speeds_m_s) {
    const auto walker = simulation.spawn(request, {.speed_m_s = speed});
    if (!walker && walker.error().status == Status::no_memory) return tl::unexpected(walker.error());
    if (!walker) continue;  // short people do not walk so fast
    walkers.push_back(*walker);
    if (auto done = simulation.set_muscles(*walker, choice); !done) return tl::unexpected(done.error());
  }
  const auto model = simulation.spawn_posed(request);
  if (!model) return tl::unexpected(model.error());
  if (auto done = simulation.set_muscles(*model, choice); !done) return tl::unexpected(done.error());
  const Body body = simulation.person(*model)->body;
  auto bound = bind_surfaces(body, {.bones = false, .sides = {true, false}, .detail = can_be_coarser() ? 0.3F : 1.0F});
  if (!bound) return tl::unexpected(bound.error());
  auto skin = make_body_skin(body, SkinDetail::distant);
  if (!skin) return tl::unexpected(skin.error());
  Fit fit(std::move(*bound), std::move(*skin));
  for (int tick = 0; tick < settled + strides; ++tick) {
    simulation.tick();
    if (tick < settled || tick % apart != 0) continue;
    for (const Entity walker : walkers)
      if (auto done = fit.add(simulation, walker, walking); !done) return tl::unexpected(done.error());
  }
  for (int n = 0; n < poses; ++n) {
    const LegAngles angles = angles_of(n);
    simulation.set_pose(*model,
                        with_bent_legs(body, {degrees(angles.hip), degrees(angles.knee), degrees(angles.ankle)}));
    for (int settle = 0; settle < 2; ++settle) simulation.tick();
    if (auto done = fit.add(simulation, *model, posed); !done) return tl::unexpected(done.error());
  }
  return fit.table();
}

Result<const SkinTable*> SkinTables::of(const BodyRequest& body) {
  if (auto ok = check_body(body); !ok) return tl::unexpected(ok.error());
  const SkinBuild build = skin_build(body, 3);
  auto& table = table_[{body.sex, build.age_y, build.step}];
  if (!table) {
    auto made = make_skin_table(build.body);
    if (!made) return tl::unexpected(made.error());
    table = std::move(*made);
  }
  return table.get();
}

}  // namespace mobil::inline v0_3
