#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "demo/lab/compare/compare_muscles.h"
#include "demo/pictures/cycle_plot.h"
#include "demo/program/json.h"

namespace mobil {
namespace {

constexpr std::array<float, 3> drawn_speeds_m_s = {0.8F, 1.4F, 1.8F};
constexpr const char* speed_colour[] = {"#2a9d8f", "#111", "#a23b72"};

std::string spaced(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '_', ' ');
  return text;
}

PlotPanel moment_panel(const MuscleComparison& comparison, std::size_t k) {
  double most = 0;
  for (const MuscleStride& stride : comparison.strides) most = std::max(most, stride.residual(k));
  PlotPanel panel = cycle_panel(fmt::format("{}, up to {:.0f} % left", leg_moment_name[k], 100 * most), "N m/kg");
  for (std::size_t s = 0; s < drawn_speeds_m_s.size(); ++s) {
    const MuscleStride& stride = comparison.at(drawn_speeds_m_s[s]);
    const std::string speed = fmt::format("{:.1f} m/s", stride.speed_m_s);
    panel.lines.push_back({cycle_percents(), cycle_values(stride.moment[k]), speed_colour[s], speed, 1.4, false});
    panel.lines.push_back({cycle_percents(), cycle_values(stride.left[k]), speed_colour[s], "", 1.2, true});
  }
  return panel;
}

PlotPanel contact_panel(const MuscleComparison& comparison, std::size_t joint) {
  PlotPanel panel = cycle_panel(fmt::format("force in the {}", leg_joint_name[joint]), "body weights");
  panel.y.low = 0;
  for (std::size_t s = 0; s < drawn_speeds_m_s.size(); ++s) {
    const MuscleStride& stride = comparison.at(drawn_speeds_m_s[s]);
    panel.lines.push_back({cycle_percents(), cycle_values(stride.contact[joint]), speed_colour[s], "", 1.4, false});
  }
  return panel;
}

PlotPanel peak_panel(const MuscleComparison& comparison, LegJointIndex joint, const char* title) {
  PlotPanel panel;
  panel.title = title;
  panel.x = {"speed (m/s)", 0, 2.2};
  panel.y = {"body weights", 0, {}};
  PlotLine ours{{}, {}, ours_colour, "", 1.4, false};
  for (const MuscleStride& stride : comparison.strides) {
    ours.x.push_back(stride.speed_m_s);
    ours.y.push_back(stride.peak(joint));
  }
  panel.lines.push_back(std::move(ours));
  PlotPoints measured{{}, {}, {}, second_colour, "instrumented implant, peak"};
  for (const ImplantPeak& peak : implant_peaks()) {
    if (peak.joint != joint) continue;
    if (std::isfinite(peak.speed_m_s)) {
      measured.x.push_back(peak.speed_m_s);
      measured.y.push_back(peak.peak);
    } else {
      panel.lines.push_back({{0.9, 1.5}, {peak.peak, peak.peak}, second_colour, "", 2.4, false});
    }
  }
  panel.points.push_back(std::move(measured));
  return panel;
}

/// Electromyograms are scaled to the peak of the activation.
PlotPanel emg_panel(const MuscleComparison& comparison, Muscle muscle) {
  const MuscleStride& stride = comparison.at(emg_speed_m_s);
  const CycleCurve& ours = std::ranges::find(stride.muscle, muscle, &MuscleCurve::muscle)->activation;
  PlotPanel panel = cycle_panel({}, "activation");
  panel.y.low = 0;
  std::string correlations;
  double worst = 1;
  for (const Emg& emg : comparison.emg) {
    if (emg.muscle != muscle) continue;
    const bool first = emg.source == "Santuz";
    const double scale = std::ranges::max(ours) / std::ranges::max(emg.curve.mean), r = emg_correlation(stride, emg);
    MeasuredCurve scaled = emg.curve;
    for (double& v : scaled.mean) v *= scale;
    for (double& v : scaled.sd) v *= scale;
    if (first) {
      add_measured(panel, scaled, "EMG, " + emg.source, first_colour, false);
    } else {
      panel.lines.push_back(
          {cycle_percents(), cycle_values(scaled.mean), second_colour, "EMG, " + emg.source, 1.4, false});
    }
    correlations += fmt::format(" {:.2f}", r);
    worst = std::min(worst, r);
  }
  panel.title = fmt::format("{}: r{}{}", spaced(muscle_name(muscle)), correlations, worst < 0.5 ? ", differs" : "");
  panel.lines.push_back({cycle_percents(), cycle_values(ours), ours_colour, "", 1.8, false});
  return panel;
}

/// Returns the muscles with an electromyogram, in the first table's order.
std::vector<Muscle> measured_muscles(const MuscleComparison& comparison) {
  std::vector<Muscle> all;
  for (const Emg& emg : comparison.emg)
    if (std::ranges::find(all, emg.muscle) == all.end()) all.push_back(emg.muscle);
  return all;
}

}  // namespace

