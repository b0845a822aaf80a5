#pragma once
// Writes a belly that moves along a few modes as GLB: its boundary, the modes as morph targets, its modal coordinates
// as their weights over time. Any viewer with morph targets shows it.

#include <filesystem>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// `target` is the displacement of every node (three each, x fastest, m) per unit of each coordinate. `weight` has a
/// row per frame with one number per target. Viewers are only required to show 8 targets.
struct BasisRecording {
  HexahedralMesh mesh;
  std::vector<std::vector<float>> target;
  std::vector<std::vector<float>> weight;
  float frame_s = 0;
};

/// Writes `path`, completely or not at all. Targets are scaled so that no weight of the recording exceeds 1. Fails
/// without frames or targets, on rows of other lengths, numbers that are not finite, or if the file cannot be written.
Result<void> write_basis_glb(const std::filesystem::path& path, const BasisRecording& recording);

}  // namespace mobil::inline v0_3
