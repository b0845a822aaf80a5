#pragma once
// Muscles of OpenSim's model.

#include <string>

#include <mobil/components/body.h>
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// Returns the lines of all muscles of both legs as elements of a ForceSet, at that indentation. `pelvis_origin_m` is
/// the origin of the model's pelvis in the pelvis' frame. A point is a PathPoint. An edge is a ConditionalPathPoint at
/// the knee flexions at which its path touches it with a straight hip. A path's end on the kneecap is a MovingPathPoint
/// on the tibia, with the published track as natural cubic splines of the knee's angle.
std::string opensim_muscles(const Body& body, const Eigen::Vector3d& pelvis_origin_m);

}  // namespace mobil::inline v0_3
