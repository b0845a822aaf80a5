#pragma once
// Checks a mesh's place against its row: by its box, the joints and the bones.

#include <optional>
#include <string>
#include <vector>

#include <mobil/assets/import/anatomy_folder.h>
#include <mobil/components/surface.h>
#include "assets/import/mesh_frame.h"

namespace mobil::inline v0_3 {

/// A box parallel to the axes.
struct MeshBox {
  Vec3<float> least, most;
};

/// Returns the box of a mesh with at least one vertex.
MeshBox box_of(const SurfaceMesh& mesh);

/// Converts a box in a file's frame to mobil's axes, m.
MeshBox to_mobil(const MeshBox& box, const MeshFrame& frame);

/// Box of a bone of the folder, m, mobil's axes.
struct PlacedBone {
  Segment segment;
  MeshBox box;
};

/// Returns a fault of a part's place or size, as "reaches …; valid: …", or nothing. `box` is in m, mobil's axes. Bones
/// are compared only with the joints. Muscles and tendons are also compared with the bones from their origin to their
/// insertion, if each segment between has one. Skins are compared only with a body's reach.
std::optional<std::string> misplaced(const MeshBox& box, const AnatomyPart& part, const AnatomyLandmarks& landmarks,
                                     const std::vector<PlacedBone>& bones);

/// Returns "; it would fit with unit cm, up y" for the frames in which a box of the file's own numbers is not
/// misplaced, or another remedy.
std::string frames_that_fit(const MeshBox& raw, const AnatomyPart& part, const AnatomyLandmarks& landmarks,
                            const std::vector<PlacedBone>& bones);

}  // namespace mobil::inline v0_3
