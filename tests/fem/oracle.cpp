#include "tests/fem/oracle.h"

#include <cmath>

#include "assets/reduction/dense.h"
#include "engine/eigen.h"

namespace mobil::oracle {

namespace {

Eigen::Matrix<double, 6, 6> elasticity(const Material& m) {
  Eigen::Matrix<double, 6, 6> compliance = Eigen::Matrix<double, 6, 6>::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) compliance(i, j) = (i == j ? 1 : -m.poisson) / m.young_pa;
    compliance(3 + i, 3 + i) = 2 * (1 + m.poisson) / m.young_pa;
  }
  return compliance.inverse();
}

}  // namespace

Shape shape_at(const HexahedralMesh& mesh, const Hexahedron& h, double x, double y, double z) {
  const std::array<double, 8> sx = {-1, 1, 1, -1, -1, 1, 1, -1}, sy = {-1, -1, 1, 1, -1, -1, 1, 1},
                              sz = {-1, -1, -1, -1, 1, 1, 1, 1};
  Eigen::Matrix<double, 8, 3> local, place;
  Shape s;
  for (std::size_t a = 0; a < 8; ++a) {
    const auto r = static_cast<Eigen::Index>(a);
    const double fx = 1 + sx[a] * x, fy = 1 + sy[a] * y, fz = 1 + sz[a] * z;
    s.n(r) = fx * fy * fz / 8;
    local.row(r) << sx[a] * fy * fz / 8, fx * sy[a] * fz / 8, fx * fy * sz[a] / 8;
    const auto& p = mesh.node[h[a]];
    place.row(r) << p.x, p.y, p.z;
  }
  const Eigen::Matrix3d j = local.transpose() * place;
  s.jacobian = j.determinant();
  s.dn = local * j.inverse().transpose();
  return s;
}

namespace {

Matrix strain_matrix(const Shape& s) {
  Matrix b = Matrix::Zero(6, 24);
  for (int a = 0; a < 8; ++a) {
    const double x = s.dn(a, 0), y = s.dn(a, 1), z = s.dn(a, 2);
    b.block<6, 3>(0, 3 * a) << x, 0, 0, 0, y, 0, 0, 0, z, y, x, 0, 0, z, y, z, 0, x;
  }
  return b;
}

}  // namespace

namespace {

/// Returns the hourglass stiffness of Flanagan and Belytschko: `share`·4μ·V·Σ|b|²/8 on each pattern's part orthogonal
/// to linear fields. `mean` is the mean strain matrix.
Matrix hourglass_stiffness(const HexahedralMesh& mesh, const Hexahedron& h, const Matrix& mean, double volume_m3,
                           const Material& material, double share) {
  Eigen::Matrix<double, 8, 3> b, place;
  for (int a = 0; a < 8; ++a) {
    const auto& p = mesh.node[h[static_cast<std::size_t>(a)]];
    place.row(a) << p.x, p.y, p.z;
    for (int d = 0; d < 3; ++d) b(a, d) = mean(d, 3 * a + d);
  }
  Eigen::Matrix<double, 8, 4> pattern;
  pattern.col(0) << 1, 1, -1, -1, -1, -1, 1, 1;
  pattern.col(1) << 1, -1, -1, 1, -1, 1, 1, -1;
  pattern.col(2) << 1, -1, 1, -1, 1, -1, 1, -1;
  pattern.col(3) << -1, 1, -1, 1, 1, -1, 1, -1;
  const Eigen::Matrix<double, 8, 4> gamma = pattern - b * (place.transpose() * pattern);
  const double mu = material.young_pa / (2 * (1 + material.poisson));
  const Matrix k = share * 4 * mu * volume_m3 * b.squaredNorm() / 8 * gamma * gamma.transpose();
  Matrix all = Matrix::Zero(24, 24);
  for (int a = 0; a < 8; ++a) {
    for (int c = 0; c < 8; ++c) all.block<3, 3>(3 * a, 3 * c) = k(a, c) * Eigen::Matrix3d::Identity();
  }
  return all;
}

}  // namespace

ElementMatrices element_matrices(const HexahedralMesh& mesh, const Hexahedron& h, const Material& material,
                                 Element kind) {
  ElementMatrices element;
  const auto d = elasticity(material);
  const double g = 1 / std::sqrt(3.0);
  std::vector<Shape> points;
  double volume_m3 = 0;
  Matrix mean = Matrix::Zero(6, 24);
  for (const double x : {-g, g}) {
    for (const double y : {-g, g}) {
      for (const double z : {-g, g}) {
        points.push_back(shape_at(mesh, h, x, y, z));
        volume_m3 += points.back().jacobian;
        mean += points.back().jacobian * strain_matrix(points.back());
      }
    }
  }
  mean /= volume_m3;
  Eigen::Matrix<double, 6, 1> unit;
  unit << 1, 1, 1, 0, 0, 0;
  for (const Shape& s : points) {
    Matrix b = strain_matrix(s);
    if (kind == Element::bbar) b += unit * unit.transpose() * (mean - b) / 3;
    if (kind == Element::one_point) b = mean;
    element.stiffness += s.jacobian * b.transpose() * d * b;
    element.mass += s.jacobian * material.density_kg_m3 * s.n * s.n.transpose();
  }
  if (kind == Element::one_point) {
    element.stiffness += hourglass_stiffness(mesh, h, mean, volume_m3, material, hourglass_share);
  }
  return element;
}

