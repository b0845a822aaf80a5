#include "demo/lab/effects/accuracy_measure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include <mobil/engine/world.h>
#include <mobil/lod.h>
#include <mobil/rows.h>
#include <mobil/schedule.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "assets/surfaces/muscle_lattice.h"
#include "demo/program/must.h"
#include "systems/bellies/belly_library.h"
#include "systems/deformation/modal.h"

namespace mobil {
namespace {

constexpr std::size_t classes = speed_class_m_s.size();
constexpr std::size_t driving_level = 1;  // its lines move the references

/// Copies of one walker, one for each level, and the references of their muscles, right and left.
struct Walk {
  std::size_t body = 0, speed = 0;
  std::array<Entity, level_count> person{};
  std::vector<std::array<ReferenceMuscle, 2>> reference;             // by muscle
  std::vector<std::array<std::vector<float>, level_count>> error_m;  // by muscle
};

void follow(const Simulation& simulation, const AccuracyPlan& plan, Walk& walk, bool counted) {
  for (std::size_t m = 0; m < plan.muscles.size(); ++m) {
    for (const Side side : {Side::right, Side::left}) {
      ReferenceMuscle& reference = walk.reference[m][side];
      reference.follow(simulation, simulation.muscle(walk.person[driving_level], plan.muscles[m], side));
      if (!counted) continue;
      for (std::size_t r = 0; r < level_count; ++r) {
        const Entity muscle = simulation.muscle(walk.person[r], plan.muscles[m], side);
        walk.error_m[m][r].push_back(reference.largest_error_m(nodal_displacement(simulation.world(), muscle)));
      }
    }
  }
}

std::string number_list(const std::array<float, level_count>& values) {
  const auto number = [](float value) {
    std::string text = fmt::format("{:.3g}", value);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text + "F";
  };
  std::array<std::string, level_count> texts;
  std::ranges::transform(values, texts.begin(), number);
  return fmt::format("{{{}}}", fmt::join(texts, ", "));
}

}  // namespace

std::shared_ptr<const ModalBasis> reference_basis(const MusclePlan& plan, const LegMuscles& choice, const Cells& cells,
                                                  std::uint32_t modes) {
  const auto mesh = must(bend_block(cells, muscle_lattice(plan.muscle), reference_belly_m(plan.muscle), belly_grading));
  const auto across = static_cast<double>(plan.scale.across), along = static_cast<double>(plan.scale.along);
  ModalBasisOptions options;
  options.modes = modes;
  options.frame_loads = choice.inertia;
  options.foundation_hz = foundation_of(choice, plan.muscle);
  options.damping_per_s = choice.damping_per_s;
  options.middle_ratio = across / along;
  options.ratio_width = 1;
  options.middle_product = across * along;
  auto basis = must(make_modal_basis(mesh, choice.material, choice.element, options));
  return std::make_shared<const ModalBasis>(std::move(basis));
}

ReferenceMuscle::ReferenceMuscle(std::shared_ptr<const ModalBasis> basis, const PersonMuscle& muscle,
                                 const LegMuscles& choice, double tick_s) {
  const BellyScale<float>& scale = muscle.plan.scale;
  const auto belly =
      must(make_modal_belly(*basis, static_cast<double>(scale.across), static_cast<double>(scale.along)));
  const auto spread = [](const std::vector<float>& row) {
    std::vector<Line> lines(row.size());
    for (std::size_t i = 0; i < row.size(); ++i) std::fill_n(lines[i].lane, lane_count, row[i]);
    return lines;
  };
  std::vector<float> motion(modal_motion_width(basis->modes, basis->inputs));
  std::vector<float> shape(modal_shape_width(basis->modes, basis->inputs));
  write_motion(belly, choice.damping_per_s, tick_s, motion);
  write_shape(belly, choice.damping_per_s, shape);
  motion_ = spread(motion);
  shape_ = spread(shape);
  state_ = spread(std::vector<float>(modal_state_width(basis->modes)));
  displacement_ = spread(std::vector<float>(3 * std::size_t{node_count(basis->options.control_cells)}));
  scale_ = broadcast(scale);
  tick_s_ = static_cast<float>(tick_s);
  basis_ = std::move(basis);
}

void ReferenceMuscle::follow(const Simulation& simulation, Entity muscle) {
  const auto end = simulation.get<EndDrive>(muscle);
  if (!end || simulation.world().get<FarEnd>(muscle) != static_cast<std::uint64_t>(FarEnd::held))
    throw Stopped("a muscle is gone, or not driven by displacement");
  const auto drive = broadcast(*end);
  const FarFaceDrive ends(FarEnd::held, drive);
  const auto load = simulation.get<FrameLoad>(muscle);
  if (!load && basis_->options.frame_loads) throw Stopped("a muscle lost its inertia");
  const auto loads = load ? broadcast(*load) : FrameLoad<Lanes<float>>{};
  const ModalBlock block{*basis_, scale_, state_.data()->lane, motion_.data()->lane,
                         basis_->options.frame_loads ? &loads : nullptr};
  deform_modal(block, ends, tick_s_);
  place_control_points(block, {shape_.data()->lane, displacement_.data()->lane}, ends);
}

float ReferenceMuscle::largest_error_m(const NodalView& nodes) const {
  float largest = 0;
  for (std::size_t n = 0; n < displacement_.size() / 3; ++n) {
    float square = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const float there = nodes.first != nullptr ? nodes.first[(3 * n + c) * lane_count] : 0.0F;
      const float apart = there - displacement_[3 * n + c].lane[0];
      square += apart * apart;
    }
    const float error = std::sqrt(square);
    if (!(error <= largest)) largest = error;
  }
  return largest;
}

