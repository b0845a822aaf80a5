#include "demo/lab/effects/accuracy_active.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <mobil/components/activation.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>
#include <mobil/lod.h>
#include <mobil/muscle_table.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "assets/finite/control_points.h"
#include "assets/finite/shape_tables.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/muscle_options.h"
#include "demo/program/must.h"
#include "demo/program/progress.h"
#include "systems/bellies/belly_library.h"
#include "systems/deformation/modal.h"

namespace mobil {
namespace {

constexpr Cells solved_cells = {4, 4, 16}, point_cells = {2, 2, 8};
constexpr int steps_a_tick = 4, solved_every = 6, led_in_ticks = 45;
using Points = std::vector<double>;  // three displacements a control point, m

/// A muscle over the ticks of a walk, and the points of each level in the compared ticks.
struct MuscleTrack {
  MusclePlan plan;
  double foundation_hz = 0;
  std::vector<WalkLoad> load;
  std::vector<std::array<Points, level_count>> shown;
};

/// One body at one speed, without inertia and with.
struct BothWalks {
  std::size_t body = 0, speed = 0;
  std::array<std::vector<MuscleTrack>, 2> track;  // by muscle
};

FinitePush push_of(const FrameLoad<float>& load) {
  const auto row = [](const Vec3<float>& v) { return std::array{double{v.x}, double{v.y}, double{v.z}}; };
  return {row(load.constant_to), {row(load.gradient_to.x), row(load.gradient_to.y), row(load.gradient_to.z)}};
}

Points points_of(const NodalView& nodes, std::size_t width) {
  Points points(width);
  for (std::size_t i = 0; i < width && nodes.first != nullptr; ++i) points[i] = double{nodes.first[i * lane_count]};
  return points;
}

std::vector<MuscleTrack> walk_with_levels(const AccuracyPlan& plan, std::size_t body, std::size_t speed, bool inertia) {
  Simulation simulation;
  LegMuscles choice;
  choice.inertia = inertia;
  choice.activation = ExcitationSource::phase;
  choice.muscles.reset();
  for (const Muscle muscle : plan.muscles) choice.muscles.set(static_cast<std::size_t>(muscle));
  const float speed_m_s = speed_class_m_s[speed] * std::sqrt(plan.bodies[body].height_m / accuracy_height_m);
  const auto copies = spawn_copies(simulation, plan.bodies[body], speed_m_s, choice, true);
  const Person person = *simulation.person(copies.front());
  std::vector<MuscleTrack> tracks;
  for (const Muscle muscle : plan.muscles) {
    const auto own = std::ranges::find(person.muscles, muscle, [](const PersonMuscle& one) { return one.plan.muscle; });
    tracks.push_back({own->plan, foundation_of(choice, muscle), {}, {}});
  }
  const auto ticks_of = [&](double s) { return static_cast<int>(std::lround(s / simulation.tick_s())); };
  const int settling = ticks_of(plan.settle_s), ticks = settling + ticks_of(plan.seconds);
  for (int t = 0; t < ticks; ++t) {
    simulation.tick();
    if (t < settling - led_in_ticks) continue;
    for (MuscleTrack& track : tracks) {
      const Muscle muscle = track.plan.muscle;
      const Entity first = simulation.muscle(copies.front(), muscle, Side::right);
      WalkLoad load;
      load.shortening = double{-simulation.get<EndDrive>(first)->to} / track.plan.belly_length_m;
      load.activation = double{simulation.get<Activation>(first)->activation};
      // Muscles that are not simulated have no load of the frame.
      const Entity moving = simulation.muscle(copies.back(), muscle, Side::right);
      if (const auto frame = simulation.get<FrameLoad>(moving)) load.push = push_of(*frame);
      track.load.push_back(load);
      if (t < settling) continue;
      auto& shown = track.shown.emplace_back();
      for (std::size_t r = 0; r < level_count; ++r) {
        const Entity one = simulation.muscle(copies[r], muscle, Side::right);
        shown[r] = points_of(nodal_displacement(simulation.world(), one), 3 * node_count(point_cells));
      }
    }
  }
  return tracks;
}

HexahedralMesh solved_mesh(const MusclePlan& plan) {
  const BellyScale<double> scale{double{plan.scale.across}, double{plan.scale.along}};
  return scaled(finite_mesh(plan.muscle, solved_cells), scale);
}

/// Advances by a part of a tick, in steps that are halved if they fail.
Result<void> follow(const FiniteBelly& belly, double tick_s, double foundation_hz, const WalkLoad& from,
                    const WalkLoad& to, double begin, double part, FiniteScratch& scratch, FiniteMotion& motion) {
  constexpr double min_part = 1.0 / 256;
  const auto at_end = [&](double a, double b) { return a + (begin + part) * (b - a); };
  FiniteStep step{part * tick_s, tuned_damping_per_s(to.activation),
                  foundation_hz, at_end(from.shortening, to.shortening),
                  to.activation, {}};
  for (std::size_t d = 0; d < 3; ++d) {
    step.push.constant_m_s2[d] = at_end(from.push.constant_m_s2[d], to.push.constant_m_s2[d]);
    for (std::size_t c = 0; c < 3; ++c)
      step.push.gradient_s2[d][c] = at_end(from.push.gradient_s2[d][c], to.push.gradient_s2[d][c]);
  }
  const auto done = advance(belly, scratch, step, motion);
  if (done || part < 1.5 * min_part) return done;
  return follow(belly, tick_s, foundation_hz, from, to, begin, part / 2, scratch, motion).and_then([&] {
    return follow(belly, tick_s, foundation_hz, from, to, begin + part / 2, part / 2, scratch, motion);
  });
}

/// Returns control points of 4×4×16 elements at rest at each tick's load, without push, held sideways like the moving
/// ones.
std::vector<Points> resting_points(const MuscleTrack& track) {
  const auto belly = must(make_finite_belly(solved_mesh(track.plan), {}, track.foundation_hz));
  FiniteScratch scratch = make_scratch(belly);
  FiniteState state = state_at_rest(belly);
  std::vector<Points> points;
  for (const WalkLoad& load : track.load) {
    must(settle(belly, scratch, state, load.shortening, load.activation));
    points.push_back(sampled_points(solved_cells, point_cells, state.displacement_m));
  }
  return points;
}

/// Returns the points of the moving belly, led in from rest.
std::vector<Points> moving_points(const MuscleTrack& track, double tick_s) {
  const auto belly = must(make_finite_belly(solved_mesh(track.plan), {}, 0));
  FiniteScratch scratch = make_scratch(belly);
  FiniteMotion motion = motion_at_rest(belly);
  std::vector<Points> points;
  WalkLoad from;
  for (std::size_t t = 0; t < track.load.size(); ++t) {
    WalkLoad to = track.load[t];
    to.shortening *= std::min(1.0, static_cast<double>(t + 1) / (led_in_ticks / 3.0));
    follow_tick(belly, tick_s, track.foundation_hz, from, to, steps_a_tick, scratch, motion);
    points.push_back(sampled_points(solved_cells, point_cells, motion.displacement_m));
    from = to;
  }
  return points;
}

/// Returns static shapes of the compared ticks: those of the table, corrected by solutions of every few ticks.
std::vector<Points> static_points(const MuscleTrack& track) {
  const Muscle muscle = track.plan.muscle;
  const double across = double{track.plan.scale.across}, along = double{track.plan.scale.along};
  const ShapeTable table = shape_table(muscle);
  const auto coefficients = body_coefficients(table, across / along);
  const HexahedralMesh rest = finite_mesh(muscle, point_cells);
  const SampledBelly belly = sampled_belly(muscle);
  const std::size_t first = track.load.size() - track.shown.size();
  std::vector<Points> points;
  for (std::size_t t = first; t < track.load.size(); ++t)
    points.push_back(shape_at(table, coefficients, rest, track.load[t].shortening, track.load[t].activation));
  Points before, after;
  std::vector<Points> corrected = points;
  for (std::size_t begin = 0; begin < points.size(); begin += solved_every) {
    const auto correction = [&](std::size_t at) {
      at = std::min(at, points.size() - 1);
      const WalkLoad& load = track.load[first + at];
      auto solved =
          must(shape_samples(belly, across / along, std::array{load.shortening}, std::array{load.activation}));
      Points off = std::move(solved.front().displacement_m);
      for (std::size_t i = 0; i < off.size(); ++i) off[i] -= points[at][i];
      return off;
    };
    auto next = correction(begin + solved_every);
    if (before.empty()) before = correction(begin);
    for (std::size_t t = begin; t < std::min(begin + solved_every, points.size()); ++t) {
      const double part = static_cast<double>(t - begin) / solved_every;
      for (std::size_t i = 0; i < before.size(); ++i) corrected[t][i] += (1 - part) * before[i] + part * next[i];
    }
    before = std::move(next);
  }
  for (Points& one : corrected) {
    for (std::size_t i = 0; i < one.size(); ++i) one[i] *= i % 3 < 2 ? across : along;
  }
  return corrected;
}

double largest_distance_m(const Points& a, const Points& b) {
  double largest = 0;
  for (std::size_t n = 0; n < a.size(); n += 3)
    largest = std::max(largest, std::hypot(a[n] - b[n], a[n + 1] - b[n + 1], a[n + 2] - b[n + 2]));
  return largest;
}

/// Rounds up to the next eighth of an octave, so that a dearer level counts as nearer only if its gain exceeds the
/// reference's uncertainty.
float rounded_up(float error) {
  return error > 0 ? std::exp2(std::ceil(8 * std::log2(error)) / 8) : 0;
}

struct TrackErrors {
  std::array<float, level_count> error_m{}, volume_off{};
};

/// Compares a muscle in both walks of a body at a speed.
std::array<TrackErrors, 2> compare(const std::array<const MuscleTrack*, 2>& track, double tick_s) {
  const auto shape = static_points(*track[0]);
  const auto still = resting_points(*track[0]);
  std::array<TrackErrors, 2> errors;
  for (std::size_t inertia = 0; inertia < 2; ++inertia) {
    const MuscleTrack& of = *track[inertia];
    const auto moved = moving_points(of, tick_s);
    const BellyScale<double> scale{double{of.plan.scale.across}, double{of.plan.scale.along}};
    const HexahedralMesh mesh = scaled(finite_mesh(of.plan.muscle, point_cells), scale);
    const std::size_t first = of.load.size() - of.shown.size();
    for (std::size_t r = 0; r < level_count; ++r) {
      std::vector<float> off_m, volume_off;
      for (std::size_t t = 0; t < of.shown.size(); ++t) {
        Points real = shape[t];
        for (std::size_t i = 0; i < real.size(); ++i) real[i] += moved[first + t][i] - still[first + t][i];
        off_m.push_back(static_cast<float>(largest_distance_m(of.shown[t][r], real)));
        volume_off.push_back(static_cast<float>(std::abs(enclosed_volume(mesh, of.shown[t][r]) - 1)));
      }
      errors[inertia].error_m[r] = percentile(off_m, 0.999);
      errors[inertia].volume_off[r] = percentile(volume_off, 0.999);
    }
  }
  return errors;
}

struct AccuracyText {
  std::string muscles;
};

/// Prints rows of systems/accuracy/accuracy_table.cpp. Without names of muscles prints all rows, and the costs.
void print_accuracy(const AccuracyText& text) {
  const MuscleSet chosen = text.muscles.empty() ? muscle_groups() | muscle_members() : must(read_muscles(text.muscles));
  std::string rows, costs;
  for (const bool inertia : {false, true}) {
    AccuracyPlan plan = accuracy_plan(chosen & muscle_groups());
    if (plan.muscles.empty()) break;
    plan.progress = [&](double part) { show_part(inertia ? "errors with inertia" : "errors without inertia", part); };
    const auto errors = measure_errors(plan, inertia);
    rows += accuracy_source(errors);
  }
  for (AccuracyPlan plan : active_plans(chosen)) {
    if (plan.muscles.empty()) continue;
    plan.progress = [](double part) { show_part("errors of muscles that pull", part); };
    const auto errors = measure_active_errors(plan);
    rows += accuracy_source(errors);
  }
  for (const bool active : {false, true}) {
    for (const bool inertia : {false, true}) {
      if (!text.muscles.empty()) continue;
      show("costs");
      const auto cost = measure_costs(1024, inertia, active);
      costs += cost_source(cost);
    }
  }
  show("");
  print_output("{}\n{}", rows, costs);
}

}  // namespace

void follow_tick(const FiniteBelly& belly, double tick_s, double foundation_hz, const WalkLoad& from,
                 const WalkLoad& to, int steps, FiniteScratch& scratch, FiniteMotion& motion) {
  for (int s = 0; s < steps; ++s)
    must(follow(belly, tick_s, foundation_hz, from, to, 1.0 / steps * s, 1.0 / steps, scratch, motion));
}

std::array<AccuracyPlan, 2> active_plans(const MuscleSet& muscles) {
  AccuracyPlan groups = accuracy_plan(muscles & muscle_groups()), members = accuracy_plan(muscles & ~muscle_groups());
  groups.bodies = {groups.bodies.front(), groups.bodies.back()};
  groups.seconds = 2;
  members.bodies.resize(1);
  members.seconds = 1;
  return {groups, members};
}

std::vector<AccuracyRow> measure_active_errors(const AccuracyPlan& plan) {
  constexpr std::size_t classes = speed_class_m_s.size();
  std::vector<BothWalks> walks;
  for (std::size_t b = 0; b < plan.bodies.size(); ++b) {
    for (std::size_t c = 0; c < classes; ++c) {
      BothWalks& both = walks.emplace_back(BothWalks{b, c, {}});
      for (const bool inertia : {false, true}) both.track[inertia] = walk_with_levels(plan, b, c, inertia);
      plan.progress(0.1 * static_cast<double>(walks.size()) / static_cast<double>(plan.bodies.size() * classes));
    }
  }
  const std::size_t muscles = plan.muscles.size(), count = walks.size() * muscles;
  std::vector<Result<std::array<TrackErrors, 2>>> found(count);
  std::atomic<std::size_t> done = 0;
  const Threads threads;
  in_parallel(threads.jobs(), count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const BothWalks& both = walks[i / muscles];
      found[i] = attempt([&] {
        return compare({&both.track[0][i % muscles], &both.track[1][i % muscles]}, Simulation{}.tick_s());
      });
      plan.progress(0.1 + 0.9 * static_cast<double>(++done) / static_cast<double>(count));
    }
  });
  std::vector<AccuracyRow> rows;
  for (const bool inertia : {false, true}) {
    for (std::size_t m = 0; m < muscles; ++m) {
      for (std::size_t c = 0; c < classes; ++c) {
        AccuracyRow row{plan.muscles[m], static_cast<SpeedClass>(c), inertia, {}, true, {}};
        for (std::size_t w = 0; w < walks.size(); ++w) {
          const auto& of = found[w * muscles + m];
          if (!of) throw Stopped(of.error().message);
          if (walks[w].speed != c) continue;
          const float size = plan.bodies[walks[w].body].height_m / accuracy_height_m;
          for (std::size_t r = 0; r < level_count; ++r) {
            row.error_m[r] = std::max(row.error_m[r], (*of)[inertia].error_m[r] / size);
            row.volume_off[r] = std::max(row.volume_off[r], (*of)[inertia].volume_off[r]);
          }
        }
        for (float& error : row.error_m) error = rounded_up(error);
        rows.push_back(row);
      }
    }
  }
  return rows;
}

Subcommand fit_accuracy_command() {
  auto text = std::make_shared<AccuracyText>();
  Subcommand command{.name = "fit-accuracy"};
  command.footer =
      "For those who change the library: prints rows and costs as systems/accuracy/accuracy_table.cpp has them. "
      "Minutes.\n"
      "Examples: mobil fit-accuracy > accuracy.txt\n"
      "          mobil fit-accuracy --muscles iliopsoas,deep_calf > accuracy.txt";
  add_options(command, {{"--muscles", &text->muscles,
                         "Print only rows of these muscles, and no costs: usual, groups, all, or names"}});
  command.run = [text] { return exit_status_of("fit-accuracy", attempt([&] { print_accuracy(*text); })); };
  return command;
}

}  // namespace mobil
