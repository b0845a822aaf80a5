#pragma once
// A shape table as stored in source: modes in 16 bits.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include <mobil/engine/error.h>
#include "assets/finite/shape_table.h"

namespace mobil::inline v0_3 {

/// Numbers of a mode: three at each of the 63 points between the ends of 2×2×8 cells.
inline constexpr std::size_t packed_numbers = 189;

/// `vector[v]` is in units of `unit_m[v]`. `coefficient[v]` has those of C₀, of C₁ and of C₂.
struct PackedShapes {
  std::array<float, shape_modes> unit_m;
  std::array<std::array<std::int16_t, packed_numbers>, shape_modes> vector;
  std::array<std::array<float, shape_amount_count * shape_ratio_terms>, shape_modes> coefficient;
};

/// Fails unless the table has six modes over 2×2×8 cells.
Result<PackedShapes> pack_shapes(const ShapeTable& table);

ShapeTable unpack_shapes(const PackedShapes& packed);

/// Returns the initialiser of a PackedShapes, in lines of at most 120 columns; floats to five digits.
std::string initialiser(const PackedShapes& packed);

}  // namespace mobil::inline v0_3
