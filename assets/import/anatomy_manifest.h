#pragma once
// The two tables of an anatomy folder, read and checked before any mesh is.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "assets/import/anatomy_folder.h"

namespace mobil {

/// One wanted row: everything about a part but its mesh (whose name is set).
struct ManifestRow {
  std::string where;  // "FOLDER/manifest.csv line N", for messages
  std::string file;   // path of the mesh
  AnatomyPart part;
  std::optional<std::size_t> triangles;
  bool watertight = false;
};

struct LandmarkTable {
  AnatomyLandmarks landmarks;
  double metres_per_unit = 0.001;
};

/// Millimetres or metres are told from the distance hip to ankle (0.4–1.3 m). See load_anatomy for what fails.
Result<LandmarkTable> read_landmarks(const std::string& folder);

/// The rows that `options` wants, in their order.
Result<std::vector<ManifestRow>> read_manifest(const std::string& folder, double metres_per_unit,
                                               const AnatomyOptions& options);

/// anatomy (+x left, +y back, +z up; folder's units) → mobil (+x left, +y up, +z forward; m).
inline Vec3<float> to_mobil(double x, double y, double z, double metres_per_unit) {
  return {static_cast<float>(x * metres_per_unit), static_cast<float>(z * metres_per_unit),
          static_cast<float>(-y * metres_per_unit)};
}

}  // namespace mobil
