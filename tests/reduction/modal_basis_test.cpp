// Bases of modal bellies, compared with dense matrices and stepped full models in double precision.
#include "assets/reduction/modal_basis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "assets/reduction/modal_belly.h"
#include "demo/lab/reference/reference.h"
#include "tests/fem/oracle.h"
#include "tests/fem/spindle.h"
#include "tests/refused.h"

namespace mobil::modal_basis_test {
using Eigen::Index;
using oracle::Matrix;
using oracle::Vector;

const Cells small = {2, 2, 8};
constexpr FarEnd far_ends[] = {FarEnd::held, FarEnd::sliding, FarEnd::free};

ModalBasisOptions options_of(FarEnd far_end, bool frame_loads, std::uint32_t modes = 32) {
  ModalBasisOptions o;
  o.modes = modes;
  o.far_end = far_end;
  o.frame_loads = frame_loads;
  o.foundation_hz = frame_loads ? 7 : 0;
  o.corrected = false;
  return o;
}

ModalBasis basis_of(const HexahedralMesh& mesh, const ModalBasisOptions& options) {
  auto basis = make_modal_basis(mesh, Material{}, Element::full, options);
  if (!basis) throw std::runtime_error(basis.error().message);
  return *basis;
}

struct Scale {
  double across, along;
};
Scale scale_of(double ratio, double product) {
  return {std::sqrt(ratio * product), std::sqrt(product / ratio)};
}

/// The full belly that the modal one approximates. All its nodes are control points.
struct Whole {
  std::vector<Index> moving;
  Matrix stiffness, mass;  // with the foundation; half lumped, half consistent
  Vector lift, traction[3];
  HexahedralMesh mesh;

  Whole(const HexahedralMesh& rest, const ModalBasisOptions& o, Scale s, const Material& material = {},
        Element element = Element::full)
      : moving(oracle::free_components(rest.cells, o.far_end)), mesh(oracle::scaled(rest, s.across, s.along)) {
    const auto model = oracle::assemble(mesh, material, element);
    mass = 0.5 * (model.mass + Matrix(model.lumped.asDiagonal()));
    stiffness = model.stiffness;
    const double circular = 2 * std::numbers::pi * o.foundation_hz;
    for (Index r = 0; r < mass.rows(); ++r) {
      for (Index c = 0; c < mass.cols(); ++c) {
        if (r % 3 != 2 && r % 3 == c % 3) stiffness(r, c) += circular * circular * mass(r, c);
      }
    }
    const Vector share = oracle::far_shares(rest);
    lift = Vector::Zero(mass.rows());
    for (auto& t : traction) t = lift;
    for (Index i = 0; i < share.size(); ++i) {
      if (i >= Index{first_insertion_node(rest.cells)}) lift(3 * i + 2) = 1;
      for (Index c = 0; c < 3; ++c) traction[c](3 * i + c) = share(i);
    }
  }

  Vector frame(std::size_t number) const {
    Vector field = Vector::Zero(mass.rows());
    for (std::size_t n = 0; n < mesh.node.size(); ++n) {
      const double place[3] = {mesh.node[n].x, mesh.node[n].y, mesh.node[n].z};
      const auto row = static_cast<Index>(3 * n);
      if (number < 3) {
        field(row + static_cast<Index>(number)) = 1;
      } else {
        field(row + static_cast<Index>((number - 3) / 3)) = place[(number - 3) % 3];
      }
    }
    return mass * field;
  }

