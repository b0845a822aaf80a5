#include "demo/lab/robustness/robustness_world.h"
#include <mobil/components/leg_frames.h>
#include <mobil/components/step_plan.h>
#include <mobil/engine/world.h>
#include <mobil/step_report.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/nodal_view.h>
// Whole simulations: one person whose state is NaN among sixteen who walk; every method with every effect, shaken
// beyond what bodies can do.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>

#include "assets/body/bent_legs.h"
#include "demo/lab/robustness/robustness.h"

namespace mobil {
namespace {

/// Returns writable rows, to write values that only a broken host could.
World& rows_of(Simulation& simulation) {
  return const_cast<World&>(simulation.world());
}

void add_row(const World& world, Entity entity, bool with_handles, std::vector<std::uint32_t>& words) {
  const auto place = world.find(entity);
  if (!place) return;
  for (const ComponentId& part : place.table->key()) {
    if (!has_column(part.kind)) continue;
    if (!with_handles && part.id == type_id<MuscleOwner<float>>()) continue;
    const auto width = static_cast<std::uint32_t>(part.value);
    const std::size_t from = words.size();
    words.resize(from + width);
    place.table->read(place.row, place.table->column(part.id), width, words.data() + from);
  }
}

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
  return [field](Simulation& simulation, Entity person, float value) {
    auto row = simulation.get<C>(person).value();
    row.*field = value;
    rows_of(simulation).set(person, row);
  };
}

template <template <class> class C>
Poison in_muscle(float C<float>::*field) {
  return [field](Simulation& simulation, Entity person, float value) {
    const Entity muscle = simulation.muscle(person, Muscle::hamstrings, Side::right);
    auto row = simulation.get<C>(muscle).value();
    row.*field = value;
    rows_of(simulation).set(muscle, row);
  };
}

template <class Tag>
Poison in_nodes() {
  return [](Simulation& simulation, Entity person, float value) {
    const Entity muscle = simulation.muscle(person, Muscle::triceps_surae, Side::left);
    const auto width = simulation.world().get<Tag>(muscle);
    if (!width) return;
    std::vector<float> nodes(*width);
    if (simulation.world().template get_field<Tag>(muscle, nodes) != Status::ok) return;
    nodes[nodes.size() / 2] = value;
    rows_of(simulation).template set_field<Tag>(muscle, nodes);
  };
}

struct Case {
  const char* name;
  Poison poison;
  std::optional<std::size_t> of{};  // whose belly has it in its state and must restart; if empty, any person's
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
           [](Simulation& simulation, Entity person, float value) {
             auto pose = simulation.get<Pose>(person).value();
             for (auto& q : pose.rotation) q.x = value;
             rows_of(simulation).set(person, pose);
           }},
          {"scale of a leg", in_muscle<LegScale>(&LegScale<float>::thigh)},
          {"section of a belly", in_muscle<BellyScale>(&BellyScale<float>::across)},
          {"length of a belly", in_muscle<BellyScale>(&BellyScale<float>::along)},
          {"length of a line", in_muscle<LineOfAction>(&LineOfAction<float>::length_m)},
          {"a belly's displacement", in_nodes<NodalDisplacement>(), 9},
          {"a belly's velocity", in_nodes<NodalVelocity>(), 11},
          {"a belly's motions", in_nodes<ModalState>(), 7}};
}

constexpr int crowd = 17;  // one more than a block

std::vector<Entity> walk_in(Simulation& simulation) {
  std::vector<Entity> people;
  for (int i = 0; i < crowd; ++i) {
    const auto person = must(simulation.spawn(nth_body(i), nth_gait(i)));
    LegMuscles choice;
    choice.inertia = i % 2 == 1;
    if (i % 3 != 0) choice.method = i % 3 == 1 ? Method::modal : Method::newmark;
    must(simulation.set_muscles(person, choice));
    simulation.enable(person, Feature::forces);
    people.push_back(person);
  }
  return people;
}

struct Way {
  std::string name;
  LegMuscles choice;
};

