#pragma once
// Measured cross-sections of the leg's long bones and muscles, and their position in a body.
//
// Source: horizontal sections measured for this project from the surfaces of BodyParts3D 3.0 (© The Database Center for
// Life Science, licensed under CC Attribution-Share Alike 2.1 Japan), a man of about 1.69 m. Only centroids and
// ellipses of equal second moments are kept.

#include <optional>
#include <span>

#include <mobil/components/body.h>
#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Stature of the measured man, mm. Lengths across the leg scale with it.
inline constexpr double reference_height_mm = 1690;

/// One horizontal section. `level` is 0 at the hip centre, 1 at the knee's and 2 at the ankle's, linear between and
/// beyond. The centre is in mm from the straight lines hip–knee–ankle and the semi-axes are in mm. The angle (degrees)
/// is that of the first semi-axis from anterior towards lateral. `bow` (mm) bends the section as in TubeStation
/// (assets/surfaces/tube.h): a curved sheet is not an ellipse.
struct LegSection {
  float level, lateral, anterior, semi_1, semi_2, angle_deg;
  float bow = 0;
};

/// Axis of sections that are orthogonal to it instead of horizontal: its ends as centres of LegSection. Their `level`
/// is 0 at `from` and 1 at `to`, their centres are in mm from the axis. Anterior is the leg's, carried from straight
/// down to the axis by the smallest rotation, and lateral is orthogonal to both.
struct SectionAxis {
  struct End {
    float level, lateral, anterior;
  };
  End from, to;
};

/// Return the sections of the three long bones by ascending level; the file's head names the source.
std::span<const LegSection> femur_sections();
std::span<const LegSection> tibia_sections();
std::span<const LegSection> fibula_sections();

/// Levels and millimetres in the right leg of a body that stands in the anatomical position at x = z = 0, m.
struct LegFrame {
  Vec3<double> hip;
  double thigh_length, shank_length;
  double above;  // length of one level above the hip: the thigh of a leg in proportion
  double unit;   // metres per mm of the measured man
};
LegFrame leg_frame(const Body& body);
Vec3<double> leg_point(const LegFrame& leg, double level, double lateral_mm, double anterior_mm);

/// Planes of a muscle's sections in a leg: the level's origin and one level along the normal, m, and directions.
struct SectionPlanes {
  bool horizontal;
  Vec3<double> origin, along;              // of an axis
  Vec3<double> normal, anterior, lateral;  // unit vectors; normal downwards, or along the axis
};
SectionPlanes section_planes(const LegFrame& leg, const std::optional<SectionAxis>& across);
/// Returns the centre of a section, m.
Vec3<double> section_centre(const LegFrame& leg, const SectionPlanes& planes, double level, double lateral_mm,
                            double anterior_mm);
/// Returns the level of a point in these planes.
double section_level(const LegFrame& leg, const SectionPlanes& planes, const Vec3<double>& at);

/// Returns the level of a height above the ground (m).
double leg_level(const LegFrame& leg, double height_m);

/// An ellipse: centre lateral and anterior, and the symmetric matrix that maps the unit circle to it in (anterior,
/// lateral), mm. `leg_ellipse` interpolates a list linearly at a level; it returns nothing beyond the list's ends.
struct LegEllipse {
  double lateral, anterior;
  double aa, al, ll;
};
std::optional<LegEllipse> leg_ellipse(std::span<const LegSection> sections, double level);

}  // namespace mobil::inline v0_3
