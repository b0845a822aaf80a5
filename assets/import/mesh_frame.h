#pragma once
// Units and axes of an anatomy's files, and how they become mobil's.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <mobil/components/lanes.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// z up: +x to the left, +y backwards, +z up. y up: +x to the left, +y up, +z forwards, as mobil's own.
struct MeshFrame {
  double metres_per_unit = 0.001;
  bool y_up = false;
  bool operator==(const MeshFrame&) const = default;
};

/// As the columns `unit` and `up` name them.
inline constexpr std::array<std::pair<std::string_view, double>, 4> mesh_units = {
    {{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}}};

/// What the cells of the two columns say; an empty one leaves that of `usual`. Errors begin with `where`.
Result<MeshFrame> read_frame(std::string_view unit, std::string_view up, const MeshFrame& usual,
                             std::string_view where);

/// "unit mm, up z".
std::string frame_name(const MeshFrame& frame);

/// A point in the frame → mobil's axes, m.
inline Vec3<float> to_mobil(double x, double y, double z, const MeshFrame& frame) {
  const double s = frame.metres_per_unit;
  return {static_cast<float>(x * s), static_cast<float>((frame.y_up ? y : z) * s),
          static_cast<float>((frame.y_up ? z : -y) * s)};
}

}  // namespace mobil::inline v0_3
