#pragma once
// A folder of anatomical meshes of the right leg, with a manifest and landmarks, checked and in mobil's axes and
// metres.
//
// manifest.csv has one row per mesh. Columns file, name, side, kind and group are required; triangles, watertight,
// origin_bone, insertion_bone, origin_{x,y,z} and insertion_{x,y,z} are optional. landmarks.csv has columns name, side,
// x, y and z. It needs hip_joint_centre, knee_joint_centre and ankle_joint_centre of the right side; hip_joint_centre
// of the left is optional. All files have one frame, derived from hip to ankle: metres, centimetres or millimetres; z
// up (+x to the left, +y backwards) or y up (+x to the left, +z forwards). Columns unit (m, cm, mm, in) and up (z, y)
// of landmarks.csv override it, equal in every row; those of manifest.csv apply to one row's mesh and points. Meshes
// are files below the folder, in any case of letters; see read_mesh for their formats. Bones are identified by the
// beginning of their file's name: hip_bone, sacrum, femur, patella, tibia, fibula, talus, calcaneus, navicular, cuboid,
// …cuneiform, metatarsal, phalanx, sesamoid.

#include <optional>
#include <string>
#include <vector>

#include <mobil/assets/import/surface_report.h>
#include <mobil/components/muscle.h>
#include <mobil/components/surface.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// One mesh, of the right side or across the middle; positions in m, x left, y up, z forward, at the folder's place.
struct AnatomyPart {
  SurfaceMesh mesh;  // named by its file's stem
  AnatomyKind kind = AnatomyKind::bone;
  std::optional<Muscle> group;                                         // of a muscle or tendon that a mesh drives
  std::optional<Muscle> muscle;                                        // that muscle itself, if its name identifies it
  Segment origin = Segment::pelvis, insertion = Segment::shank_right;  // a bone's own segment in both
  std::optional<Vec3<float>> origin_m, insertion_m;                    // centroids of the attachments
  bool midline = false;  // the mesh spans both sides and has no mirror image
  SurfaceReport report;  // before simplification
};

/// Joint centres of the right leg, and x of the plane of symmetry, m, mobil's axes.
struct AnatomyLandmarks {
  Vec3<float> hip, knee, ankle;
  float middle_x = 0;
};

/// A folder's meshes and landmarks, in m and mobil's axes.
struct Anatomy {
  double metres_per_unit = 0.001;
  AnatomyLandmarks landmarks;
  std::vector<AnatomyPart> part;  // in the manifest's order
  std::vector<std::string> said;  // about the folder; repairs of a mesh are in its report
};

/// One row of the manifest: the part, or the reason why it is missing. The report has the known data of the mesh in
/// either case.
struct SurveyedMesh {
  std::string file;  // as the manifest names it
  AnatomyPart part;
  std::optional<Error> fault;
};

/// A folder with all its faults.
struct AnatomySurvey {
  Anatomy anatomy;                  // without parts
  std::vector<std::string> faults;  // of the folder and its tables
  std::vector<SurveyedMesh> mesh;   // of the rows that can be read, in their order
};

/// Selection of meshes, and their simplification.
struct AnatomyOptions {
  bool other_muscles = false;  // muscles that are not in the table
  bool skin = false;
  double muscle_cell_m = 0.003;  // vertex clustering of all except bones, see clustered(); 0 keeps every vertex
  double bone_cell_m = 0;
  double speck_share = 0.01;  // pieces with a smaller share of a muscle's triangles are removed
  unsigned threads = 2;
};

/// Reads the folder. Muscles of the table (mobil/muscle_table.h) are selected, the tendon belongs to triceps_surae, and
/// `options` selects the rest; left-hand rows are skipped. A row's group is a group or a single muscle of the table. A
/// mesh's name or its file's identifies its muscle, if it has all words of the table's name in any order ("Long head of
/// right biceps femoris"; fibularis is peroneus). That also replaces an empty group. The part's report lists repairs of
/// winding, pinched vertices, small holes, doubled triangles, specks and pieces on the left side; see mend_and_check.
/// Fails with one line naming file and row on a missing folder, file, column or landmark; an invalid number; a file
/// outside the folder; a mesh that cannot be read (see read_mesh), or has another count of triangles than in the
/// manifest; one that is open but listed as watertight, is not the surface of a body (see mend_and_check), or is far
/// from the landmarks or from the bones of its segments; landmarks in other units or axes; an unknown kind or bone.
Result<Anatomy> load_anatomy(const std::string& folder, const AnatomyOptions& options = {});

/// Reads the folder and continues after a fault.
AnatomySurvey survey_anatomy(const std::string& folder, const AnatomyOptions& options = {});

}  // namespace mobil::inline v0_3