/// Returns methods times effects. Inertia does not apply to methods without a state. The force-driven end needs a
/// method that steps.
std::vector<Way> ways() {
  struct Kind {
    std::string_view name;
    Method method;
    bool moving, tuned;
  };
  constexpr std::array kinds = {Kind{"static", Method::statics, true, false},
                                Kind{"explicit-central", Method::explicit_central, true, false},
                                Kind{"implicit-central", Method::implicit_central, true, false},
                                Kind{"newmark", Method::newmark, true, false},
                                Kind{"finite", Method::finite, true, false},
                                Kind{"modal", Method::modal, true, false},
                                Kind{"modal, not moving", Method::modal, false, false},
                                Kind{"modal and tuned", Method::modal, true, true}};
  std::vector<Way> all;
  for (const Kind& kind : kinds) {
    for (const bool pulls : {false, true}) {
      for (const bool inertia : {false, true}) {
        if (kind.tuned && !pulls) continue;
        Way way;
        way.choice.method = kind.method;
        way.choice.modal.moving = kind.moving;
        way.choice.modal.tuned = kind.tuned;
        way.choice.modal.cells = {2, 2, 8};
        way.choice.inertia = inertia;
        way.choice.activation = pulls ? ExcitationSource::host : ExcitationSource::none;
        way.name = fmt::format("{}{}{}", kind.name, inertia ? ", inertia" : "", pulls ? ", pulling" : "");
        all.push_back(way);
      }
    }
  }
  for (const Method method : {Method::explicit_central, Method::implicit_central, Method::newmark}) {
    Way way;
    way.choice.method = method;
    way.choice.drive = Drive::force;
    way.name = fmt::format("{}, driven by force", method_name[static_cast<std::size_t>(method)]);
    all.push_back(way);
  }
  return all;
}

/// Treatment of a posed person, tick by tick.
struct Ordeal {
  std::string_view name;
  void (*tick)(Simulation& simulation, Entity person, const Body& body, int tick);
};

void kicked(Simulation& simulation, Entity person, const Body& body, int tick) {
  const bool bent = tick % 2 == 0;
  must(simulation.set_pose(person,
                           with_bent_legs(body, {bent ? 90.0F : 0.0F, bent ? 120.0F : 0.0F, bent ? 20.0F : -40.0F})));
}

void thrown(Simulation& simulation, Entity person, const Body& body, int tick) {
  Pose<float> pose = with_bent_legs(body, {});
  const float far = tick % 2 == 0 ? 100.0F : -100.0F;
  for (auto& p : pose.position_m) p = {p.x + far, p.y + far, p.z - far};
  must(simulation.set_pose(person, pose));
}

void pulled_apart(Simulation& simulation, Entity person, const Body& body, int tick) {
  Pose<float> pose = with_bent_legs(body, {});
  for (const Segment segment : {Segment::shank_right, Segment::foot_right, Segment::shank_left, Segment::foot_left}) {
    pose.position_m[index(segment)].y -= tick % 3 == 0 ? 2.0F : 0.0F;
  }
  must(simulation.set_pose(person, pose));
}

void excited(Simulation& simulation, Entity person, const Body&, int tick) {
  for (const MuscleRef& own : simulation.muscles(person)) {
    for (const Side side : {Side::right, Side::left})
      must(simulation.set_excitation(person, own.muscle, side, tick % 2 == 0 ? 1.0F : 0.01F));
  }
}

Entity doll(Simulation& simulation, const LegMuscles& choice) {
  auto person = must(simulation.spawn_posed({}));
  must(simulation.set_muscles(person, choice));
  return person;
}

}  // namespace

