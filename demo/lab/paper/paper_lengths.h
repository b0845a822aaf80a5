#pragma once
// Published lengths of leg muscles over the gait cycle.

#include <string>
#include <string_view>
#include <vector>

#include <mobil/engine/error.h>
#include "demo/pictures/cycle_curve.h"

namespace mobil {

/// Length from origin to insertion over that in the anatomical position, as the paths of the gait2392 model have it on
/// measured joint angles; the deviation is that of the angles, carried over. Without one (`sd` zero) where none was
/// published.
struct PublishedLength {
  std::string muscle;  // hamstrings, rectus_femoris, gastrocnemius, soleus, tibialis_anterior
  MeasuredCurve curve;
};

/// All of one walk: opensim_normal_gait, schwartz_slow, schwartz_free or schwartz_fast; from the table that the program
/// carries. Error: the table is not as it should be.
Result<std::vector<PublishedLength>> read_published_lengths(std::string_view walk);

}  // namespace mobil
