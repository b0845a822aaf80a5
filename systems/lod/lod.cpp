#include <mobil/lod.h>

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
#include <mobil/muscle_library.h>
#include <mobil/muscle_table.h>
#include <mobil/rows.h>
#include "systems/accuracy/packed_rungs.h"
#include "systems/lod/lod_module.h"
#include "systems/lod/lod_round.h"
#include "systems/muscles/leg_moments.h"
#include "systems/muscles/leg_muscles.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/people/by_table.h"
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

LodWork& Lod::work() const {
  return frame_.workspace.get<LodWork>();
}

const SceneNeeds& Lod::scene() const {
  return work().scene;
}

const LodReport& Lod::report() const {
  return work().report;
}

Result<void> Lod::set_options(const LodOptions& options) {
  if (auto ok = check(options); !ok) return ok;
  LodWork& to = work();
  to.options = options;
  to.ladder = RungLadder(options.table != nullptr ? *options.table : accuracy_table());
  to.orders.make_by(options.background, options.making_ticks);
  return {};
}

Result<void> Lod::set_scene(const SceneNeeds& needs) {
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
  work().scene = needs;
  return {};
}

/// Rungs that may be the cheapest for one of the scene's muscles and any walk: for these tolerances, where a cheaper
/// method must keep to the least part of one; for any, where tolerances follow from a camera or a budget.
static std::array<bool, rung_count> called_for(const LodWork& work, std::span<const float> tolerances_m) {
  std::array<bool, rung_count> called{};
  RungCase of{.inertia = work.options.leg_muscles.inertia, .living = pulls_alive(work.options.leg_muscles)};
  for (of.muscle = 0; of.muscle < muscles().size(); ++of.muscle) {
    for (of.speed_step = 0; of.speed_step < RungLadder::speed_steps && work.scene.muscles[of.muscle]; ++of.speed_step) {
      if (!work.scene.camera && !work.scene.budget_s) {
        for (const float tolerance_m : tolerances_m)
          called[work.ladder.cheapest(of, work.options.slack * tolerance_m / work.options.margin)] = true;
        continue;
      }
      for (const bool points : {false, true}) {
        of.points = points;
        for (std::uint32_t r = 0; r < rung_count; ++r)
          called[work.ladder.cheapest(of, work.ladder.error_m(of, r))] = true;
      }
    }
  }
  return called;
}

Result<void> Lod::prepare(std::span<const float> own_tolerances_m,
                          const std::function<void(std::size_t done, std::size_t of)>& progress) {
  std::vector<float> tolerances(own_tolerances_m.begin(), own_tolerances_m.end());
  for (const float tolerance_m : tolerances)
    if (!positive(double{tolerance_m}))
      return fail(fmt::format("prepare: a tolerance of {} m; give a positive one", tolerance_m));
  if (!work().scene.camera) tolerances.push_back(work().scene.tolerance_m.value_or(default_tolerance_m));
  const auto called = called_for(work(), tolerances);
  const auto calls = std::accumulate(called.begin() + 1, called.end(), std::size_t{0});
  for (std::size_t r = 1, done = 0; r < rung_count; ++r) {
    if (!called[r]) continue;
    if (progress) progress(done++, calls);
    LegMuscles choice = work().options.leg_muscles;
    const MuscleMethod method = rung_method(r, true, pulls_alive(choice));
    choice.muscles = work().scene.muscles;
    choice.method = method.method;
    choice.reduced = method.reduced;
    if (auto made = MuscleLibrary(frame_).prepare(choice); !made) return made;
  }
  return {};
}

/// All are awake, whole and have muscles, or nobody has changed.
static Result<void> make_ready(const Frame& frame, const LodWork& work, std::span<const Entity> people,
                               const PersonNeeds& needs) {
  World::Attempt attempt(frame.world, frame.jobs);
  if (auto done = make_muscles_whole(frame, people); !done) return done;
  LegMuscles choice = work.options.leg_muscles;
  choice.muscles = needs.muscles.value_or(work.scene.muscles);
  choice.method = Method::none;
  for (const Entity human : people) {
    if (choice.muscles.none() || frame.world.alive(frame.world.first_member(human))) continue;
    if (auto done = set_muscles(frame, {&human, 1}, choice); !done) return done;
  }
  attempt.keep();
  return {};
}

Result<void> Lod::manage(Entity human, const PersonNeeds& needs) {
  return manage(std::span(&human, 1), needs);
}

