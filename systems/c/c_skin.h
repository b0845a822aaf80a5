#pragma once
// Common parts of the calls for skins.

#include <array>
#include <vector>

#include <mobil/skin_writer.h>
#include "systems/c/c_call.h"

namespace mobil::inline v0_3::c {

/// A person's pose, and vertices of muscles in the library's axes, relative to the world's origin.
struct PosedSkin {
  Pose<float> pose;
  std::array<std::vector<Vec3<float>>, 2> of_side;
};

/// Makes a request from a target, without shape and streams. `posed` must live as long as the request. `sex` is that of
/// the triangles; a negative value allows any.
int skin_person(mobil_sim& s, const mobil_skin_target& as, int sex, PosedSkin& posed, SkinRequest& to);
int skin_streams(mobil_sim& s, const mobil_skin_target& as, VertexStream& positions, VertexStream& normals);

}  // namespace mobil::inline v0_3::c
