// `mobil body`: what follows from height, mass and build, with its sources, and what it looks like.

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <mobil/anthropometry.h>
#include <mobil/assets/files/output_file.h>
#include <mobil/png.h>
#include "demo/lab/body/body_json.h"
#include "demo/lab/body/body_picture.h"
#include "demo/program/body_options.h"
#include "demo/program/commands.h"

namespace mobil {
namespace {

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