  /// Returns the static displacement under 1 of an input.
  Vector rest(const ModalBasisOptions& o, std::size_t input) const {
    const std::size_t ends = o.far_end == FarEnd::free ? 3 : 1;
    Vector u = Vector::Zero(mass.rows()), load = u;
    if (input >= ends) {
      load = frame(input - ends);
    } else if (o.far_end == FarEnd::held) {
      u = lift;
      load = -stiffness * u;
    } else {
      load = traction[ends == 3 ? input : 2];
    }
    u(moving) += oracle::solve(stiffness(moving, moving), load(moving));
    return u;
  }
};

/// Returns the modal belly's static displacement under 1 of an input, from the numbers for the kernels.
Vector shown_rest(const ModalBasis& basis, Scale s, std::size_t input) {
  const auto belly = make_modal_belly(basis, s.across, s.along).value();
  const std::size_t n = basis.modes, width = n + basis.inputs;
  std::vector<float> shape(modal_shape_width(basis.modes, basis.inputs));
  write_shape(belly, 8, shape);
  const std::size_t rows = 3 * basis.control_weight.size();
  Vector u = Vector::Zero(static_cast<Index>(rows));
  for (std::size_t row = 0; row < rows; ++row) {
    double& to = u(static_cast<Index>(row));
    if (input == 0) to = static_cast<double>(basis.shape[row * (n + 1)]);
    for (std::size_t i = 0; i < n; ++i) {
      to += static_cast<double>(basis.shape[row * (n + 1) + 1 + i]) * static_cast<double>(shape[i * width + n + input]);
    }
  }
  return u;
}

// Rounding can give more directions than there are moving rows. The first excess direction must not spoil the basis.
TEST(ModalBasis, MeshHasAsManyModesAsMovingRows) {
  for (const double length_m : {0.15, 0.21, 0.24, 0.33}) {
    for (const double width : {1.05, 1.2, 2.0, 4.0}) {
      ModalBasisOptions o = options_of(FarEnd::held, true, 12);
      o.control_cells = {1, 1, 2};
      o.ratio_width = width;
      EXPECT_TRUE(make_modal_basis(wide_spindle({1, 1, 2}, length_m), Material{}, Element::full, o))
          << length_m << " " << width;
      o.modes = 13;
      EXPECT_TRUE(is_refused(make_modal_basis(wide_spindle({1, 1, 2}, length_m), Material{}, Element::full, o),
                             "that has 12;"));
    }
  }
}

TEST(ModalBasis, StaticSolutionsMatchTheFullBellyInTraining) {
  const auto mesh = wide_spindle(small);
  for (const FarEnd end : far_ends) {
    for (const bool frame : {false, true}) {
      const auto o = options_of(end, frame);
      const auto basis = basis_of(mesh, o);
      for (const double ratio : {basis.lowest_ratio, o.middle_ratio, basis.highest_ratio}) {
        const Scale s = scale_of(ratio, o.middle_product);
        const Whole whole(mesh, o, s);
        // each load is as large as in walking; loads that hardly move a belly are represented less accurately
        double largest = 0;
        for (std::size_t input = 0; input < basis.inputs; ++input) {
          const double size = input + frame_inputs < basis.inputs || !frame ? 0.0 : 10.0;
          largest = std::max(largest, size * whole.rest(o, input).norm());
        }
        for (std::size_t input = 0; input < basis.inputs; ++input) {
          const bool end_moves = !frame || input + frame_inputs < basis.inputs;
          const Vector exact = whole.rest(o, input);
          const double error = (shown_rest(basis, s, input) - exact).norm();
          const double allowed = end_moves ? (frame ? 5e-3 : 1e-3) * exact.norm() : 0.01 * largest / 10;
          EXPECT_LT(error, allowed) << "end " << static_cast<int>(end) << " ratio " << ratio << " input " << input;
          if (input == 0 && end == FarEnd::held && ratio == o.middle_ratio) {
            EXPECT_LT(error, 1e-6 * exact.norm());
          }
        }
      }
    }
  }
}

TEST(ModalBasis, StiffnessAndFrequenciesBoundTheFullBellyFromAbove) {
  const auto mesh = wide_spindle(small);
  for (const FarEnd end : far_ends) {
    for (const bool frame : {false, true}) {
      const auto o = options_of(end, frame, 12);
      const auto basis = basis_of(mesh, o);
      for (const double ratio : {0.96, 1.0, 1.04}) {
        const Scale s = scale_of(ratio, 1.0);
        const auto belly = make_modal_belly(basis, s.across, s.along).value();
        const Whole whole(mesh, o, s);
        const Matrix k = whole.stiffness(whole.moving, whole.moving), m = whole.mass(whole.moving, whole.moving);
        const Vector exact = oracle::eigenvalues(k, m);
        for (std::size_t j = 0; j < belly.modes; ++j) {
          EXPECT_GE(belly.omega_1_s[j], std::sqrt(exact(static_cast<Index>(j))) * (1 - 1e-9)) << j;
        }
        EXPECT_LT(belly.omega_1_s[0], 1.01 * std::sqrt(exact(0)));
        if (end != FarEnd::held) continue;
        const Vector u = whole.rest(o, 0);
        const double stiffness = u.dot(whole.stiffness * u);
        EXPECT_GE(belly.reaction[0], stiffness * (1 - 1e-9));
        EXPECT_LT(belly.reaction[0], stiffness * (1 + 2e-3));
        // the reaction of the frame's loads at the face, from the work done as it moves
        for (std::size_t input = 1; input < basis.inputs; ++input) {
          EXPECT_NEAR(belly.reaction[input], -u.dot(whole.frame(input - 1)), 1e-3 * u.dot(whole.frame(2))) << input;
        }
      }
    }
  }
}

TEST(ModalBasis, FrequenciesAreNeverBelowTheFullBelly) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0, 1)(random);
  };
  for (int round = 0; round < 9; ++round) {
    std::vector<LatticeStation> stations;
    for (const float t : {0.0F, 0.4F, 1.0F}) {
      const auto draw = [&](double low, double high) { return static_cast<float>(between(low, high)); };
      stations.push_back({t, draw(-0.01, 0.01), draw(-0.01, 0.01), draw(0.02, 0.04), draw(0.02, 0.04)});
    }
    ModalBasisOptions o = options_of(far_ends[round % 3], round % 2 == 1, static_cast<std::uint32_t>(between(3, 17)));
    if (o.foundation_hz > 0) o.foundation_hz = between(2, 8);
    o.middle_ratio = between(0.7, 1.4);
    o.ratio_width = round % 5 == 4 ? 1 : between(1.02, 1.08);
    const Material material{1000, between(5e3, 5e4), between(0, 0.42)};
    const auto element = static_cast<Element>(round / 3 % 3);
    const auto mesh = bend_block(small, stations, between(0.15, 0.3)).value();
    const auto basis = make_modal_basis(mesh, material, element, o).value();
    for (const double side : {between(-1, 1), 1.0}) {
      const Scale s = scale_of(o.middle_ratio * std::pow(o.ratio_width, side), between(0.7, 1.3));
      const auto belly = make_modal_belly(basis, s.across, s.along).value();
      const Whole whole(mesh, o, s, material, element);
      const Vector exact =
          oracle::eigenvalues(whole.stiffness(whole.moving, whole.moving), whole.mass(whole.moving, whole.moving));
      for (std::size_t j = 0; j < belly.modes; ++j)
        EXPECT_GE(belly.omega_1_s[j], std::sqrt(exact(static_cast<Index>(j))) * (1 - 1e-9)) << round << " " << j;
      EXPECT_LT(belly.omega_1_s[0], 1.05 * std::sqrt(exact(0))) << round;
      // and they match the matrices of the modes
      const auto square = [&](const std::vector<double>& numbers) -> Matrix {
        return Eigen::Map<const Matrix>(numbers.data(), Index{basis.modes}, Index{basis.modes});
      };
      const double r = s.across / s.along, p = s.across * s.along;
      Matrix own = (square(basis.a) / r + square(basis.b) + r * square(basis.c)) / p;
      if (!basis.foundation.empty()) own += basis.foundation_1_s2 * square(basis.foundation);
      const Vector squares = oracle::eigenvalues(own);
      for (std::size_t j = 0; j < belly.modes; ++j)
        EXPECT_NEAR(std::pow(belly.omega_1_s[j], 2) / squares(static_cast<Index>(j)), 1, 1e-9) << round << " " << j;
    }
  }
}

