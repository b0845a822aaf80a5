#include "demo/lab/effects/relevance_show.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "demo/lab/bench/bench_crowd.h"
#include "demo/lab/effects/accuracy_measure.h"
#include "engine/schedule.h"
#include "systems/relevance/relevance.h"
#include "systems/simulation_world.h"

namespace mobil {
namespace {

constexpr double p99 = 0.99;

/// Where the crowd stands: in rows, all walking the same way.
constexpr float apart_m = 1.5F;

struct Crowd {
  std::shared_ptr<BenchCrowd> crowd;
  double deformation_s = 0;  // of the last tick

  Simulation& simulation() const { return crowd->simulation(); }
  void tick() {
    const auto cpu_s = crowd->cpu_of([&] { simulation().tick(); });
    deformation_s = 0;
    for (std::size_t s = 0; s < cpu_s.size(); ++s) {
      if (is_deformation(simulation().schedule().systems()[s].module)) deformation_s += cpu_s[s];
    }
  }
  double median_tick_s(int ticks) {
    std::vector<double> all;
    for (int i = 0; i < ticks; ++i) {
      tick();
      all.push_back(deformation_s);
    }
    return median(all);
  }
};

Result<Crowd> make_crowd(std::size_t humans) {
  auto made = BenchCrowd::make(humans);
  if (!made) return tl::unexpected(made.error());
  World& world = world_of((*made)->simulation());
  const auto across = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(humans))));
  for (std::size_t i = 0; i < humans; ++i) {
    const Entity human = (*made)->people()[i];
    auto state = *world.get<GaitState>(human);
    const std::size_t column = i % across, row = i / across;
    state.line_x_m = state.anchor_x_m = apart_m * static_cast<float>(column);
    state.line_z_m = state.anchor_z_m = apart_m * static_cast<float>(row);
    world.set(human, state);
  }
  for (int i = 0; i < 60; ++i) (*made)->simulation().tick();
  return Crowd{std::move(*made)};
}

Result<void> for_all(const Crowd& crowd, const std::function<Result<void>(std::size_t, Entity)>& ask) {
  for (std::size_t i = 0; i < crowd.crowd->size(); ++i) {
    if (auto done = ask(i, crowd.crowd->people()[i]); !done) return done;
  }
  return {};
}

struct Told {
  std::vector<ShownFigure>& figures;
  void operator()(std::string name, double value, std::string unit) const {
    figures.push_back({std::move(name), value, std::move(unit), "", true});
  }
  void held(std::string name, double value, std::string unit, double most) const {
    figures.push_back({std::move(name), value, std::move(unit), fmt::format("at most {:.4g}", most), value <= most});
  }
};

/// Until nothing waits and nothing fades.
void settle(Crowd& crowd, Relevance& relevance) {
  std::size_t settled = 0;
  for (int i = 0; i < 20000 && settled < 40; ++i) {
    const auto report = relevance.update();
    settled = report.switched + report.waiting == 0 ? settled + 1 : 0;
    if (i % 8 == 0) crowd.tick();
  }
}

/// One in twenty looked at within 1 mm, the others within 5 mm.
Result<void> show_near_and_far(Crowd& crowd, const Told& told) {
  Simulation& simulation = crowd.simulation();
  Relevance relevance(simulation, {.switches = 4096, .stagger = 1});
  if (auto done = relevance.set_scene({.tolerance_m = 0.005F, .looked_at = false}); !done) return done;
  const auto with = [&](std::size_t i) { return i % 20 == 0 ? PersonNeeds{{}, 0.001F, true} : PersonNeeds{}; };
  if (auto done = for_all(crowd, [&](std::size_t i, Entity human) { return relevance.manage(human, with(i)); }); !done)
    return done;
  settle(crowd, relevance);
  const double unseen_s = crowd.median_tick_s(31);
  std::vector<double> own;
  for (int i = 0; i < 31; ++i) {
    const double start = thread_cpu_now_s();
    relevance.update();
    own.push_back(thread_cpu_now_s() - start);
  }
  if (auto done = relevance.set_scene({.tolerance_m = 0.005F}); !done) return done;
  settle(crowd, relevance);
  const double seen_s = crowd.median_tick_s(31);
  auto done = for_all(crowd, [&](std::size_t, Entity human) -> Result<void> {
    relevance.release(human);
    return simulation.change_leg_muscles(human, {});
  });
  if (!done) return done;
  for (int i = 0; i < 40; ++i) crowd.tick();
  const double full_s = crowd.median_tick_s(15);
  told("deformation, everyone at full order", 1e3 * full_s, "ms a tick");
  told("1 in 20 within 1 mm, the others unseen within 5 mm", 1e3 * unseen_s, "ms a tick");
  told.held("  of full order", 100 * unseen_s / full_s, "%", 10);
  told("the others seen too, their control points placed", 1e3 * seen_s, "ms a tick");
  told.held("  of full order", 100 * seen_s / full_s, "%", 10);
  told("choosing, all people at once", 1e3 * median(own), "ms");
  return {};
}

