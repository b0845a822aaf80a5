#pragma once
// Measures of posed people that follow from the pose: joint angles, points of the soles, centre of mass of own limbs.

#include <mobil/components/body.h>
#include <mobil/components/lanes.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// Returns the angle of a rotation's twist about the x axis, −π to π.
double twist_about_x(const Quat<double>& rotation);

/// Returns angles as in JointAngles. A pose has no walking direction, so the pelvis' rotation is relative to the chest.
JointAngles<float> joint_angles(const Pose<float>& pose);
/// Corrects the centre of mass for own limb lengths; on entry it is that of limbs whose lengths follow from height.
/// Each limb's own centre keeps its relative position along the limb (Dempster, in mobil/anthropometry.h).
void move_mass_along_limbs(const BodySize<Lanes<float>>& size, const LimbLengths<Lanes<float>>& limbs,
                           const Pose<Lanes<float>>& pose, CentreOfMass<Lanes<float>>& centre);
/// Returns the points of the soles of a body of that height. `phase` is 0, because a pose has none.
Feet<float> sole_points(float leg_scale_m, const Pose<float>& pose);

}  // namespace mobil::inline v0_3
