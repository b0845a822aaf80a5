#pragma once
// Options of `mobil walk`, and its exports to formats of other programs.

#include <filesystem>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/components/leg_muscles.h>
#include "demo/program/body_options.h"
#include "demo/program/file_axes.h"
#include "demo/program/options.h"
#include "demo/walk/walk_ground.h"
#include "demo/walk/walk_script.h"

namespace mobil {

enum class WalkFormat { glb, bvh, mot, sto, xml, osim, usda, wrl, x3d, gl };

struct WalkExport {
  std::string file;  // in the folder of results
  WalkFormat format;
};

/// Reads names, whose endings determine the format. Errors: an unknown ending, a folder in a name, a repeated name.
Result<std::vector<WalkExport>> read_exports(const std::vector<std::string>& names);

/// Returns true for a format with every tick and without surfaces; other formats have every picture.
bool of_every_tick(const WalkExport& wanted);
/// Returns true for a format with velocities, of which WalkRecording::around is needed.
bool needs_velocities(const WalkExport& wanted);
/// Returns the name of a model's table: NAME_motion.csv.
std::string motion_file(const WalkExport& model);

/// Writes one file into `folder`, for .xml also its motion. `ticks`: poses of every tick, and forces if there are any.
/// `pictures`: with surfaces. `skinned`: pictures for formats with skins. If pictures are turned (put_z_back), ticks
/// are turned here for formats without axes of their own.
Result<void> write_export(const WalkExport& wanted, const Body& body, const WalkRecording& pictures,
                          const WalkRecording& skinned, const WalkRecording& ticks,
                          const std::filesystem::path& folder);

/// Part of --help about export formats.
extern const char* const walk_exports_help;

/// Carrier of the way in files: the pelvis, the root, or none.
enum class WalkWay { pelvis, root, in_place };

enum class WalkView { stick, wireframe, surface, skin, glass };

/// Direction of the usual camera, from the front right.
inline constexpr double usual_camera_deg = -61.2;

struct WalkOptions {
  BodyRequest body;
  GaitRequest gait;
  std::optional<WalkScript> script;
  double seconds = 5;
  std::size_t cycle = 0;  // whole strides instead of seconds; 0: none
  WalkGround ground;
  bool scale_speed = false;
  LegMuscles muscles;
  bool forces = true;  // ground reactions and joint moments
  std::optional<std::filesystem::path> anatomy;
  WalkView view = WalkView::surface;
  bool skin = false, skin_anatomy = false, fat = false, contact = false, frames = false, video = false, stereo = false;
  double camera_deg = 0;        // direction from the walker to the camera: 0 front, 90 to the walker's left
  bool camera_on_legs = false;  // near, from the waist down
  std::filesystem::path out = "out";
  std::vector<WalkExport> exports;
  WalkWay way = WalkWay::pelvis;
  bool z_back = false;  // of exports
  double eye_distance_m = 0.063;
};

/// Options as text from the command line, bound by `walk_options`.
struct WalkText {
  BodyText body;
  std::string speed, step_length, step_frequency, seconds = "5";
  std::string camera = "front-right", muscles = "usual", drive = "displacement", method = "explicit-central",
              element = "full", activation = "none", anatomy, view = "surface", out = "out";
  std::string eye_distance = "63mm";
  std::vector<std::string> set, exports;
  std::string script, ground = "level", cycle, axes = usual_axes;
  bool list_parameters = false, barefoot = false, scale_speed = false, no_forces = false, tuned = false, inertia = false;
  bool skin = false, skin_anatomy = false, fat = false, contact = false, frames = false, video = false, stereo = false,
       root_motion = false, in_place = false;
};

std::vector<Option> walk_options(WalkText& text);

/// Part of --help about the options of muscles.
extern const char* const walk_muscles_help;

/// Reads and checks every option. Errors name the option, the valid range and the remedy.
Result<WalkOptions> read_walk_options(const WalkText& text);

}  // namespace mobil