/// Through the crowd and round, in and out.
Viewpoint flight(double time_s, double side_m) {
  const double middle = 0.5 * side_m, angle = 0.35 * time_s;
  const double radius = 0.45 * side_m * (0.35 + 0.65 * std::abs(std::cos(0.23 * time_s)));
  Viewpoint camera;
  camera.position_m = {static_cast<float>(middle + radius * std::sin(angle)), 1.7F,
                       static_cast<float>(middle + 1.3 * time_s - radius * std::cos(angle))};
  camera.forward = {static_cast<float>(-std::sin(angle + 0.6 * std::sin(0.5 * time_s))), 0,
                    static_cast<float>(std::cos(angle + 0.6 * std::sin(0.5 * time_s)))};
  camera.half_angle_rad = 0.6F;
  camera.radians_per_pixel = 0.0008F;
  camera.reach_m = 150;
  return camera;
}

Result<void> show_budget(Crowd& crowd, const CrowdShow& show, const Told& told) {
  Simulation& simulation = crowd.simulation();
  Relevance relevance(simulation, {.measured_s = [&](const Simulation&) { return crowd.deformation_s; }});
  const double side_m = static_cast<double>(apart_m) * std::sqrt(static_cast<double>(show.humans));
  if (auto done = relevance.set_scene({.camera = flight(0, side_m)}); !done) return done;
  if (auto done = for_all(crowd, [&](std::size_t, Entity human) { return relevance.manage(human); }); !done)
    return done;
  settle(crowd, relevance);
  const double wanted_s = crowd.median_tick_s(15), budget_s = 0.5 * wanted_s;
  if (auto done = relevance.set_scene({.camera = flight(0, side_m), .budget_s = budget_s}); !done) return done;
  for (int i = 0; i < 120; ++i) {
    relevance.update();
    crowd.tick();
  }
  std::vector<double> spent, own;
  double factor = 0;
  std::size_t switched = 0;
  const auto ticks = static_cast<int>(std::lround(show.flight_s / simulation.tick_s()));
  for (int i = 0; i < ticks; ++i) {
    const SceneNeeds scene{.camera = flight(i * simulation.tick_s(), side_m), .budget_s = budget_s};
    if (auto done = relevance.set_scene(scene); !done) return done;
    const double start = thread_cpu_now_s();
    const auto report = relevance.update();
    own.push_back(thread_cpu_now_s() - start);
    crowd.tick();
    spent.push_back(crowd.deformation_s);
    factor = std::max(factor, static_cast<double>(report.factor));
    switched += report.switched;
  }
  std::ranges::sort(spent);
  const auto at = [&](double part) {
    return spent[static_cast<std::size_t>(part * static_cast<double>(spent.size() - 1))];
  };
  told("budget as the camera flies (half of what 1 pixel takes at first)", 1e3 * budget_s, "ms a tick");
  told("  spent, median", 100 * at(0.5) / budget_s, "%");
  told.held("  spent, 99th percentile", 100 * at(p99) / budget_s, "%", 110);
  told("  tolerances missed by a factor of at most", factor, "");
  told("  methods changed a tick", static_cast<double>(switched) / ticks, "");
  told("  choosing and changing, median", 1e3 * median(own), "ms a tick");
  return {};
}

/// Where a muscle's control points are; nothing where there are none.
std::vector<float> shown(const Simulation& simulation, Entity muscle) {
  const NodalView nodes = simulation.nodal_displacement(muscle);
  std::vector<float> all(nodes.first == nullptr ? 0 : 3 * std::size_t{nodes.nodes});
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = nodes.first[i * lane_count];
  return all;
}

double farthest_m(const std::vector<float>& a, const std::vector<float>& b) {
  double square = 0;
  for (std::size_t i = 0; i + 2 < std::min(a.size(), b.size()); i += 3) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double by = static_cast<double>(a[i + c]) - static_cast<double>(b[i + c]);
      sum += by * by;
    }
    if (!(sum <= square)) square = sum;
  }
  return std::sqrt(square);
}

