// `mobil anatomy`: what a folder of meshes holds, what was mended in it, and every fault.

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include <mobil/png.h>
#include "demo/anatomy/anatomy_picture.h"
#include "demo/anatomy/anatomy_table.h"
#include "demo/program/commands.h"

namespace mobil {
namespace {

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
  fmt::print("{}", text.json ? anatomy_json(text.folder[0], survey) : anatomy_table(survey));
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
                  "faults) say why: mend them, or take their rows out of manifest.csv",
                  text.folder[0], faults));
}

}  // namespace

Subcommand anatomy_command() {
  auto text = std::make_shared<AnatomyText>();
  Subcommand command{.name = "anatomy"};
  command.footer =
      "A folder as `mobil walk --anatomy` takes it: manifest.csv, landmarks.csv and meshes (.obj, .stl, .ply, .gltf,\n"
      ".glb). Every row of the right side and the middle is read. Columns: triangles, open edges and edges of more "
      "than\n"
      "two triangles as the file has them; pieces, pairs of triangles that cut each other, volume and area as mended.\n"
      "Exit status 2 if a mesh or a row cannot be used.\n"
      "\nExamples: mobil anatomy leg\n"
      "          mobil anatomy leg --out leg.png\n"
      "          mobil anatomy leg --json | jq .faults";
  command.options = {{"folder", &text->folder, "The folder"},
                     {"--json", &text->json, "Print JSON instead of the table"},
                     {"--out", &text->out, "A picture of the meshes from the front and from the right (PNG)"}};
  command.empty_refused = true;
  command.run = [text] { return exit_status_of("anatomy", run_anatomy(*text)); };
  return command;
}

}  // namespace mobil
