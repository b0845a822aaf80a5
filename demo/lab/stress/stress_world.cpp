// Whole simulations: one person whose state is NaN among sixteen who walk.

#include "demo/lab/stress/stress_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "demo/lab/stress/stress.h"
#include "systems/simulation_world.h"

namespace mobil {
namespace {

void add_row(const World& world, Entity entity, bool with_handles, std::vector<std::uint32_t>& words) {
  const auto place = world.find(entity);
  if (!place) return;
  for (const KeyPart& part : place.table->key()) {
    if (!has_column(part.kind)) continue;
    if (!with_handles && part.id == type_id<MuscleOwner<float>>()) continue;
    const auto width = static_cast<std::uint32_t>(part.value);
    const std::size_t from = words.size();
    words.resize(from + width);
    place.table->read(place.row, place.table->column(part.id), width, words.data() + from);
  }
}

}  // namespace

std::vector<std::uint32_t> human_words(const Simulation& simulation, Entity human) {
  std::vector<std::uint32_t> words;
  add_row(simulation.world(), human, false, words);
  for (std::size_t g = 0; g < muscle_group_count; ++g) {
    for (const Side side : {Side::right, Side::left}) {
      add_row(simulation.world(), simulation.muscle(human, static_cast<Muscle>(g), side), false, words);
    }
  }
  return words;
}

std::vector<std::uint32_t> world_words(const Simulation& simulation) {
  std::vector<std::uint32_t> words;
  for (const Table& table : simulation.world().tables()) {
    words.push_back(static_cast<std::uint32_t>(table.row_count()));
    for (std::uint32_t row = 0; row < table.row_count(); ++row) {
      const Entity entity = table.entities(row / lane_count)[row % lane_count];
      words.push_back(entity.index);
      words.push_back(entity.generation);
      add_row(simulation.world(), entity, true, words);
    }
  }
  return words;
}

std::vector<float> control_points(const Simulation& simulation, Entity human) {
  std::vector<float> all;
  for (const OwnMuscle& own : simulation.muscles(human)) {
    for (const Entity muscle : own.entity) {
      const NodalView nodes = simulation.nodal_displacement(muscle);
      for (std::uint32_t i = 0; nodes.first != nullptr && i < 3 * nodes.nodes; ++i) {
        all.push_back(nodes.first[i * lane_count]);
      }
    }
  }
  return all;
}

double largest(const std::vector<float>& displacements) {
  return largest_difference(displacements, std::vector<float>(displacements.size(), 0.0F));
}

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double worst = a.size() == b.size() ? 0 : std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    keep_worst(worst, std::abs(double{a[i]} - double{b[i]}));
  }
  return worst;
}

std::size_t different_words(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  const std::size_t both = std::min(a.size(), b.size());
  std::size_t different = std::max(a.size(), b.size()) - both;
  for (std::size_t i = 0; i < both; ++i) {
    if (a[i] != b[i]) ++different;
  }
  return different;
}

