// `mobil body`: what follows from height, mass and build, with its sources, and what it looks like.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/files/output_file.h>
#include <mobil/assets/surfaces/muscle_surfaces.h>
#include <mobil/components/body.h>
#include <mobil/engine/error.h>
#include <mobil/engine/geometry.h>
#include <mobil/png.h>
#include <mobil/renderer.h>
#include <mobil/systems/capture/image.h>
#include "assets/body/segment_inertia.h"
#include "assets/surfaces/bone_surfaces.h"
#include "assets/surfaces/surface_mesh.h"
#include "demo/lab/body/body_json.h"
#include "demo/pictures/contact_sheet.h"
#include "demo/program/body_options.h"
#include "demo/program/commands.h"

namespace mobil {
namespace {

constexpr int view_width = 560, view_height = 1080;
constexpr Colour tendon_cream{0.81F, 0.75F, 0.67F};
constexpr Placement as_it_is{}, mirrored{.scale = {-1, 1, 1}};
constexpr float field_of_view_deg = 12;  // narrow: nearly without perspective, as in an atlas

/// Far enough for the whole stature with a margin.
Camera looking(const Body& body, Vec3<float> from) {
  const float stature = body.request.height_m, far = 5.35F * stature;
  Camera camera;
  camera.target = {0, 0.5F * stature, 0};
  camera.eye = {far * from.x, camera.target.y + far * from.y, far * from.z};
  camera.vertical_fov_deg = field_of_view_deg;
  return camera;
}

/// From the front and from the body's right beside each other, to the same scale. Error: no graphics driver (with the
/// packages to install), or one that fails.
Result<Image> body_picture(const Body& body) {
  auto renderer = Renderer::create(view_width, view_height);
  if (!renderer) return tl::unexpected(renderer.error());

  const auto bones = make_bone_surfaces(body);
  const auto muscles = make_muscle_surfaces(body);
  std::vector<Placement> stand(bones.size());
  std::vector<DrawMesh> meshes;
  for (std::size_t i = 0; i < bones.size(); ++i) {
    stand[i].position = geometry::to_float(joint_centre_m(body, bones[i].segment));
    meshes.push_back({.position = bones[i].mesh.position,
                      .triangle = bones[i].mesh.triangle,
                      .colour = bone_ivory,
                      .placement = {&stand[i], 1}});
  }
  for (const GroupSurface& muscle : muscles) {
    const bool tendon = std::ranges::find(muscle.tendon, 0.0F) == muscle.tendon.end();
    for (const Placement* side : {&as_it_is, &mirrored}) {
      meshes.push_back({.position = muscle.surface.mesh.position,
                        .triangle = muscle.surface.mesh.triangle,
                        .colour = tendon ? tendon_cream : muscle_red,
                        .wetness = 0.5F,
                        .placement = {side, 1}});
    }
  }

  std::vector<Image> pair;
  struct View {
    Vec3<float> from, light;  // steep and from the left, so that no shadow reaches into the other view
  };
  constexpr std::array<View, 2> views = {
      {{{0, 0.05F, 1}, {-0.20F, 1.1F, 0.50F}}, {{-1, 0.05F, 0}, {-0.50F, 1.1F, -0.20F}}}};
  for (const View& view : views) {
    Scene scene;
    scene.camera = looking(body, view.from);
    scene.meshes = meshes;
    scene.light = view.light;
    auto image = renderer->render(scene);
    if (!image) return image;
    pair.push_back(std::move(*image));
  }
  return contact_sheet({&pair, 1}, 0);
}

struct BodyCommand {
  BodyText body;
  std::string out = "out";
  bool json = false;
};

Result<void> write_body(const Body& body, const std::filesystem::path& out) {
  auto results = OutputFolder::make(out);
  if (!results) return tl::unexpected(results.error());
  const auto picture = body_picture(body);
  if (picture) {
    if (auto done = write_png((results->inside() / "body.png").string(), *picture); !done) return done;
  }
  if (auto done = write_file(results->inside() / "body.json", body_json(body)); !done) return done;
  if (auto done = results->put(); !done) return done;
  std::error_code ignored;
  if (!picture) std::filesystem::remove(out / "body.png", ignored);  // another body's
  fmt::print("{}", body_table(body));
  say_where(fmt::format("\nlook at {}: body.json{}", out.string(), picture ? " body.png" : ""));
  if (!picture) fmt::print(stderr, "mobil body: no picture: {}\n", picture.error().message);
  return {};
}

Result<void> run_body(const BodyCommand& text) {
  const auto request = read_body_options(text.body);
  if (!request) return tl::unexpected(request.error());
  const auto body = make_body(*request);
  if (!body) return tl::unexpected(body.error());
  if (!text.json) return write_body(*body, text.out);
  fmt::print("{}", body_json(*body));
  return {};
}

}  // namespace

Subcommand body_command() {
  auto text = std::make_shared<BodyCommand>();
  Subcommand command{.name = "body"};
  command.footer =
      "Height gives the lengths, mass the masses; both give the leg's muscles. Constitution and mesomorphy make\n"
      "muscles larger or smaller, endomorphy is fat, ectomorphy slenderness, which height and mass decide between\n"
      "themselves: where a request contradicts itself, what gave way is said in a note. What no living body weighs at\n"
      "that height is refused.\n"
      "body.json holds 48 segments (joint, length, mass, centre, inertia), the joints' limits and the leg's muscles\n"
      "(attachments, belly, fibres, pennation, tendon, section, volume), each with its source; body.png shows the\n"
      "body from the front and from its right in the anatomical position.\n"
      "\n"
      "Examples: mobil body --height 1.80 --mass 80 --out out\n"
      "          mobil body --height 165cm --mass 58 --biotype 2-3-4 --constitution thin --json | less";
  add_options(command, body_options(text->body));
  add_options(command, {{"--json", &text->json, "Print the JSON, and write and draw nothing"},
                        {"--out", &text->out, "Folder for the results, made if missing"}});
  command.empty_refused = true;
  command.run = [text] { return exit_status_of("body", run_body(*text)); };
  return command;
}

}  // namespace mobil