Result<void> Lod::manage(std::span<const Entity> people, const PersonNeeds& needs) {
  if (!frame_.world.alive_once(people) ||
      !std::ranges::all_of(people, [&](Entity human) { return is_person(frame_.world, human); }))
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
  const float tolerance_m =
      row.tolerance_m > 0 ? row.tolerance_m : work().scene.tolerance_m.value_or(default_tolerance_m);
  World::Attempt attempt(frame_.world, frame_.jobs);
  if (auto done = make_ready(frame_, work(), people, needs); !done) return done;
  std::vector<Tiers<float>> tiers(people.size());
  in_parallel(frame_.jobs, people.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      tiers[i] = tiers_of(frame_.world, people[i]);
      tiers[i].tolerance_m = tolerance_m;
      tiers[i].relative_size = work().options.margin;
    }
  });
  std::vector<Entity> anew;
  for (const Entity human : people)
    if (!frame_.world.has<Needs>(human) || !frame_.world.has<Tiers>(human)) anew.push_back(human);
  by_table(frame_.world, anew, [&](std::span<const Entity> together) {
    frame_.world.remake_many(
        together, std::array{PartValue{component_part<Needs>(), nullptr}, PartValue{component_part<Tiers>(), nullptr}},
        {}, frame_.jobs);
  });
  attempt.keep();
  for (std::size_t i = 0; i < people.size(); ++i) {
    frame_.world.set(people[i], row);
    frame_.world.set(people[i], tiers[i]);
  }
  return {};
}

Result<std::size_t> Lod::manage_asleep(std::span<const Entity> people) {
  if (!frame_.world.alive_once(people))
    return fail("manage_asleep: somebody is not there (a stale handle), or named twice; name each once",
                Status::stale_entity);
  for (const Entity human : people)
    if (!is_person(frame_.world, human) || has_any_muscles(frame_.world, human))
      return fail("manage_asleep: somebody has muscles, or is no person; manage them instead", Status::already_there);
  LegMuscles choice = work().options.leg_muscles;
  choice.muscles = work().scene.muscles;
  choice.method = Method::none;
  if (choice.muscles.any()) {
    if (auto ok = check_choice(choice, frame_.workspace.get<MuscleMeans>().tick_s); !ok)
      return tl::unexpected(ok.error());
    for (const Entity human : people)
      if (auto ok = check_leg_moments(frame_.world, human, choice); !ok) return tl::unexpected(ok.error());
  }
  frame_.world.global<LodProgress>().all_sleepers = 1;  // some may be in view of a camera that stands still
  const auto kept = keep_choice(frame_.world, *frame_.workspace.get<MuscleMeans>().library, choice);
  const std::array keeps = {key_part(TagValue<SleepsManaged>{1}), key_part(kept)};
  const std::size_t slept = sleep_managed(frame_, people, keeps);
  for (const Entity human : people) {
    if (is_managed(frame_.world, human)) continue;
    if (auto done = manage(human); !done) return tl::unexpected(done.error());
  }
  return slept;
}

Result<void> Lod::release(Entity human) {
  return release(std::span(&human, 1));
}

Result<void> Lod::release(std::span<const Entity> people) {
  if (!frame_.world.alive_once(people))
    return fail("release: somebody is not there (a stale handle), or named twice", Status::stale_entity);
  std::vector<Entity> whole;
  for (const Entity human : people) {
    if (!is_managed(frame_.world, human)) return fail("release: somebody is not managed", Status::missing);
    // Nobody else would begin the muscles that are to come.
    const bool stays_compact = is_compact(frame_.world, human) &&
                               (frame_.world.has<CompactMuscles>(human) || !kept_choice(frame_.world, human));
    if (!stays_compact) whole.push_back(human);
  }
  World::Attempt attempt(frame_.world, frame_.jobs);
  if (auto done = make_muscles_whole(frame_, whole); !done) return done;
  constexpr std::array parts = {type_id<Needs<float>>(), type_id<Tiers<float>>()};
  by_table(frame_.world, people,
           [&](std::span<const Entity> together) { frame_.world.remake_many(together, {}, parts, frame_.jobs); });
  attempt.keep();
  return {};
}

