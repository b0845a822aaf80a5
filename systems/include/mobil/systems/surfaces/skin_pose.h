#pragma once
// The rigid motions that a surface follows: its muscle's frame and its two bones.

#include <mobil/components/body.h>
#include <mobil/components/muscle.h>
#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Where a frame is in the world: its origin, m, and its rotation.
struct RigidPose {
  Vec3<float> position_m;
  Quat<float> rotation;
};

/// x ↦ column[0]·x + column[1]·y + column[2]·z + column[3]; four floats each, the last one 0.
struct AffineMap {
  alignas(16) float column[4][4];
};

/// The same motion as an affine map.
AffineMap affine_map(const RigidPose& pose);

/// One end of a surface: its bone (right side, left side), where that lies in the standing body (m, world), where the
/// right-hand surface is attached (m, world, the body standing), and how far its end turns with the muscle instead of
/// the bone (0–1).
struct SurfaceEnd {
  std::array<Segment, 2> bone{};
  std::array<Vec3<float>, 2> bone_m{};
  Vec3<float> attachment_m{};
  float turn = 0;
};

/// What of a bound surface does not depend on its vertices. `rotation`: of the muscle's frame at rest.
struct SurfaceRest {
  Quat<float> rotation{0, 0, 0, 1};
  SurfaceEnd origin, insertion;
};
SurfaceRest surface_rest(const MuscleSurface& surface, const Body& body);

/// How much larger a body is than the one that a surface was bound to: all its lengths, times this the bones
/// of origin and insertion along their own axes, and its belly's mesh.
struct SurfaceScale {
  float lengths = 1, origin = 1, insertion = 1;
  BellyScale<float> belly{1, 1};
};

/// From the muscle's frame, and from the standing body by its bones of origin and insertion, to where they are now. Of
/// a left muscle all in the mirror image, x = 0 being the mirror. `belly`: of places in the muscle's rest frame.
struct SkinMaps {
  AffineMap frame, origin, insertion;
  BellyScale<float> belly{1, 1};
};

/// Where the bones of one side are now (m, world) and the muscle's line; `from_m` is subtracted from all positions.
SkinMaps skin_maps(const SurfaceRest& rest, Side side, RigidPose origin, RigidPose insertion,
                   const LineOfAction<float>& line, const Vec3<float>& from_m = {0, 0, 0},
                   const SurfaceScale& scale = {});

}  // namespace mobil::inline v0_3
