#pragma once
// A belly thick in its middle and a little bent, for tests of methods that step one.

#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>

namespace mobil {

/// 12 cm long, up to 42 mm wide.
inline HexahedralMesh spindle(const Cells& cells) {
  const std::vector<LatticeStation> stations = {
      {0, 0, 0, 0.012F, 0.014F}, {0.5F, 0.006F, -0.004F, 0.021F, 0.018F}, {1, 0, 0, 0.011F, 0.01F}};
  return *bend_block(cells, stations, 0.12);
}

/// Up to 72 mm wide.
inline HexahedralMesh wide_spindle(const Cells& cells, double length_m = 0.24) {
  const std::vector<LatticeStation> stations = {
      {0, 0, 0, 0.02F, 0.018F}, {0.4F, 0.008F, -0.01F, 0.036F, 0.03F}, {1, 0, 0, 0.014F, 0.012F}};
  return *bend_block(cells, stations, length_m);
}

}  // namespace mobil
