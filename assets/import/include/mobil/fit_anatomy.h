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

/// A right-hand muscle (or the tendon) with the meshes that can drive it, its own muscle's or its group's; what the
/// folder says about its attachments, m, in the frame of the surface, and where it is held: there, or else where it
/// ends. One that runs past the kneecap ends on the shank.
struct FittedMuscle {
  Muscle group, muscle;
  MuscleSurface surface;
  std::optional<Vec3<float>> origin_m, insertion_m;
  Attachments attachments{};
};

/// `bones`: both sides, the left the mirror image of the right, each in its segment's frame (names end in _right,
/// _left). `muscles`: right side, world axes, the body in the anatomical position at x = z = 0; not bound to a lattice
/// yet. `others`: further muscles, of no group, as the muscles; `skins`, too.
struct FittedAnatomy {
  std::vector<BoneSurface> bones;
  std::vector<FittedMuscle> muscles;
  std::vector<MuscleSurface> others;
  std::vector<SurfaceMesh> skins;
};

/// What a muscle's surface is beyond the kneecap, and from where to where it is the ligament.
struct Ligament {
  MuscleSurface surface;
  Attachments ends;
};

/// Cuts a surface that runs on past the kneecap in two there: what stays of it ends on the kneecap, what is returned
/// goes on to the shank; both have the vertices of the cut. Others stay as they are. Bind the second with bind_beyond.
std::optional<Ligament> cut_at_kneecap(FittedMuscle& muscle, const Body& body);

/// Joint centres land on the body's, the lowest point of the foot's bones on the ground; see bone_maps for how each
/// bone is stretched. Fails with one line for a body without positive lengths.
Result<FittedAnatomy> fit_anatomy(const Anatomy& anatomy, const Body& body);

}  // namespace mobil::inline v0_3