/// Every muscle changes to another method about once a second.
Result<void> show_switching(const CrowdShow& show, const Told& told) {
  const std::size_t humans = (show.switching_muscles + 7) / 8;
  auto made = make_crowd(humans);
  if (!made) return tl::unexpected(made.error());
  Simulation& simulation = made->simulation();
  if (auto done = for_all(*made, [&](std::size_t, Entity human) { return simulation.add_leg_muscles(human); }); !done)
    return done;
  std::mt19937 dice(1);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(dice() % n); };
  const auto ticks = static_cast<int>(std::lround(show.switching_s / simulation.tick_s()));
  double jump_m = 0, step_m = 0;
  std::size_t changed = 0, bad = 0;
  for (int t = 0; t < ticks; ++t) {
    for (std::size_t i = 0; i < humans * muscle_group_count / 60; ++i) {
      const Entity human = made->crowd->people()[below(humans)];
      const auto muscle = static_cast<Muscle>(below(muscle_group_count));
      const auto before = shown(simulation, simulation.muscle(human, muscle, Side::right));
      const MuscleMethod method = rung_method(below(rung_count - 1) == 9 ? 10 : below(rung_count - 2), below(4) != 0);
      if (auto done = simulation.set_method(human, muscle, method); !done) return done;
      const auto after = shown(simulation, simulation.muscle(human, muscle, Side::right));
      if (!before.empty() && !after.empty()) jump_m = std::max(jump_m, farthest_m(before, after));
      ++changed;
    }
    // of a few, how far they went in the tick
    std::vector<std::pair<Entity, std::vector<float>>> watched;
    for (std::size_t i = 0; i < 20; ++i) {
      const Entity muscle = simulation.muscle(made->crowd->people()[below(humans)],
                                              static_cast<Muscle>(below(muscle_group_count)), Side::right);
      watched.emplace_back(muscle, shown(simulation, muscle));
    }
    simulation.tick();
    for (const auto& [muscle, before] : watched) {
      const auto after = shown(simulation, muscle);
      if (!before.empty() && !after.empty()) step_m = std::max(step_m, farthest_m(before, after));
    }
    if (t % 60 != 59) continue;
    for (const Entity human : made->crowd->people()) {
      for (std::size_t m = 0; m < 2 * muscle_group_count; ++m) {
        const Entity muscle = simulation.muscle(human, static_cast<Muscle>(m / 2), static_cast<Side>(m % 2));
        for (const float value : shown(simulation, muscle)) bad += std::isfinite(value) ? 0 : 1;
      }
    }
    if (show.progress) show.progress(fmt::format("switching {}/{} s", (t + 1) / 60, ticks / 60));
  }
  told(fmt::format("methods changed at random, {} muscles, {:.0f} s", 8 * humans, show.switching_s),
       static_cast<double>(2 * changed), "muscles");
  told.held("  largest jump", 1e3 * jump_m, "mm", 0.1);
  told("  farthest that a control point went in a tick", 1e3 * step_m, "mm");
  told.held("  displacements that are no numbers", static_cast<double>(bad), "", 0);
  return {};
}

}  // namespace

Result<std::vector<ShownFigure>> show_crowd(const CrowdShow& show) {
  std::vector<ShownFigure> figures;
  const Told told{figures};
  const auto tell = [&](const std::string& what) {
    if (show.progress) show.progress(what);
  };
  tell("spawning the crowd");
  auto crowd = make_crowd(show.humans);
  if (!crowd) return tl::unexpected(crowd.error());
  tell("near and far");
  if (auto done = show_near_and_far(*crowd, told); !done) return tl::unexpected(done.error());
  tell("the camera flies");
  if (auto done = show_budget(*crowd, show, told); !done) return tl::unexpected(done.error());
  crowd->crowd.reset();
  tell("switching");
  if (auto done = show_switching(show, told); !done) return tl::unexpected(done.error());
  return figures;
}

std::string figures_table(const std::vector<ShownFigure>& figures) {
  std::size_t width = 0;
  for (const ShownFigure& figure : figures) width = std::max(width, figure.name.size());
  std::string text;
  for (const ShownFigure& figure : figures) {
    text += fmt::format("{:<{}}  {:>9.4g} {:<10} {}{}\n", figure.name, width, figure.value, figure.unit, figure.bound,
                        figure.held ? "" : "  NOT HELD");
  }
  return text;
}

}  // namespace mobil