Result<void> Lod::force(Entity human, Muscle muscle, const MuscleMethod& method) {
  auto tiers = frame_.world.get<Tiers>(human);
  const auto m = static_cast<std::uint32_t>(muscle);
  if (!tiers || m >= most_muscles || !bit_at(tiers->muscles, m))
    return fail("force: that person, or that muscle of theirs, is not managed; manage it first",
                tiers ? Status::missing : tiers.error());
  struct AsBefore {  // where it is refused, or memory runs out: once the attempt is undone
    World& world;
    Entity human;
    Tiers<float> tiers;
    bool done = false;
    ~AsBefore() {
      if (!done) world.set(human, tiers);
    }
  } as_before{frame_.world, human, *tiers};
  std::optional<World::Attempt> attempt;
  const auto ask = [&]() -> Result<void> {
    if ((tiers->effects & tier_bare) != 0) {
      attempt.emplace(frame_.world, frame_.jobs);
      if (auto done = mobil::make_whole(frame_, {&human, 1}); !done) return done;
      if (auto done = LodRound(frame_).begin_muscles(std::span(&human, 1), 0, false); !done) return done;
    }
    return set_method(frame_, {&human, 1}, muscle, method);
  };
  if (auto done = ask(); !done) return done;
  if (attempt) attempt->keep();
  as_before.done = true;
  tiers = frame_.world.get<Tiers>(human);
  set_rung(tiers->rung, m, forced_rung);
  frame_.world.set(human, *tiers);
  return {};
}

Result<void> Lod::unforce(Entity human, Muscle muscle) {
  auto tiers = frame_.world.get<Tiers>(human);
  if (!tiers) return fail(tiers.error());
  const auto m = static_cast<std::uint32_t>(muscle);
  if (m >= most_muscles || !bit_at(tiers->muscles, m)) return fail(Status::missing);
  const MuscleMethod method = method_of(frame_.world, human, muscle);
  set_rung(tiers->rung, m, rung_of(method, is_living(*tiers)));
  set_bit(tiers->points, m, method.method != Method::none && method.reduced.control_points);
  return result_of("unforce", frame_.world.set(human, *tiers));
}

Result<Choice> Lod::why(Entity human, Muscle muscle) const {
  const auto tiers = frame_.world.get<Tiers>(human);
  if (!tiers) return fail(tiers.error());
  const auto needs = *frame_.world.get<Needs>(human);
  const auto m = static_cast<std::uint32_t>(muscle);
  if (m >= most_muscles || !bit_at(tiers->muscles, m)) return fail(Status::missing);
  Choice choice;
  choice.method = method_of(frame_.world, human, muscle);
  const std::uint32_t marked = rung_at(tiers->rung, m), goal = rung_at(tiers->goal, m);
  choice.living = is_living(*tiers);
  choice.rung = marked >= refused_rung ? rung_of(choice.method, choice.living) : marked;
  const RungCase of = rung_case(*tiers, m, bit_at(tiers->points, m));
  const Ladder& ladder = rungs_of(choice.living);
  const auto rung = static_cast<std::uint32_t>(choice.rung);
  choice.predicted_error_m = work().ladder.error_m(of, rung) * tiers->relative_size;
  choice.predicted_volume_off = work().ladder.volume_off(of, rung);
  choice.tolerance_m = tiers->tolerance_m;
  choice.predicted_cost_us =
      0.5e-6 * static_cast<double>(work().ladder.cost_ps(of, rung)) * LodRound(frame_).machine().mean();
  const auto view = static_cast<View>(tiers->view);
  const bool shown_differs =
      bit_at(tiers->points, m) != bit_at(tiers->goal_points, m) && ladder[choice.rung].method == Method::reduced;
  if (marked == forced_rung) {
    choice.reason = Reason::forced;
  } else if (marked == refused_rung) {
    choice.reason = Reason::refused;
  } else if (goal != marked || shown_differs) {
    choice.reason = Reason::switch_pending;
  } else if (!bit_at(LodRound(frame_).wanted(needs), m)) {
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
  choice.text = explain(choice, view, std::string(goal < rung_count ? ladder[goal].name : "another"));
  return choice;
}

std::array<std::size_t, rung_count + 1> Lod::muscles_by_rung(bool living) const {
  std::array<std::size_t, rung_count + 1> count{};
  each(frame_.world, [&](const Rows& rows, const Tiers<Lanes<float>>& block) {
    for (std::uint32_t lane = 0; lane < rows.live; ++lane) {
      const Tiers<float> tiers = row_of(block, lane);
      for (std::uint32_t m = 0; m < most_muscles && is_living(tiers) == living; ++m) {
        if (bit_at(tiers.muscles, m)) count[std::min<std::size_t>(rung_at(tiers.rung, m), rung_count)] += 2;
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
