// `mobil view`: a window with one person, a crowd, and sliders for their parameters.

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>

#include <mobil/components/gait.h>
#include <mobil/png.h>
#include "demo/program/body_options.h"
#include "demo/program/commands.h"
#include "demo/program/units.h"
#include "demo/view/view_scene.h"
#include "demo/view/view_window.h"

namespace mobil {
namespace {

/// State of the window only.
struct ViewTime {
  bool paused = false;
  int pace = 0;  // real time, a quarter, a sixteenth
  double tick_ms = 0, picture_ms = 0;
};

constexpr std::array<const char*, view_groups> group_name = {"hamstrings", "quadriceps", "triceps surae",
                                                             "tibialis anterior"};
constexpr std::array methods = {Method::explicit_central,
                                Method::implicit_central,
                                Method::newmark,
                                Method::statics,
                                Method::modal,
                                Method::finite,
                                Method::none};

void slide(const char* name, float& value, float low, float high, const char* format) {
  ImGui::SliderFloat(name, &value, low, high, format, ImGuiSliderFlags_AlwaysClamp);
}

/// Shows a list of names to choose from.
template <class Names>
void pick(const char* name, std::size_t& chosen, const Names& names) {
  if (!ImGui::BeginCombo(name, std::string(names[chosen]).c_str())) return;
  for (std::size_t i = 0; i < std::size(names); ++i) {
    if (ImGui::Selectable(std::string(names[i]).c_str(), i == chosen)) chosen = i;
  }
  ImGui::EndCombo();
}

void body_and_walk(ViewChoice& choice) {
  if (ImGui::CollapsingHeader("Body", ImGuiTreeNodeFlags_DefaultOpen)) {
    slide("height", choice.body.height_m, 1.2F, 2.2F, "%.2f m");
    slide("mass", choice.body.mass_kg, 30, 200, "%.0f kg");
    auto build = static_cast<std::size_t>(choice.body.constitution);
    pick("build", build, constitution_name);
    choice.body.constitution = static_cast<Constitution>(build);
    auto sex = static_cast<std::size_t>(choice.body.sex);
    pick("sex", sex, sex_name);
    choice.body.sex = static_cast<Sex>(sex);
  }
  if (ImGui::CollapsingHeader("Walk", ImGuiTreeNodeFlags_DefaultOpen)) {
    float speed_km_h = 3.6F * choice.gait.speed_m_s.value_or(0), step_m = choice.gait.step_length_m.value_or(0);
    slide("speed", speed_km_h, 0, 8, "%.1f km/h");
    slide("step length", step_m, 0, 1.1F, step_m > 0 ? "%.2f m" : "usual");
    choice.gait.speed_m_s = speed_km_h / 3.6F;
    choice.gait.step_length_m = step_m > 0.01F && speed_km_h > 0 ? std::optional(step_m) : std::nullopt;
  }
  if (ImGui::CollapsingHeader("Style of walking")) {
    for (const GaitParameter& p : gait_parameters) {
      slide(std::string(p.name).c_str(), choice.gait.style.*p.value, p.low, p.high, "%.3g");
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(p.meaning).c_str());
    }
  }
}

void muscles(const ViewScene& scene, ViewChoice& choice) {
  if (!ImGui::CollapsingHeader("Muscles", ImGuiTreeNodeFlags_DefaultOpen)) return;
  for (std::size_t g = 0; g < view_groups; ++g) {
    const ViewMethod is = scene.method(g);
    if (choice.choose) {
      ImGui::LabelText(group_name[g], "%s",
                       std::string(method_name[static_cast<std::size_t>(is.method.method)]).c_str());
    } else {
      std::array<std::string_view, methods.size()> names;
      std::ranges::transform(methods, names.begin(), [](Method m) { return method_name[static_cast<std::size_t>(m)]; });
      auto chosen = static_cast<std::size_t>(std::ranges::find(methods, choice.method[g]) - methods.begin());
      pick(group_name[g], chosen, names);
      choice.method[g] = methods[chosen];
    }
    if (is.cost_us > 0) {
      ImGui::TextDisabled("  error up to %.2f mm, %.2f us per tick", static_cast<double>(1000 * is.error_m),
                          static_cast<double>(is.cost_us));
    }
  }
  int modes = static_cast<int>(choice.modes);
  ImGui::SliderInt("modes", &modes, 1, 32, "%d", ImGuiSliderFlags_AlwaysClamp);
  choice.modes = static_cast<std::uint32_t>(modes);
  constexpr std::array<ExcitationSource, 3> sources = {ExcitationSource::none, ExcitationSource::phase,
                                                       ExcitationSource::moments};
  constexpr std::array<std::string_view, 3> pulls = {"none", "by gait phase", "by joint moments"};
  auto pull = static_cast<std::size_t>(std::ranges::find(sources, choice.activation) - sources.begin());
  pick("activation", pull, pulls);
  choice.activation = sources[pull];
  ImGui::Checkbox("inertia", &choice.inertia);
  ImGui::SameLine();
  ImGui::Checkbox("forces", &choice.forces);
}

void crowd(const ViewScene& scene, ViewChoice& choice) {
  if (!ImGui::CollapsingHeader("Crowd", ImGuiTreeNodeFlags_DefaultOpen)) return;
  int people = static_cast<int>(choice.people);
  ImGui::SliderInt("people", &people, 0, 5000, "%d", ImGuiSliderFlags_AlwaysClamp);
  choice.people = static_cast<std::size_t>(people);
  ImGui::Checkbox("choose methods for this camera", &choice.choose);
  auto budget_ms = static_cast<float>(1000 * choice.budget_s);
  slide("error", choice.tolerance_px, 0.25F, 8, "%.2f px");
  slide("budget", budget_ms, 0, 10, budget_ms > 0 ? "%.1f ms" : "none");
  choice.budget_s = static_cast<double>(budget_ms) / 1000;
  if (const auto& did = scene.chosen())
    ImGui::TextDisabled("  muscles %.2f ms per tick, %zu switched", 1000 * did->predicted_s, did->switched);
}

template <std::size_t N>
void plot(const char* name, const std::array<float, N>& values, float low, float high) {
  ImGui::PlotLines(name, values.data(), static_cast<int>(N), 0, nullptr, low, high, {0, 42});
}

/// Draws the panel, between ViewWindow::begin_frame and end_frame. Returns the choice with the user's changes;
/// `refusal` is shown in red.
ViewChoice view_panel(const ViewScene& scene, const std::string& refusal, ViewTime& time) {
  ViewChoice choice = scene.choice();
  const ImVec2 all = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({10, 10}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize({300, std::min(all.y - 20, 640.0F)}, ImGuiCond_FirstUseEver);
  if (ImGui::Begin("mobil")) {
    ImGui::PushItemWidth(150);
    if (ImGui::Button(time.paused ? "Play" : "Pause")) time.paused = !time.paused;
    ImGui::SameLine();
    ImGui::SetNextItemWidth(110);
    ImGui::Combo("time", &time.pace, "real time\0a quarter\0a sixteenth\0");
    ImGui::TextDisabled("tick %.2f ms, picture %.1f ms", time.tick_ms, time.picture_ms);
    if (!refusal.empty()) {
      ImGui::PushStyleColor(ImGuiCol_Text, {1, 0.45F, 0.4F, 1});
      ImGui::TextWrapped("%s", refusal.c_str());
      ImGui::PopStyleColor();
    }
    body_and_walk(choice);
    muscles(scene, choice);
    crowd(scene, choice);
    ImGui::PopItemWidth();
  }
  ImGui::End();
  ImGui::SetNextWindowPos({all.x - 320, 10}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize({310, 500}, ImGuiCond_FirstUseEver);
  if (ImGui::Begin("The last 2.4 s, right leg")) {
    ImGui::PushItemWidth(150);
    const ViewTrace& trace = scene.trace();
    plot("hip, deg", trace.hip_deg, -40, 80);
    plot("knee, deg", trace.knee_deg, -40, 80);
    plot("ankle, deg", trace.ankle_deg, -40, 80);
    plot("right, of weight", trace.right_load, 0, 1.5F);
    plot("left, of weight", trace.left_load, 0, 1.5F);
    for (std::size_t g = 0; g < view_groups; ++g) {
      plot(fmt::format("{}, mm", group_name[g]).c_str(), trace.elongation_mm[g], -60, 60);
    }
    ImGui::PopItemWidth();
  }
  ImGui::End();
  return choice;
}

struct ViewText {
  BodyText body;
  std::string speed = "5km/h", seconds;
  std::size_t people = 60, width = 1280, height = 760;
  std::string capture;
  bool hidden = false;
};

/// A camera that orbits the person and stays above the ground.
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

/// Runs the window until it is closed, or for `seconds` of simulated time (0: no end) at 30 pictures per second.
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
  if (text.people > 5000) return fail(fmt::format("--people {}: give a whole number from 0 to 5000", text.people));
  if (text.width < 200 || text.width > 8192 || text.height < 200 || text.height > 8192)
    return fail(fmt::format("--width {} --height-px {}: give whole numbers from 200 to 8192", text.width, text.height));
  if (!text.capture.empty() && *seconds == 0) return fail("--capture needs --seconds, the time of the picture");
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
      "Drag to orbit, turn the wheel to zoom, press Space to pause and '.' to advance one tick. An invalid\n"
      "value is rejected with the library's message, and the slider returns to its old value.\n"
      "\nExamples: mobil view\n"
      "          mobil view --height 1.62 --mass 55 --people 1000\n"
      "          mobil view --seconds 3 --capture view.png";
  command.options = body_options(text->body);
  add_options(command, {{"--speed", &text->speed, "Walking speed, 0 to 10 m/s"},
                        {"--people", &text->people, "Number of people in the crowd, 0 to 5000"},
                        {"--width", &text->width, "Width of the window, 200 to 8192 pixels"},
                        {"--height-px", &text->height, "Height of the window, 200 to 8192 pixels"},
                        {"--seconds", &text->seconds, "Close after this simulated time, at 30 pictures per second"},
                        {"--capture", &text->capture, "Picture of the window at the end, FILE.png; needs --seconds"},
                        {"--hidden", &text->hidden, "Draw without showing the window (still needs a display)"}});
  command.run = [text] { return exit_status_of("view", run_view(*text)); };
  return command;
}

}  // namespace mobil
