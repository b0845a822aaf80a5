#pragma once
// Bellies that are thick and slightly bent in the middle, for tests of methods that step one belly.

#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>

namespace mobil {

/// A belly of 12 cm, up to 42 mm wide, bent by 6 mm in x:
///
///      x ^        __________
///        |    ___/          `---.      half-widths in x: 12, 21, 11 mm
///        |   |  - - - - - - -   |      at z = 0, 60, 120 mm
///        |   |___            ___|
///        |       `----------'
///        +----------------------> z
inline HexahedralMesh spindle(const Cells& cells) {
  const std::vector<LatticeStation> stations = {
      {0, 0, 0, 0.012F, 0.014F}, {0.5F, 0.006F, -0.004F, 0.021F, 0.018F}, {1, 0, 0, 0.011F, 0.01F}};
  return *bend_block(cells, stations, 0.12);
}

/// A belly of 24 cm by default, up to 72 mm wide.
inline HexahedralMesh wide_spindle(const Cells& cells, double length_m = 0.24) {
  const std::vector<LatticeStation> stations = {
      {0, 0, 0, 0.02F, 0.018F}, {0.4F, 0.008F, -0.01F, 0.036F, 0.03F}, {1, 0, 0, 0.014F, 0.012F}};
  return *bend_block(cells, stations, length_m);
}

}  // namespace mobil
