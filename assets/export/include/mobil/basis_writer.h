#pragma once
// A belly that moves along a few modes as a GLB: its boundary, the modes as morph targets, its modal coordinates
// as their weights over time. A viewer that morphs needs nothing else of us.

#include <filesystem>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// `target`: displacement of every node (three each, x fastest, m) per unit of each coordinate; `weight`: a row a
/// frame, one number a target. Viewers need to show only 8 targets.
struct BasisRecording {
  HexahedralMesh mesh;
  std::vector<std::vector<float>> target;
  std::vector<std::vector<float>> weight;
  float frame_s = 0;
};

/// Writes `path`, whole or not at all. Targets are scaled so that no weight of the recording exceeds 1. Errors: no
/// frames or targets, rows of other lengths, a value that is not finite, a file that cannot be written.
Result<void> write_basis_glb(const std::filesystem::path& path, const BasisRecording& recording);

}  // namespace mobil::inline v0_3
