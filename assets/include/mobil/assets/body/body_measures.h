#pragma once
// Girths, breadths and depths of people by height and mass.

#include <mobil/components/body.h>

namespace mobil::inline v0_3 {

/// Measures of a standing body, m.
struct BodyMeasures {
  double thigh_girth;        // under the buttock
  double lower_thigh_girth;  // above the kneecap
  double calf_girth, ankle_girth;
  double buttock_girth, waist_girth, chest_girth, neck_girth;
  double biceps_girth, forearm_girth, wrist_girth;  // relaxed
  double hip_breadth, buttock_depth;
  double waist_breadth, waist_depth;
  double chest_breadth, chest_depth;
  double shoulder_breadth;  // over the deltoids
  double head_breadth, head_length;
  double hand_breadth, foot_length, foot_breadth;
};

/// Returns the mean measures of people of that height and mass. Each is a power of both, fitted to the survey of US
/// Army personnel ANSUR II (Gordon et al. 2014, NATICK/TR-15/007). Residual deviations are 2.5 to 6 %. Biceps and
/// forearm were measured flexed; relaxed ones are taken as 0.93 and 0.95 of them, our choice.
BodyMeasures body_measures(const BodyRequest& request);

}  // namespace mobil::inline v0_3
