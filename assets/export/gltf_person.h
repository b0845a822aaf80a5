#pragma once
// One person of a GLB: the joints under a root, the skin, and the meshes that follow it.

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/gltf_writer.h>
#include "assets/export/figure_pieces.h"
#include "assets/export/gltf_buffers.h"
#include "assets/export/recorded_people.h"
#include "assets/export/skeleton_keys.h"
#include "assets/export/unique_names.h"

namespace mobil::inline v0_3 {

/// A figure's surfaces, written once for all people who share it: a primitive for each cloth (without its material), in
/// the standing place of the first person.
struct GltfFigure {
  StandingPlaces standing_m;
  std::vector<std::size_t> cloth;  // of each primitive
  std::vector<std::string> name;   // its name
  std::vector<bool> rigid;         // true for bones
  std::vector<tinygltf::Primitive> primitive;
  std::vector<std::vector<float>> skin_weight;  // [frame][morph target] of the skin; empty without drawn places
};

/// A scene being written.
struct GltfScene {
  GltfDraft draft;
  GltfAnimation animation;
  tinygltf::Scene scene;
  UniqueNames names, material_names;
  std::map<std::pair<std::string, std::array<float, 3>>, int> materials;  // by use and colour
  std::map<std::size_t, GltfFigure> figures;                              // by their number
};

/// Adds a person: nodes, skin, meshes and channels of the animation. All names begin with `prefix`. Fails on a surface
/// whose triangles have no area.
Result<void> add_person(GltfScene& scene, const SeenPerson& person, const SeenFigure& figure, const std::string& prefix,
                        const ExportOptions& options, ExportReport& report);

}  // namespace mobil::inline v0_3
