#pragma once
// The table's muscles as they are drawn: from bone to bone, with the calcaneal tendon they share.

#include <cstddef>
#include <string_view>
#include <vector>

#include "assets/muscles/leg_sections.h"
#include "components/muscle.h"
#include "components/segments.h"

namespace mobil {

inline constexpr std::size_t no_muscle = static_cast<std::size_t>(-1);

/// One muscle of the right leg from its origin (first section) to its insertion (last); the quadriceps end at the upper
/// edge of the kneecap, gastrocnemius and soleus in the calcaneal tendon. `lies_on`: the muscle of this list that it
/// covers and is pushed out by. `ends_in`: the tendon of this list that it goes on in.
struct MuscleShape {
  std::string_view name;
  Muscle group;
  Segment origin, insertion;
  std::vector<LegSection> sections;
  std::size_t lies_on, ends_in;
};

/// The members in the order of member_muscles(), with their sections (muscle_sections.h) led on to where they are
/// attached; then the calcaneal tendon.
std::vector<MuscleShape> muscle_shapes();

/// Where the measured man's kneecap stands: its upper edge's level, its centre in mm from the knee's.
inline constexpr double measured_patella_top = 0.992, measured_patella_lateral = 12, measured_patella_anterior = 40;

}  // namespace mobil
