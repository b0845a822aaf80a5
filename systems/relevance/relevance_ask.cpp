// What can be asked of Relevance: whose muscles it chooses, by what needs, and why it chose.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <mobil/components/compact.h>
#include <mobil/each.h>
#include <mobil/engine/jobs.h>
#include <mobil/muscle_table.h>
#include <mobil/relevance.h>
#include <mobil/rows.h>
#include <mobil/systems/relevance/relevance_module.h>
#include "systems/muscles/leg_muscles.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/muscles/sleep.h"
#include "systems/people/by_table.h"
#include "systems/relevance/packed_rungs.h"
#include "systems/simulation_world.h"

namespace mobil::inline v0_3 {
namespace {

std::string explain(const Choice& choice, View view, const std::string& goal) {
  const std::string_view name = rungs_of(choice.living)[choice.rung].name;
  const double error_mm = 1e3 * static_cast<double>(choice.predicted_error_m);
  const double allowed_mm = 1e3 * static_cast<double>(choice.tolerance_m);
  std::string figures = fmt::format("{}: {:.3g} mm of {:.3g} mm allowed, {:.3g} us a tick", name, error_mm, allowed_mm,
                                    choice.predicted_cost_us);
  if (choice.predicted_volume_off > 0)
    figures += fmt::format(", volume within {:.2g} %", 100 * choice.predicted_volume_off);
  switch (choice.reason) {
    case Reason::tolerance:
      return figures + "; the cheapest that keeps to it";
    case Reason::best:
      return figures + "; there is none better";
    case Reason::budget:
      return figures + "; better costs more than the budget";
    case Reason::out_of_sight:
    case Reason::out_of_reach:
      return fmt::format("{}: {}", name, view_name[static_cast<std::size_t>(view)]);
    case Reason::not_wanted:
      return fmt::format("{}: the scene does not want this muscle", name);
    case Reason::forced:
      return "forced by the caller";
    case Reason::refused:
      return "left as it was: the simulation refused what was chosen";
    case Reason::switch_pending:
      return figures + fmt::format("; {} is chosen and waits for its turn", goal);
  }
  return figures;
}

}  // namespace

Tiers<float> tiers_of(const World& world, Entity human) {
  const auto before = world.get<Tiers>(human);
  const bool anew = !before || before->relative_size == 0;
  Tiers<float> tiers = before.value_or(Tiers<float>{});
  if (anew) tiers.view = static_cast<std::uint32_t>(View::out_of_reach);
  tiers.muscles = tiers.effects = 0;
  tiers.relative_size = 1;
  for (const OwnMuscle& own : muscles_of(world, human)) {
    const auto m = static_cast<std::uint32_t>(own.muscle);
    const Entity one = world.alive(own.entity[Side::right]) ? own.entity[Side::right] : own.entity[Side::left];
    if (tiers.muscles == 0) {
      const LegMuscles& choice = *world.shared<LegMuscles>(one);
      tiers.effects = (choice.inertia ? tier_inertia : 0U) | (pulls_alive(choice) ? tier_living : 0U);
    }
    set_bit(tiers.muscles, m, true);
    if (!anew && bit_at(before->muscles, m) && rung_at(tiers.rung, m) == forced_rung) continue;
    const MuscleMethod method = muscle_method(world, one);
    const std::uint32_t rung = rung_of(method, is_living(tiers));
    set_rung(tiers.rung, m, rung);
    set_rung(tiers.goal, m, rung);
    set_bit(tiers.points, m, method.method != Method::none && method.reduced.control_points);
  }
  return tiers;
}

std::uint32_t rung_of(const MuscleMethod& method, bool living) {
  if (method.method == Method::none) return 0;
  const Ladder& ladder = rungs_of(living);
  const ReducedChoice& reduced = method.reduced;
  const bool moving = reduced.moving && (reduced.tuned || !living);
  std::uint32_t nearest = rung_count - (living || method.method != Method::reduced ? 1 : 2);
  for (std::uint32_t r = rung_count - 1; r > 0; --r) {
    const Rung& rung = ladder[r];
    if (rung.method != method.method) continue;
    if (rung.method != Method::reduced) return r;
    if (moving != rung.moving || (living && rung.finite_shape == reduced.linear_shape)) continue;
    if (!moving || (reduced.cells == rung.cells && reduced.vectors <= rung.vectors)) nearest = r;
  }
  return nearest;
}

MuscleMethod rung_method(std::size_t rung, bool control_points, bool living) {
  const Rung& of = rungs_of(living)[rung];
  MuscleMethod method{of.method, {}};
  if (of.method == Method::reduced) {
    method.reduced = {of.vectors,     of.moving, true,     of.cells,
                      control_points, false,     of.tuned, living && !of.finite_shape};
  }
  return method;
}

Result<void> Relevance::set_scene(const SceneNeeds& needs) {
  if (needs.tolerance_m && !positive(static_cast<double>(*needs.tolerance_m)))
    return fail(fmt::format("set_scene: a tolerance of {} m is not finite and positive", *needs.tolerance_m));
  if (!positive(static_cast<double>(needs.tolerance_px)))
    return fail(fmt::format("set_scene: a tolerance of {} pixels is not finite and positive", needs.tolerance_px));
  if (needs.budget_s && !positive(*needs.budget_s))
    return fail(fmt::format("set_scene: a budget of {} s a tick is not finite and positive", *needs.budget_s));
  if ((needs.muscles >> muscles().size()).any())
    return fail(
        fmt::format("set_scene: there are {} muscles; take muscle_groups(), muscle_members() or find_muscle(name)",
                    muscles().size()));
  if (needs.asleep_beyond_m && !(needs.camera && *needs.asleep_beyond_m >= 2 && *needs.asleep_beyond_m < 1e6F))
    return fail(fmt::format("set_scene: asleep beyond {} m; give 2 m or more, and a camera", *needs.asleep_beyond_m));
  if (needs.camera) {
    const Viewpoint& c = *needs.camera;
    const Vec3<float>&f = c.forward, &p = c.position_m;
    const bool sound = positive(static_cast<double>(f.x * f.x + f.y * f.y + f.z * f.z)) &&
                       std::isfinite(p.x + p.y + p.z) && positive(static_cast<double>(c.radians_per_pixel)) &&
                       c.half_angle_rad > 0 && c.half_angle_rad <= 1.6F && c.near_m >= 0 && c.reach_m >= 0;
    if (!sound)
      return fail(
          "set_scene: a camera needs a finite place, a direction, radians per pixel above 0, half an angle of 0 to 1.6"
          " rad, and distances of 0 or more");
  }
  scene_ = needs;
  return {};
}

/// Rungs that may be the cheapest for one of the scene's muscles and any walk: for these tolerances, where a cheaper
/// method must keep to the least part of one; for any, where tolerances follow from a camera or a budget.
std::array<bool, rung_count> Relevance::called_for(std::span<const float> tolerances_m) const {
  std::array<bool, rung_count> called{};
  RungCase of{.inertia = options_.leg_muscles.inertia, .living = pulls_alive(options_.leg_muscles)};
  for (of.muscle = 0; of.muscle < muscles().size(); ++of.muscle) {
    for (of.speed_step = 0; of.speed_step < RungLadder::speed_steps && scene_.muscles[of.muscle]; ++of.speed_step) {
      if (!scene_.camera && !scene_.budget_s) {
        for (const float tolerance_m : tolerances_m)
          called[ladder_.cheapest(of, options_.slack * tolerance_m / options_.margin)] = true;
        continue;
      }
      for (const bool points : {false, true}) {
        of.points = points;
        for (std::uint32_t r = 0; r < rung_count; ++r) called[ladder_.cheapest(of, ladder_.error_m(of, r))] = true;
      }
    }
  }
  return called;
}

Result<void> Relevance::prepare(std::span<const float> own_tolerances_m,
                                const std::function<void(std::size_t done, std::size_t of)>& progress) {
  std::vector<float> tolerances(own_tolerances_m.begin(), own_tolerances_m.end());
  for (const float tolerance_m : tolerances)
    if (!positive(double{tolerance_m}))
      return fail(fmt::format("prepare: a tolerance of {} m; give a positive one", tolerance_m));
  if (!scene_.camera) tolerances.push_back(scene_.tolerance_m.value_or(default_tolerance_m));
  const auto called = called_for(tolerances);
  const auto calls = std::accumulate(called.begin() + 1, called.end(), std::size_t{0});
  for (std::size_t r = 1, done = 0; r < rung_count; ++r) {
    if (!called[r]) continue;
    if (progress) progress(done++, calls);
    LegMuscles choice = options_.leg_muscles;
    const MuscleMethod method = rung_method(r, true, pulls_alive(choice));
    choice.muscles = scene_.muscles;
    choice.method = method.method;
    choice.reduced = method.reduced;
    if (auto made = simulation_.prepare(choice); !made) return made;
  }
  return {};
}

Result<void> Relevance::manage(Entity human, const PersonNeeds& needs) {
  return manage(std::span(&human, 1), needs);
}

Result<void> Relevance::manage(std::span<const Entity> people, const PersonNeeds& needs) {
  World& world = world_of(simulation_);
  if (!world.alive_once(people) ||
      !std::ranges::all_of(people, [&](Entity human) { return simulation_.is_person(human); }))
    return fail("manage: somebody is not there (a stale handle), or named twice; spawn people first, name each once",
                Status::stale_entity);
  if (needs.tolerance_m && !positive(static_cast<double>(*needs.tolerance_m)))
    return fail(fmt::format("manage: a tolerance of {} m is not finite and positive", *needs.tolerance_m));
  Needs<float> row{};
  if (needs.muscles) {
    row.own |= own_muscles;
    row.muscles = static_cast<std::uint32_t>(needs.muscles->to_ulong());
  }
  if (needs.tolerance_m) {
    row.own |= own_tolerance;
    row.tolerance_m = *needs.tolerance_m;
  }
  if (needs.looked_at) {
    row.own |= own_look;
    row.looked_at = *needs.looked_at ? 1 : 0;
  }
  const float tolerance_m = row.tolerance_m > 0 ? row.tolerance_m : scene_.tolerance_m.value_or(default_tolerance_m);
  const Jobs& jobs = SimulationWorld::jobs(simulation_);
  World::Attempt attempt(world, jobs);
  if (auto done = make_ready(people, needs); !done) return done;
  std::vector<Tiers<float>> tiers(people.size());
  in_parallel(jobs, people.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      tiers[i] = tiers_of(world, people[i]);
      tiers[i].tolerance_m = tolerance_m;
      tiers[i].relative_size = options_.margin;
    }
  });
  std::vector<Entity> anew;
  for (const Entity human : people)
    if (!world.has<Needs>(human) || !world.has<Tiers>(human)) anew.push_back(human);
  by_table(world, anew, [&](std::span<const Entity> together) {
    world.remake_many(
        together, std::array{PartValue{component_part<Needs>(), nullptr}, PartValue{component_part<Tiers>(), nullptr}},
        {}, jobs);
  });
  attempt.keep();
  for (std::size_t i = 0; i < people.size(); ++i) {
    world.set(people[i], row);
    world.set(people[i], tiers[i]);
  }
  return {};
}

