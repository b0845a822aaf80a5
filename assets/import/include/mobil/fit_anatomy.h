#pragma once
// An anatomy fitted to one body's skeleton, bone by bone from the joint centres.

#include <optional>
#include <vector>

#include <mobil/assets/import/anatomy_folder.h>
#include <mobil/assets/surfaces/surface_binding.h>
#include <mobil/components/body.h>
#include <mobil/components/muscle.h>
#include <mobil/components/surface.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// A right-hand muscle (or the tendon) with the muscles whose meshes can drive it, its own or its group's. `origin_m`
/// and `insertion_m` are the folder's attachments, m, in the frame of the surface. `attachments` are those, or else the
/// surface's ends. They change places if they run against the muscle's line. A muscle that runs past the kneecap ends on
/// the shank, a mesh that ends well above the knee on the thigh.
struct FittedMuscle {
  Muscle group, muscle;
  MuscleSurface surface;
  std::optional<Vec3<float>> origin_m, insertion_m;
  Attachments attachments{};
};

/// Fitted meshes. `bones` are of both sides, the left mirroring the right, each in its segment's frame (names end in
/// _right, _left). `muscles` are of the right side, in world axes, the body in the anatomical position at x = z = 0;
/// not bound to a lattice yet. `others` are further muscles, of no group, placed alike, as are `skins`.
struct FittedAnatomy {
  std::vector<BoneSurface> bones;
  std::vector<FittedMuscle> muscles;
  std::vector<MuscleSurface> others;
  std::vector<SurfaceMesh> skins;
};

/// Part of a muscle's surface beyond the kneecap, and the ends of the ligament in it.
struct Ligament {
  MuscleSurface surface;
  Attachments ends;
};

/// Cuts a surface that runs past the kneecap in two there; both parts have the vertices of the cut. The first ends on
/// the kneecap, the returned one continues to the shank. Others do not change. Bind the second with bind_beyond.
std::optional<Ligament> cut_at_kneecap(FittedMuscle& muscle, const Body& body);

/// Fits an anatomy to a body. Joint centres coincide with the body's, and the lowest point of the foot's bones is on
/// the ground; bone_maps defines the stretch of each bone. Fails with one line on a body without positive lengths.
Result<FittedAnatomy> fit_anatomy(const Anatomy& anatomy, const Body& body);

}  // namespace mobil::inline v0_3
