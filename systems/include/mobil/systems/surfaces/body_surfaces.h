#pragma once
// The surfaces of one body, bound to its bones and to the meshes of its muscles. They are made once, immutable, and
// usable for all people with that body.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/assets/surfaces/surface_binding.h>
#include <mobil/assets/surfaces/texture_places.h>
#include <mobil/components/body.h>
#include <mobil/components/muscle.h>
#include <mobil/components/surface.h>
#include <mobil/engine/error.h>
#include <mobil/muscle_table.h>
#include <mobil/systems/surfaces/packed_surface.h>

namespace mobil::inline v0_3 {

class LegBones;  // assets/surfaces/leg_bones.h

/// Selection of surfaces. Muscles and their tendons are included if a muscle in `simulated` drives them: the muscle
/// itself or its group. `simulated` and `cells` must be those of the people's LegMuscles.
struct SurfaceChoice {
  bool bones = true;
  std::array<bool, 2> sides = {true, true};  // by Side; bones in the middle belong to both
  MuscleSet simulated = usual_muscles();
  Cells cells = {2, 2, 8};
  /// Fraction of the triangles of each piece that is kept before binding, for medium distances (assets/surfaces/
  /// coarser_surface.h). The mean error is 0.5 mm at a third and 1.5 mm at a tenth, at which small pieces can vanish.
  double detail = 1;
  /// True for texture coordinates, and for tangents if requested.
  bool textured = false;
  /// Moves muscle vertices that would be within the drawn bones of the pose onto their surface (generated surfaces of
  /// the pelvis and the legs). Takes twice as long as writing the muscles without it, in addition.
  bool clear_of_bones = true;
};

/// A muscle's mesh at rest in one body, right side, in the muscle's frame, and that frame.
struct RestMesh {
  HexahedralMesh lattice;
  RestFrame frame;
  double min_passage_m;  // for bind_muscle
};
/// Makes a muscle's mesh at rest. Errors: cells out of range.
Result<RestMesh> rest_mesh(const Body& body, Muscle muscle, const Cells& cells);

/// A right-side surface bound (mobil/assets/surfaces/surface_binding.h) to the mesh of the muscle that drives it.
struct DrivenSurface {
  Muscle driver{}, muscle{};  // `muscle` is the surface's own, or the group of a tendon
  MuscleSurface surface;
  std::vector<float> tendon = {};  // of each vertex, 0 in the belly to 1 in the tendon; empty: where it is thin
};

/// Surfaces of a body before they are bound: generated, or read from files.
struct DrawnSurfaces {
  std::vector<BoneSurface> bones;                      // both sides
  std::vector<DrivenSurface> muscles;                  // right side
  std::shared_ptr<const LegBones> clear_of = nullptr;  // bones that muscles do not enter; null: they can
};
/// Generates surfaces from published dimensions. Errors: those of rest_mesh, a `detail` outside 0.05 to 1.
Result<DrawnSurfaces> draw_surfaces(const Body& body, const SurfaceChoice& choice);

/// One piece of the output: a bone, or a muscle or tendon of one side. Its vertices and indices are contiguous.
struct SurfacePart {
  std::string name;  // T4, thigh_left, soleus_right
  Segment segment{};
  std::optional<Muscle> driver;  // muscle whose mesh it follows; empty for bones
  Side side = Side::right;       // right for bones in the middle
  std::uint32_t first_vertex = 0, vertices = 0;
  std::uint32_t first_index = 0, indices = 0;
  FibreScale fibres{};  // of a muscle
};

/// Bound surfaces: bones in the order of their list, then muscles, each right and left. Vertices keep the order of
/// their meshes.
struct BodySurfaces {
  std::vector<SurfacePart> part;
  std::vector<std::uint32_t> index;   // three per triangle, into all vertices of the body, wound outwards
  std::vector<TexturePlace> texture;  // by vertex, folded; empty if not textured
  std::vector<Tissue> tissue;         // by vertex
  std::uint32_t vertices = 0;

  // The rest is for SurfaceWriter.
  struct Driver {
    Muscle muscle{};
    BellyScale<float> scale{};  // of the bound body
    std::uint32_t nodes = 0;
    std::vector<float> along;  // position of each node along the belly, 0–1
  };
  struct Piece {
    std::variant<RigidSurface, PackedSurface> surface;
    std::size_t driver = 0;
    std::array<std::optional<std::uint32_t>, 2> part{};  // by side; bones use the first
  };
  std::array<Vec3<float>, segment_count> bone_scale{};  // m per mm of the drawn man
  std::array<bool, 2> sides{};
  std::vector<Driver> driver;
  std::vector<Piece> piece;
  std::size_t max_nodes = 0, max_places = 0;
  std::shared_ptr<const LegBones> clear_of = nullptr;
};

/// Scales that fit the surfaces of one body to another one, so that a crowd can share bound surfaces.
struct SurfaceFit {
  std::array<Vec3<float>, segment_count> bone{};  // scale of each segment's bones along its axes
  std::vector<BellyScale<float>> belly;           // scale of each driver's mesh
};

/// Computes the fit of bound surfaces to another body made by `make_body`, in 4 µs, or up to 16 µs for children and
/// individual limb lengths. Bones scale with the lengths of their segments. Bellies scale with their meshes, and
/// tendons connect both. Compared with surfaces generated for that body, bones are exact. Muscles have a mean error
/// below 1 mm for a similar build, and of 4 mm for an athlete with surfaces of a usual build, because muscles are drawn
/// away from their bones (surface_fit_test). Bind one body of each build.
SurfaceFit fit_surfaces(const BodySurfaces& bound, const Body& body);

/// Binds surfaces to a body; the second function generates them first. Both steps take some tenths of a second, most
/// of it generation, and the first call a second more: it shapes the bones. A crowd can share the result
/// (fit_surfaces). Errors: refused cells; a surface that is not bound to its driver's mesh, has more than 32,768 places
/// (packed_surface.h), or has vertex indices out of range.
Result<BodySurfaces> bind_surfaces(const Body& body, const DrawnSurfaces& drawn, const SurfaceChoice& choice);
Result<BodySurfaces> bind_surfaces(const Body& body, const SurfaceChoice& choice = {});

}  // namespace mobil::inline v0_3