Model assemble(const HexahedralMesh& mesh, const Material& material, Element kind) {
  const auto size = static_cast<Eigen::Index>(3 * mesh.node.size());
  Model model{Matrix::Zero(size, size), Matrix::Zero(size, size), Vector::Zero(size)};
  for (std::uint32_t e = 0; e < element_count(mesh.cells); ++e) {
    const Hexahedron h = element_nodes(mesh.cells, e);
    const auto [k, m] = element_matrices(mesh, h, material, kind);
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t c = 0; c < 8; ++c) {
        const auto ra = static_cast<Eigen::Index>(3 * h[a]), rc = static_cast<Eigen::Index>(3 * h[c]);
        const auto ia = static_cast<Eigen::Index>(a), ic = static_cast<Eigen::Index>(c);
        model.stiffness.block<3, 3>(ra, rc) += k.block<3, 3>(3 * ia, 3 * ic);
        model.mass.block<3, 3>(ra, rc) += m(ia, ic) * Eigen::Matrix3d::Identity();
      }
    }
  }
  model.lumped = model.mass.rowwise().sum();
  return model;
}

HexahedralMesh scaled(HexahedralMesh mesh, double across, double along) {
  for (auto& p : mesh.node) p = {p.x * across, p.y * across, p.z * along};
  return mesh;
}

std::vector<Eigen::Index> free_components(const Cells& cells, FarEnd end) {
  std::vector<Eigen::Index> moving;
  for (std::uint32_t n = 0; n < node_count(cells); ++n) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (moves(cells, end, n, c)) moving.push_back(static_cast<Eigen::Index>(3 * n + c));
    }
  }
  return moving;
}

double highest_frequency(const Model& model, const std::vector<Eigen::Index>& moving) {
  const Vector w = model.lumped(moving).cwiseSqrt().cwiseInverse();
  const Matrix k = w.asDiagonal() * model.stiffness(moving, moving) * w.asDiagonal();
  return std::sqrt(eigenvalues(k).maxCoeff());
}

Vector far_shares(const HexahedralMesh& mesh) {
  Vector share = Vector::Zero(static_cast<Eigen::Index>(mesh.node.size()));
  const double g = 1 / std::sqrt(3.0);
  const std::uint32_t below = element_count(mesh.cells) - mesh.cells[0] * mesh.cells[1];
  for (std::uint32_t e = below; e < element_count(mesh.cells); ++e) {
    const Hexahedron h = element_nodes(mesh.cells, e);
    for (const double x : {-g, g}) {
      for (const double y : {-g, g}) {
        const Shape s = shape_at(mesh, h, x, y, 1);
        Eigen::Matrix2d plane = Eigen::Matrix2d::Zero();
        // the face is flat, so its Jacobian depends on x and y only
        for (std::size_t a = 4; a < 8; ++a) {
          const double sx = a == 5 || a == 6 ? 1 : -1, sy = a > 5 ? 1 : -1;
          const auto& p = mesh.node[h[a]];
          plane += Eigen::Vector2d(sx * (1 + sy * y) / 4, sy * (1 + sx * x) / 4) * Eigen::RowVector2d(p.x, p.y);
        }
        for (std::size_t a = 4; a < 8; ++a) {
          share(static_cast<Eigen::Index>(h[a])) += plane.determinant() * s.n(static_cast<Eigen::Index>(a));
        }
      }
    }
  }
  return share / share.sum();
}

Vector solve(const Matrix& symmetric, const Vector& right) {
  return solved(symmetric, right);
}

Vector eigenvalues(const Matrix& symmetric) {
  return symmetric_eigen(symmetric).values;
}

SymmetricEigen modes(const Matrix& stiffness, const Matrix& mass) {
  const Eigen::LLT<Matrix> factor(mass);
  const Matrix half = factor.matrixL().solve(stiffness);
  SymmetricEigen found = symmetric_eigen(factor.matrixL().solve(half.transpose()));
  found.vectors = factor.matrixU().solve(found.vectors).eval();
  return found;
}

Vector eigenvalues(const Matrix& stiffness, const Matrix& mass) {
  return modes(stiffness, mass).values;
}

}  // namespace mobil::oracle
