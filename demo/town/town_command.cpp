// `mobil town`: people walk in a small town with kerbs, stairs and a ramp, and avoid each other.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <mobil/assets/files/output_file.h>
#include <mobil/engine/geometry.h>
#include <mobil/png.h>
#include <mobil/step_report.h>
#include <mobil/video.h>
#include "demo/crowd/crowd_picture.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/json.h"
#include "demo/program/progress.h"
#include "demo/program/units.h"
#include "demo/town/town_scene.h"

namespace mobil {
namespace {

enum class TownView { follow, above };

using namespace geometry;

/// Offset of the camera from the followed person: to the left of the tour's path and behind, m.
constexpr Vec3<float> beside{-4.2F, 2.1F, -5.2F};
constexpr float hips_m = 0.95F, follows_per_frame = 0.04F;
constexpr Colour joint{0.66F, 0.64F, 0.60F};

/// Takes pictures of the town and its people.
class TownCamera {
 public:
  /// Creates a camera for pictures of that size, pixels. Errors: a size out of range, no driver.
  static Result<TownCamera> create(int width, int height, TownView view) {
    auto camera = CrowdCamera::create(width, height);
    if (!camera) return tl::unexpected(camera.error());
    return TownCamera(std::move(*camera), view);
  }

  /// Moves the camera, once per picture. It lags a little, so that it sways less than the followed person.
  void follow(const TownScene& scene) {
    if (view_ == TownView::above) {
      camera_.eye = {-13, 13, -17};
      camera_.target = {-0.5F, 0, 4.5F};
      camera_.vertical_fov_deg = 42;
      return;
    }
    const Root guide = scene.guide();
    const auto x = static_cast<float>(guide.x_m), z = static_cast<float>(guide.z_m);
    const Vec3<float> target{x, town_ground(x, z).height_m + hips_m, z};
    const Vec3<float> by = target - camera_.target;
    camera_.target = looks_ ? camera_.target + follows_per_frame * by : target;
    camera_.eye = camera_.target + beside;
    camera_.vertical_fov_deg = 42;
    looks_ = true;
  }
  /// Takes a picture. Errors: those of the driver.
  Result<void> take(const TownScene& scene, Image& image) {
    people_.set_backdrop(meshes_, lines_);
    std::vector<CrowdCamera::Drawn> people;
    for (std::size_t i = 0; i < scene.people().size(); ++i) people.push_back({scene.people()[i], i, false});
    return people_.take(scene.simulation(), camera_, people, image);
  }

 private:
  TownCamera(CrowdCamera camera, TownView view)
      : people_(std::move(camera)), view_(view), town_(town_meshes()), paving_(town_paving()) {
    for (const TownMesh& mesh : town_)
      meshes_.push_back(
          {.position = mesh.position, .triangle = mesh.triangle, .normal = mesh.normal, .colour = mesh.colour});
    lines_.push_back({.position = paving_, .colour = joint, .width = 0.012F, .unit = LineUnit::metre});
  }