/// All are awake, whole and have muscles, or nobody has changed.
Result<void> Relevance::make_ready(std::span<const Entity> people, const PersonNeeds& needs) {
  World& world = world_of(simulation_);
  World::Attempt attempt(world, SimulationWorld::jobs(simulation_));
  if (auto done = SimulationWorld::make_muscles_whole(simulation_, people); !done) return done;
  LegMuscles choice = options_.leg_muscles;
  choice.muscles = needs.muscles.value_or(scene_.muscles);
  choice.method = Method::none;
  for (const Entity human : people) {
    if (choice.muscles.none() || world.alive(world.first_member(human))) continue;
    if (auto done = simulation_.add_leg_muscles(human, choice); !done) return done;
  }
  attempt.keep();
  return {};
}

bool is_managed(const World& world, Entity human) {
  return world.has<Needs>(human) || world.has<SleepsManaged>(human);
}

Result<void> Relevance::release(Entity human) {
  return release(std::span(&human, 1));
}

Result<void> Relevance::release(std::span<const Entity> people) {
  World& world = world_of(simulation_);
  const Jobs& jobs = SimulationWorld::jobs(simulation_);
  if (!world.alive_once(people))
    return fail("release: somebody is not there (a stale handle), or named twice", Status::stale_entity);
  std::vector<Entity> whole;
  for (const Entity human : people) {
    if (!is_managed(world, human)) return fail("release: somebody is not managed", Status::missing);
    // Nobody else would begin the muscles that are to come.
    const bool stays_compact =
        simulation_.is_compact(human) && (world.has<CompactMuscles>(human) || !kept_choice(world, human));
    if (!stays_compact) whole.push_back(human);
  }
  World::Attempt attempt(world, jobs);
  if (auto done = SimulationWorld::make_muscles_whole(simulation_, whole); !done) return done;
  constexpr std::array parts = {type_id<Needs<float>>(), type_id<Tiers<float>>()};
  by_table(world, people, [&](std::span<const Entity> together) { world.remake_many(together, {}, parts, jobs); });
  attempt.keep();
  return {};
}

