// Every method with every effect, shaken as no body can be: what it comes to, and whether anything is left of it.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/simulation.h>
#include "assets/body/bent_legs.h"
#include "demo/lab/stress/stress.h"
#include "demo/lab/stress/stress_world.h"

namespace mobil {
namespace {

struct Way {
  std::string name;
  LegMuscles choice;
};

/// Methods times effects. Of what has no state of its own inertia means nothing; the force-driven end needs a method
/// that steps.
std::vector<Way> ways() {
  struct Kind {
    std::string_view name;
    Method method;
    bool moving, tuned;
  };
  constexpr std::array kinds = {Kind{"static", Method::statics, true, false},
                                Kind{"ecd", Method::ecd, true, false},
                                Kind{"icd", Method::icd, true, false},
                                Kind{"caa", Method::caa, true, false},
                                Kind{"finite", Method::finite, true, false},
                                Kind{"reduced", Method::reduced, true, false},
                                Kind{"reduced, not moving", Method::reduced, false, false},
                                Kind{"reduced and tuned", Method::reduced, true, true}};
  std::vector<Way> all;
  for (const Kind& kind : kinds) {
    for (const bool pulls : {false, true}) {
      for (const bool inertia : {false, true}) {
        if (kind.tuned && !pulls) continue;
        Way way;
        way.choice.method = kind.method;
        way.choice.reduced.moving = kind.moving;
        way.choice.reduced.tuned = kind.tuned;
        way.choice.reduced.cells = {2, 2, 8};
        way.choice.inertia = inertia;
        way.choice.activation = pulls ? ExcitationSource::host : ExcitationSource::none;
        way.name = fmt::format("{}{}{}", kind.name, inertia ? ", inertia" : "", pulls ? ", pulling" : "");
        all.push_back(way);
      }
    }
  }
  for (const Method method : {Method::ecd, Method::icd, Method::caa}) {
    Way way;
    way.choice.method = method;
    way.choice.drive = Drive::force;
    way.name = fmt::format("{}, driven by force", method_name[static_cast<std::size_t>(method)]);
    all.push_back(way);
  }
  return all;
}

/// What a posed person is put through, tick by tick.
struct Ordeal {
  std::string_view name;
  Result<void> (*tick)(Simulation& simulation, Entity human, const Body& body, int tick);
};

Result<void> kicked(Simulation& simulation, Entity human, const Body& body, int tick) {
  const bool bent = tick % 2 == 0;
  return simulation.set_pose(human,
                             with_bent_legs(body, {bent ? 90.0F : 0.0F, bent ? 120.0F : 0.0F, bent ? 20.0F : -40.0F}));
}

Result<void> thrown(Simulation& simulation, Entity human, const Body& body, int tick) {
  Pose<float> pose = with_bent_legs(body, {});
  const float far = tick % 2 == 0 ? 100.0F : -100.0F;
  for (auto& p : pose.position_m) p = {p.x + far, p.y + far, p.z - far};
  return simulation.set_pose(human, pose);
}

Result<void> pulled_apart(Simulation& simulation, Entity human, const Body& body, int tick) {
  Pose<float> pose = with_bent_legs(body, {});
  for (const Segment segment : {Segment::shank_right, Segment::foot_right, Segment::shank_left, Segment::foot_left}) {
    pose.position_m[index(segment)].y -= tick % 3 == 0 ? 2.0F : 0.0F;
  }
  return simulation.set_pose(human, pose);
}

Result<void> excited(Simulation& simulation, Entity human, const Body&, int tick) {
  for (const OwnMuscle& own : simulation.muscles(human)) {
    for (const Side side : {Side::right, Side::left}) {
      auto done = simulation.set_excitation(human, own.muscle, side, tick % 2 == 0 ? 1.0F : 0.01F);
      if (!done) return done;
    }
  }
  return {};
}

Result<Entity> doll(Simulation& simulation, const LegMuscles& choice) {
  auto human = simulation.spawn_posed({});
  if (!human) return human;
  if (auto added = simulation.add_leg_muscles(*human, choice); !added) return tl::unexpected(added.error());
  return human;
}

}  // namespace

Result<void> stress_ways(StressRun& run) {
  constexpr std::array ordeals = {Ordeal{"knees bent by 120 degrees and back in every tick", &kicked},
                                  Ordeal{"thrown 300 m in every tick", &thrown},
                                  Ordeal{"shanks 2 m off the thighs in one tick of three", &pulled_apart},
                                  Ordeal{"excitation from none to full in every tick", &excited}};
  constexpr int rest_s = 4;
  struct Trial {
    const Way* way;
    const Ordeal* ordeal;
    Entity human, calm;
    double worst_m = 0;
  };
  // All in one simulation, for what is made once for each muscle takes longest; people do not meet.
  Simulation simulation;
  std::vector<Trial> trials;
  const auto all = ways();
  for (const Way& way : all) {
    const auto calm = doll(simulation, way.choice);
    if (!calm) return tl::unexpected(calm.error());
    for (const Ordeal& ordeal : ordeals) {
      if (ordeal.tick == &excited && !has_activation(way.choice)) continue;
      const auto human = doll(simulation, way.choice);
      if (!human) return tl::unexpected(human.error());
      trials.push_back({&way, &ordeal, *human, *calm});
    }
    run.progress(0.3 * static_cast<double>(&way - all.data()) / static_cast<double>(all.size()));
  }
  const Body body = simulation.human(trials.front().human)->body;
  const Pose<float> usual = *simulation.get<Pose>(trials.front().human);
  const int shaken = run.quick ? 30 : 240, ticks = shaken + 60 * rest_s;
  for (int tick = 0; tick < ticks; ++tick) {
    for (Trial& trial : trials) {
      if (tick < shaken) {
        if (auto done = trial.ordeal->tick(simulation, trial.human, body, tick); !done) return done;
      } else if (tick == shaken) {
        if (has_activation(trial.way->choice)) {
          if (auto done = excited(simulation, trial.human, body, 1); !done) return done;
        }
        if (auto done = simulation.set_pose(trial.human, usual, Arrival::jumped); !done) return done;
      }
    }
    simulation.tick();
    for (Trial& trial : trials) {
      if (tick < shaken) keep_worst(trial.worst_m, largest(control_points(simulation, trial.human)));
    }
    run.progress(0.3 + 0.7 * tick / ticks);
  }
  for (const Trial& trial : trials) {
    // Of ωh ≫ 1 the trapezoidal rule keeps (1 − 4·α/(ω²·h)) a step: what rings faster than ticks hardly dies away.
    const bool keeps_ringing = trial.way->choice.method == Method::caa;
    run.at_most(fmt::format("{}: {}", trial.way->name, trial.ordeal->name),
                fmt::format("control points off those of who stood still, {} s later, m", rest_s),
                keeps_ringing ? std::max(1e-3, trial.worst_m) : 1e-3,
                largest_difference(control_points(simulation, trial.human), control_points(simulation, trial.calm)),
                keeps_ringing ? "what rings faster than ticks this rule hardly damps; it never grows"
                              : "vibration falls by e^-4 a second or faster; nothing else is remembered",
                fmt::format("up to {:.3g} m meanwhile", trial.worst_m));
  }
  return {};
}

}  // namespace mobil
