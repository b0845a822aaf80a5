#pragma once
// Cross-sections of the leg's long bones and muscles as measured figures, and where they lie in one body.
//
// Source: horizontal sections measured for this project from the surfaces of BodyParts3D 3.0 (© The Database Center for
// Life Science, licensed under CC Attribution-Share Alike 2.1 Japan): a man of about 1.69 m. Only centroids and
// ellipses of equal second moments are kept.

#include <optional>
#include <span>

#include <mobil/components/body.h>
#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Stature of the measured man, mm: lengths across the leg are taken in proportion to it.
inline constexpr double reference_height_mm = 1690;

/// One horizontal section. `level`: 0 at the hip centre, 1 at the knee's, 2 at the ankle's, linear between and beyond.
/// Centre in mm from the straight lines hip–knee–ankle; semi-axes in mm; the angle (degrees) of the first semi-axis
/// from anterior towards lateral.
struct LegSection {
  float level, lateral, anterior, semi_1, semi_2, angle_deg;
};

/// Sections of the three long bones, by ascending level; the source is named at the file's head.
std::span<const LegSection> femur_sections();
std::span<const LegSection> tibia_sections();
std::span<const LegSection> fibula_sections();

/// Where levels and millimetres lie in a body that stands in the anatomical position at x = z = 0: its right leg, m.
struct LegFrame {
  Vec3<double> hip;
  double thigh_length, shank_length;
  double above;  // what a level is long over the hip: the thigh of a leg in proportion
  double unit;   // metres per mm of the measured man
};
LegFrame leg_frame(const Body& body);
Vec3<double> leg_point(const LegFrame& leg, double level, double lateral_mm, double anterior_mm);

/// The level of a height over the ground (m).
double leg_level(const LegFrame& leg, double height_m);

/// The ellipse of a list of sections at one level, linear between them; nothing beyond their ends. Centre lateral and
/// anterior, and the symmetric matrix that carries the unit circle onto it, in (anterior, lateral), mm.
struct LegEllipse {
  double lateral, anterior;
  double aa, al, ll;
};
std::optional<LegEllipse> leg_ellipse(std::span<const LegSection> sections, double level);

}  // namespace mobil::inline v0_3
