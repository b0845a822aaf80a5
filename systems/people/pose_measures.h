#pragma once
// What follows from a pose alone: joint angles and points of the soles, of people whose host animates them.

#include <mobil/components/body.h>
#include <mobil/components/lanes.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// The angle of a rotation's part about the x axis, −π to π.
double twist_about_x(const Quat<double>& rotation);

/// By the conventions of JointAngles. A pose has no direction of walking: the pelvis' rotation is against the chest.
JointAngles<float> joint_angles(const Pose<float>& pose);
/// Takes the centre of mass of a body whose limbs' lengths follow from its height to where limbs of their own have it:
/// each limb's own centre is as far along as in any body (Dempster, in mobil/anthropometry.h).
void move_mass_along_limbs(const BodySize<Lanes<float>>& size, const LimbLengths<Lanes<float>>& limbs,
                           const Pose<Lanes<float>>& pose, CentreOfMass<Lanes<float>>& centre);
/// Of a body of that height. `phase` is 0: a pose has none.
Feet<float> sole_points(float height_m, const Pose<float>& pose);

}  // namespace mobil::inline v0_3
