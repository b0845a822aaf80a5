#pragma once
// Whether a mesh lies where its row says that it does: by its box, the joints and the bones.

#include <optional>
#include <string>
#include <vector>

#include <mobil/assets/import/anatomy_folder.h>
#include <mobil/components/surface.h>
#include "assets/import/mesh_frame.h"

namespace mobil::inline v0_3 {

/// Parallel to the axes.
struct MeshBox {
  Vec3<float> least, most;
};

/// Of a mesh with at least one vertex.
MeshBox box_of(const SurfaceMesh& mesh);

/// Of a box in a file's frame, in mobil's axes, m.
MeshBox to_mobil(const MeshBox& box, const MeshFrame& frame);

/// The boxes of a folder's bones, m, mobil's axes.
struct PlacedBone {
  Segment segment;
  MeshBox box;
};

/// What is wrong with a part's place or size, as "reaches …; valid: …"; nothing where it is right. `box` in m, mobil's
/// axes. Bones are compared with the joints alone, muscles and tendons also with the bones from their origin to their
/// insertion, where each segment on the way has one; skins only with how far a body reaches.
std::optional<std::string> misplaced(const MeshBox& box, const AnatomyPart& part, const AnatomyLandmarks& landmarks,
                                     const std::vector<PlacedBone>& bones);

/// "; it would fit with unit cm, up y" for the frames in which a box of the file's own numbers is not misplaced; or how
/// to mend it otherwise.
std::string frames_that_fit(const MeshBox& raw, const AnatomyPart& part, const AnatomyLandmarks& landmarks,
                            const std::vector<PlacedBone>& bones);

}  // namespace mobil::inline v0_3
