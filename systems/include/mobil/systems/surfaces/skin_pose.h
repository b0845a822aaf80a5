#pragma once
// The rigid motions that a muscle's surface follows: those of the muscle's frame and of its two bones.

#include <mobil/components/body.h>
#include <mobil/components/muscle.h>
#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Origin, m, and rotation of a frame in the world.
struct RigidPose {
  Vec3<float> position_m;
  Quat<float> rotation;
};

/// Affine map x ↦ column[0]·x + column[1]·y + column[2]·z + column[3]. The fourth float of each column is 0.
struct AffineMap {
  alignas(16) float column[4][4];
};

/// Converts a rigid motion to an affine map.
AffineMap affine_map(const RigidPose& pose);

/// One end of a surface: its bone and the bone's position, right and left, and the attachment of the right-side
/// surface, both in the standing body (m, world). `turn` is the weight of the muscle's rotation against the bone's
/// (0–1).
struct SurfaceEnd {
  std::array<Segment, 2> bone{};
  std::array<Vec3<float>, 2> bone_m{};
  Vec3<float> attachment_m{};
  float turn = 0;
};

/// Data of a bound surface that do not depend on its vertices. `rotation` is that of the muscle's frame at rest.
struct SurfaceRest {
  Quat<float> rotation{0, 0, 0, 1};
  SurfaceEnd origin, insertion;
};
SurfaceRest surface_rest(const MuscleSurface& surface, const Body& body);

/// Scale of a body relative to the one that a surface was bound to: all lengths, additional scales of the bones of
/// origin and insertion along their axes, and the belly's mesh.
struct SurfaceScale {
  float lengths = 1, origin = 1, insertion = 1;
  BellyScale<float> belly{1, 1};
};

/// Maps from the muscle's frame, and from the standing body by the bones of origin and insertion, to the present world.
/// Held parts do not turn with the muscle. Maps of a left muscle are mirrored at x = 0. `belly` scales positions in the muscle's rest frame.
struct SkinMaps {
  AffineMap frame, origin, insertion, origin_held, insertion_held;
  BellyScale<float> belly{1, 1};
};

/// Computes the maps from the bones of one side (m, world) and the muscle's line, relative to `from_m`.
SkinMaps skin_maps(const SurfaceRest& rest, Side side, RigidPose origin, RigidPose insertion,
                   const LineOfAction<float>& line, const Vec3<float>& from_m = {0, 0, 0},
                   const SurfaceScale& scale = {});

}  // namespace mobil::inline v0_3
