#pragma once
// The muscles of the right leg as rows of sections, before they are fitted to a body.

#include <cstddef>
#include <string_view>
#include <vector>

#include <mobil/assets/muscles/leg_sections.h>
#include <mobil/components/body.h>
#include <mobil/components/muscle.h>
#include <mobil/components/segments.h>

namespace mobil::inline v0_3 {

inline constexpr std::size_t no_muscle = static_cast<std::size_t>(-1);

/// A member as drawn on the right leg, from its origin (first section) to its insertion (last), the calcaneal tendon or
/// a sheet (MemberMuscle). It covers the shape `lies_on` and ends at the shape `cut_back_to`. `ends_in` is the tendon
/// or sheet that continues it.
struct MuscleShape {
  std::string_view name;
  Muscle group, muscle;
  Segment origin, insertion;
  std::vector<LegSection> sections;
  SectionPlanes planes;
  double volume_m3 = 0;
  std::size_t lies_on = no_muscle, cut_back_to = no_muscle, ends_in = no_muscle;
  bool sheet = false;
};

/// Returns the single muscles in the order of member_muscles(), then the calcaneal tendon, and sheets if requested.
std::vector<MuscleShape> muscle_shapes(const Body& body, const LegFrame& leg, bool with_sheets);

}  // namespace mobil::inline v0_3
