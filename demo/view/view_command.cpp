// `mobil view`: a window with one person and a crowd, and sliders for all that can be asked of them.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>

#include <mobil/png.h>
#include "demo/program/body_options.h"
#include "demo/program/commands.h"
#include "demo/program/units.h"
#include "demo/view/view_panel.h"
#include "demo/view/view_scene.h"
#include "demo/view/view_window.h"

namespace mobil {
namespace {

struct ViewText {
  BodyText body;
  std::string speed = "5km/h", seconds;
  std::size_t people = 60, width = 1280, height = 760;
  std::string capture;
  bool hidden = false;
};

/// Looks at the person from all sides, as far as the ground allows.
struct Orbit {
  float round_rad = 0.5F, up_rad = 0.09F, away_m = 4.2F;

  void follow(const ViewInput& input) {
    round_rad -= 0.006F * input.turn_px;
    up_rad = std::clamp(up_rad + 0.006F * input.tilt_px, -0.15F, 1.5F);
    away_m = std::clamp(away_m * std::exp(-0.12F * input.zoom), 1.3F, 40.0F);
  }
  Camera camera(const Vec3<float>& pelvis) const {
    Camera camera;
    camera.target = {pelvis.x, 0.88F, pelvis.z};
    const float flat = away_m * std::cos(up_rad);
    camera.eye = {camera.target.x + flat * std::sin(round_rad),
                  std::max(0.05F, camera.target.y + away_m * std::sin(up_rad)),
                  camera.target.z + flat * std::cos(round_rad)};
    return camera;
  }
};

using SteadyClock = std::chrono::steady_clock;
double ms_since(SteadyClock::time_point start) {
  return std::chrono::duration<double, std::milli>(SteadyClock::now() - start).count();
}

/// The window, until it is closed, or for so many seconds of simulated time (0: no end) at 30 pictures a second.
Result<void> show_view(ViewScene& scene, ViewWindow& window, double seconds, const std::string& capture) {
  auto pictures = CrowdCamera::create(window.width(), window.height());
  if (!pictures) return tl::unexpected(pictures.error());
  int width = window.width(), height = window.height();
  Orbit orbit;
  ViewTime time;
  Image picture, shot;
  std::string refusal;
  auto last = SteadyClock::now();
  double rest_s = 0;
  while (!window.closing()) {
    const ViewInput input = window.begin_frame();
    orbit.follow(input);
    if (input.pause) time.paused = !time.paused;
    const ViewChoice asked = view_panel(scene, refusal, time);
    if (!same_choice(asked, scene.choice())) {
      const auto done = scene.set(asked);
      refusal = done ? "" : done.error().message;
    }
    if (const auto gone = scene.gone()) pictures->forget(*gone);

    const Camera camera = orbit.camera(scene.place());
    const double tick_s = scene.simulation().tick_s();
    rest_s += seconds > 0 ? 1.0 / 30 : ms_since(last) / 1000 * std::pow(0.25, time.pace);
    last = SteadyClock::now();
    rest_s = time.paused ? (input.step ? tick_s : 0) : std::min(rest_s, 0.1);
    for (; rest_s >= tick_s * 0.999; rest_s -= tick_s) {
      const auto start = SteadyClock::now();
      scene.tick(camera, width, height);
      time.tick_ms += 0.05 * (ms_since(start) - time.tick_ms);
    }

    if (window.width() != width || window.height() != height) {
      width = window.width();
      height = window.height();
      pictures = CrowdCamera::create(width, height);
      if (!pictures) return tl::unexpected(pictures.error());
    }
    const auto start = SteadyClock::now();
    const Camera now = orbit.camera(scene.place());
    if (auto done = pictures->take(scene.simulation(), now, scene.drawn(), picture); !done) return done;
    time.picture_ms += 0.1 * (ms_since(start) - time.picture_ms);
    const bool ends = seconds > 0 && scene.simulation().time_s() >= seconds - 1e-6;
    window.end_frame(picture, ends && !capture.empty() ? &shot : nullptr);
    if (ends) break;
  }
  if (capture.empty() || shot.rgba.empty()) return {};
  if (auto done = write_png(capture, shot); !done) return fail(fmt::format("--capture: {}", done.error().message));
  say_written(capture);
  return {};
}

Result<void> run_view(const ViewText& text) {
  ViewChoice choice;
  OptionReader read;
  choice.body = read(read_body_options(text.body));
  choice.gait.speed_m_s = static_cast<float>(read(read_value("--speed", text.speed, Quantity::speed, 0, 10)));
  choice.people = text.people;
  double given_s = 0;
  if (!text.seconds.empty()) given_s = read(read_value("--seconds", text.seconds, Quantity::time, 0.1, 3600));
  const auto seconds = read.result(given_s);
  if (!seconds) return tl::unexpected(seconds.error());
  if (text.people > 5000) return fail(fmt::format("--people {}: 0 to 5000", text.people));
  if (text.width < 200 || text.width > 8192 || text.height < 200 || text.height > 8192)
    return fail(fmt::format("--width {} --height-px {}: 200 to 8192", text.width, text.height));
  if (!text.capture.empty() && *seconds == 0) return fail("--capture wants --seconds: when the picture is taken");
  auto window = ViewWindow::open("mobil", static_cast<int>(text.width), static_cast<int>(text.height), text.hidden);
  if (!window) return tl::unexpected(window.error());
  auto scene = ViewScene::make(choice);
  if (!scene) return tl::unexpected(scene.error());
  return show_view(*scene, *window, *seconds, text.capture);
}

}  // namespace

Subcommand view_command() {
  auto text = std::make_shared<ViewText>();
  Subcommand command{.name = "view"};
  command.footer =
      "Drag to turn, wheel to come nearer, Space stops time, '.' makes one tick. What cannot be is refused in the\n"
      "library's words, and the slider goes back.\n"
      "\nExamples: mobil view\n"
      "          mobil view --height 1.62 --mass 55 --people 1000\n"
      "          mobil view --seconds 3 --capture view.png";
  command.options = body_options(text->body);
  add_options(command,
              {{"--speed", &text->speed, "Walking speed, 0 to 10 m/s"},
               {"--people", &text->people, "Of the crowd, 0 to 5000"},
               {"--width", &text->width, "Of the window, pixels"},
               {"--height-px", &text->height, "Of the window, pixels"},
               {"--seconds", &text->seconds, "Closes then, of simulated time at 30 pictures a second"},
               {"--capture", &text->capture, "PNG of the window at its end; wants --seconds"},
               {"--hidden", &text->hidden, "Draws without showing the window (a display is needed all the same)"}});
  command.run = [text] { return exit_status_of("view", run_view(*text)); };
  return command;
}

}  // namespace mobil
