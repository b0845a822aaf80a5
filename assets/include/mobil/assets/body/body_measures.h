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

/// Returns the mean measures of people of that height, mass, sex and age. Each is a power of both, fitted to the survey
/// of US Army personnel ANSUR II (Gordon et al. 2014, NATICK/TR-15/007). Residual deviations are 2.5 to 6 %. Biceps and
/// forearm were measured flexed; relaxed ones are taken as 0.93 and 0.95 of them, our choice. Girths of the trunk and
/// legs change linearly with age from 18 to 65 years, as in the survey's people of equal height and mass (18 to 58
/// years). Children's powers are the adults'. Their waist is 1.4 % larger for each year below 16, and their head is the
/// median adult's times ratios of girths (UK 1990 reference). Their shoulders follow the skeleton.
BodyMeasures body_measures(const BodyRequest& request);
/// Returns all measures `by` times as large.
BodyMeasures scaled(const BodyMeasures& measures, double by);

}  // namespace mobil::inline v0_3