Result<void> Relevance::force(Entity human, Muscle muscle, const MuscleMethod& method) {
  auto tiers = simulation_.world().get<Tiers>(human);
  const auto m = static_cast<std::uint32_t>(muscle);
  if (!tiers || m >= most_muscles || !bit_at(tiers->muscles, m))
    return fail("force: that person, or that muscle of theirs, is not managed; manage it first",
                tiers ? Status::missing : tiers.error());
  World& world = world_of(simulation_);
  struct AsBefore {  // where it is refused, or memory runs out: once the attempt is undone
    World& world;
    Entity human;
    Tiers<float> tiers;
    bool done = false;
    ~AsBefore() {
      if (!done) world.set(human, tiers);
    }
  } as_before{world, human, *tiers};
  std::optional<World::Attempt> attempt;
  const auto ask = [&]() -> Result<void> {
    if ((tiers->effects & tier_bare) != 0) {
      attempt.emplace(world, SimulationWorld::jobs(simulation_));
      if (auto done = SimulationWorld::make_whole(simulation_, {&human, 1}); !done) return done;
      if (auto done = begin_muscles(std::span(&human, 1), 0, false); !done) return done;
    }
    return simulation_.set_method(human, muscle, method);
  };
  if (auto done = ask(); !done) return done;
  if (attempt) attempt->keep();
  as_before.done = true;
  tiers = world.get<Tiers>(human);
  set_rung(tiers->rung, m, forced_rung);
  world.set(human, *tiers);
  return {};
}

