// `mobil compare`: walks at the speeds of measured people, and is held against them.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <mobil/anthropometry.h>
#include <mobil/assets/files/output_file.h>
#include "demo/lab/compare/compare_plots.h"
#include "demo/lab/compare/compare_report.h"
#include "demo/program/commands.h"
#include "demo/walk/walk_options.h"

namespace mobil {
namespace {

struct CompareText {
  WalkText walk;
  std::string reference, out = "out";
  bool check = false;
};

constexpr float varied_speed = 5 / 3.6F;     // the paper's natural step
constexpr float varied_height_speed = 1.3F;  // within every height's published range
constexpr float slowest = 0.7F, fastest = 1.9F, shortest = 1.5F, tallest = 1.9F;

/// What is common to all walks of a comparison.
struct Walker {
  BodyRequest body;
  GaitStyle style;

  Result<WalkedStride> at(float speed_m_s) const { return walk(body, speed_m_s); }
  Result<WalkedStride> walk(const BodyRequest& who, float speed_m_s, std::optional<float> step_length_m = {}) const {
    GaitRequest gait;
    gait.speed_m_s = speed_m_s;
    gait.step_length_m = step_length_m;
    gait.style = style;
    return walk_stride(who, gait);
  }
};

/// Adds a walk, or says which one failed.
Result<void> add(std::vector<VariedWalk>& walks, double value, const Result<WalkedStride>& stride) {
  if (!stride) return tl::unexpected(stride.error());
  walks.push_back({value, *stride});
  return {};
}

Result<void> walk_reference_speeds(const Walker& walker, Comparison& comparison) {
  const auto body = make_body(walker.body);
  if (!body) return tl::unexpected(body.error());
  for (std::size_t s = 0; s < comparison.reference.sets.size(); ++s) {
    for (std::size_t c = 0; c < speed_class_count; ++c) {
      if (!comparison.reference.sets[s].measured[c]) continue;
      const double speed = comparison.reference.sets[s].speed_m_s(c, static_cast<double>(body->hip_height_m));
      const auto stride = walker.at(static_cast<float>(speed));
      if (!stride) return tl::unexpected(stride.error());
      comparison.walks.push_back({s, c, speed, *stride});
    }
  }
  return {};
}

Result<void> walk_variations(const Walker& walker, Comparison& comparison) {
  for (int i = 0; i <= 6; ++i) {
    const float speed = slowest + (fastest - slowest) * static_cast<float>(i) / 6;
    if (auto ok = add(comparison.by_speed, static_cast<double>(speed), walker.at(speed)); !ok) return ok;
  }
  for (int i = 0; i <= 4; ++i) {
    BodyRequest body = walker.body;
    body.height_m = shortest + (tallest - shortest) * static_cast<float>(i) / 4;
    const float ratio = body.height_m / walker.body.height_m;
    body.mass_kg = std::clamp(walker.body.mass_kg * ratio * ratio, 30.0F, 200.0F);  // the same body mass index
    const auto stride = walker.walk(body, varied_height_speed);
    if (auto ok = add(comparison.by_height, static_cast<double>(body.height_m), stride); !ok) return ok;
  }
  const auto natural = walker.at(varied_speed);
  if (!natural) return tl::unexpected(natural.error());
  for (const float times : {0.9F, 1.0F, 1.1F}) {
    const float length = times * static_cast<float>(natural->step_length_m);
    const auto stride = walker.walk(walker.body, varied_speed, length);
    if (auto ok = add(comparison.by_step_length, static_cast<double>(length), stride); !ok) return ok;
  }
  for (const float mass : {65.0F, 80.0F, 120.0F}) {
    BodyRequest body = walker.body;
    body.mass_kg = mass;
    const auto stride = walker.walk(body, varied_speed);
    if (auto ok = add(comparison.by_mass, static_cast<double>(mass), stride); !ok) return ok;
  }
  return {};
}

Result<void> write_all(const std::filesystem::path& out, const Comparison& comparison,
                       const std::vector<Verdict>& verdicts) {
  auto results = OutputFolder::make(out);
  if (!results) return tl::unexpected(results.error());
  const auto& inside = results->inside();
  if (auto done = write_file(inside / "compare.json", comparison_json(comparison, verdicts)); !done) return done;
  for (const auto& plot : comparison_plots(comparison)) {
    if (auto done = write_file(inside / plot.file, plot.text); !done) return done;
  }
  return results->put();
}

/// True where every bound held.
Result<bool> run_compare(const CompareText& text) {
  const auto options = read_walk_options(text.walk);
  if (!options) return tl::unexpected(options.error());
  const auto folder = text.reference.empty() ? std::nullopt : std::optional<std::filesystem::path>(text.reference);
  auto reference = read_gait_reference(folder);
  if (!reference) return tl::unexpected(reference.error());
  Comparison comparison{options->body, std::move(*reference), {}, {}, {}, {}, {}, {}};
  const Walker walker{options->body, options->gait.style};
  if (auto done = walk_reference_speeds(walker, comparison); !done) return tl::unexpected(done.error());
  if (auto done = walk_variations(walker, comparison); !done) return tl::unexpected(done.error());
  auto balance = walk_balance_scenes(options->body, options->gait.style);
  if (!balance) return tl::unexpected(balance.error());
  comparison.balance = std::move(*balance);
  const auto verdicts = judge(comparison);
  if (auto done = write_all(text.out, comparison, verdicts); !done) return tl::unexpected(done.error());
  fmt::print("{}", comparison_text(comparison, verdicts));
  say_where(fmt::format(
      "look at {}: compare.json angles.svg ground_reaction.svg moments.svg steps.svg centre_of_mass.svg", text.out));
  return std::ranges::all_of(verdicts, [](const Verdict& verdict) { return verdict.held.value_or(false); });
}

}  // namespace

Subcommand compare_command() {
  auto text = std::make_shared<CompareText>();
  Subcommand command{.name = "compare"};
  command.footer =
      "Writes compare.json and plots of ours over the measured bands (SVG). The program carries the curves of\n"
      "Schwartz et al. 2008 and the steps of Lencioni et al. 2019.\n"
      "Example: mobil compare --height 1.75 --mass 75 --check --out out";
  add_options(command, body_options(text->walk.body));
  add_options(command,
              {{"--set", &text->walk.set,
                "NAME=VALUE: any gait parameter of mobil walk --list-parameters; again for more", "Gait"},
               {"--reference", &text->reference,
                "Folder with winter_joint_angles.csv, _moments.csv, winter_grf.csv (and others that replace what the "
                "program carries)"},
               {"--check", &text->check, "Exit status 1 where a bound does not hold or is not simulated"},
               {"--out", &text->out, "Folder for the results, made if missing"}});
  command.run = [text] {
    const auto held = run_compare(*text);
    if (!held) return complain("compare", held.error().message);
    return text->check && !*held ? 1 : 0;
  };
  return command;
}

}  // namespace mobil
