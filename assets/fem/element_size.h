#pragma once
// How coarse a mesh may be for the waves that it is to carry.

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/muscle.h>

namespace mobil::inline v0_3 {

/// Elements to a compression wave's length, and the highest frequency of a walk's loads (Hz) at which they are counted.
/// The paper (section 6.3) states one result of its rule, Δx ≤ 0.030 m for a material whose compression waves travel at
/// 4 m/s: only 4 m/s / 0.030 m, elements times frequency, is known from it. Ten elements a wave, the usual
/// measure (1.6 % of error in a linear element's wave speed), put the frequency at 13⅓ Hz: the fifteenth harmonic of a
/// stride at 0.9 Hz, beyond which a walk's forces are small.
inline constexpr double elements_per_wavelength = 10;
inline constexpr double highest_load_hz = 4 / 0.030 / elements_per_wavelength;

/// √((λ + 2μ)/ρ), m/s.
double compression_wave_speed(const Material& material);

/// Longest element edge (m) that follows the rule; in proportion to the speed of compression waves.
double largest_element_m(const Material& material);

/// Longest edge of any element of a mesh, m.
double longest_edge_m(const HexahedralMesh& mesh);

}  // namespace mobil::inline v0_3
