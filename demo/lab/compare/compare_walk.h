#pragma once
// One steady stride of a simulated walk, sampled as measured ones are published.

#include <optional>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/engine/error.h>
#include "demo/lab/compare/compare_judge.h"
#include "demo/lab/compare/compare_reference.h"

namespace mobil {

/// Ground reaction of the right foot in body weights, moments of the right leg in N m/kg, over the right leg's cycle.
struct StrideForces {
  CycleCurve vertical, fore_aft, hip_moment, knee_moment, ankle_moment;
  double mean_weights;  // both feet's vertical force over the stride
};

/// The right leg's cycle. Angles in degrees, heights over the ground in m; percents of the cycle.
struct WalkedStride {
  double height_m, leg_m;  // hip to ground
  double speed_m_s, step_length_m, step_frequency_hz;
  double double_support_cycle;  // one double support as a fraction of the cycle
  CycleCurve hip_from_pelvis, hip_from_vertical, knee, ankle, com_height;
  double com_mean_m, com_lowest_m, com_highest_m;
  /// Of the lowest and the highest point within a step: 0–50, from either heel strike.
  double com_lowest_percent, com_highest_percent;
  std::optional<StrideForces> forces;  // nothing where they are not simulated

  /// Null where it is not simulated. The hip as the set measures it.
  const CycleCurve* curve(GaitQuantity quantity, bool from_vertical) const;
};

/// Walks until steady and then one stride more, in ticks of 1/240 s. Errors: a body or gait out of range.
Result<WalkedStride> walk_stride(const BodyRequest& body, const GaitRequest& gait);

/// Values at rows of rising cycle phase (in cycles, from at most 0 to at least 1), at every 2 % between.
CycleCurve sample_cycle(const std::vector<double>& phase, const std::vector<double>& value);

}  // namespace mobil
