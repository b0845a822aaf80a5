#pragma once
// Largest elements of a mesh for the waves that it carries.

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/muscle.h>

namespace mobil::inline v0_3 {

/// Elements per compression wavelength, and the highest frequency of a walk's loads (Hz) at which they are counted. The
/// paper (section 6.3) states one result of its rule, Δx ≤ 0.030 m for compression waves of 4 m/s. It thus gives only
/// elements times frequency, 4 m/s / 0.030 m. Ten elements per wave, the usual measure (1.6 % of error in a linear
/// element's wave speed), put the frequency at 13⅓ Hz. That is the fifteenth harmonic of a stride at 0.9 Hz, beyond
/// which a walk's forces are small.
inline constexpr double elements_per_wavelength = 10;
inline constexpr double highest_load_hz = 4 / 0.030 / elements_per_wavelength;

/// Returns √((λ + 2μ)/ρ), m/s.
double compression_wave_speed(const Material& material);

/// Returns the longest element edge (m) that the rule allows, in proportion to the speed of compression waves.
double largest_element_m(const Material& material);

/// Returns the longest edge of any element of a mesh, m.
double longest_edge_m(const HexahedralMesh& mesh);

}  // namespace mobil::inline v0_3
