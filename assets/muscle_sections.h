#pragma once
// Cross-sections of the leg's muscles, in the terms and from the source of leg_sections.h: centroids and ellipses of
// equal second moments, the semi-axes reduced to the measured area where a section is not an ellipse.

#include <cstddef>
#include <span>
#include <string_view>

#include "assets/leg_sections.h"
#include "components/muscle.h"
#include "components/segments.h"

namespace mobil {

inline constexpr std::size_t no_muscle = static_cast<std::size_t>(-1);

/// One muscle of the right leg from its origin (first section) to its insertion (last); the quadriceps end at the upper
/// edge of the kneecap. `lies_on`: the muscle of this list that it covers and is pushed out by.
struct MuscleShape {
  std::string_view name;
  MuscleGroup group;
  Segment origin, insertion;
  std::span<const LegSection> sections;
  std::size_t lies_on;
};

/// The eleven members of the three groups, then the calcaneal tendon.
std::span<const MuscleShape> muscle_shapes();

/// Where the measured man's kneecap stands: its upper edge's level, its centre in mm from the knee's.
inline constexpr double measured_patella_top = 0.992, measured_patella_lateral = 12, measured_patella_anterior = 40;

}  // namespace mobil
