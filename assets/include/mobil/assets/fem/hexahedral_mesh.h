#pragma once
// Structured blocks of eight-node hexahedra, the meshes of muscles. Nodes are numbered x fastest, z slowest, so that
// the origin face (z = 0) is the first plane of nodes and the insertion face the last.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// nx × ny × nz hexahedra over (nx+1)(ny+1)(nz+1) nodes; positions in m, in the muscle's frame (z from the origin-side
/// to the insertion-side end).
struct HexahedralMesh {
  Cells cells{};
  std::vector<Vec3<double>> node;
};

/// One cross-section of a bent block at the fraction t (0–1) of its length. The offset is that of its centre from the z
/// axis. From there the block's own x and y directions reach (semi_x, shear_y) and (shear_x, semi_y), m. Without shear
/// these are the half-widths of an ellipse along x and y.
struct LatticeStation {
  float t, offset_x_m, offset_y_m, semi_x_m, semi_y_m;
  float shear_x_m = 0, shear_y_m = 0;
};

/// Node numbers of a face's four corners, and of an element's eight.
using Quad = std::array<std::uint32_t, 4>;
using Hexahedron = std::array<std::uint32_t, 8>;

/// Largest block that is accepted; the couplings of a node take about 3 kB.
inline constexpr std::uint32_t largest_mesh_nodes = 40000;

/// Returns the number of nodes of one cross-section, (nx+1)(ny+1).
constexpr std::uint32_t plane_nodes(const Cells& cells) {
  return (cells[0] + 1) * (cells[1] + 1);
}
/// Returns the number of nodes of the block.
constexpr std::uint32_t node_count(const Cells& cells) {
  return plane_nodes(cells) * (cells[2] + 1);
}
/// Returns the number of elements of the block.
constexpr std::uint32_t element_count(const Cells& cells) {
  return cells[0] * cells[1] * cells[2];
}
/// Returns the number of the node at the grid place (i, j, k), each from 0 to the cells in that direction.
constexpr std::uint32_t node_index(const Cells& cells, std::uint32_t i, std::uint32_t j, std::uint32_t k) {
  return (k * (cells[1] + 1) + j) * (cells[0] + 1) + i;
}

/// Returns the first node of the insertion face, whose plane_nodes(cells) nodes extend to the end of the mesh.
constexpr std::uint32_t first_insertion_node(const Cells& cells) {
  return plane_nodes(cells) * cells[2];
}

/// Returns the eight nodes of an element (x fastest): counter-clockwise round its lower face, then round its upper.
Hexahedron element_nodes(const Cells& cells, std::uint32_t element);

/// Returns the block's boundary as quadrilaterals wound outwards.
std::vector<Quad> boundary_quads(const Cells& cells);

/// Returns the insertion face's quadrilaterals, wound towards +z.
std::vector<Quad> insertion_quads(const Cells& cells);

/// Returns the middle node of the insertion face, or the two or four nearest if cells are odd across.
std::vector<std::uint32_t> insertion_centre(const Cells& cells);

/// Ratio of element lengths in the middle of a block to those at its ends (`along`) or edges (`across`, in x and y),
/// with geometric growth in between. Ever finer blocks approach the ratio; n elements have the power 1 − 2/n of it. A
/// block of twice the elements has all nodes of the other. 1 is uniform; above 1 is finer towards the boundary.
struct Grading {
  double across = 1, along = 1;
};

/// Makes a block of cubes of edge `cell_size_m`, centred on the z axis, z from 0; graded elements fill the same block.
/// Fails outside 1–256 cells a side, beyond `largest_mesh_nodes`, for a size outside 1e-6–10 m or a grading outside
/// 0.01–100.
Result<HexahedralMesh> make_block(const Cells& cells, double cell_size_m, const Grading& grading = {});

/// Fails unless each is from 1 to 256 and the nodes are at most largest_mesh_nodes.
Result<void> check_cells(const Cells& cells);

/// Makes a belly along z from 0 to `length_m` with rounded cross-sections through the stations (t ascending from 0 to
/// 1, linear between them). A section blends a square grid with its elliptical image (2 : 3), so that its edges'
/// middles touch the ellipse and its corners stay elements. Fails on a bad station or grading, or on an inverted or
/// flat element, which the error names.
Result<HexahedralMesh> bend_block(const Cells& cells, std::span<const LatticeStation> stations, double length_m,
                                  const Grading& grading = {});

/// Returns a template's mesh at one person's size.
template <class F>
HexahedralMesh scaled(HexahedralMesh mesh, const BellyScale<F>& by) {
  const auto across = static_cast<double>(by.across), along = static_cast<double>(by.along);
  for (Vec3<double>& node : mesh.node) {
    node.x *= across;
    node.y *= across;
    node.z *= along;
  }
  return mesh;
}

/// Returns the volume enclosed by the trilinear elements, m³ (exact).
double volume(const HexahedralMesh& mesh);

/// Scaled Jacobian below which elements are refused as flat.
inline constexpr double min_scaled_jacobian = 1e-3;

/// Returns the minimum over the eight corners of det(e₁,e₂,e₃) / (|e₁||e₂||e₃|): 1 for a box, 0 or less if inverted.
double scaled_jacobian(const HexahedralMesh& mesh, std::uint32_t element);
double smallest_scaled_jacobian(const HexahedralMesh& mesh);

/// Returns "element 8 (cell 0,0,2 of 2x2x3)", for messages.
std::string element_label(const Cells& cells, std::uint32_t element);

/// Fails on an inverted or flat element, which the error names.
Result<void> check_elements(const HexahedralMesh& mesh);

}  // namespace mobil::inline v0_3
