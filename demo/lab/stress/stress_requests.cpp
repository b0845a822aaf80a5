// Requests of bodies and walks, files and options whose values are not numbers.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <mobil/simulation.h>
#include "demo/lab/muscle/force_history.h"
#include "demo/lab/muscle/muscle_options.h"
#include "demo/lab/muscle/muscle_run.h"
#include "demo/lab/stress/stress.h"
#include "demo/lab/stress/stress_world.h"

namespace mobil {
namespace {

constexpr std::array<double, 3> bad = {std::numeric_limits<double>::quiet_NaN(),
                                       std::numeric_limits<double>::infinity(),
                                       -std::numeric_limits<double>::infinity()};

/// Counts what was asked, what was not refused, and what it changed.
struct Refusals {
  const Simulation& simulation;
  std::vector<std::uint32_t> before = world_words(simulation);
  std::size_t asked = 0, accepted = 0, changed = 0;
  std::string last{}, first_accepted{};

  /// `error`: the refusal, or nothing.
  void take(const std::string& what, const std::optional<std::string>& error) {
    ++asked;
    if (error) {
      last = *error;
    } else {
      if (accepted++ == 0) first_accepted = what;
    }
    changed += different_words(before, world_words(simulation));
  }
};

template <class T>
std::optional<std::string> refusal(const Result<T>& result) {
  if (result) return std::nullopt;
  return result.error().message;
}

std::vector<std::pair<std::string, GaitRequest>> bad_gaits() {
  std::vector<std::pair<std::string, GaitRequest>> gaits;
  for (const double value : bad) {
    const auto number = static_cast<float>(value);
    GaitRequest speed, length, frequency;
    speed.speed_m_s = length.step_length_m = frequency.step_frequency_hz = number;
    gaits.insert(gaits.end(), {{"speed", speed}, {"step length", length}, {"step frequency", frequency}});
    for (const GaitParameter& parameter : gait_parameters) {
      GaitRequest style;
      style.style.*parameter.value = number;
      gaits.emplace_back(parameter.name, style);
    }
  }
  return gaits;
}

std::vector<std::pair<std::string, LegMuscles>> bad_muscles() {
  std::vector<std::pair<std::string, LegMuscles>> choices;
  for (const double value : bad) {
    for (double Material::*field : {&Material::density_kg_m3, &Material::young_pa, &Material::poisson}) {
      LegMuscles choice;
      choice.material.*field = value;
      choices.emplace_back("material", choice);
    }
    LegMuscles mass, stiffness, foundation, step, slow;
    mass.damping_per_s = stiffness.stiffness_damping_s = value;
    foundation.foundation_hz = step.dt_s = slow.dt_s = value;
    slow.method = Method::caa;
    choices.insert(choices.end(), {{"mass damping", mass},
                                   {"stiffness damping", stiffness},
                                   {"foundation", foundation},
                                   {"explicit step", step},
                                   {"step of mean acceleration", slow}});
  }
  return choices;
}

void tell(StressRun& run, const std::string& tried, const Refusals& refusals) {
  run.add({.tried = tried,
           .quantity = "not refused",
           .bound = 0,
           .reason = "each input has a range that it must lie in",
           .value = static_cast<double>(refusals.accepted),
           .detail = refusals.accepted == 0 ? fmt::format("{} refused, as in \"{}\"", refusals.asked, refusals.last)
                                            : fmt::format("{} first", refusals.first_accepted)});
  run.add({.tried = tried,
           .quantity = "words of the world that changed",
           .bound = 0,
           .reason = "what is refused changes nothing",
           .value = static_cast<double>(refusals.changed)});
}

}  // namespace

Result<void> stress_requests(StressRun& run) {
  Simulation simulation;
  const auto human = simulation.spawn({});
  if (!human) return tl::unexpected(human.error());
  const auto bare = simulation.spawn({});
  if (!bare) return tl::unexpected(bare.error());
  if (auto added = simulation.add_leg_muscles(*human); !added) return added;
  for (int tick = 0; tick < 30; ++tick) simulation.tick();

  Refusals bodies{simulation};
  for (const double value : bad) {
    const auto number = static_cast<float>(value);
    std::vector<BodyRequest> requests(5);
    requests[0].height_m = requests[1].mass_kg = number;
    requests[2].biotype.endo = requests[3].biotype.meso = requests[4].biotype.ecto = number;
    for (const BodyRequest& request : requests) bodies.take("a body", refusal(simulation.spawn(request)));
  }
  tell(run, "height, mass and biotype of a body that are no number or infinite", bodies);
  run.progress(0.2);

  Refusals gaits{simulation};
  for (const auto& [what, gait] : bad_gaits()) {
    gaits.take(what, refusal(simulation.spawn({}, gait)));
    gaits.take(what, refusal(simulation.set_gait(*human, gait)));
  }
  for (const double value : bad) {
    gaits.take("heading", refusal(simulation.turn_to(*human, static_cast<float>(value))));
  }
  tell(run, "speed, step and every style of a gait, at the start and under way, and headings", gaits);
  run.progress(0.5);

  Refusals muscles{simulation};
  for (const auto& [what, choice] : bad_muscles()) {
    muscles.take(what, refusal(simulation.add_leg_muscles(*bare, choice)));
    muscles.take(what + " under way", refusal(simulation.change_leg_muscles(*human, choice)));
  }
  tell(run, "material, damping, foundation and step of leg muscles, at the start and under way", muscles);
  run.progress(0.9);

  Refusals times{simulation};
  for (const double value : {bad[0], bad[1], bad[2], -1.0}) {
    const Ticks ticks = simulation.advance(value);
    const bool refused = !ticks.valid && ticks.count == 0;
    times.take("a frame", refused ? std::optional<std::string>("not valid, and dropped") : std::nullopt);
    for (const bool longest : {false, true}) {
      SimulationOptions options;
      (longest ? options.max_frame_s : options.tick_s) = value;
      std::optional<std::string> thrown;
      try {
        const Simulation none(options);
      } catch (const std::invalid_argument& error) {
        thrown = error.what();
      }
      times.take("a clock", thrown);
    }
  }
  tell(run, "frames, ticks and longest frames that are no number, infinite, negative", times);
  return {};
}

namespace {

struct BadOption {
  const char* name;
  std::string MuscleText::*text;
};

}  // namespace

Result<void> stress_tables(StressRun& run) {
  std::size_t asked = 0, accepted = 0, unnamed = 0;
  std::string last;
  const std::string header = "time_s,force_x_n,force_y_n,force_z_n\n0,0,0,0\n";
  for (const char* word :
       {"nan", "NaN", "-nan", "inf", "-inf", "Infinity", "1e999", "-1e999", "", " ", "1e", "0x1p3", "1,5", "one"}) {
    for (std::size_t column = 0; column < 4; ++column) {
      std::array<std::string, 4> cell = {"1", "0", "0", "0"};
      cell[column] = word;
      ++asked;
      const auto history =
          parse_force_history(header + fmt::format("{},{},{},{}\n", cell[0], cell[1], cell[2], cell[3]), "load.csv");
      if (history) {
        ++accepted;
        last = fmt::format("'{}' was read", word);
      } else {
        last = history.error().message;
        if (last.find("line 3") == std::string::npos) ++unnamed;
      }
    }
  }
  run.add({.tried = "a table of loads with a cell that is no finite number",
           .quantity = "not refused with the line named",
           .bound = 0,
           .reason = "one bad cell would be in every step after it",
           .value = static_cast<double>(accepted + unnamed),
           .detail = fmt::format("{} refused, as in \"{}\"", asked - accepted, last)});

  asked = accepted = unnamed = 0;
  for (const auto& [name, text] : {BadOption{"--cell-size", &MuscleText::cell_size},
                                   {"--young", &MuscleText::young},
                                   {"--poisson", &MuscleText::poisson},
                                   {"--density", &MuscleText::density},
                                   {"--dt", &MuscleText::dt},
                                   {"--seconds", &MuscleText::seconds},
                                   {"--damping", &MuscleText::damping},
                                   {"--stiffness-damping", &MuscleText::stiffness_damping},
                                   {"--foundation", &MuscleText::foundation},
                                   {"--gravity", &MuscleText::gravity},
                                   {"--cells", &MuscleText::cells}}) {
    for (const char* word : {"nan", "inf", "-inf", "1e999", "-1"}) {
      MuscleText options;
      options.*text = std::string_view(name) == "--gravity" ? fmt::format("0,{}e9,0", word) : std::string(word);
      ++asked;
      const auto request = read_muscle_request(options);
      if (request) {
        ++accepted;
        last = fmt::format("{} {} was accepted", name, options.*text);
        continue;
      }
      std::string message = request.error().message;
      std::ranges::transform(message, message.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
      const bool named = message.find(std::string_view(name).substr(2)) != std::string::npos;
      if (!named) ++unnamed;
      if (!named || accepted + unnamed == 0) last = request.error().message;
    }
  }
  run.add({.tried = "options of `mobil muscle` that are no number, infinite, too large, negative",
           .quantity = "not refused with the option named",
           .bound = 0,
           .reason = "each has its range",
           .value = static_cast<double>(accepted + unnamed),
           .detail = fmt::format("{} refused, as in \"{}\"", asked - accepted, last)});

  std::size_t lost = 0, ran = 0;
  for (const char* method : {"ecd", "icd", "caa", "static"}) {
    MuscleText options;
    options.method = method;
    options.seconds = "0.5";
    auto request = read_muscle_request(options);
    if (!request) return tl::unexpected(request.error());
    request->load = {{{0, {0, 0, 0}}, {0.1, {1e38, 0, 1e38}}, {0.2, {3e38, 0, 3e38}}}};
    const auto result = run_muscle(*request);
    if (!result) return tl::unexpected(result.error());
    ++ran;
    if (result->lost_at_s) ++lost;
  }
  run.add({.tried = "loads up to 3e38 N, which no displacement in single precision answers, by the four methods",
           .quantity = "runs that did not report when the displacement ceased to be a number",
           .bound = 0,
           .reason = "a table of NaN is never written as if it were numbers",
           .value = static_cast<double>(ran - lost)});
  return {};
}

}  // namespace mobil