std::vector<std::uint32_t> person_words(const Simulation& simulation, Entity person) {
  std::vector<std::uint32_t> words;
  add_row(simulation.world(), person, false, words);
  for (std::size_t g = 0; g < usual_muscle_count; ++g) {
    for (const Side side : {Side::right, Side::left}) {
      add_row(simulation.world(), simulation.muscle(person, static_cast<Muscle>(g), side), false, words);
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

std::vector<float> control_points(const Simulation& simulation, Entity person) {
  std::vector<float> all;
  for (const MuscleRef& own : simulation.muscles(person)) {
    for (const Entity muscle : own.entity) {
      const NodalView nodes = nodal_displacement(simulation.world(), muscle);
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

void robustness_walkers(RobustnessRun& run) {
  Simulation sound;
  const auto people = walk_in(sound);
  const int ticks = run.quick ? 45 : 120;  // some steps end in it, and are planned again
  std::vector<std::vector<std::uint32_t>> expected(crowd);
  for (int tick = 0; tick < 20 + ticks; ++tick) sound.tick();
  for (std::size_t i = 0; i < crowd; ++i) expected[i] = person_words(sound, people[i]);

  const auto all = poisons();
  std::vector<std::string> touched;
  std::size_t different = 0, compared = 0, tried = 0, not_finite = 0, still_ill = 0;
  double part = 0;
  for (const auto& [name, poison, of] : all) {
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      if (run.quick && std::isinf(value)) continue;
      Simulation simulation;
      const auto members = walk_in(simulation);
      const std::size_t sick = of.value_or(5 * ++tried % lane_count);
      for (int tick = 0; tick < 20 + ticks; ++tick) {
        if (tick == 20) poison(simulation, members[sick], value);
        simulation.tick();
      }
      if (of) {
        const std::vector<float> points = control_points(simulation, members[sick]);
        not_finite +=
            static_cast<std::size_t>(std::ranges::count_if(points, [](float x) { return !std::isfinite(x); }));
        still_ill += simulation.report().total_restarted_bellies == 0 ? 1 : 0;
      }
      for (std::size_t i = 0; i < crowd; ++i) {
        if (i == sick) continue;
        const std::size_t now = different_words(expected[i], person_words(simulation, members[i]));
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
}

void robustness_ways(RobustnessRun& run) {
  constexpr std::array ordeals = {Ordeal{"knees bent by 120 degrees and back in every tick", &kicked},
                                  Ordeal{"thrown 300 m in every tick", &thrown},
                                  Ordeal{"shanks 2 m off the thighs in one tick of three", &pulled_apart},
                                  Ordeal{"excitation from none to full in every tick", &excited}};
  constexpr int rest_s = 4;
  struct Trial {
    const Way* way;
    const Ordeal* ordeal;
    Entity person, calm;
    double worst_m = 0;
  };
  // All trials share one simulation, because the set-up of each muscle takes longest; people do not meet.
  Simulation simulation;
  std::vector<Trial> trials;
  const auto all = ways();
  for (const Way& way : all) {
    const auto calm = doll(simulation, way.choice);
    for (const Ordeal& ordeal : ordeals) {
      if (ordeal.tick == &excited && !has_activation(way.choice)) continue;
      const auto person = doll(simulation, way.choice);
      trials.push_back({&way, &ordeal, person, calm});
    }
    run.progress(0.3 * static_cast<double>(&way - all.data()) / static_cast<double>(all.size()));
  }
  const Body body = simulation.person(trials.front().person)->body;
  const Pose<float> usual = *simulation.get<Pose>(trials.front().person);
  const int shaken = run.quick ? 30 : 240, ticks = shaken + 60 * rest_s;
  for (int tick = 0; tick < ticks; ++tick) {
    for (Trial& trial : trials) {
      if (tick < shaken) {
        trial.ordeal->tick(simulation, trial.person, body, tick);
      } else if (tick == shaken) {
        if (has_activation(trial.way->choice)) excited(simulation, trial.person, body, 1);
        must(simulation.set_pose(trial.person, usual, Arrival::jumped));
      }
    }
    simulation.tick();
    for (Trial& trial : trials) {
      if (tick < shaken) keep_worst(trial.worst_m, largest(control_points(simulation, trial.person)));
    }
    run.progress(0.3 + 0.7 * tick / ticks);
  }
  for (const Trial& trial : trials) {
    // For ωh ≫ 1 the trapezoidal rule keeps (1 − 4·α/(ω²·h)) a step: vibrations faster than ticks hardly decay.
    const bool keeps_ringing = trial.way->choice.method == Method::newmark;
    run.at_most(fmt::format("{}: {}", trial.way->name, trial.ordeal->name),
                fmt::format("control points off those of who stood still, {} s later, m", rest_s),
                keeps_ringing ? std::max(1e-3, trial.worst_m) : 1e-3,
                largest_difference(control_points(simulation, trial.person), control_points(simulation, trial.calm)),
                keeps_ringing ? "what rings faster than ticks this rule hardly damps; it never grows"
                              : "vibration falls by e^-4 a second or faster; nothing else is remembered",
                fmt::format("up to {:.3g} m meanwhile", trial.worst_m));
  }
}

}  // namespace mobil
