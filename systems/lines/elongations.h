#pragma once
// How far the lines of muscles that nobody looks at are drawn out: their lengths alone, without force and frame.

#include <cstddef>
#include <span>

#include <mobil/components/leg_frames.h>
#include <mobil/components/muscle.h>
#include "systems/lines/muscle_lines.h"

namespace mobil::inline v0_3 {

/// The lines of each of the table's muscles: the same for everybody, made once.
const MuscleLines& lines_of(Muscle muscle);

/// The part of a line's length that no joint changes, m: segments between points of one bone, of a leg of that size.
double constant_length_m(const MuscleLines& lines, const LegScale<float>& scale);

/// L − L₀ of several muscles of a leg, m, within 4 µm of `lines_of_action`'s. `slack_m`: their rest lengths less the
/// constant ones. A NaN stays in its lane.
struct ElongatedLine {
  const MuscleLines* lines;
  const Lanes<float>* slack_m;
  Lanes<float>* elongation_m;
};
void elongations(std::span<const ElongatedLine> muscles, const LegScale<Lanes<float>>& scale,
                 const KneeFrame<Lanes<float>>& leg);

}  // namespace mobil::inline v0_3