/// Returns an input as in a walk: slow swings with kinks, different for each input.
double drive(std::size_t input, double t_s) {
  const double swing = std::sin(7 * t_s + 0.9 * static_cast<double>(input));
  const double kinked = std::abs(std::fmod(t_s * 1.8 + 0.13 * static_cast<double>(input), 1.0) - 0.3);
  return swing + kinked;
}

/// Returns displacements of the control points over time, from the modal motions only.
std::vector<double> modal_run(const ModalBasis& basis, Scale s, const std::vector<std::vector<double>>& input,
                              double tick_s) {
  const double damping = 8;
  const auto belly = make_modal_belly(basis, s.across, s.along).value();
  const std::size_t n = basis.modes, rows = 3 * basis.control_weight.size();
  const std::size_t width = modal_motion_width(basis.modes, basis.inputs) / n;
  std::vector<float> motion(modal_motion_width(basis.modes, basis.inputs));
  write_motion(belly, damping, tick_s, motion);
  std::vector<double> x(n), w(n), run;
  for (std::size_t t = 1; t < input.size(); ++t) {
    std::vector<double> q(n);
    for (std::size_t j = 0; j < n; ++j) {
      double before = 0, now = 0;
      for (std::size_t k = 0; k < basis.inputs; ++k) {
        before += belly.participation[j][k] * input[t - 1][k];
        now += belly.participation[j][k] * input[t][k];
      }
      const auto number = [&](std::size_t i) { return static_cast<double>(motion[j * width + i]); };
      const double rate = (now - before) / tick_s, a = number(0), b = number(1), g = number(2);
      const double y = x[j] + g * rate, v = w[j] - rate;
      x[j] = a * y + b * v - g * rate;
      w[j] = -b * y + (a - g * b) * v + rate;
      const double z = now + x[j] / belly.omega_1_s[j] - belly.lift_share[j] * input[t][0];
      for (std::size_t i = 0; i < n; ++i) q[i] += belly.eigenvector[i][j] * z;
    }
    for (std::size_t row = 0; row < rows; ++row) {
      double u = static_cast<double>(basis.shape[row * (n + 1)]) * input[t][0];
      for (std::size_t i = 0; i < n; ++i) u += static_cast<double>(basis.shape[row * (n + 1) + 1 + i]) * q[i];
      run.push_back(u);
    }
  }
  return run;
}

