#include "assets/reduction/modal_tension.h"

#include <algorithm>
#include <cmath>

#include "assets/fem/finite_element.h"
#include "assets/reduction/modal_operators.h"

namespace mobil::inline v0_3 {
namespace {

using Eigen::Index;

constexpr Index points = 8, rows_a_point = 4, rows_an_element = points * rows_a_point;

/// Writes √(taut)·(a·∇)u, three rows, and √(growth)·a·(a·∇)u of each point of an element; their squares are its energy.
void write_rows(const FiniteElement& element, const HexahedralMesh& mesh, const FibreTension& tension,
                const Columns& fields, Eigen::Ref<Columns> rows) {
  for (Index q = 0; q < points; ++q) {
    const auto& fibre = element.fibre[static_cast<std::size_t>(q)];
    auto along = rows.middleRows<3>(rows_a_point * q);
    along.setZero();
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    for (std::size_t a = 0; a < fibre.size(); ++a) {
      const auto& at = mesh.node[element.node[a]];
      direction += fibre[a] * Eigen::Vector3d(at.x, at.y, at.z);
      along += fibre[a] * fields.middleRows<3>(3 * static_cast<Index>(element.node[a]));
    }
    const double volume = element.fibre_volume_m3[static_cast<std::size_t>(q)];
    const double growth = volume * (tension.slope_pa - tension.stress_pa);
    rows.row(rows_a_point * q + 3).noalias() = std::sqrt(growth) * (direction.transpose() * along);
    along *= std::sqrt(volume * tension.stress_pa);
  }
}

}  // namespace

Eigen::MatrixXd tension_stiffness(const HexahedralMesh& mesh, double shear_pa, const Columns& fields) {
  FiniteTissue tissue;
  tissue.active_pa *= shear_pa / tissue.shear_pa;
  tissue.shear_pa = shear_pa;
  const auto elements = finite_elements(mesh, tissue);
  const FibreTension tension = fibre_tension(tissue, 1, 1, 1);
  constexpr Index at_once = 3;  // as many rows as `inner` sums at a time
  Columns rows(at_once * rows_an_element, fields.cols());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(fields.cols(), fields.cols());
  for (std::size_t e = 0; e < elements->size(); e += at_once) {
    rows.setZero();
    for (std::size_t i = e; i < std::min(e + at_once, elements->size()); ++i) {
      const Index first = static_cast<Index>(i - e) * rows_an_element;
      write_rows((*elements)[i], mesh, tension, fields, rows.middleRows(first, rows_an_element));
    }
    sum += inner(rows, rows);
  }
  return sum;
}

}  // namespace mobil::inline v0_3
