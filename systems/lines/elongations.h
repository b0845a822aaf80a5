#pragma once
// Elongation of the lines of action of unseen muscles: only their lengths, without force and frame.

#include <cstddef>
#include <span>

#include <mobil/components/leg_frames.h>
#include <mobil/components/muscle.h>
#include "systems/lines/muscle_lines.h"

namespace mobil::inline v0_3 {

/// Returns the lines of a muscle in the table. They are built once and shared by all people.
const MuscleLines& lines_of(Muscle muscle);

/// Returns the part of a line's length that no joint changes, m: segments on one bone, for a leg of that size.
double constant_length_m(const MuscleLines& lines, const LegScale<float>& scale);

/// Elongations L − L₀ of several muscles of a leg, m, within 4 µm of those of `lines_of_action`. `slack_m` contains
/// their rest lengths minus the constant lengths. A NaN stays in its lane.
struct ElongatedLine {
  const MuscleLines* lines;
  const Lanes<float>* slack_m;
  Lanes<float>* elongation_m;
};
void elongations(std::span<const ElongatedLine> muscles, const LegScale<Lanes<float>>& scale,
                 const KneeFrame<Lanes<float>>& leg);

}  // namespace mobil::inline v0_3
