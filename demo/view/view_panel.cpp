#include "demo/view/view_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <iterator>

#include <mobil/components/gait_style.h>
#include "demo/program/body_options.h"

namespace mobil {
namespace {

constexpr std::array<const char*, view_groups> group_name = {"hamstrings", "quadriceps", "triceps surae",
                                                             "tibialis anterior"};
constexpr std::array methods = {Method::ecd,     Method::icd,    Method::caa, Method::statics,
                                Method::reduced, Method::finite, Method::none};

void slide(const char* name, float& value, float low, float high, const char* format) {
  ImGui::SliderFloat(name, &value, low, high, format, ImGuiSliderFlags_AlwaysClamp);
}

/// A list of names of which one is chosen.
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
      ImGui::TextDisabled("  %.2f mm off at most, %.2f us a tick", static_cast<double>(1000 * is.error_m),
                          static_cast<double>(is.cost_us));
    }
  }
  int vectors = static_cast<int>(choice.vectors);
  ImGui::SliderInt("vectors", &vectors, 1, 32, "%d", ImGuiSliderFlags_AlwaysClamp);
  choice.vectors = static_cast<std::uint32_t>(vectors);
  constexpr std::array<ExcitationSource, 3> sources = {ExcitationSource::none, ExcitationSource::phase,
                                                       ExcitationSource::moments};
  constexpr std::array<std::string_view, 3> pulls = {"not at all", "by the phase of gait", "by joint moments"};
  auto pull = static_cast<std::size_t>(std::ranges::find(sources, choice.activation) - sources.begin());
  pick("pull", pull, pulls);
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
    ImGui::TextDisabled("  muscles %.2f ms a tick, %zu switched", 1000 * did->predicted_s, did->switched);
}

template <std::size_t N>
void plot(const char* name, const std::array<float, N>& values, float low, float high) {
  ImGui::PlotLines(name, values.data(), static_cast<int>(N), 0, nullptr, low, high, {0, 42});
}

}  // namespace

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
    ImGui::Combo("time", &time.pace, "as it runs\0a quarter\0a sixteenth\0");
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

}  // namespace mobil