std::array<Entity, level_count> spawn_copies(Simulation& simulation, const BodyRequest& body, float speed_m_s,
                                             const LegMuscles& choice, bool active) {
  std::array<Entity, level_count> all{};
  for (std::size_t r = 0; r < level_count; ++r) {
    const Entity person = all[r] = must(simulation.spawn(body, {.speed_m_s = speed_m_s}));
    must(simulation.set_muscles(person, choice));
    for (std::size_t m = 0; m < choice.muscles.size(); ++m) {
      if (!choice.muscles[m]) continue;
      must(simulation.set_method(person, static_cast<Muscle>(m), level_method(r, true, active)));
    }
  }
  return all;
}

float percentile(std::vector<float>& values, double part) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

AccuracyPlan accuracy_plan(const MuscleSet& muscles) {
  AccuracyPlan plan;
  for (std::size_t m = 0; m < muscle_count; ++m)
    if (muscles[m]) plan.muscles.push_back(static_cast<Muscle>(m));
  const auto add = [&](float height_m, float mass_kg, Constitution constitution) {
    BodyRequest body;
    body.height_m = height_m;
    body.mass_kg = mass_kg;
    body.constitution = constitution;
    plan.bodies.push_back(body);
  };
  add(1.80F, 80, Constitution::average);
  add(1.60F, 52, Constitution::thin);
  add(1.68F, 85, Constitution::athletic);
  add(1.92F, 78, Constitution::average);
  add(1.88F, 115, Constitution::heavy);
  return plan;
}

