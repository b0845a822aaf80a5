// `mobil anatomy`: lists the meshes of a folder, the repairs made to them, and every fault.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <mobil/assets/import/anatomy_folder.h>
#include <mobil/engine/error.h>
#include <mobil/engine/geometry.h>
#include <mobil/muscle_table.h>
#include <mobil/png.h>
#include <mobil/renderer.h>
#include <mobil/systems/render/image.h>
#include <mobil/systems/render/matrix.h>
#include "demo/pictures/contact_sheet.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/json.h"

namespace mobil {
namespace {

constexpr std::array<std::string_view, 4> kind_name = {"bone", "muscle", "tendon", "skin"};

std::string_view kind_of(const AnatomyPart& part) {
  return kind_name[static_cast<std::size_t>(part.kind)];
}

/// Returns the name of the mesh's muscle, of its group if the muscle is unknown, or "-".
std::string_view muscle_of(const AnatomyPart& part) {
  if (part.muscle) return muscle_name(*part.muscle);
  return part.group ? muscle_name(*part.group) : std::string_view("-");
}

std::string all_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += (text.empty() ? "" : "; ") + line;
  return text;
}

/// Returns the number of unusable meshes and other faults.
std::size_t fault_count(const AnatomySurvey& survey) {
  const auto bad = std::ranges::count_if(survey.mesh, [](const SurveyedMesh& mesh) { return mesh.fault.has_value(); });
  return survey.faults.size() + static_cast<std::size_t>(bad);
}

/// Formats one line per mesh with its kind, measures and repairs, then one line per note and fault.
std::string anatomy_table(const AnatomySurvey& survey) {
  std::size_t widest = 4;
  for (const auto& mesh : survey.mesh) widest = std::max(widest, std::min<std::size_t>(mesh.file.size(), 60));
  std::string text = fmt::format("{:{}} {:6} {:26} {:>9} {:>6} {:>6} {:>6} {:>6} {:>10} {:>10}  {}\n", "file", widest,
                                 "kind", "muscle", "triangles", "open", "over", "pieces", "cuts", "volume_cm3",
                                 "area_cm2", "repairs and remarks");
  for (const auto& mesh : survey.mesh) {
    const SurfaceReport& report = mesh.part.report;
    text += fmt::format("{:{}} {:6} {:26} {:>9} {:>6} {:>6} {:>6} {:>6} {:>10.2f} {:>10.1f}  {}{}\n", mesh.file, widest,
                        kind_of(mesh.part), muscle_of(mesh.part), report.triangles, report.open_edges,
                        report.overused_edges, report.pieces, report.self_intersections, report.volume_cm3,
                        report.area_cm2, mesh.fault ? "UNUSABLE; " : "", all_of(report.said));
  }
  for (const auto& line : survey.anatomy.said) text += fmt::format("note: {}\n", line);
  for (const auto& line : survey.faults) text += fmt::format("fault: {}\n", line);
  for (const auto& mesh : survey.mesh) {
    if (mesh.fault) text += fmt::format("fault: {}\n", mesh.fault->message);
  }
  return text;
}

/// Formats the survey as one JSON object with the members folder, unit_m, said, meshes and faults.
std::string anatomy_json(const std::string& folder, const AnatomySurvey& survey) {
  Json meshes = Json::array(), faults = Json(survey.faults);
  for (const auto& mesh : survey.mesh) {
    const SurfaceReport& report = mesh.part.report;
    if (mesh.fault) faults.push_back(mesh.fault->message);
    const std::string_view muscle = muscle_of(mesh.part);
    meshes.push_back({{"file", mesh.file},
                      {"kind", kind_of(mesh.part)},
                      {"muscle", muscle == "-" ? Json() : Json(muscle)},
                      {"usable", !mesh.fault},
                      {"triangles", report.triangles},
                      {"open_edges", report.open_edges},
                      {"overused_edges", report.overused_edges},
                      {"pieces", report.pieces},
                      {"self_intersections", report.self_intersections},
                      {"volume_cm3", report.volume_cm3},
                      {"area_cm2", report.area_cm2},
                      {"said", report.said},
                      {"fault", mesh.fault ? Json(mesh.fault->message) : Json()}});
  }
  Json all;
  all["folder"] = folder;
  all["unit_m"] = survey.anatomy.metres_per_unit;
  all["said"] = survey.anatomy.said;
  all["meshes"] = meshes;
  all["faults"] = faults;
  return all.dump(2) + "\n";
}

using namespace geometry;

constexpr int panel_width = 560, panel_height = 1080;
constexpr Colour other_rose{0.66F, 0.42F, 0.38F}, sinew_cream{0.81F, 0.75F, 0.67F};
constexpr float narrow_view_deg = 12;  // little perspective, as in an atlas

Colour colour_of(const AnatomyPart& part) {
  if (part.kind == AnatomyKind::bone) return bone_ivory;
  if (part.kind == AnatomyKind::tendon) return sinew_cream;
  return part.group ? muscle_red : other_rose;
}

/// Draws the meshes from the front and from the right, 1120 × 1080 pixels. Skins and meshes with a fault are left out.
/// Errors: no usable mesh, those of the renderer.
Result<Image> anatomy_picture(const AnatomySurvey& survey) {
  std::vector<DrawMesh> meshes;
  for (const auto& mesh : survey.mesh) {
    if (mesh.fault || mesh.part.kind == AnatomyKind::skin) continue;
    meshes.push_back({.position = mesh.part.mesh.position,
                      .triangle = mesh.part.mesh.triangle,
                      .colour = colour_of(mesh.part),
                      .wetness = mesh.part.kind == AnatomyKind::bone ? 0.0F : 0.5F});
  }
  if (meshes.empty()) return fail("no usable mesh to draw; fix the faults first");
  auto renderer = Renderer::create(panel_width, panel_height);
  if (!renderer) return tl::unexpected(renderer.error());
  capture_math::Box box;
  for (const DrawMesh& mesh : meshes) {
    for (const auto& p : mesh.position) box.add(p);
  }
  const Vec3<float> centre = 0.5F * (box.low + box.high);
  const float radius = 0.5F * length(box.high - box.low);
  const float far = 1.05F * radius / std::tan(0.5F * capture_math::radians(narrow_view_deg));
  std::vector<Image> pair;
  for (const Vec3<float>& from : {Vec3<float>{0, 0, 1}, Vec3<float>{-1, 0, 0}}) {
    Scene scene;
    scene.camera.target = centre;
    scene.camera.eye = centre + far * from;
    scene.camera.vertical_fov_deg = narrow_view_deg;
    scene.meshes = meshes;
    scene.light = 0.5F * from + Vec3<float>{-0.2F, 1.1F, 0.1F};
    auto image = renderer->render(scene);
    if (!image) return image;
    pair.push_back(std::move(*image));
  }
  return contact_sheet({&pair, 1}, 0);
}

struct AnatomyText {
  std::vector<std::string> folder;
  std::string out;
  bool json = false;
};

Result<void> run_anatomy(const AnatomyText& text) {
  if (text.folder.size() != 1) {
    return fail(fmt::format("{} folders; name one, with manifest.csv, landmarks.csv and the meshes: mobil anatomy DIR",
                            text.folder.size()));
  }
  const AnatomySurvey survey = survey_anatomy(text.folder[0], {.other_muscles = true, .skin = true});
  if (survey.mesh.empty() && survey.faults.size() == 1) return fail(survey.faults[0]);
  write_output(text.json ? anatomy_json(text.folder[0], survey) : anatomy_table(survey));
  if (!text.out.empty()) {
    const auto picture = anatomy_picture(survey);
    if (!picture) return fail(fmt::format("--out {}: {}", text.out, picture.error().message));
    if (auto done = write_png(text.out, *picture); !done) return done;
    if (!text.json) say_written(text.out);
  }
  const std::size_t faults = fault_count(survey);
  if (faults == 0) return {};
  return fail(
      fmt::format("{}: {} of its meshes and rows cannot be used; the lines that begin with 'fault' (--json: "
                  "faults) give the reasons; fix them, or remove their rows from manifest.csv",
                  text.folder[0], faults));
}

}  // namespace

Subcommand anatomy_command() {
  auto text = std::make_shared<AnatomyText>();
  Subcommand command{.name = "anatomy"};
  command.footer =
      "The folder has the format of `mobil walk --anatomy`: manifest.csv, landmarks.csv and meshes\n"
      "(.obj, .stl, .ply, .gltf, .glb). All rows of the right side and the midline are read. Columns:\n"
      "triangles, open edges and edges shared by more than two triangles count the file's mesh; pieces,\n"
      "pairs of intersecting triangles, volume and area describe the repaired mesh. The exit status is 2\n"
      "if a mesh or a row cannot be used.\n"
      "\nExamples: mobil anatomy leg\n"
      "          mobil anatomy leg --out leg.png\n"
      "          mobil anatomy leg --json | jq .faults";
  command.options = {{"folder", &text->folder, "The folder"},
                     {"--json", &text->json, "Print JSON instead of the table"},
                     {"--out", &text->out, "Picture of the meshes from the front and from the right, FILE.png"}};
  command.empty_refused = true;
  command.run = [text] { return exit_status_of("anatomy", run_anatomy(*text)); };
  return command;
}

}  // namespace mobil
