#pragma once
// The surfaces of one body, bound to its bones and to the meshes of its muscles: made once, immutable, good for every
// person of that body.

#include <array>
#include <cstdint>
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

/// Which surfaces. Of muscles those that one of `simulated` drives (the muscle itself, else its group), with tendons;
/// `cells` of their meshes. Both as in the LegMuscles of the people who are to show them.
struct SurfaceChoice {
  bool bones = true;
  std::array<bool, 2> sides = {true, true};  // by Side; what lies in the middle is there with either
  MuscleSet simulated = muscle_groups();
  Cells cells = {2, 2, 8};
  /// For the middle distance: the part of the triangles that are kept of each piece (assets/surfaces/
  /// coarser_surface.h), before it is bound; 1: all that are drawn. A third is off by half a millimetre in the mean, a
  /// tenth by 1.5, where small pieces may go.
  double detail = 1;
  /// Texture coordinates, and tangents where they are asked for.
  bool textured = false;
};

/// A muscle's mesh at rest in one body, right side: in the muscle's frame, and the frame.
struct RestMesh {
  HexahedralMesh lattice;
  RestFrame frame;
  double min_passage_m;  // for bind_muscle
};
/// Errors: cells out of range.
Result<RestMesh> rest_mesh(const Body& body, Muscle muscle, const Cells& cells);

/// A right-hand surface bound (mobil/assets/surfaces/surface_binding.h) to the mesh of the muscle that drives it.
struct DrivenSurface {
  Muscle driver{};
  MuscleSurface surface;
};

/// What a body is drawn with, before it is bound: generated, or read from files.
struct DrawnSurfaces {
  std::vector<BoneSurface> bones;      // both sides
  std::vector<DrivenSurface> muscles;  // right side
};
/// Generated from published dimensions. Errors: as rest_mesh; `detail` outside 0.05 to 1.
Result<DrawnSurfaces> draw_surfaces(const Body& body, const SurfaceChoice& choice);

/// One piece of what comes out: a bone, or a muscle or tendon of one side. Its vertices and indices lie together.
struct SurfacePart {
  std::string name;  // T4, thigh_left, soleus_right
  Segment segment{};
  std::optional<Muscle> driver;  // of a muscle: whose mesh it follows
  Side side = Side::right;       // of a bone in the middle: right
  std::uint32_t first_vertex = 0, vertices = 0;
  std::uint32_t first_index = 0, indices = 0;
};

/// Bones in the order of their list, then muscles, of each right and left. Vertices are in the order of their meshes.
struct BodySurfaces {
  std::vector<SurfacePart> part;
  std::vector<std::uint32_t> index;   // three a triangle, of vertices of the whole body, wound outwards
  std::vector<TexturePlace> texture;  // by vertex, folded, where the choice was textured
  std::uint32_t vertices = 0;

  // What follows is for SurfaceWriter.
  struct Driver {
    Muscle muscle{};
    BellyScale<float> scale{};  // of the body that it is bound to
    std::uint32_t nodes = 0;
    std::vector<float> along;  // of each node: how far along the belly, 0–1
  };
  struct Piece {
    std::variant<RigidSurface, PackedSurface> surface;
    std::size_t driver = 0;
    std::array<std::optional<std::uint32_t>, 2> part{};  // by side; of a bone the first
  };
  float height_m = 0;
  LimbLengths<float> limbs{};
  std::array<bool, 2> sides{};
  std::vector<Driver> driver;
  std::vector<Piece> piece;
  std::size_t max_nodes = 0, max_places = 0;
};

/// What makes the surfaces of one body those of another: few numbers, so that a crowd shares what was bound once.
struct SurfaceFit {
  float lengths = 1;                     // over those of the body bound
  LimbLengths<float> limbs{1, 1, 1, 1};  // along themselves, besides
  std::vector<BellyScale<float>> belly;  // the same of the meshes, by driver
};

/// Of surfaces that were bound to one body, for another one: bones are as much longer and wider as the body is taller,
/// limbs of their own as long as they are, bellies grow with their meshes, and tendons go from the one to the other.
/// Two microseconds. Against surfaces drawn for that body bones are where they were, and muscles off by less than a
/// millimetre in the mean where its build is alike; by four where an athlete shows those of a usual build, for muscles
/// are drawn away from their bones (surface_fit_test): bind one body of each build. `body` is one that `make_body`
/// made.
SurfaceFit fit_surfaces(const BodySurfaces& bound, const Body& body);

/// Binds. To draw and to bind one body takes some tens of milliseconds, two thirds of it drawing; a crowd shares what
/// is bound for one (fit_surfaces). Errors, in one line: a mesh of cells that is refused; a surface that is not bound
/// to its driver's mesh, has more than 32,768 places (packed_surface.h), or triangles of vertices that are not there.
Result<BodySurfaces> bind_surfaces(const Body& body, const DrawnSurfaces& drawn, const SurfaceChoice& choice);
Result<BodySurfaces> bind_surfaces(const Body& body, const SurfaceChoice& choice = {});

}  // namespace mobil::inline v0_3