  CrowdCamera people_;
  TownView view_;
  Camera camera_;
  bool looks_ = false;
  std::vector<TownMesh> town_;
  std::vector<Vec3<float>> paving_;
  std::vector<DrawMesh> meshes_;
  std::vector<DrawLines> lines_;
};

struct TownText {
  std::string people = "40", seconds = "45", seed = "1", threads = "0", view = "follow", capture, report;
};

struct TownRun {
  TownOptions town;
  double seconds = 0;
  TownView view = TownView::follow;
  std::filesystem::path capture, report;
  bool video = false;
};

constexpr int width = 1280, height = 720, ticks_a_picture = 2;

Result<TownRun> read_options(const TownText& text) {
  TownRun run;
  OptionReader read;
  run.town.people = read(read_count("--people", text.people, 1, 300));
  run.town.seed = read(read_count("--seed", text.seed, 0, 999'999'999'999'999'999));
  run.town.threads = static_cast<int>(read(read_count("--threads", text.threads, 0, 256)));
  run.seconds = read(read_value("--seconds", text.seconds, Quantity::time, 0.1, 3600));
  run.view = text.view == "above" ? TownView::above : TownView::follow;
  run.capture = text.capture;
  run.report = text.report;
  run.video = run.capture.extension() == ".mp4";
  if (!run.capture.empty()) {
    if (!run.video && run.capture.extension() != ".png")
      read.refuse(
          fmt::format("--capture {}: is neither .mp4 nor .png; end it in .mp4 for a video, or in .png for a picture",
                      text.capture));
    read(check_result_place("--capture", run.capture));
  }
  if (!run.report.empty()) read(check_result_place("--report", run.report));
  return read.result(std::move(run));
}

std::string report_text(const TownScene& scene) {
  const TownReport& r = scene.report();
  const double per_tick = 1e6 / static_cast<double>(r.ticks), people = static_cast<double>(scene.people().size());
  const double seconds = scene.simulation().time_s();
  return fmt::format(
      "{} people, {:.0f} s: {:.2f} m/s on average, {} arrivals, {} paths found\n"
      "{}longest wait {:.1f} s\n"
      "mean tick {:.0f} us: paths {:.0f}, avoidance {:.0f}, ground {:.0f} ({:.1f} queries), walking {:.0f}\n",
      scene.people().size(), seconds, r.walked_m / seconds / people, r.arrivals, r.paths,
      people < 2 ? "" : fmt::format("smallest gap between people {:.1f} cm; ", 100 * r.nearest_m), r.longest_wait_s,
      per_tick * (r.paths_s + r.avoidance_s + r.terrain_s + r.tick_s), per_tick * r.paths_s, per_tick * r.avoidance_s,
      per_tick * r.terrain_s, static_cast<double>(r.places_asked) / static_cast<double>(r.ticks), per_tick * r.tick_s);
}

std::string report_json(const TownScene& scene, const TownRun& run) {
  const TownReport& r = scene.report();
  Json json;
  json["people"] = scene.people().size();
  json["seed"] = run.town.seed;
  json["seconds"] = scene.simulation().time_s();
  json["mean_speed_m_s"] = r.walked_m / scene.simulation().time_s() / static_cast<double>(scene.people().size());
  json["arrivals"] = r.arrivals;
  json["paths"] = r.paths;
  if (scene.people().size() > 1) json["nearest_m"] = r.nearest_m;
  json["longest_wait_s"] = r.longest_wait_s;
  json["tick_us"] = {{"ways", 1e6 * r.paths_s / static_cast<double>(r.ticks)},
                     {"avoidance", 1e6 * r.avoidance_s / static_cast<double>(r.ticks)},
                     {"ground", 1e6 * r.terrain_s / static_cast<double>(r.ticks)},
                     {"walking", 1e6 * r.tick_s / static_cast<double>(r.ticks)}};
  json["state_hash"] = fmt::format("{:016x}", scene.simulation().state_hash());
  return json.dump(2) + "\n";
}

/// Runs the ticks and takes pictures: every second tick for a video, or one at the end.
Result<void> go(const TownRun& run, TownScene& scene) {
  const auto ticks = static_cast<std::size_t>(std::max(1L, std::lround(run.seconds / scene.simulation().tick_s())));
  std::optional<TownCamera> camera;
  std::optional<VideoWriter> video;
  if (!run.capture.empty()) {
    auto made = TownCamera::create(width, height, run.view);
    if (!made) return tl::unexpected(made.error());
    camera.emplace(std::move(*made));
  }
  if (run.video) {
    auto opened =
        VideoWriter::create(run.capture.string(), width, height, 1 / (ticks_a_picture * scene.simulation().tick_s()));
    if (!opened) return tl::unexpected(opened.error());
    video = std::move(*opened);
  }
  Image image;
  ProgressBar bar("town", ticks);
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    scene.tick();
    if (camera && !run.video) camera->follow(scene);
    if (run.video && tick % ticks_a_picture == 0) {
      camera->follow(scene);
      if (auto done = camera->take(scene, image); !done) return done;
      if (auto done = video->add(image); !done) return done;
    }
    bar.at(tick + 1);
  }
  if (video) {
    if (auto done = video->close(); !done) return done;
  } else if (camera) {
    if (auto done = camera->take(scene, image); !done) return done;
    if (auto done = write_png(run.capture.string(), image, PngEffort::small); !done)
      return fail("--capture " + done.error().message);
  }
  if (camera) say_written(run.capture);
  return {};
}

Result<void> run_town(const TownText& text) {
  const auto run = read_options(text);
  if (!run) return tl::unexpected(run.error());
  auto scene = TownScene::make(run->town);
  if (!scene) return tl::unexpected(scene.error());
  if (auto done = go(*run, *scene); !done) return done;
  write_output(report_text(*scene));
  if (run->report.empty()) return {};
  return write_result("--report", run->report, report_json(*scene, *run));
}

}  // namespace

Subcommand town_command() {
  auto text = std::make_shared<TownText>();
  Subcommand command{.name = "town"};
  command.footer =
      "The town has a street with kerbs, a square, houses, stairs up to a terrace and a ramp down from it.\n"
      "Each person has a destination, a path found by Recast and Detour, and a desired velocity along it.\n"
      "Avoidance keeps people apart; Terrain places their feet on the ground. One person takes a tour\n"
      "across the street, around the corner of a house, up the stairs, over the terrace and down the ramp;\n"
      "--view follow moves with this person.\n"
      "\n"
      "Examples: mobil town\n"
      "          mobil town --capture town.mp4\n"
      "          mobil town --people 120 --seconds 20 --view above --capture town.png";
  add_options(
      command,
      {{"--people", &text->people, "Number of people, 1 to 300"},
       {"--seconds", &text->seconds, "Simulated time, 0.1s to 3600s"},
       {"--seed", &text->seed, "Seed of the people and their destinations"},
       {"--threads", &text->threads, "Number of threads, 1 to 256; 0: one per processor"},
       {.name = "--view", .target = &text->view, .help = "Position of the camera", .choices = {"follow", "above"}},
       {"--capture", &text->capture, "Video, FILE.mp4, or picture at the end, FILE.png"},
       {"--report", &text->report, "JSON FILE for the results"}});
  command.empty_refused = true;
  command.run = [text] { return exit_status_of("town", run_town(*text)); };
  return command;
}

}  // namespace mobil
