#include <mobil/lod.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <mobil/components/compact.h>
#include <mobil/each.h>
#include <mobil/engine/jobs.h>
#include <mobil/muscle_library.h>
#include <mobil/muscle_table.h>
#include <mobil/rows.h>
#include "systems/accuracy/packed_levels.h"
#include "systems/lod/lod_module.h"
#include "systems/lod/lod_round.h"
#include "systems/muscles/leg_moments.h"
#include "systems/muscles/leg_muscles.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/people/group_by_table.h"
#include "systems/states/muscle_verbs.h"
#include "systems/states/person_states.h"
#include "systems/states/sleep.h"

namespace mobil::inline v0_3 {
namespace {

Result<void> check(const LodOptions& options) {
  if (options.slack > 0 && options.slack <= 1 && options.stagger > 0 && options.every > 0 &&
      positive(double{options.margin}) && positive(options.machine_factor.value_or(1)) &&
      positive(options.switching_s)) {
    return {};
  }
  return fail(
      "set_options: slack must be within 0 and 1, stagger and every at least 1, margin, switching_s and machine_factor "
      "positive");
}

std::string explain(const Choice& choice, View view, const std::string& goal) {
  const std::string_view name = levels_of(choice.active)[choice.level].name;
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

LodWork& Lod::work() const {
  return frame_.workspace.get<LodWork>();
}

const LodScene& Lod::scene() const {
  return work().scene;
}

const LodReport& Lod::report() const {
  return work().report;
}

Result<void> Lod::set_options(const LodOptions& options) {
  const FloatMode mode;
  if (auto ok = check(options); !ok) return ok;
  LodWork& to = work();
  to.options = options;
  std::construct_at(&to.lod_table,
                    options.table != nullptr ? *options.table : accuracy_table());  // too large for small stacks
  to.orders.make_by(options.background, options.making_ticks);
  return {};
}

Result<void> Lod::set_scene(const LodScene& needs) {
  const FloatMode mode;
  if (needs.tolerance_m && !positive(static_cast<double>(*needs.tolerance_m)))
    return fail(fmt::format("set_scene: a tolerance of {} m is not finite and positive", *needs.tolerance_m));
  if (!positive(static_cast<double>(needs.tolerance_px)))
    return fail(fmt::format("set_scene: a tolerance of {} pixels is not finite and positive", needs.tolerance_px));
  if (needs.budget_s && !positive(*needs.budget_s))
    return fail(fmt::format("set_scene: a budget of {} s a tick is not finite and positive", *needs.budget_s));
  if ((needs.muscles >> muscles().size()).any())
    return fail(
        fmt::format("set_scene: there are {} muscles; take usual_muscles(), muscle_members() or find_muscle(name)",
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
  work().scene = needs;
  return {};
}

/// Returns the levels that can be the cheapest for one of the scene's muscles at any speed. Tests these tolerances, of
/// which a cheaper method must keep to `slack`. With a camera or a budget tests all tolerances.
static std::array<bool, level_count> called_for(const LodWork& work, std::span<const float> tolerances_m) {
  std::array<bool, level_count> called{};
  LevelCase of{.inertia = work.options.leg_muscles.inertia, .active = pulls_alive(work.options.leg_muscles)};
  for (of.muscle = 0; of.muscle < muscles().size(); ++of.muscle) {
    for (of.speed_step = 0; of.speed_step < LodTable::speed_steps && work.scene.muscles[of.muscle]; ++of.speed_step) {
      if (!work.scene.camera && !work.scene.budget_s) {
        for (const float tolerance_m : tolerances_m)
          called[work.lod_table.cheapest(of, work.options.slack * tolerance_m / work.options.margin)] = true;
        continue;
      }
      for (const bool points : {false, true}) {
        of.points = points;
        for (std::uint32_t r = 0; r < level_count; ++r)
          called[work.lod_table.cheapest(of, work.lod_table.error_m(of, r))] = true;
      }
    }
  }
  return called;
}

Result<void> Lod::prepare(std::span<const float> own_tolerances_m,
                          const std::function<void(std::size_t done, std::size_t of)>& progress) {
  const FloatMode mode;
  std::vector<float> tolerances(own_tolerances_m.begin(), own_tolerances_m.end());
  for (const float tolerance_m : tolerances)
    if (!positive(double{tolerance_m}))
      return fail(fmt::format("prepare: a tolerance of {} m; give a positive one", tolerance_m));
  if (!work().scene.camera) tolerances.push_back(work().scene.tolerance_m.value_or(default_tolerance_m));
  const auto called = called_for(work(), tolerances);
  const auto calls = std::accumulate(called.begin() + 1, called.end(), std::size_t{0});
  for (std::size_t r = 1, done = 0; r < level_count; ++r) {
    if (!called[r]) continue;
    if (progress) progress(done++, calls);
    LegMuscles choice = work().options.leg_muscles;
    const MuscleMethod method = level_method(r, true, pulls_alive(choice));
    choice.muscles = work().scene.muscles;
    choice.method = method.method;
    choice.modal = method.modal;
    if (auto made = MuscleLibrary(frame_).prepare(choice); !made) return made;
  }
  return {};
}

/// Makes all people full and awake, and gives them muscles where they have none. On an error no person has changed.
static Result<void> make_ready(const Frame& frame, const LodWork& work, std::span<const Entity> people,
                               const LodOverrides& needs) {
  World::Transaction transaction(frame.world, frame.jobs);
  if (auto done = make_muscles_full(frame, people); !done) return done;
  LegMuscles choice = work.options.leg_muscles;
  choice.muscles = needs.muscles.value_or(work.scene.muscles);
  choice.method = Method::none;
  for (const Entity person : people) {
    if (choice.muscles.none() || frame.world.alive(frame.world.first_member(person))) continue;
    if (auto done = set_muscles(frame, {&person, 1}, choice); !done) return done;
  }
  transaction.commit();
  return {};
}

Result<void> Lod::manage(Entity person, const LodOverrides& needs) {
  return manage(std::span(&person, 1), needs);
}

Result<void> Lod::manage(std::span<const Entity> people, const LodOverrides& needs) {
  const FloatMode mode;
  if (!frame_.world.alive_once(people) ||
      !std::ranges::all_of(people, [&](Entity person) { return is_person(frame_.world, person); }))
    return fail("manage: somebody is not there (a stale handle), or named twice; spawn people first, name each once",
                Status::stale_entity);
  if (needs.tolerance_m && !positive(static_cast<double>(*needs.tolerance_m)))
    return fail(fmt::format("manage: a tolerance of {} m is not finite and positive", *needs.tolerance_m));
  LodRequest<float> row{};
  if (needs.muscles) {
    row.own |= own_muscles;
    set_bits(row.muscles, *needs.muscles);
  }
  if (needs.tolerance_m) {
    row.own |= own_tolerance;
    row.tolerance_m = *needs.tolerance_m;
  }
  if (needs.looked_at) {
    row.own |= own_look;
    row.looked_at = *needs.looked_at ? 1 : 0;
  }
  const float tolerance_m =
      row.tolerance_m > 0 ? row.tolerance_m : work().scene.tolerance_m.value_or(default_tolerance_m);
  World::Transaction transaction(frame_.world, frame_.jobs);
  if (auto done = make_ready(frame_, work(), people, needs); !done) return done;
  std::vector<LodState<float>> lod_state(people.size());
  in_parallel(frame_.jobs, people.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      lod_state[i] = lod_state_of(frame_.world, people[i]);
      lod_state[i].tolerance_m = tolerance_m;
      lod_state[i].relative_size = work().options.margin;
    }
  });
  std::vector<Entity> anew;
  for (const Entity person : people)
    if (!frame_.world.has<LodRequest>(person) || !frame_.world.has<LodState>(person)) anew.push_back(person);
  group_by_table(frame_.world, anew, [&](std::span<const Entity> together) {
    frame_.world.change_archetype(
        together,
        std::array{PartValue{component_id<LodRequest>(), nullptr}, PartValue{component_id<LodState>(), nullptr}}, {},
        frame_.jobs);
  });
  transaction.commit();
  for (std::size_t i = 0; i < people.size(); ++i) {
    frame_.world.set(people[i], row);
    frame_.world.set(people[i], lod_state[i]);
  }
  return {};
}

Result<std::size_t> Lod::manage_asleep(std::span<const Entity> people) {
  const FloatMode mode;
  if (!frame_.world.alive_once(people))
    return fail("manage_asleep: somebody is not there (a stale handle), or named twice; name each once",
                Status::stale_entity);
  for (const Entity person : people)
    if (!is_person(frame_.world, person) || has_any_muscles(frame_.world, person))
      return fail("manage_asleep: somebody has muscles, or is no person; manage them instead", Status::already_there);
  LegMuscles choice = work().options.leg_muscles;
  choice.muscles = work().scene.muscles;
  choice.method = Method::none;
  if (choice.muscles.any()) {
    if (auto ok = check_choice(choice, frame_.workspace.get<MuscleMeans>().tick_s); !ok)
      return tl::unexpected(ok.error());
    for (const Entity person : people)
      if (auto ok = check_leg_moments(frame_.world, person, choice); !ok) return tl::unexpected(ok.error());
  }
  frame_.world.global<LodProgress>().all_sleepers = 1;  // some can be in view of a camera that does not move
  const auto kept = keep_choice(frame_.world, *frame_.workspace.get<MuscleMeans>().library, choice);
  const std::array keeps = {component_id(TagValue<SleepsManaged>{1}), component_id(kept)};
  const std::size_t slept = sleep_managed(frame_, people, keeps);
  for (const Entity person : people) {
    if (is_managed(frame_.world, person)) continue;
    if (auto done = manage(person); !done) return tl::unexpected(done.error());
  }
  return slept;
}

Result<void> Lod::release(Entity person) {
  return release(std::span(&person, 1));
}

Result<void> Lod::release(std::span<const Entity> people) {
  const FloatMode mode;
  if (!frame_.world.alive_once(people))
    return fail("release: somebody is not there (a stale handle), or named twice", Status::stale_entity);
  std::vector<Entity> whole;
  for (const Entity person : people) {
    if (!is_managed(frame_.world, person)) return fail("release: somebody is not managed", Status::missing);
    // A person with pending muscles is made full, because nothing else would begin those muscles.
    const bool stays_compact = is_compact(frame_.world, person) &&
                               (frame_.world.has<CompactMuscles>(person) || !kept_choice(frame_.world, person));
    if (!stays_compact) whole.push_back(person);
  }
  World::Transaction transaction(frame_.world, frame_.jobs);
  if (auto done = make_muscles_full(frame_, whole); !done) return done;
  constexpr std::array parts = {type_id<LodRequest<float>>(), type_id<LodState<float>>()};
  group_by_table(frame_.world, people, [&](std::span<const Entity> together) {
    frame_.world.change_archetype(together, {}, parts, frame_.jobs);
  });
  transaction.commit();
  return {};
}

Result<void> Lod::force(Entity person, Muscle muscle, const MuscleMethod& method) {
  const FloatMode mode;
  auto lod_state = frame_.world.get<LodState>(person);
  const auto m = static_cast<std::uint32_t>(muscle);
  if (!lod_state || m >= max_muscles || !bit_at(lod_state->muscles, m))
    return fail("force: that person, or that muscle of theirs, is not managed; manage it first",
                lod_state ? Status::missing : lod_state.error());
  struct AsBefore {  // runs after the rollback of the transaction, on a refusal or if memory runs out
    World& world;
    Entity person;
    LodState<float> lod_state;
    bool done = false;
    ~AsBefore() {
      if (!done) world.set(person, lod_state);
    }
  } as_before{frame_.world, person, *lod_state};
  std::optional<World::Transaction> transaction;
  const auto ask = [&]() -> Result<void> {
    if ((lod_state->effects & lod_bare) != 0) {
      transaction.emplace(frame_.world, frame_.jobs);
      if (auto done = mobil::make_full(frame_, {&person, 1}); !done) return done;
      if (auto done = LodRound(frame_).begin_muscles(std::span(&person, 1), 0, false); !done) return done;
    }
    return set_method(frame_, {&person, 1}, muscle, method);
  };
  if (auto done = ask(); !done) return done;
  if (transaction) transaction->commit();
  as_before.done = true;
  lod_state = frame_.world.get<LodState>(person);
  set_level(lod_state->level, m, forced_level);
  frame_.world.set(person, *lod_state);
  return {};
}

Result<void> Lod::unforce(Entity person, Muscle muscle) {
  const FloatMode mode;
  auto lod_state = frame_.world.get<LodState>(person);
  if (!lod_state) return fail(lod_state.error());
  const auto m = static_cast<std::uint32_t>(muscle);
  if (m >= max_muscles || !bit_at(lod_state->muscles, m)) return fail(Status::missing);
  const MuscleMethod method = method_of(frame_.world, person, muscle);
  set_level(lod_state->level, m, level_of(method, is_active(*lod_state)));
  set_bit(lod_state->points, m, method.method != Method::none && method.modal.control_points);
  return result_of("unforce", frame_.world.set(person, *lod_state));
}

Result<Choice> Lod::why(Entity person, Muscle muscle) const {
  const auto lod_state = frame_.world.get<LodState>(person);
  if (!lod_state) return fail(lod_state.error());
  const auto needs = *frame_.world.get<LodRequest>(person);
  const auto m = static_cast<std::uint32_t>(muscle);
  if (m >= max_muscles || !bit_at(lod_state->muscles, m)) return fail(Status::missing);
  Choice choice;
  choice.method = method_of(frame_.world, person, muscle);
  const std::uint32_t marked = level_at(lod_state->level, m), goal = level_at(lod_state->goal, m);
  choice.active = is_active(*lod_state);
  choice.level = marked >= refused_level ? level_of(choice.method, choice.active) : marked;
  const LevelCase of = level_case(*lod_state, m, bit_at(lod_state->points, m));
  const LodLevels& all = levels_of(choice.active);
  const auto level = static_cast<std::uint32_t>(choice.level);
  choice.predicted_error_m = work().lod_table.error_m(of, level) * lod_state->relative_size;
  choice.predicted_volume_off = work().lod_table.volume_off(of, level);
  choice.tolerance_m = lod_state->tolerance_m;
  choice.predicted_cost_us =
      0.5e-6 * static_cast<double>(work().lod_table.cost_ps(of, level)) * LodRound(frame_).machine().mean();
  const auto view = static_cast<View>(lod_state->view);
  const bool shown_differs =
      bit_at(lod_state->points, m) != bit_at(lod_state->goal_points, m) && all[choice.level].method == Method::modal;
  if (marked == forced_level) {
    choice.reason = Reason::forced;
  } else if (marked == refused_level) {
    choice.reason = Reason::refused;
  } else if (goal != marked || shown_differs) {
    choice.reason = Reason::switch_pending;
  } else if ((LodRound(frame_).wanted(needs) >> m & 1U) == 0) {
    choice.reason = Reason::not_wanted;
  } else if (view == View::out_of_sight) {
    choice.reason = Reason::out_of_sight;
  } else if (view == View::out_of_reach) {
    choice.reason = Reason::out_of_reach;
  } else if (choice.predicted_error_m <= choice.tolerance_m) {
    choice.reason = Reason::tolerance;
  } else {
    choice.reason = work().scene.budget_s && LodRound(frame_).factor() > 1 ? Reason::budget : Reason::best;
  }
  choice.text = explain(choice, view, std::string(goal < level_count ? all[goal].name : "another"));
  return choice;
}

std::array<std::size_t, level_count + 1> Lod::muscles_by_level(bool active) const {
  std::array<std::size_t, level_count + 1> count{};
  each(frame_.world, [&](const Rows& rows, const LodState<Lanes<float>>& block) {
    for (std::uint32_t lane = 0; lane < rows.live; ++lane) {
      const LodState<float> lod_state = row_of(block, lane);
      for (std::uint32_t m = 0; m < max_muscles && is_active(lod_state) == active; ++m) {
        if (bit_at(lod_state.muscles, m)) count[std::min<std::size_t>(level_at(lod_state.level, m), level_count)] += 2;
      }
    }
  });
  return count;
}

Phase detail_chosen() {
  return {"level of detail", [](const Frame& frame) {
            if (!frame.workspace.get<ManagedPeople>().tables.any_rows(frame.world)) return;
            if (frame.tick.index % frame.workspace.get<LodWork>().options.every == 0) LodRound(frame).run();
          }};
}

void begin_lod_report(const Frame& frame) {
  LodWork* const work = frame.workspace.find<LodWork>();
  if (work == nullptr) return;
  const LodReport& last = work->report;
  work->report = {.factor = last.factor, .machine = last.machine, .predicted_s = last.predicted_s};
}

}  // namespace mobil::inline v0_3
