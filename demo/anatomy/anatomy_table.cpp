#include "demo/anatomy/anatomy_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include <mobil/muscle_table.h>
#include "demo/program/json.h"

namespace mobil {
namespace {

constexpr std::array<std::string_view, 4> kind_name = {"bone", "muscle", "tendon", "skin"};

std::string_view kind_of(const AnatomyPart& part) {
  return kind_name[static_cast<std::size_t>(part.kind)];
}

/// The muscle that a mesh is, or else its group.
std::string_view muscle_of(const AnatomyPart& part) {
  if (part.muscle) return muscle_name(*part.muscle);
  return part.group ? muscle_name(*part.group) : std::string_view("-");
}

std::string all_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += (text.empty() ? "" : "; ") + line;
  return text;
}

}  // namespace

std::size_t fault_count(const AnatomySurvey& survey) {
  const auto bad = std::ranges::count_if(survey.mesh, [](const SurveyedMesh& mesh) { return mesh.fault.has_value(); });
  return survey.faults.size() + static_cast<std::size_t>(bad);
}

std::string anatomy_table(const AnatomySurvey& survey) {
  std::size_t widest = 4;
  for (const auto& mesh : survey.mesh) widest = std::max(widest, std::min<std::size_t>(mesh.file.size(), 60));
  std::string text = fmt::format("{:{}} {:6} {:26} {:>9} {:>6} {:>6} {:>6} {:>6} {:>10} {:>10}  {}\n", "file", widest,
                                 "kind", "muscle", "triangles", "open", "over", "pieces", "cuts", "volume_cm3",
                                 "area_cm2", "what was mended or is remarkable");
  for (const auto& mesh : survey.mesh) {
    const SurfaceReport& report = mesh.part.report;
    text += fmt::format("{:{}} {:6} {:26} {:>9} {:>6} {:>6} {:>6} {:>6} {:>10.2f} {:>10.1f}  {}{}\n",
                        mesh.file.substr(0, 60), widest, kind_of(mesh.part), muscle_of(mesh.part), report.triangles,
                        report.open_edges, report.overused_edges, report.pieces, report.self_intersections,
                        report.volume_cm3, report.area_cm2, mesh.fault ? "UNUSABLE; " : "", all_of(report.said));
  }
  for (const auto& line : survey.anatomy.said) text += fmt::format("note: {}\n", line);
  for (const auto& line : survey.faults) text += fmt::format("fault: {}\n", line);
  for (const auto& mesh : survey.mesh) {
    if (mesh.fault) text += fmt::format("fault: {}\n", mesh.fault->message);
  }
  return text;
}

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

}  // namespace mobil