std::vector<AccuracyRow> measure_errors(const AccuracyPlan& plan, bool inertia) {
  Simulation simulation;
  LegMuscles choice;
  choice.inertia = inertia;
  choice.muscles.reset();
  for (const Muscle muscle : plan.muscles) choice.muscles.set(static_cast<std::size_t>(muscle));
  std::vector<Walk> walks;
  for (std::size_t b = 0; b < plan.bodies.size(); ++b) {
    std::vector<std::shared_ptr<const ModalBasis>> basis;
    for (std::size_t c = 0; c < classes; ++c) {
      Walk walk{b, c, {}, {}, {}};
      const float speed = speed_class_m_s[c] * std::sqrt(plan.bodies[b].height_m / accuracy_height_m);
      walk.person = spawn_copies(simulation, plan.bodies[b], speed, choice, false);
      const Person person = *simulation.person(walk.person[driving_level]);
      for (std::size_t m = 0; m < plan.muscles.size(); ++m) {
        const auto own =
            std::ranges::find(person.muscles, plan.muscles[m], [](const auto& h) { return h.plan.muscle; });
        if (basis.size() <= m) {
          basis.push_back(reference_basis(own->plan, choice));
          plan.progress(0.8 * static_cast<double>(b * plan.muscles.size() + m) /
                        static_cast<double>(plan.bodies.size() * plan.muscles.size()));
        }
        const ReferenceMuscle reference(basis[m], *own, choice, simulation.tick_s());
        walk.reference.push_back({reference, reference});
      }
      walk.error_m.resize(plan.muscles.size());
      walks.push_back(std::move(walk));
    }
  }
  const auto ticks_of = [&](double s) { return static_cast<int>(std::lround(s / simulation.tick_s())); };
  const int settling = ticks_of(plan.settle_s), ticks = settling + ticks_of(plan.seconds);
  for (int t = 0; t < ticks; ++t) {
    simulation.tick();
    for (Walk& walk : walks) follow(simulation, plan, walk, t >= settling);
    plan.progress(0.8 + 0.2 * t / ticks);
  }
  std::vector<AccuracyRow> rows;
  for (std::size_t m = 0; m < plan.muscles.size(); ++m) {
    for (std::size_t c = 0; c < classes; ++c) {
      AccuracyRow row{plan.muscles[m], static_cast<SpeedClass>(c), inertia, {}};
      for (Walk& walk : walks) {
        if (walk.speed != c) continue;
        const float size = plan.bodies[walk.body].height_m / accuracy_height_m;
        for (std::size_t r = 0; r < level_count; ++r) {
          row.error_m[r] = std::max(row.error_m[r], percentile(walk.error_m[m][r], 0.999) / size);
        }
      }
      rows.push_back(row);
    }
  }
  return rows;
}

LevelCost measure_costs(std::size_t people, bool inertia, bool active) {
  BenchCrowd crowd(people);
  Simulation& simulation = crowd.simulation();
  LegMuscles choice;
  choice.inertia = inertia;
  if (active) choice.activation = ExcitationSource::phase;
  for (const Entity person : crowd.people()) must(simulation.set_muscles(person, choice));
  const auto measure = [&](std::size_t level, bool points) {
    for (const Entity person : crowd.people()) {
      for (std::size_t g = 0; g < usual_muscle_count; ++g)
        must(simulation.set_method(person, static_cast<Muscle>(g), level_method(level, points, active)));
    }
    for (int i = 0; i < 60; ++i) simulation.tick();  // until all fades have ended
    constexpr int repeats = 12, ticks = 10;
    double least = INFINITY;
    for (int i = 0; i < repeats; ++i) {
      const auto cpu_s = crowd.cpu_of([&] {
        for (int t = 0; t < ticks; ++t) simulation.tick();
      });
      double sum = 0;
      for (std::size_t s = 0; s < cpu_s.size(); ++s) {
        if (is_deformation(simulation.schedule().systems()[s].module)) sum += cpu_s[s];
      }
      least = std::min(least, sum);
    }
    return 1e6 * least / (ticks * 2.0 * usual_muscle_count * static_cast<double>(crowd.size()));
  };
  LevelCost cost;
  const double nothing = measure(0, false);  // time of reading the clock
  for (std::size_t r = 1; r < level_count; ++r) {
    const LodLevel& level = levels_of(active)[r];
    if (level.cells == reference_cells) {  // in a tick a finer mesh's modes cost the same as others
      cost.state_us[r] = cost.state_us[r - 1];
      cost.points_us[r] = cost.points_us[r - 1];
      continue;
    }
    const double bare = measure(r, false);
    const double with = level.method == Method::modal ? measure(r, true) : bare;
    const double state_us = std::max(0.0, bare - nothing);
    cost.state_us[r] = static_cast<float>(state_us);
    cost.points_us[r] = static_cast<float>(std::max(0.0, with - bare));
  }
  return cost;
}

std::string accuracy_source(const std::vector<AccuracyRow>& rows) {
  std::string source;
  for (const AccuracyRow& row : rows) {
    const std::string active = row.active ? fmt::format(", true, {}", number_list(row.volume_off)) : "";
    source += fmt::format("    {{Muscle{{{}}}, SpeedClass::{}, {}, {}{}}},\n", static_cast<int>(row.muscle),
                          speed_class_name[static_cast<std::size_t>(row.speed)], row.inertia, number_list(row.error_m),
                          active);
  }
  return source;
}

std::string cost_source(const LevelCost& cost) {
  return fmt::format("    LevelCost{{{}, {}}},\n", number_list(cost.state_us), number_list(cost.points_us));
}

}  // namespace mobil
