#include "demo/lab/compare/compare_verdicts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "demo/program/json.h"

namespace mobil {
namespace {

constexpr GaitQuantity quantities[] = {GaitQuantity::hip,         GaitQuantity::knee,        GaitQuantity::ankle,
                                       GaitQuantity::vertical,    GaitQuantity::fore_aft,    GaitQuantity::hip_moment,
                                       GaitQuantity::knee_moment, GaitQuantity::ankle_moment};

bool is_angle(GaitQuantity quantity) {
  return index(quantity) < 3;
}

double step_excursion_mm(const WalkedStride& stride) {
  return 1000 * (stride.com_highest_m - stride.com_lowest_m);
}

/// Returns "Schwartz" for "Schwartz 2008".
std::string short_name(const MeasuredSet& set) {
  return set.name.substr(0, set.name.find(' '));
}

std::string angle_line(const GaitReference& reference, const CurveFinding& finding, double rms_bound, double max_rate) {
  std::string line =
      fmt::format("{:>4.0f} %{} {:>5.1f}{} ", 100 * finding.inside_union, finding.inside_union >= 0.9 ? ' ' : '!',
                  finding.rms_nearer_set, finding.rms_nearer_set <= rms_bound ? ' ' : '!');
  std::vector<std::string> peaks, alone;
  for (const auto& peak : finding.peaks) {
    peaks.push_back(fmt::format("{:+.1f}{}", peak.timing_outside, std::abs(peak.timing_outside) <= 3 ? ' ' : '!'));
  }
  line += fmt::format(" {:<14} {:>4.2f}{}", fmt::format("{}", fmt::join(peaks, " ")), finding.rate_ratio,
                      finding.rate_ratio <= max_rate ? ' ' : '!');
  for (std::size_t i = 0; i < finding.set.size(); ++i) {
    alone.push_back(fmt::format("{} {:.0f} % {:.1f}", short_name(reference.sets[finding.set[i]]),
                                100 * finding.inside[i], finding.rms[i]));
  }
  return line + fmt::format(" {}", fmt::join(alone, ", "));
}

/// Moments are compared with the measured ones scaled to our leg; in brackets also with Schwartz' as published.
std::string force_line(const GaitReference& reference, GaitQuantity quantity, const CurveFinding& finding) {
  std::vector<std::string> peaks;
  for (const auto& peak : finding.peaks) {
    const double sign = peak.ours.value < 0 ? -1 : 1;  // more is +, whichever way the peak points
    std::string beside = fmt::format("{:+.0f} %", 100 * sign * peak.size_outside);
    for (std::size_t i = 0; i < finding.set.size() && is_moment(quantity); ++i) {
      beside += fmt::format(", {}'s as printed {:+.0f} %", short_name(reference.sets[finding.set[i]]),
                            100 * (peak.ratio_printed[i] - 1));
    }
    peaks.push_back(fmt::format("{} {:.2f} ({})", peak.name, peak.ours.value, beside));
  }
  return fmt::format("{:>4.0f} %  r {:.3f}  {}", 100 * finding.inside_union, finding.best_correlation,
                     fmt::join(peaks, ", "));
}

Json per_set(const GaitReference& reference, const CurveFinding& finding, const std::vector<double>& values) {
  Json object;
  for (std::size_t i = 0; i < finding.set.size(); ++i) object[short_name(reference.sets[finding.set[i]])] = values[i];
  return object;
}

Json finding_json(const GaitReference& reference, GaitQuantity quantity, const CurveFinding& finding) {
  Json json;
  json["unit"] = is_angle(quantity) ? "deg" : index(quantity) < 5 ? "body weights" : "N m/kg";
  json["inside_union"] = finding.inside_union;
  json["inside"] = per_set(reference, finding, finding.inside);
  json["fastest_of_measured"] = finding.rate_ratio;
  json["rms_nearer_set"] = finding.rms_nearer_set;
  json["rms_nearer_point"] = finding.rms_nearer_point;
  json["rms"] = per_set(reference, finding, finding.rms);
  json["correlation"] = per_set(reference, finding, finding.correlation);
  for (const auto& peak : finding.peaks) {
    Json entry = {{"name", peak.name},
                  {"percent", peak.ours.percent},
                  {"value", peak.ours.value},
                  {"timing_error_percent", per_set(reference, finding, peak.timing)},
                  {"ratio", per_set(reference, finding, peak.ratio)}};
    if (is_moment(quantity)) entry["ratio_as_printed"] = per_set(reference, finding, peak.ratio_printed);
    json["peaks"].push_back(std::move(entry));
  }
  return json;
}

Json step_json(const WalkedStride& stride) {
  return {{"speed_m_s", stride.speed_m_s},
          {"step_length_m", stride.step_length_m},
          {"cadence_steps_min", 60 * stride.step_frequency_hz},
          {"com_lowest_m", stride.com_lowest_m},
          {"com_highest_m", stride.com_highest_m},
          {"com_mean_m", stride.com_mean_m}};
}

Json walk_json(const Comparison& comparison, const ComparedWalk& walk) {
  const MeasuredSet& own = comparison.reference.sets[walk.set];
  Json json;
  json["set"] = own.name;
  json["class"] = compared_class_name[walk.speed_class];
  json.update(step_json(walk.stride));
  json["double_support_cycle"] = walk.stride.double_support_cycle;
  json["com_lowest_percent"] = walk.stride.com_lowest_percent;
  json["com_highest_percent"] = walk.stride.com_highest_percent;
  if (walk.stride.forces) json["mean_vertical_force_body_weights"] = walk.stride.forces->mean_weights;
  for (const auto quantity : quantities) {
    Json& entry = json["quantities"][std::string(gait_quantity_name[index(quantity)])];
    const auto finding = examine(walk, comparison.reference, quantity);
    if (!finding) {
      entry = "not simulated";
      continue;
    }
    entry = finding_json(comparison.reference, quantity, *finding);
    entry["ours"] = *walk.stride.curve(quantity, own.hip_from_vertical);
  }
  json["com_height_m"] = walk.stride.com_height;
  return json;
}

Json balance_json(const std::vector<BalancedScene>& scenes) {
  Json json = Json::array();
  for (const auto& scene : scenes) {
    json.push_back({{"scene", scene.name},
                    {"unit", "N m/kg"},
                    {"pitch_rms", scene.moment.pitch_rms},
                    {"pitch_peak", scene.moment.pitch_peak},
                    {"roll_rms", scene.moment.roll_rms},
                    {"roll_peak", scene.moment.roll_peak},
                    {"yaw_rms", scene.moment.yaw_rms},
                    {"yaw_peak", scene.moment.yaw_peak}});
  }
  return json;
}

Json varied_json(const std::vector<VariedWalk>& walks, std::string_view name) {
  Json json = Json::array();
  for (const auto& walk : walks) {
    Json entry = {{name, walk.value}};
    entry.update(step_json(walk.stride));
    json.push_back(std::move(entry));
  }
  return json;
}

std::string varied_text(const char* title, const std::vector<VariedWalk>& walks, std::string_view unit) {
  std::string text = title;
  for (const auto& walk : walks) {
    text += fmt::format("  {:.4g} {}: {:.1f} to {:.1f} mm", walk.value, unit, 1000 * walk.stride.com_lowest_m,
                        1000 * walk.stride.com_highest_m);
  }
  return text + '\n';
}

}  // namespace

std::string comparison_text(const Comparison& comparison, const std::vector<Verdict>& verdicts) {
  const GaitReference& reference = comparison.reference;
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{:g} m, {:g} kg against", comparison.body.height_m, comparison.body.mass_kg);
  for (const auto& set : reference.sets)
    fmt::format_to(out, " {}{}", set.name, &set == &reference.sets.back() ? "" : ",");
  text += '\n';
  if (!reference.note.empty()) fmt::format_to(out, "({})\n", reference.note);

  fmt::format_to(out, "\n{:<34} {:<6} {:>7} {:>6}  {:<14} {:<5} {}\n", "joint angles", "", "inside", "rms",
                 "peaks, % off", "rate", "each set alone: inside, rms (deg)");
  for (const auto& walk : comparison.walks) {
    for (std::size_t q = 0; q < 3; ++q) {
      const auto finding = examine(walk, reference, quantities[q]);
      fmt::format_to(out, "{:<34} {:<6} {}\n", q == 0 ? walk_name(comparison, walk) : "", gait_quantity_name[q],
                     angle_line(reference, *finding, angle_rms_bound_deg(walk.speed_class), rate_bound[q]));
    }
  }
  text += "\nground reaction (body weights), moments (N m/kg)\n";
  const bool any =
      std::ranges::any_of(comparison.walks, [](const auto& walk) { return walk.stride.forces.has_value(); });
  if (!any) text += "  not simulated\n";
  for (const auto& walk : comparison.walks) {
    if (!walk.stride.forces) continue;
    fmt::format_to(out, "{}, mean of both feet {:.4f} body weights\n", walk_name(comparison, walk),
                   walk.stride.forces->mean_weights);
    for (std::size_t q = 3; q < gait_quantity_count; ++q) {
      fmt::format_to(out, "  {:<14} {}\n", gait_quantity_name[q],
                     force_line(reference, quantities[q], *examine(walk, reference, quantities[q])));
    }
  }
  text += "\nmoment of the ground that the motion does not account for (N m/kg, rms and peak)\n";
  for (const auto& scene : comparison.balance) {
    const UnbalancedMoment& m = scene.moment;
    fmt::format_to(out, "  {:<22} pitch {:.3f} {:.2f}  roll {:.3f} {:.2f}  yaw {:.3f} {:.2f}\n", scene.name,
                   m.pitch_rms, m.pitch_peak, m.roll_rms, m.roll_peak, m.yaw_rms, m.yaw_peak);
  }
  text += "\ncentre of mass and steps\n";
  for (const auto& walk : comparison.walks) {
    const auto norm = excursion_of(reference, walk.stride);
    fmt::format_to(out,
                   "{:<34} rises {:.1f} mm (measured {:.0f} +- {:.0f}), lowest at {:.0f} %, highest at {:.0f} %, steps "
                   "of {:.3f} m, {:.0f} a minute\n",
                   walk_name(comparison, walk), step_excursion_mm(walk.stride), 1000 * norm.mean_m, 1000 * norm.sd_m,
                   walk.stride.com_lowest_percent, walk.stride.com_highest_percent, walk.stride.step_length_m,
                   60 * walk.stride.step_frequency_hz);
  }
  text += varied_text("longer steps", comparison.by_step_length, "m");
  text += varied_text("heavier people", comparison.by_mass, "kg");

  const auto held = std::ranges::count_if(verdicts, [](const Verdict& v) { return v.held.value_or(false); });
  fmt::format_to(out, "\n{} of {} bounds hold", held, verdicts.size());
  text += held == static_cast<long>(verdicts.size()) ? "\n" : "; these do not:\n";
  for (const auto& v : verdicts) {
    if (v.held.value_or(false)) continue;
    if (!v.held) {
      fmt::format_to(out, "  {}: not simulated\n", v.what);
    } else {
      fmt::format_to(out, "  {}: {:.3g}, {}{}\n", v.what, v.value, v.bound, v.unit == "1" ? "" : " " + v.unit);
    }
  }
  return text;
}

std::string comparison_json(const Comparison& comparison, const std::vector<Verdict>& verdicts) {
  Json json;
  json["body"] = {{"height_m", comparison.body.height_m}, {"mass_kg", comparison.body.mass_kg}};
  for (const auto& set : comparison.reference.sets) json["reference"].push_back(set.name);
  json["note"] = comparison.reference.note;
  for (const auto& walk : comparison.walks) json["walks"].push_back(walk_json(comparison, walk));
  json["by_speed"] = varied_json(comparison.by_speed, "asked_speed_m_s");
  json["by_height"] = varied_json(comparison.by_height, "height_m");
  json["by_step_length"] = varied_json(comparison.by_step_length, "asked_step_length_m");
  json["by_mass"] = varied_json(comparison.by_mass, "mass_kg");
  json["balance"] = balance_json(comparison.balance);
  std::size_t held = 0, missing = 0;
  for (const auto& v : verdicts) {
    held += v.held.value_or(false) ? 1 : 0;
    missing += v.held ? 0 : 1;
    json["bounds"].push_back({{"what", v.what},
                              {"value", v.held ? Json(v.value) : Json()},
                              {"unit", v.unit},
                              {"bound", v.bound},
                              {"held", v.held ? Json(*v.held) : Json()}});
  }
  json["held"] = held;
  json["not_held"] = verdicts.size() - held - missing;
  json["not_simulated"] = missing;
  return json.dump(1) + '\n';
}

}  // namespace mobil
