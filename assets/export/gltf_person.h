#pragma once
// One person of a GLB: the joints under a root, the skin, and the meshes that follow it.

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/gltf_writer.h>
#include "assets/export/gltf_buffers.h"
#include "assets/export/recorded_people.h"
#include "assets/export/skeleton_keys.h"
#include "assets/export/unique_names.h"

namespace mobil::inline v0_3 {

/// A figure's surfaces, written once for all who look like that: a primitive for each cloth (without its material), in
/// the places where the first of them stands.
struct GltfFigure {
  std::array<Eigen::Vector3d, segment_count> standing_m;
  std::vector<std::size_t> cloth;  // of each primitive
  std::vector<std::string> name;   // and what it is
  std::vector<bool> rigid;         // and whether it is of bones
  std::vector<tinygltf::Primitive> primitive;
};

/// A scene under way.
struct GltfScene {
  GltfDraft draft;
  GltfAnimation animation;
  tinygltf::Scene scene;
  UniqueNames names, material_names;
  std::map<std::pair<std::string, std::array<float, 3>>, int> materials;  // by what is made of it, and colour
  std::map<std::size_t, GltfFigure> figures;                              // by their number
};

/// Adds a person: nodes, skin, meshes and channels of the animation. Names of all begin with `prefix`. Errors: a
/// surface whose triangles have no area.
Result<void> add_person(GltfScene& scene, const SeenPerson& person, const SeenFigure& figure, const std::string& prefix,
                        const ExportOptions& options, std::vector<MuscleFidelity>& fidelity);

}  // namespace mobil::inline v0_3
