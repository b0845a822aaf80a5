#pragma once
// A drawable surface, generated or read from a file, and the bindings of its vertices to the body.

#include <cstdint>
#include <string>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/components/segments.h>

namespace mobil::inline v0_3 {

/// Triangles wound outwards (counter-clockwise seen from outside). Positions in m.
struct SurfaceMesh {
  std::string name;
  std::vector<Vec3<float>> position;
  std::vector<std::uint32_t> triangle;  // three indices each
};

/// A surface fixed to one segment; positions in that segment's frame.
struct BoneSurface {
  Segment segment = Segment::pelvis;
  SurfaceMesh mesh;
};

/// One vertex of a muscle surface. It has eight nodes of its lattice with trilinear weights (sum 1), and shares for the
/// lattice, the bone of origin and the bone of insertion (sum 1).
struct VertexBinding {
  std::uint16_t node[8];
  float node_weight[8];
  float lattice, origin, insertion;
};

/// A right-side muscle surface in the anatomical position, in world axes, the body standing at x = z = 0 (m). Each
/// vertex: p = lattice · frame(rest_in_lattice + Σ wᵢ uᵢ) + origin · T_origin(p₀) + insertion · T_insertion(p₀). T
/// translates with the attachment on its bone. It rotates with the bone (`…_turn` 0) or with the muscle (1).
struct MuscleSurface {
  SurfaceMesh mesh;
  Segment origin = Segment::pelvis, insertion = Segment::shank_right;
  std::vector<VertexBinding> binding;
  std::vector<Vec3<float>> rest_in_lattice;  // the vertex in the muscle's rest frame, m
  Vec3<float> origin_m{}, insertion_m{};  // attachment points
  Quat<float> rest_rotation{0, 0, 0, 1};  // of the muscle's frame
  float origin_turn = 0, insertion_turn = 0;
};

}  // namespace mobil::inline v0_3
