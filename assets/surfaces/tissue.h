#pragma once
// Tendon, aponeurosis and direction of fibres on the surface of a muscle.

#include <span>
#include <vector>

#include <mobil/assets/surfaces/texture_places.h>
#include <mobil/components/body.h>
#include <mobil/components/muscle.h>
#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Returns the share of tendon, 0 to 1, where a muscle's section has that part of the area of its largest.
double tendon_share(double relative_area);

struct MuscleTissue {
  std::vector<Tissue> vertex;
  FibreScale fibres;
};

/// Returns the tissue of each vertex of a right-side surface with valid indices in the anatomical position, the body
/// standing at x = z = 0 (m, world axes). `place` has its texture coordinates, not folded, and `tendon` its shares, 0
/// to 1. Without shares a vertex is in a tendon where the surface is thin.
///
/// An aponeurosis is the part of a tendon inside the belly. It begins where the free tendon ends and has the slack
/// length of the published tendon (mobil/muscle_table.h) less the free tendons' length, narrowing to its tip. That of
/// the insertion is on the side of the bone if the muscle covers another one, else on the outside. That of the origin
/// is on the opposite side, because fibres run from one to the other. Muscles with parallel fibres have none.
MuscleTissue muscle_tissue(const Body& body, Muscle muscle, const SurfaceMesh& mesh,
                           std::span<const TexturePlace> place, std::span<const float> tendon);

}  // namespace mobil::inline v0_3