namespace {

BodyRequest nth_body(int i) {
  return {.height_m = 1.55F + 0.025F * static_cast<float>(i), .mass_kg = 55.0F + 2.0F * static_cast<float>(i)};
}

GaitRequest nth_gait(int i) {
  GaitRequest gait;
  gait.speed_m_s = 1.0F + 0.03F * static_cast<float>(i);
  return gait;
}

using Poison = std::function<void(Simulation&, Entity, float)>;

template <template <class> class C>
Poison in_component(float C<float>::*field) {
  return [field](Simulation& simulation, Entity human, float value) {
    auto row = simulation.get<C>(human).value();
    row.*field = value;
    world_of(simulation).set(human, row);
  };
}

template <template <class> class C>
Poison in_muscle(float C<float>::*field) {
  return [field](Simulation& simulation, Entity human, float value) {
    const Entity muscle = simulation.muscle(human, Muscle::hamstrings, Side::right);
    auto row = simulation.get<C>(muscle).value();
    row.*field = value;
    world_of(simulation).set(muscle, row);
  };
}

template <class Tag>
Poison in_nodes() {
  return [](Simulation& simulation, Entity human, float value) {
    const Entity muscle = simulation.muscle(human, Muscle::triceps_surae, Side::left);
    const auto width = simulation.world().get<Tag>(muscle);
    if (!width) return;
    std::vector<float> nodes(*width);
    if (simulation.world().template get_field<Tag>(muscle, nodes) != Status::ok) return;
    nodes[nodes.size() / 2] = value;
    world_of(simulation).template set_field<Tag>(muscle, nodes);
  };
}

struct Case {
  const char* name;
  Poison poison;
  std::optional<std::size_t> of{};  // whose belly has it in its state, and so must begin anew; else anybody's
};

std::vector<Case> poisons() {
  return {{"height", in_component<BodySize>(&BodySize<float>::height_m)},
          {"mass", in_component<BodySize>(&BodySize<float>::mass_kg)},
          {"time in the step", in_component<GaitState>(&GaitState<float>::time_s)},
          {"heading", in_component<GaitState>(&GaitState<float>::heading_rad)},
          {"duration of the step", in_component<StepPlan>(&StepPlan<float>::duration_s)},
          {"step length", in_component<StepPlan>(&StepPlan<float>::step_length_m)},
          {"wanted speed", in_component<Gait>(&Gait<float>::speed_m_s)},
          {"wanted heading", in_component<Gait>(&Gait<float>::heading_rad)},
          {"a pose",
           [](Simulation& simulation, Entity human, float value) {
             auto pose = simulation.get<Pose>(human).value();
             for (auto& q : pose.rotation) q.x = value;
             world_of(simulation).set(human, pose);
           }},
          {"scale of a leg", in_muscle<LegScale>(&LegScale<float>::thigh)},
          {"section of a belly", in_muscle<BellyScale>(&BellyScale<float>::across)},
          {"length of a belly", in_muscle<BellyScale>(&BellyScale<float>::along)},
          {"length of a line", in_muscle<LineOfAction>(&LineOfAction<float>::length_m)},
          {"a belly's displacement", in_nodes<NodalDisplacement>(), 9},
          {"a belly's velocity", in_nodes<NodalVelocity>(), 11},
          {"a belly's motions", in_nodes<ReducedState>(), 7}};
}

constexpr int crowd = 17;  // one more than a block

Result<std::vector<Entity>> walk_in(Simulation& simulation) {
  std::vector<Entity> people;
  for (int i = 0; i < crowd; ++i) {
    const auto human = simulation.spawn(nth_body(i), nth_gait(i));
    if (!human) return tl::unexpected(human.error());
    LegMuscles choice;
    choice.inertia = i % 2 == 1;
    if (i % 3 != 0) choice.method = i % 3 == 1 ? Method::reduced : Method::caa;
    if (auto added = simulation.add_leg_muscles(*human, choice); !added) return tl::unexpected(added.error());
    simulation.add_forces(*human);
    people.push_back(*human);
  }
  return people;
}

}  // namespace

Result<void> stress_walkers(StressRun& run) {
  Simulation sound;
  const auto people = walk_in(sound);
  if (!people) return tl::unexpected(people.error());
  const int ticks = run.quick ? 45 : 120;  // some steps end in it, and are planned anew
  std::vector<std::vector<std::uint32_t>> expected(crowd);
  for (int tick = 0; tick < 20 + ticks; ++tick) sound.tick();
  for (std::size_t i = 0; i < crowd; ++i) expected[i] = human_words(sound, (*people)[i]);

  const auto all = poisons();
  std::vector<std::string> touched;
  std::size_t different = 0, compared = 0, tried = 0, not_finite = 0, still_ill = 0;
  double part = 0;
  for (const auto& [name, poison, of] : all) {
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      if (run.quick && std::isinf(value)) continue;
      Simulation simulation;
      const auto members = walk_in(simulation);
      if (!members) return tl::unexpected(members.error());
      const std::size_t sick = of.value_or(5 * ++tried % lane_count);
      for (int tick = 0; tick < 20 + ticks; ++tick) {
        if (tick == 20) poison(simulation, (*members)[sick], value);
        simulation.tick();
      }
      if (of) {
        const std::vector<float> points = control_points(simulation, (*members)[sick]);
        not_finite +=
            static_cast<std::size_t>(std::ranges::count_if(points, [](float x) { return !std::isfinite(x); }));
        still_ill += simulation.report().total_restarted_bellies == 0 ? 1 : 0;
      }
      for (std::size_t i = 0; i < crowd; ++i) {
        if (i == sick) continue;
        const std::size_t now = different_words(expected[i], human_words(simulation, (*members)[i]));
        different += now;
        compared += expected[i].size();
        if (now > 0 && (touched.empty() || touched.back() != name)) touched.emplace_back(name);
      }
    }
    run.progress(++part / static_cast<double>(all.size()));
  }
  std::string names;
  for (const auto& name : touched) names += (names.empty() ? ", touched by a bad " : ", ") + name;
  run.at_most(fmt::format("no number in one person's body, gait, plan, pose, lines or bellies, {} in all, among {} "
                          "who walk on for {} ticks",
                          tried, crowd - 1, ticks),
              "words of the others and their muscles that are not the same bits", 0, static_cast<double>(different),
              "lanes never meet", fmt::format("of {}{}", compared, names));
  run.at_most("no number in the displacement, the velocity or the motions of one of their bellies",
              "of these, how many did not begin anew, and words of control points that are not finite in the end", 0,
              static_cast<double>(still_ill + not_finite), "a belly that is not finite begins anew");
  return {};
}

}  // namespace mobil
