#pragma once
// Ends of drawn muscles on their bones.

#include <cstddef>
#include <vector>

#include <mobil/components/segments.h>
#include <mobil/components/surface.h>
#include "assets/surfaces/leg_bones.h"

namespace mobil::inline v0_3 {

/// Layout of a lofted muscle: a pole, `cap` rings of its rounded end, `rings` rings of its body, `cap` rings and a
/// pole, each ring of `segments` vertices.
struct TubeLayout {
  std::size_t rings, segments, cap;
  std::size_t all_rings() const { return rings + 2 * cap; }
  std::size_t vertex(std::size_t ring) const { return 1 + ring * segments; }
};

enum class TubeEnd : bool { origin, insertion };

/// Spreads the end of a lofted muscle on its bone. Its last ring becomes a footprint on the bone's surface, the rounded
/// end beyond sinks into the bone, and the rings before follow, the less the farther they are.
void spread_end(const LegBones& bones, Segment bone, TubeEnd end, const TubeLayout& layout, SurfaceMesh& mesh);

/// Returns the share of each vertex that follows its bone rigidly: 1 at the footprint and beyond it, 0 from the third
/// ring on.
std::vector<float> held_shares(TubeEnd end, const TubeLayout& layout, std::size_t vertices);

}  // namespace mobil::inline v0_3