Result<void> Relevance::unforce(Entity human, Muscle muscle) {
  auto tiers = simulation_.world().get<Tiers>(human);
  if (!tiers) return fail(tiers.error());
  const auto m = static_cast<std::uint32_t>(muscle);
  if (m >= most_muscles || !bit_at(tiers->muscles, m)) return fail(Status::missing);
  const MuscleMethod method = simulation_.method(human, muscle);
  set_rung(tiers->rung, m, rung_of(method, is_living(*tiers)));
  set_bit(tiers->points, m, method.method != Method::none && method.reduced.control_points);
  return result_of("unforce", world_of(simulation_).set(human, *tiers));
}

Result<Choice> Relevance::why(Entity human, Muscle muscle) const {
  const auto tiers = simulation_.world().get<Tiers>(human);
  if (!tiers) return fail(tiers.error());
  const auto needs = *simulation_.world().get<Needs>(human);
  const auto m = static_cast<std::uint32_t>(muscle);
  if (m >= most_muscles || !bit_at(tiers->muscles, m)) return fail(Status::missing);
  Choice choice;
  choice.method = simulation_.method(human, muscle);
  const std::uint32_t marked = rung_at(tiers->rung, m), goal = rung_at(tiers->goal, m);
  choice.living = is_living(*tiers);
  choice.rung = marked >= refused_rung ? rung_of(choice.method, choice.living) : marked;
  const RungCase of = rung_case(*tiers, m, bit_at(tiers->points, m));
  const Ladder& ladder = rungs_of(choice.living);
  const auto rung = static_cast<std::uint32_t>(choice.rung);
  choice.predicted_error_m = ladder_.error_m(of, rung) * tiers->relative_size;
  choice.predicted_volume_off = ladder_.volume_off(of, rung);
  choice.tolerance_m = tiers->tolerance_m;
  choice.predicted_cost_us = 0.5e-6 * static_cast<double>(ladder_.cost_ps(of, rung)) * machine_.mean();
  const auto view = static_cast<View>(tiers->view);
  const bool shown_differs =
      bit_at(tiers->points, m) != bit_at(tiers->goal_points, m) && ladder[choice.rung].method == Method::reduced;
  if (marked == forced_rung) {
    choice.reason = Reason::forced;
  } else if (marked == refused_rung) {
    choice.reason = Reason::refused;
  } else if (goal != marked || shown_differs) {
    choice.reason = Reason::switch_pending;
  } else if (!bit_at(wanted(needs), m)) {
    choice.reason = Reason::not_wanted;
  } else if (view == View::out_of_sight) {
    choice.reason = Reason::out_of_sight;
  } else if (view == View::out_of_reach) {
    choice.reason = Reason::out_of_reach;
  } else if (choice.predicted_error_m <= choice.tolerance_m) {
    choice.reason = Reason::tolerance;
  } else {
    choice.reason = scene_.budget_s && factor_ > 1 ? Reason::budget : Reason::best;
  }
  choice.text = explain(choice, view, std::string(goal < rung_count ? ladder[goal].name : "another"));
  return choice;
}

std::array<std::size_t, rung_count + 1> Relevance::muscles_by_rung(bool living) const {
  std::array<std::size_t, rung_count + 1> count{};
  each(simulation_.world(), [&](const Rows& rows, const Tiers<Lanes<float>>& block) {
    for (std::uint32_t lane = 0; lane < rows.live; ++lane) {
      const Tiers<float> tiers = row_of(block, lane);
      for (std::uint32_t m = 0; m < most_muscles && is_living(tiers) == living; ++m) {
        if (bit_at(tiers.muscles, m)) count[std::min<std::size_t>(rung_at(tiers.rung, m), rung_count)] += 2;
      }
    }
  });
  return count;
}

}  // namespace mobil::inline v0_3