/// Returns the same for the full belly, in small steps of constant average acceleration.
std::vector<double> whole_run(const HexahedralMesh& mesh, const ModalBasisOptions& o, Scale s,
                              const std::vector<std::vector<double>>& input, double tick_s) {
  constexpr int steps = 16;
  auto terms = assemble(mesh, Material{}).value();
  for (std::size_t n = 0; n < mesh.node.size(); ++n) {
    for (std::size_t slot = 0; slot < stencil_size; ++slot) {
      double& mass = terms.consistent_mass_kg[n * stencil_size + slot];
      mass = 0.5 * (mass + (slot == stencil_slot(0, 0, 0) ? terms.lumped_mass_kg[n] : 0.0));
    }
  }
  ReferenceOptions r{Method::newmark, Mass::consistent, o.far_end, tick_s / steps, 8, 0, 0, s.across, s.along};
  r.foundation_1_s = 2 * std::numbers::pi * o.foundation_hz;
  const std::size_t ends = o.far_end == FarEnd::free ? 3 : 1;
  const auto load = [&](std::size_t t, int step) {
    const double part = static_cast<double>(step) / steps;
    std::vector<double> now = input[t];
    for (std::size_t k = 0; k < now.size(); ++k) now[k] += part * (input[t + 1][k] - input[t][k]);
    ReferenceLoad l;
    l.end = ends == 3 ? Vec3<double>{now[0], now[1], now[2]} : Vec3<double>{0, 0, now[0]};
    if (o.frame_loads) {
      const double* const f = now.data() + ends;
      l.constant = {f[0], f[1], f[2]};
      l.gradient = {{f[3], f[4], f[5]}, {f[6], f[7], f[8]}, {f[9], f[10], f[11]}};
    }
    return l;
  };
  auto belly = ReferenceBelly::make(mesh, terms, r).value();
  r.method = Method::statics;
  auto rest = ReferenceBelly::make(mesh, terms, r).value();
  rest.start(load(0, 0));
  std::ranges::copy(rest.displacement(), belly.displacement().begin());
  std::vector<double> run;
  for (std::size_t t = 0; t + 1 < input.size(); ++t) {
    for (int step = 0; step < steps; ++step) belly.step(load(t, step), load(t, step + 1));
    run.insert(run.end(), belly.displacement().begin(), belly.displacement().end());
  }
  return run;
}

TEST(ModalBasis, OtherBodiesConvergeToTheFullBellyWithMoreModes) {
  const auto mesh = wide_spindle(small);
  constexpr double tick_s = 1.0 / 60;
  for (const FarEnd end : far_ends) {
    for (const bool frame : {false, true}) {
      const auto o = options_of(end, frame);
      const auto basis = basis_of(mesh, o);
      const Scale s = scale_of(1.03, 1.05);
      const std::size_t ends = basis.inputs - (frame ? frame_inputs : 0);
      std::vector<std::vector<double>> input;
      for (int t = 0; t < 60; ++t) {
        std::vector<double> now;
        for (std::size_t k = 0; k < basis.inputs; ++k) {
          const double size = k >= ends             ? (k < ends + 3 ? 5 : 10)
                              : end == FarEnd::held ? 0.015
                              : k + 1 == ends       ? 1
                                                    : 0.03;
          now.push_back(size * drive(k, t * tick_s));
        }
        input.push_back(now);
      }
      const auto whole = whole_run(mesh, o, s, input, tick_s);
      double last = 1;
      for (const std::uint32_t modes : {4U, 8U, 16U, 32U}) {
        const auto modal = modal_run(truncated(basis, modes), s, input, tick_s);
        ASSERT_EQ(modal.size(), whole.size());
        double error = 0, norm = 0;
        for (std::size_t i = 0; i < whole.size(); ++i) {
          error += (modal[i] - whole[i]) * (modal[i] - whole[i]);
          norm += whole[i] * whole[i];
        }
        error = std::sqrt(error / norm);
        EXPECT_LT(error, 1.1 * last) << modes << " modes";
        if (modes == 16) {
          EXPECT_LT(error, 0.03);
        }
        if (modes == 32) {
          EXPECT_LT(error, 0.02);
        }
        last = error;
      }
    }
  }
}

