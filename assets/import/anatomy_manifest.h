#pragma once
// The two tables of an anatomy folder, read and checked before any mesh.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <mobil/assets/import/anatomy_folder.h>
#include "assets/import/mesh_frame.h"

namespace mobil::inline v0_3 {

/// One wanted row: everything about a part except its mesh, of which only the name is set.
struct ManifestRow {
  std::string where;  // "FOLDER/manifest.csv line N", for messages
  std::string name;   // of the mesh's file, as written there
  std::string file;   // path of the mesh
  MeshFrame frame;
  AnatomyPart part;
  std::optional<std::size_t> triangles;
  bool watertight = false;
};

/// The rows that are readable and wanted, in their order, and the faults of the others.
struct Manifest {
  std::vector<ManifestRow> row;
  std::vector<std::string> faults;
};

struct LandmarkTable {
  AnatomyLandmarks landmarks;
  MeshFrame frame;
  std::vector<std::string> said;
};

/// Reads the landmarks. The columns unit and up give the unit and the axes. If they are empty, the distance from hip to
/// ankle (0.4–1.3 m) and its direction decide. load_anatomy lists the failures.
Result<LandmarkTable> read_landmarks(const std::string& folder);

/// Reads the rows that `options` selects. Fails on a table that cannot be read, or without such a row.
Result<Manifest> read_manifest(const std::string& folder, const MeshFrame& frame, const AnatomyOptions& options);

}  // namespace mobil::inline v0_3
