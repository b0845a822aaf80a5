#include "demo/walk/walk_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include <mobil/anthropometry.h>
#include <mobil/assets/export/recorded_axes.h>
#include <mobil/bvh_writer.h>
#include <mobil/gl_writer.h>
#include <mobil/gltf_writer.h>
#include <mobil/mujoco_writer.h>
#include <mobil/muscle_table.h>
#include <mobil/opensim_writer.h>
#include <mobil/systems/gait/resolve_gait.h>
#include <mobil/usd_writer.h>
#include <mobil/x3d_writer.h>
#include "demo/program/muscle_options.h"
#include "demo/program/units.h"
#include "demo/walk/gait_parameters.h"

namespace mobil {
namespace {

/// Endings of file names, in the order of WalkFormat.
constexpr std::string_view endings[] = {".glb",  ".bvh",  ".mot", ".sto", ".xml",
                                        ".osim", ".usda", ".wrl", ".x3d", ".gl"};

constexpr std::string_view drives[] = {"displacement", "force"};                          // in the order of Drive
constexpr std::string_view views[] = {"stick", "wireframe", "surface", "skin", "glass"};  // in the order of WalkView

// A program has no host that excites muscles.
constexpr std::string_view walk_activations[] = {"none", "phase", "moments"};
constexpr ExcitationSource walk_sources[] = {ExcitationSource::none, ExcitationSource::phase,
                                             ExcitationSource::moments};

/// Reads the direction of the camera, degrees.
Result<double> read_camera(const std::string& text, bool on_legs) {
  constexpr std::pair<std::string_view, double> names[] = {
      {"front", 0},  {"front-left", 45},   {"left", 90},   {"back-left", 135},
      {"back", 180}, {"back-right", -135}, {"right", -90}, {"front-right", usual_camera_deg}};
  const std::string direction = on_legs ? text.substr(0, text.size() - std::string_view(":legs").size()) : text;
  for (const auto& [name, degrees] : names) {
    if (direction == name) return degrees;
  }
  const auto degrees = parse_quantity(direction, Quantity::ratio);
  if (degrees && std::abs(*degrees) <= 360) return *degrees;
  return fail(
      fmt::format("--camera {}: give front, front-left, left, back-left, back, back-right, right, front-right or -360 "
                  "to 360 degrees,"
                  " alone or followed by :legs",
                  text));
}

}  // namespace

const char* const walk_exports_help =
    "Formats of --export, by the file's ending (lengths in m, +Y up, walking toward +Z or as --axes; details are in\n"
    "assets/export/README.md):\n"
    "  .glb   glTF, as walk.glb: 48 joints, bones, muscles as morph targets, or with --skin a skin alone; for\n"
    "         engines, Blender, browsers\n"
    "  .usda  USD: skeleton, skinned bones, muscle point caches; for Houdini, Omniverse, Blender, Maya\n"
    "  .bvh   skeleton and joint angles of every tick; for character animation\n"
    "  .mot   OpenSim's coordinates of its gait2392 model, every tick, in its axes; .sto: ground forces;\n"
    "         .osim: the body with muscles as a model that they move\n"
    "  .xml   MJCF: the body with muscles as a model for MuJoCo; NAME_motion.csv is its motion, every tick\n"
    "  .x3d   X3D, and .wrl VRML97: geometry with interpolators for joints and muscles\n"
    "  .gl    vertices, normals and triangles for OpenGL, one block per picture\n";

Result<std::vector<WalkExport>> read_exports(const std::vector<std::string>& names) {
  std::vector<WalkExport> wanted;
  std::set<std::string> taken;
  for (const std::string& name : names) {
    const std::filesystem::path path(name);
    if (path.filename() != path) {
      return fail(fmt::format("--export {}: is written into the folder of --out; give a name without folders", name));
    }
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const auto* const ending = std::ranges::find(endings, extension);
    if (ending == std::end(endings)) {
      std::string known;
      for (const auto& one : endings) known += fmt::format("{}{}", known.empty() ? "" : ", ", one);
      return fail(fmt::format("--export {}: does not end in a known format; use one of {}", name, known));
    }
    if (!taken.insert(name).second) return fail(fmt::format("--export {}: is given twice; remove one", name));
    wanted.push_back({name, static_cast<WalkFormat>(ending - std::begin(endings))});
  }
  return wanted;
}

bool of_every_tick(const WalkExport& wanted) {
  using enum WalkFormat;
  return wanted.format == bvh || wanted.format == mot || wanted.format == sto || wanted.format == xml;
}

bool needs_velocities(const WalkExport& wanted) {
  return wanted.format == WalkFormat::xml;
}

std::string motion_file(const WalkExport& model) {
  return std::filesystem::path(model.file).stem().string() + "_motion.csv";
}

Result<void> write_export(const WalkExport& wanted, const Body& body, const WalkRecording& pictures,
                          const WalkRecording& skinned, const WalkRecording& ticks,
                          const std::filesystem::path& folder) {
  const auto file = folder / wanted.file;
  switch (wanted.format) {
    case WalkFormat::glb: {
      const auto written = write_glb(file, skinned);
      return written ? Result<void>{} : tl::unexpected(written.error());
    }
    case WalkFormat::bvh: {
      if (!pictures.z_back) return write_bvh(file, ticks);
      WalkRecording turned = ticks;
      put_z_back(turned);
      return write_bvh(file, turned);
    }
    case WalkFormat::mot:
      return write_opensim_motion(file, ticks);
    case WalkFormat::sto:
      return write_opensim_forces(file, ticks);
    case WalkFormat::xml: {
      if (auto done = write_mujoco_model(file, body, ticks); !done) return done;
      return write_mujoco_motion(folder / motion_file(wanted), body, ticks);
    }
    case WalkFormat::osim:
      return write_opensim_model(file, body);
    case WalkFormat::usda:
      return write_usda(file, skinned);
    case WalkFormat::wrl:
      return write_x3d(file, pictures, SceneNotation::vrml);
    case WalkFormat::x3d:
      return write_x3d(file, pictures, SceneNotation::x3d);
    case WalkFormat::gl:
      return write_gl(file, pictures);
  }
  return {};
}

const char* const walk_muscles_help =
    "Muscles: a belly is a block of elements in the frame of its line of action.\n"
    "  --muscles usual: hamstrings, quadriceps, triceps_surae and tibialis_anterior, groups of muscles\n"
    "    with the same action, and cheap; groups: these and eight more, of hip and shank; all: the 38\n"
    "    single muscles of a leg, for close views; or names of groups and single muscles.\n"
    "  --method explicit-central: explicit, in steps short enough for each belly; implicit-central: the\n"
    "    same with the consistent mass; newmark: implicit, one step per tick; static: no vibration;\n"
    "    modal: a few modes of a finer mesh, the cheapest method with vibration; none: only lines of\n"
    "    action, without bellies; finite: for close-ups, tissue of constant volume with active fibres\n"
    "    (--activation phase), on 425 nodes. summary.json contains the steps.\n"
    "  --activation phase: excitation as measured in walking people, at any speed. A fibre and a tendon\n"
    "    in series share the muscle's length, and the belly gets the part that the tendon leaves;\n"
    "    muscles.csv contains both. moments: excitation that produces the walk's own moments at hip, knee\n"
    "    and ankle at minimum cost; motion.csv contains the remaining moments.\n"
    "  --tuned: for --method modal; tension of a muscle stiffens and damps its vibration, as in people.\n"
    "  --inertia: gravity and the leg's motion shake the bellies, which fascia and neighbours support\n"
    "    sideways (7 Hz). Without it only the line of action moves them.\n";

std::vector<Option> walk_options(WalkText& text) {
  const char *gait = "Gait", *muscles = "Muscles", *pictures = "Pictures";
  auto options = body_options(text.body);
  const std::vector<Option> own = {
      {"--speed", &text.speed, "Walking speed (5km/h if no gait option is given)", gait},
      {"--step-length", &text.step_length, "Heel to opposite heel; any two of the three determine the third", gait},
      {"--step-frequency", &text.step_frequency, "Steps per second, or 110steps/min", gait},
      {"--barefoot", &text.barefoot, "Walk without shoes, which changes a step length that is left out", gait},
      {"--set", &text.set, "NAME=VALUE: a gait parameter of --list-parameters, like toe_out_deg=12; repeat for more",
       gait},
      {"--list-parameters", &text.list_parameters, "Print names, ranges and meanings for --set, and exit", gait},
      {"--script", &text.script, "CSV file time_s,parameter,value of changes during the walk, see below", gait},
      {"--seconds", &text.seconds, "Duration of the walk, 0.1s to 60s", gait},
      {"--cycle", &text.cycle, "Walk 1 to 20 whole strides, so that the animation is a loop, instead of --seconds",
       gait},
      {"--ground", &text.ground, "level, slope:10%, cross:10%, hills:20cm, kerb:15cm or stairs:16cm/30cm, see below",
       gait},
      {"--slow-down", &text.scale_speed, "Scale speed on slopes and stairs, as people do; on level ground as requested",
       gait},
      {"--no-forces", &text.no_forces, "Omit ground reactions and joint moments (empty cells in motion.csv)", gait},
      {"--muscles", &text.muscles,
       "Muscles of both legs to simulate: usual, groups, all, or names like hamstrings,soleus", muscles},
      {"--drive", &text.drive,
       "displacement: the belly's end follows the line of action; force: the paper's spring force pulls it", muscles,
       words_of(drives)},
      {"--method", &text.method,
       "How muscles deform: explicit-central, implicit-central, newmark, static, modal, finite or none, see below",
       muscles, words_of(method_name)},
      {"--element", &text.element,
       "full: 2x2x2 points; bbar: for nearly incompressible tissue; one-point: one point, with hourglass stiffness",
       muscles, words_of(element_name)},
      {"--activation", &text.activation,
       "phase: muscles are active as in people at that phase of gait, with elastic tendons; moments; none", muscles,
       words_of(walk_activations)},
      {"--tuned", &text.tuned, "Tension stiffens and damps vibration; needs --activation phase, --method modal",
       muscles},
      {"--inertia", &text.inertia, "Apply gravity and the leg's acceleration to muscles, see below", muscles},
      {"--anatomy", &text.anatomy, "Folder of real meshes with manifest.csv and landmarks.csv", pictures},
      {"--view", &text.view,
       "stick (lines of action), wireframe (finite-element meshes), surface (muscles and bones), skin (dressed) or "
       "glass (muscles and bones through the skin)",
       pictures, words_of(views)},
      {"--skin", &text.skin, "Write skin and clothes to walk.glb and .usda, instead of bones and muscles", pictures},
      {"--skin-anatomy", &text.skin_anatomy, "With --skin, also write bones and muscles, which the skin covers",
       pictures},
      {"--fat", &text.fat, "Let fat under the skin wobble, in pictures with --view skin or glass", pictures},
      {"--contact", &text.contact, "Keep muscles from penetrating each other and bones, in pictures and files",
       pictures},
      {"--camera", &text.camera,
       "front, back, left, right, front-right … of the walker, or degrees (0 front, 90 left); with :legs near, as "
       "back:legs",
       pictures},
      {"--stereo", &text.stereo, "Show left and right eye side by side, along parallel axes", pictures},
      {"--eye-distance", &text.eye_distance, "Distance between the two eyes of --stereo, 1mm to 0.5m", pictures},
      {"--frames", &text.frames, "Write frame_*.png, 1280x720, 30 per second", pictures},
      {"--video", &text.video, "Write walk.mp4", pictures},
      {"--export", &text.exports, "Also write the walk as NAME.bvh, .usda, .mot …, see below; repeat for more"},
      {"--root-motion", &text.root_motion, "Animate the way on the root, with the pelvis relative to it (.glb, .usda)"},
      {"--in-place", &text.in_place, "Write the walk without its way, on the spot"},
      axes_option(text.axes, ".glb, .usda, .bvh, .x3d, .wrl and .gl"),
      {"--out", &text.out, "Folder for the results, created if missing"}};
  options.insert(options.end(), own.begin(), own.end());
  return options;
}

Result<WalkOptions> read_walk_options(const WalkText& text) {
  WalkOptions options;
  options.frames = text.frames;
  options.video = text.video;
  options.stereo = text.stereo;
  options.forces = !text.no_forces;
  options.out = text.out;
  options.skin = text.skin;
  options.skin_anatomy = text.skin_anatomy;
  options.fat = text.fat;
  options.contact = text.contact;
  options.z_back = text.axes == z_back_axes;

  OptionReader read;
  options.camera_on_legs = text.camera.ends_with(":legs");
  options.camera_deg = read(read_camera(text.camera, options.camera_on_legs));
  options.exports = read(read_exports(text.exports));
  for (const WalkExport& wanted : options.exports) {
    if (wanted.format == WalkFormat::sto && text.no_forces)
      read.refuse(fmt::format("--export {}: contains ground forces; remove --no-forces", wanted.file));
  }
  if (text.skin_anatomy && !text.skin)
    read.refuse("--skin-anatomy: bones and muscles are written anyway without a skin; add --skin, or remove it");
  if (text.root_motion && text.in_place) read.refuse("--root-motion and --in-place exclude each other; remove one");
  options.way = text.root_motion ? WalkWay::root : text.in_place ? WalkWay::in_place : WalkWay::pelvis;
  for (const WalkExport& wanted : options.exports) {
    if (text.in_place && (wanted.format == WalkFormat::mot || wanted.format == WalkFormat::sto))
      read.refuse(fmt::format("--export {}: OpenSim needs the way; remove --in-place", wanted.file));
    if (text.in_place && wanted.format == WalkFormat::xml)
      read.refuse(fmt::format("--export {}: MuJoCo needs the way; remove --in-place", wanted.file));
  }
  options.eye_distance_m = read(read_value("--eye-distance", text.eye_distance, Quantity::length, 0.001, 0.5));
  if (text.eye_distance != WalkText{}.eye_distance && !text.stereo)
    read.refuse("--eye-distance: needs pictures for two eyes; add --stereo, or remove it");
  options.body = read(read_body_options(text.body));

  // The gait's own ranges depend on the body and are checked when the walk is resolved.
  const auto optional = [&](std::string_view option, const std::string& given, Quantity quantity, double most) {
    if (given.empty()) return std::optional<float>{};
    return std::optional(static_cast<float>(read(read_value(option, given, quantity, 0, most))));
  };
  options.gait.speed_m_s = optional("--speed", text.speed, Quantity::speed, 10);
  options.gait.step_length_m = optional("--step-length", text.step_length, Quantity::length, 3);
  options.gait.step_frequency_hz = optional("--step-frequency", text.step_frequency, Quantity::frequency, 10);
  options.ground = read(read_walk_ground(text.ground));
  options.scale_speed = text.scale_speed;
  if (options.ground.kind == GroundKind::stairs && !options.gait.step_length_m) {
    options.gait.step_length_m = options.ground.tread_m;
    constexpr float usual_hz = 1.8F;  // of people on stairs
    if (!options.gait.speed_m_s && !options.gait.step_frequency_hz) options.gait.step_frequency_hz = usual_hz;
  }
  options.gait.style = usual_style(options.body);
  const bool no_pace = !options.gait.speed_m_s && !options.gait.step_length_m && !options.gait.step_frequency_hz;
  if (text.body.typical && no_pace) options.gait.speed_m_s = usual_speed_m_s(options.body);
  if (text.barefoot && !text.script.empty()) read.refuse("--barefoot: steps of a script are in shoes; remove --script");
  if (const auto body = make_body(options.body); body && text.barefoot) {
    const auto walked = resolve_gait(*body, options.gait, Footwear::barefoot);  // errors come when the walk begins
    if (walked && walked->speed_m_s > 0)
      options.gait = {.speed_m_s = walked->speed_m_s, .step_length_m = walked->step_length_m, .style = walked->style};
  }
  for (const auto& assignment : text.set) {
    if (auto done = set_gait_parameter(assignment, options.gait.style); !done)
      read.refuse(fmt::format("--set {}", done.error().message));
  }
  if (!text.script.empty()) {
    auto script = read_walk_script(text.script);
    if (!script) read.refuse(fmt::format("--script {}", script.error().message));
    if (script) options.script = std::move(*script);
  }
  options.seconds = read(read_value("--seconds", text.seconds, Quantity::time, 0.1, 60));
  if (!text.cycle.empty()) {
    options.cycle = read(read_count("--cycle", text.cycle, 1, 20));
    if (text.seconds != WalkText{}.seconds) read.refuse("--cycle and --seconds exclude each other; remove one");
    if (options.script || !text.script.empty()) read.refuse("--cycle: needs a steady walk; remove --script");
    if (options.ground.kind != GroundKind::level) read.refuse("--cycle: needs level ground; remove --ground");
  }

  options.muscles.muscles = read(read_muscles(text.muscles));
  options.muscles.line_motion = true;
  options.muscles.drive = read(choose<Drive>("--drive", text.drive, drives));
  options.muscles.method = read(choose<Method>("--method", text.method, method_name));
  if (options.muscles.method == Method::finite) options.muscles.cells = close_up_cells;
  options.muscles.element = read(choose<Element>("--element", text.element, element_name));
  options.muscles.activation =
      walk_sources[read(choose<std::size_t>("--activation", text.activation, walk_activations))];
  if (has_activation(options.muscles) && options.muscles.drive == Drive::force)
    read.refuse("--activation prescribes the place of the belly's end; remove --drive force or --activation");
  if (options.muscles.activation == ExcitationSource::moments && !options.forces)
    read.refuse("--activation moments needs joint moments; remove --no-forces, or choose phase");
  options.muscles.modal.tuned = text.tuned;
  if (text.tuned && (!has_activation(options.muscles) || options.muscles.method != Method::modal))
    read.refuse("--tuned needs active modal muscles; add --activation phase --method modal, or remove it");
  options.muscles.inertia = text.inertia;
  options.view = read(choose<WalkView>("--view", text.view, views));
  const bool shows_skin = options.view == WalkView::skin || options.view == WalkView::glass;
  if (text.fat && !(shows_skin && (text.frames || text.video)))
    read.refuse("--fat: needs pictures of skin; add --view skin --frames (or glass, --video), or remove it");
  if (!text.anatomy.empty()) options.anatomy = text.anatomy;
  return read.result(std::move(options));
}

}  // namespace mobil
