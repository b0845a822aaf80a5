#pragma once
// Common parts of the calls for skins.

#include <array>
#include <new>
#include <vector>

#include <mobil/skin_writer.h>
#include "systems/c/c_call.h"

namespace mobil::inline v0_3::c {

/// A person's pose, and vertices of muscles in the library's axes, relative to the world's origin.
struct PosedSkin {
  Pose<float> pose;
  std::array<std::vector<Vec3<float>>, 2> of_side;
};

/// Returns true for numbers of a sex and a level of detail.
constexpr bool is_skin(int sex, int detail) {
  return sex >= 0 && sex <= static_cast<int>(Sex::woman) && detail >= 0 && detail < static_cast<int>(skin_details);
}
/// Returns count(sex, detail); 0 for an unknown skin or without memory.
template <class Count>
std::size_t skin_count(int sex, int detail, Count count) noexcept try {
  return is_skin(sex, detail) ? count(static_cast<Sex>(sex), static_cast<SkinDetail>(detail)) : 0;
} catch (const std::bad_alloc&) {
  return 0;
}

/// Refuses a body of another sex than that of the triangles; a negative `sex` allows any.
int same_sex(mobil_sim& s, int sex, const BodyRequest& body);
/// Makes a request from a target, without shape and streams. `posed` must live as long as the request. `sex` is that of
/// the triangles; a negative value allows any.
int skin_person(mobil_sim& s, const mobil_skin_target& as, int sex, PosedSkin& posed, SkinRequest& to);
int skin_streams(mobil_sim& s, const mobil_skin_target& as, VertexStream& positions, VertexStream& normals);

}  // namespace mobil::inline v0_3::c
