#pragma once
// A folder of anatomical meshes of the right leg, with a manifest and landmarks, checked and in mobil's axes and
// metres.
//
// The folder: manifest.csv (one row a mesh; columns file, name, side, kind, group are needed; triangles, watertight,
// origin_bone, insertion_bone, origin_{x,y,z}, insertion_{x,y,z} are used where they stand) and landmarks.csv (columns
// name, side, x, y, z; hip_joint_centre, knee_joint_centre and ankle_joint_centre of the right side are needed,
// hip_joint_centre of the left is used). Millimetres or metres, +x to the left, +y backwards, +z up, one frame for
// all files. Bones are known by the beginning of their file's name: hip_bone, sacrum, femur, patella, tibia, fibula,
// talus, calcaneus, navicular, cuboid, …cuneiform, metatarsal, phalanx, sesamoid.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/muscle.h"
#include "components/surface.h"
#include "engine/error.h"

namespace mobil {

enum class AnatomyKind : std::uint8_t { bone, muscle, tendon, skin };

/// One mesh; positions in m, x left, y up, z forward, where the folder has them. Right side, or across the middle.
struct AnatomyPart {
  SurfaceMesh mesh;  // named by its file's stem
  AnatomyKind kind = AnatomyKind::bone;
  std::optional<Muscle> group;                                         // of a muscle or tendon that a mesh drives
  std::optional<Muscle> muscle;                                        // that muscle itself, where its name tells it
  Segment origin = Segment::pelvis, insertion = Segment::shank_right;  // a bone's own segment in both
  std::optional<Vec3<float>> origin_m, insertion_m;                    // centroids of the attachments
  bool midline = false;  // the mesh spans both sides and has no mirror image
};

/// Joint centres of the right leg, and the plane of symmetry's x, m, mobil's axes.
struct AnatomyLandmarks {
  Vec3<float> hip, knee, ankle;
  float middle_x = 0;
};

struct Anatomy {
  double metres_per_unit = 0.001;
  AnatomyLandmarks landmarks;
  std::vector<AnatomyPart> part;  // in the manifest's order
};

struct AnatomyOptions {
  bool other_muscles = false;  // muscles of no group
  bool skin = false;
  double muscle_cell_m = 0.003;  // vertex clustering of everything but bones, see clustered(); 0 keeps every vertex
  double bone_cell_m = 0;
  double speck_share = 0.01;  // pieces with a smaller share of a muscle's triangles are taken away
  unsigned threads = 2;
};

/// Reads the folder. Muscles of the table's groups are wanted, the tendon goes with triceps_surae, and the rest is as
/// `options` says; left-hand rows are passed over. Which muscle of its group a mesh is follows from its name or its
/// file's, which hold all words of the table's name in any order ("Long head of right biceps femoris"); that also makes
/// up for an empty group. A closed mesh that is wound inwards is turned. Fails
/// with one line naming file and row for: a missing folder, file, column or landmark; a number that is not one; a mesh
/// that cannot be read (see read_mesh), has another count of triangles than the manifest says, is open where the
/// manifest says watertight, has edges used by more than two triangles, or lies far from the landmarks; landmarks in
/// other units or axes; an unknown kind or bone.
Result<Anatomy> load_anatomy(const std::string& folder, const AnatomyOptions& options = {});

}  // namespace mobil