TEST(ModalBasis, TruncationEqualsABasisOfFewerModes) {
  for (const bool corrected : {false, true}) {
    auto o = options_of(FarEnd::held, true);
    o.corrected = corrected;
    o.control_cells = {2, 2, 4};
    const auto mesh = wide_spindle({4, 4, 8}, 0.12);
    const auto whole = basis_of(mesh, o);
    o.modes = 7;
    const auto cut = truncated(whole, o.modes), made = basis_of(mesh, o);
    EXPECT_EQ(cut.modes, 7U);
    EXPECT_EQ(cut.a, made.a);
    EXPECT_EQ(cut.b, made.b);
    EXPECT_EQ(cut.c, made.c);
    EXPECT_EQ(cut.foundation, made.foundation);
    EXPECT_EQ(cut.lift_a, made.lift_a);
    EXPECT_EQ(cut.lift_mass, made.lift_mass);
    EXPECT_EQ(cut.lift_kinetic, made.lift_kinetic);
    EXPECT_EQ(cut.frame, made.frame);
    EXPECT_EQ(cut.shape, made.shape);
    EXPECT_EQ(cut.fit, made.fit);
  }
}

TEST(ModalBasis, CorrectionRemovesMostOfTheMeshError) {
  const auto belly_of = [](const Cells& cells, bool corrected) {
    auto o = options_of(FarEnd::held, false, 12);
    o.corrected = corrected;
    o.ratio_width = 1;
    o.control_cells = {2, 2, 4};
    return make_modal_belly(basis_of(wide_spindle(cells, 0.12), o), 0.95, 0.95).value();
  };
  const auto plain = belly_of({4, 4, 8}, false), corrected = belly_of({4, 4, 8}, true),
             fine = belly_of({8, 8, 16}, false);
  const auto off = [](double coarse, double finer, double got) {
    return std::abs(got - finer) / std::abs(coarse - finer);
  };
  EXPECT_LT(off(plain.reaction[0], fine.reaction[0], corrected.reaction[0]), 0.5);
  for (std::size_t j = 0; j < 4; ++j) {
    EXPECT_LT(off(plain.omega_1_s[j], fine.omega_1_s[j], corrected.omega_1_s[j]), 0.5) << j;
  }
}

TEST(ModalBasis, BadOptionsAreRefusedWithTheValidRange) {
  const auto message = [](auto&& change, Cells cells = small) {
    ModalBasisOptions o = options_of(FarEnd::held, false, 4);
    change(o);
    const auto basis = make_modal_basis(wide_spindle(cells), Material{}, Element::full, o);
    return basis ? std::string() : basis.error().message;
  };
  using O = ModalBasisOptions&;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<std::string, std::string>> cases = {
      {message([](O o) { o.modes = 0; }), "1 to 32"},
      {message([](O o) { o.modes = 33; }), "1 to 32"},
      {message([](O o) {
         o.control_cells = {2, 2, 5};
       }),
       "2x2x5"},
      {message([](O o) {
         o.control_cells = {0, 2, 8};
       }),
       "0x2x8"},
      {message([](O o) { o.corrected = true; }, {2, 2, 8}), ""},
      {message(
           [](O o) {
             o.corrected = true, o.control_cells = {1, 1, 1};
           },
           {3, 3, 9}),
       "even"},
      {message([nan](O o) { o.foundation_hz = nan; }), "foundation"},
      {message([](O o) { o.damping_per_s = -1; }), "damping"},
      {message([](O o) { o.middle_ratio = 0; }), "ratio"},
      {message([](O o) { o.ratio_width = 0.9; }), "width"},
      {message([nan](O o) { o.middle_product = nan; }), "product"},
      {message(
           [](O o) {
             o.control_cells = {1, 1, 1};
           },
           {1, 1, 1}),
       "one layer"},
      {message(
           [](O o) {
             o.modes = 32, o.control_cells = {1, 1, 2};
           },
           {1, 1, 2}),
       "ask for no more"},
  };
  for (const auto& [got, part] : cases) {
    EXPECT_NE(got.find(part), std::string::npos) << got;
    EXPECT_EQ(got.find('\n'), std::string::npos) << got;
    EXPECT_EQ(got.empty(), part.empty()) << got;
  }
}

}  // namespace mobil::modal_basis_test