std::string muscle_text(const MuscleComparison& comparison) {
  std::string text = "\nmuscles that make the moments of the walk\n";
  const auto out = std::back_inserter(text);
  for (const MuscleStride& stride : comparison.strides) {
    fmt::format_to(out, "{:.2f} m/s: rest of", stride.speed_m_s);
    for (std::size_t k = 0; k < leg_moment_count; ++k)
      fmt::format_to(out, "{} {} {:.1f} %", k == 0 ? "" : ",", leg_moment_name[k], 100 * stride.residual(k));
    for (std::size_t j = 0; j < leg_joint_count; ++j)
      fmt::format_to(out, "{}{} {:.2f}", j == 0 ? "; peak force in the " : ", ", leg_joint_name[j], stride.peak(j));
    text += " body weights\n";
  }
  for (const ImplantPeak& peak : implant_peaks())
    fmt::format_to(out, "  implant in the {}: {:.2f} body weights{} ({})\n", leg_joint_name[peak.joint], peak.peak,
                   std::isfinite(peak.speed_m_s) ? fmt::format(" at {:.2f} m/s", peak.speed_m_s) : "", peak.source);
  text += "  correlation with electromyograms:";
  for (const Emg& emg : comparison.emg)
    fmt::format_to(out, " {} {:.2f} ({}),", muscle_name(emg.muscle), emg_correlation(comparison.at(emg_speed_m_s), emg),
                   emg.source);
  text.back() = '\n';
  return text;
}

std::string muscle_json(const MuscleComparison& comparison) {
  Json json;
  for (const MuscleStride& stride : comparison.strides) {
    Json entry = {{"speed_m_s", stride.speed_m_s}};
    for (std::size_t k = 0; k < leg_moment_count; ++k) {
      entry["moments"][leg_moment_name[k]] = {
          {"unit", "N m/kg"}, {"residual", stride.residual(k)}, {"moment", stride.moment[k]}, {"left", stride.left[k]}};
    }
    for (std::size_t j = 0; j < leg_joint_count; ++j) {
      entry["contact"][leg_joint_name[j]] = {
          {"unit", "body weights"}, {"peak", stride.peak(j)}, {"ours", stride.contact[j]}};
    }
    for (const MuscleCurve& curve : stride.muscle) entry["activation"][muscle_name(curve.muscle)] = curve.activation;
    json["walks"].push_back(std::move(entry));
  }
  for (const Emg& emg : comparison.emg)
    json["emg"].push_back({{"muscle", muscle_name(emg.muscle)},
                           {"source", emg.source},
                           {"correlation", emg_correlation(comparison.at(emg_speed_m_s), emg)}});
  for (const ImplantPeak& peak : implant_peaks())
    json["implants"].push_back({{"joint", leg_joint_name[peak.joint]},
                                {"speed_m_s", peak.speed_m_s},
                                {"peak_body_weights", peak.peak},
                                {"source", peak.source}});
  return json.dump(1) + '\n';
}

std::string muscle_plot(const MuscleComparison& comparison) {
  PlotFigure figure{
      "Muscles that make the moments of the walk",
      "Dashed: moments that the muscles do not make. EMG at 1.4 m/s: shape only, 75 ms later. Implants in "
      "hips: Bergmann 2001, and 1993 (one person); in knees: Kutzner 2010 (own speed, line), Patil 2013 "
      "(maximum). There are none in ankles.",
      5, 200, 120};
  for (std::size_t k = 0; k < leg_moment_count; ++k) figure.panels.push_back(moment_panel(comparison, k));
  for (std::size_t j = 0; j < leg_joint_count; ++j) figure.panels.push_back(contact_panel(comparison, j));
  figure.panels.push_back(peak_panel(comparison, at_hip, "hip: above all implants"));
  figure.panels.push_back(peak_panel(comparison, at_knee, "knee: above most implants"));
  for (const Muscle muscle : measured_muscles(comparison)) figure.panels.push_back(emg_panel(comparison, muscle));
  return svg(figure);
}

}  // namespace mobil
