#pragma once
// A folder of anatomical meshes of the right leg, with a manifest and landmarks, checked and in mobil's axes and
// metres.
//
// The folder: manifest.csv (one row a mesh; columns file, name, side, kind, group are needed; triangles, watertight,
// origin_bone, insertion_bone, origin_{x,y,z}, insertion_{x,y,z} are used where they stand) and landmarks.csv (columns
// name, side, x, y, z; hip_joint_centre, knee_joint_centre and ankle_joint_centre of the right side are needed,
// hip_joint_centre of the left is used). One frame for all files, told from hip to ankle: metres, centimetres or
// millimetres; z up (+x to the left, +y backwards) or y up (+x to the left, +z forwards). Columns unit (m, cm, mm, in)
// and up (z, y) of landmarks.csv say it instead, the same in every row; those of manifest.csv say it of one row's mesh
// and points. Meshes are files below the folder; see read_mesh for their formats. Bones are known by the beginning of
// their file's name: hip_bone, sacrum, femur, patella, tibia, fibula, talus, calcaneus, navicular, cuboid, …cuneiform,
// metatarsal, phalanx, sesamoid.

#include <optional>
#include <string>
#include <vector>

#include <mobil/assets/import/surface_report.h>
#include <mobil/components/muscle.h>
#include <mobil/components/surface.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// One mesh; positions in m, x left, y up, z forward, where the folder has them. Right side, or across the middle.
struct AnatomyPart {
  SurfaceMesh mesh;  // named by its file's stem
  AnatomyKind kind = AnatomyKind::bone;
  std::optional<Muscle> group;                                         // of a muscle or tendon that a mesh drives
  std::optional<Muscle> muscle;                                        // that muscle itself, where its name tells it
  Segment origin = Segment::pelvis, insertion = Segment::shank_right;  // a bone's own segment in both
  std::optional<Vec3<float>> origin_m, insertion_m;                    // centroids of the attachments
  bool midline = false;  // the mesh spans both sides and has no mirror image
  SurfaceReport report;  // before simplification
};

/// Joint centres of the right leg, and the plane of symmetry's x, m, mobil's axes.
struct AnatomyLandmarks {
  Vec3<float> hip, knee, ankle;
  float middle_x = 0;
};

/// A folder's meshes and landmarks, in m and mobil's axes.
struct Anatomy {
  double metres_per_unit = 0.001;
  AnatomyLandmarks landmarks;
  std::vector<AnatomyPart> part;  // in the manifest's order
  std::vector<std::string> said;  // about the folder; what was done to a mesh is in its report
};

/// One row of the manifest: the part, or the line that says why there is none. What is known of the part's mesh is in
/// the report in either case.
struct SurveyedMesh {
  std::string file;  // as the manifest names it
  AnatomyPart part;
  std::optional<Error> fault;
};

/// A folder with every fault in it.
struct AnatomySurvey {
  Anatomy anatomy;                  // without parts
  std::vector<std::string> faults;  // of the folder and its tables
  std::vector<SurveyedMesh> mesh;   // of the rows that can be read, in their order
};

/// Which meshes are read, and how they are simplified.
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
/// up for an empty group. What is mended is said in the part's report: winding, pinched vertices, small holes, doubled
/// triangles, specks, pieces on the left side; see mend_and_check. Fails with one line naming file and row for: a
/// missing folder, file, column or landmark; a number that is not one; a file outside the folder; a mesh that cannot be
/// read (see read_mesh), has another count of triangles than the manifest says, is open where the manifest says
/// watertight, is not the surface of a body (see mend_and_check), or lies far from the landmarks or from the bones of
/// its segments; landmarks in other units or axes; an unknown kind or bone.
Result<Anatomy> load_anatomy(const std::string& folder, const AnatomyOptions& options = {});

/// The same, which goes on after a fault.
AnatomySurvey survey_anatomy(const std::string& folder, const AnatomyOptions& options = {});

}  // namespace mobil::inline v0_3
