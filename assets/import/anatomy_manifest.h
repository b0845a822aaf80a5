#pragma once
// The two tables of an anatomy folder, read and checked before any mesh is.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <mobil/assets/import/anatomy_folder.h>
#include "assets/import/mesh_frame.h"

namespace mobil::inline v0_3 {

/// One wanted row: everything about a part but its mesh (whose name is set).
struct ManifestRow {
  std::string where;  // "FOLDER/manifest.csv line N", for messages
  std::string name;   // of the mesh's file, as written there
  std::string file;   // path of the mesh
  MeshFrame frame;
  AnatomyPart part;
  std::optional<std::size_t> triangles;
  bool watertight = false;
};

/// The rows that can be read and are wanted, in their order, and the faults of the others.
struct Manifest {
  std::vector<ManifestRow> row;
  std::vector<std::string> faults;
};

struct LandmarkTable {
  AnatomyLandmarks landmarks;
  MeshFrame frame;
  std::vector<std::string> said;
};

/// The columns unit and up name the unit and the axes. Where they are empty, the distance from hip to ankle (0.4–1.3 m)
/// and its direction decide. load_anatomy says what fails.
Result<LandmarkTable> read_landmarks(const std::string& folder);

/// The rows that `options` wants; fails for a table that cannot be read, or has no such row.
Result<Manifest> read_manifest(const std::string& folder, const MeshFrame& frame, const AnatomyOptions& options);

}  // namespace mobil::inline v0_3
