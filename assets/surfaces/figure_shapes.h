#pragma once
// People as they look from afar: smooth bodies of one shape a segment.

#include <cstdint>
#include <vector>

#include "components/body.h"
#include "components/surface.h"

namespace mobil {

/// What covers a part of the figure.
enum class Cloth : std::uint8_t { skin, shirt, trousers, shoes };
inline constexpr std::size_t cloth_count = 4;
Cloth cloth_of(Segment segment);

/// Surfaces in the frames of their segments, m, wound outwards, closed but for a pinhole at either end; kneecaps have
/// none. Joints are covered by shapes that reach into each other.
std::vector<BoneSurface> make_figure_shapes(const Body& body);

}  // namespace mobil
