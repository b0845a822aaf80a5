#include "assets/import/mesh_frame.h"

#include <fmt/format.h>

#include <algorithm>

#include "assets/import/mesh_text.h"

namespace mobil::inline v0_3 {

Result<MeshFrame> read_frame(std::string_view unit, std::string_view up, const MeshFrame& usual,
                             std::string_view where) {
  MeshFrame frame = usual;
  if (!unit.empty()) {
    const auto* known = std::ranges::find(mesh_units, unit, &std::pair<std::string_view, double>::first);
    if (known == mesh_units.end()) {
      return fail(fmt::format("{}: unit {} is not known; valid: m, cm, mm, in, or empty", where, shown(unit)));
    }
    frame.metres_per_unit = known->second;
  }
  if (!up.empty()) {
    if (up != "y" && up != "z") {
      return fail(fmt::format("{}: up {} is not known; valid: z (+x left, +y back), y (+x left, +z forward), or empty",
                              where, shown(up)));
    }
    frame.y_up = up == "y";
  }
  return frame;
}

std::string frame_name(const MeshFrame& frame) {
  const auto* unit = std::ranges::find(mesh_units, frame.metres_per_unit, &std::pair<std::string_view, double>::second);
  return fmt::format("unit {}, up {}", unit == mesh_units.end() ? "?" : unit->first, frame.y_up ? "y" : "z");
}

}  // namespace mobil::inline v0_3
