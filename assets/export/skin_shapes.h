#pragma once
// Shapes of a skin for programs that blend joints' matrices, so that bones and muscles stay inside it.

#include <functional>
#include <span>
#include <vector>

#include "assets/export/figure_pieces.h"
#include "assets/export/morph_targets.h"

namespace mobil::inline v0_3 {

/// Returns the vertices of all muscles in a frame, as the file has them, in the world.
using MusclePoints = std::function<std::vector<Eigen::Vector3d>(std::size_t frame)>;

/// A skin as a shape at rest with morph targets. Columns are the vertices of all pieces that are skin, in their
/// order.
struct SkinShapes {
  MorphedSurface surface;
  double bones_moved_m = 0;  // largest displacement of a bone's vertex
};

/// Returns true if the pieces have a skin whose drawn places were recorded.
bool has_drawn_skin(std::span<const FigurePiece> pieces);

/// Returns shapes that, blended with the pieces' weights, come near the skin's drawn places in each frame, and puts the
/// pieces in the shape without targets. The shapes are the principal components (morph_targets) of the drawn places,
/// moved back by the inverse of the blended matrix. Then lifts the shape by a millimetre
/// over vertices of `muscles` that come through in any of up to 32 frames, and moves those of bones to a millimetre
/// below the skin. `standing` is the places for which the pieces are drawn.
SkinShapes skin_shapes(std::span<FigurePiece> pieces, const MusclePoints& muscles, const SkeletonKeys& skeleton,
                       const StandingPlaces& standing, int max_targets, double tolerance_m);

}  // namespace mobil::inline v0_3
