#pragma once
// A drawable surface, generated or read from a file, and the bindings of its vertices to the body.

#include <algorithm>
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

/// Tissue of a vertex; each byte is 0 to 255 for 0 to 1. `along` and `around` are texture coordinates (TexturePlace,
/// folded). `tendon` is 0 in a belly and 1 in a tendon. `aponeurosis` is 1 where the sheet in which a tendon continues
/// covers the belly. Bones have zeros.
struct Tissue {
  std::uint8_t along = 0, around = 0, tendon = 0, aponeurosis = 0;
  bool operator==(const Tissue&) const = default;
};
/// Returns the share of a tendon's colour in a vertex's colour, 0 to 1; the rest is the muscle's.
inline float tendon_colour_share(const Tissue& tissue) {
  return (std::max)(static_cast<float>(tissue.tendon), 0.6F * static_cast<float>(tissue.aponeurosis)) / 255;
}

/// Mean length and girth of a muscle's surface, m, and the angle between its fibres and the direction along it, rad.
struct FibreScale {
  float length_m = 0, girth_m = 0, pennation_rad = 0;
};

/// One vertex of a muscle surface. It has eight nodes of its lattice with trilinear weights (sum 1), and shares for the
/// lattice, and for the bones of origin and insertion as attached and as held (sum 1). A vertex that is held has no
/// share of the lattice.
struct VertexBinding {
  std::uint16_t node[8];
  float node_weight[8];
  float lattice, origin, insertion, origin_held = 0, insertion_held = 0;
};

/// A right-side muscle surface in the anatomical position, in world axes, the body standing at x = z = 0 (m). Each
/// vertex: p = lattice · frame(rest_in_lattice + Σ wᵢ uᵢ) + origin · T_origin(p₀) + insertion · T_insertion(p₀). T
/// translates with the attachment on its bone. It rotates with the bone (`…_turn` 0) or with the muscle (1). Held shares
/// move with their bone alone.
struct MuscleSurface {
  SurfaceMesh mesh;
  Segment origin = Segment::pelvis, insertion = Segment::shank_right;
  std::vector<VertexBinding> binding;
  std::vector<Vec3<float>> rest_in_lattice;  // the vertex in the muscle's rest frame, m
  Vec3<float> origin_m{}, insertion_m{};     // attachment points
  Quat<float> rest_rotation{0, 0, 0, 1};     // of the muscle's frame
  float origin_turn = 0, insertion_turn = 0;
  std::vector<float> origin_held, insertion_held;  // held share of each vertex; empty: none
};

}  // namespace mobil::inline v0_3
