#pragma once
// Units and axes of an anatomy's files, and their conversion to mobil's.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <mobil/components/lanes.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Axes: with z up, +x to the left and +y backwards; with y up, +x to the left and +z forwards, as in mobil.
struct MeshFrame {
  double metres_per_unit = 0.001;
  bool y_up = false;
  bool operator==(const MeshFrame&) const = default;
};

/// Names in the column `unit`, with metres per unit.
inline constexpr std::array<std::pair<std::string_view, double>, 4> mesh_units = {
    {{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}}};

/// Reads the cells of the two columns; an empty one keeps that of `usual`. Errors begin with `where`.
Result<MeshFrame> read_frame(std::string_view unit, std::string_view up, const MeshFrame& usual,
                             std::string_view where);

/// Returns "unit mm, up z".
std::string frame_name(const MeshFrame& frame);

/// Converts a point in the frame to mobil's axes, m.
inline Vec3<float> to_mobil(double x, double y, double z, const MeshFrame& frame) {
  const double s = frame.metres_per_unit;
  return {static_cast<float>(x * s), static_cast<float>((frame.y_up ? y : z) * s),
          static_cast<float>((frame.y_up ? z : -y) * s)};
}

}  // namespace mobil::inline v0_3
