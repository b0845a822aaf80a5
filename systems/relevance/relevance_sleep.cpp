// Who sleeps: those who are further from being seen than a scene says, and are going steadily.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <mobil/components/footing.h>
#include <mobil/components/sleep.h>
#include <mobil/each.h>
#include <mobil/relevance.h>
#include <mobil/rows.h>
#include "engine/exact_math.h"
#include "systems/gait/asleep.h"
#include "systems/muscles/belly_library.h"
#include "systems/muscles/leg_moments.h"
#include "systems/muscles/leg_muscles.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/muscles/sleep.h"
#include "systems/relevance/packed_rungs.h"
#include "systems/relevance/sight.h"
#include "systems/simulation_world.h"

namespace mobil::inline v0_3 {
namespace {

constexpr float fastest_m_s = 2.6F;  // of walkers
/// Who turns or changes speed is not yet where the words of a sleeper say: off by this at most.
constexpr float unsettled_m = 8;

float length(const Vec3<float>& v) {
  return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

/// How high sleepers' hips are; over the ground that they fell asleep on where it is not level.
Lanes<float> pelvis_heights(const Table& table, std::size_t block) {
  Lanes<float> up_m;
  const TableColumn<Footing> footing(table);
  constexpr auto stance = index(FootholdOf::stance);
  for (std::size_t l = 0; l < lane_count; ++l)
    up_m[l] = footing ? pelvis_m + footing.at(table, block).height_m[stance][l] : pelvis_m;
  return up_m;
}

/// How much nearer to being seen anybody can have come as a camera has moved so.
float camera_moved_m(const Viewpoint& now, const Vec3<float>& eye, const Vec3<float>& gaze) {
  if (length(gaze) == 0) return INFINITY;
  const Vec3<float>& p = now.position_m;
  const float along =
      (now.forward.x * gaze.x + now.forward.y * gaze.y + now.forward.z * gaze.z) / (length(now.forward) * length(gaze));
  const float turned = exact::acos(std::clamp(along, -1.0F, 1.0F));
  return length({p.x - eye.x, p.y - eye.y, p.z - eye.z}) + turned * now.reach_m;
}

}  // namespace

std::array<float, 4> Relevance::sees() const {
  const Viewpoint& camera = *scene_.camera;
  return {camera.half_angle_rad, camera.reach_m, camera.near_m, *scene_.asleep_beyond_m};
}

/// Everybody, in the order of their handles.
void Relevance::list_all_sleepers() {
  waking_.clear();
  const bool seen = !scene_.camera && scene_.looked_at;
  for (const Table* const table : sleeping_tables_)
    for (std::size_t b = 0; b < table->block_count(); ++b)
      for (std::uint32_t l = 0; l < table->live(b); ++l) waking_.push_back({0, table->entities(b)[l], seen});
}

/// A part of the sleepers, as large as what the camera has moved asks for: each is looked at again before camera and
/// walkers together can have gone nine tenths of the way within which they are to be awake.
void Relevance::look_at_sleepers() {
  const Viewpoint& camera = *scene_.camera;
  sleeping_blocks_.clear();
  std::size_t blocks = 0;
  for (const Table* const table : sleeping_tables_) sleeping_blocks_.push_back(blocks += table->block_count());
  const auto tick_s = static_cast<float>(simulation_.tick_s());
  // After a change of the angle or of a distance anybody may be in view.
  const float moved_m = sees() == saw_ ? camera_moved_m(camera, eye_m_, gaze_) + fastest_m_s * tick_s : INFINITY;
  const float part = moved_m / (0.9F * *scene_.asleep_beyond_m);
  std::size_t looked = blocks, first = 0;
  if (!all_sleepers_ && part < 1) {
    looked = std::min(blocks, static_cast<std::size_t>(std::ceil(part * static_cast<float>(blocks))));
    first = blocks == 0 ? 0 : sleepers_looked_ % blocks;
  }
  sleepers_looked_ = static_cast<std::uint32_t>(blocks == 0 ? 0 : (first + looked) % blocks);
  const auto place = [&](std::size_t i) {
    const std::size_t block = (first + i) % blocks;
    const auto after = std::upper_bound(sleeping_blocks_.begin(), sleeping_blocks_.end(), block);
    const auto table = static_cast<std::size_t>(after - sleeping_blocks_.begin());
    return std::pair{sleeping_tables_[table], block - (table == 0 ? 0 : sleeping_blocks_[table - 1])};
  };
  near_lanes_.assign(looked, 0);
  const std::uint32_t tick = simulation_.ticks();
  const Gap gap(camera, cone_cos_, cone_sin_);
  in_parallel(SimulationWorld::jobs(simulation_), looked, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto [table, block] = place(i);
      const float within = *scene_.asleep_beyond_m + (TableColumn<Unsettled>(*table) ? unsettled_m : 0);
      Lanes<float> x_m, z_m;
      steady_places(TableColumn<Asleep>(*table).at(*table, block).walk, tick, tick_s, x_m, z_m);
      const Lanes<float> up_m = pelvis_heights(*table, block);
      const float farthest = gap.farthest(within);
      std::uint32_t lanes = 0;
      for (std::uint32_t l = 0; l < lane_count; ++l)
        lanes |= static_cast<std::uint32_t>(gap.squared({x_m[l], up_m[l], z_m[l]}) < farthest * farthest) << l;
      for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
        const auto l = static_cast<std::uint32_t>(std::countr_zero(left));
        if (!(gap({x_m[l], up_m[l], z_m[l]}) < within)) lanes &= ~(1U << l);
      }
      near_lanes_[i] = static_cast<std::uint16_t>(lanes & ((1U << table->live(block)) - 1));
    }
  });
  waking_.clear();
  for (std::size_t i = 0; i < looked; ++i) {
    if (near_lanes_[i] == 0) continue;
    const auto [table, block] = place(i);
    Lanes<float> x_m, z_m;
    steady_places(TableColumn<Asleep>(*table).at(*table, block).walk, tick, tick_s, x_m, z_m);
    for (std::uint32_t left = near_lanes_[i]; left != 0; left &= left - 1) {
      const auto l = static_cast<std::uint32_t>(std::countr_zero(left));
      const float dx = x_m[l] - camera.position_m.x, dz = z_m[l] - camera.position_m.z;
      // Who is seen comes before who is not, then the nearer one.
      const float unseen_m = std::max(gap({x_m[l], pelvis_heights(*table, block)[l], z_m[l]}), 0.0F);
      waking_.push_back({std::sqrt(dx * dx + dz * dz) + 1000 * unseen_m, table->entities(block)[l], unseen_m == 0});
    }
  }
}

void Relevance::wake_sleepers(RelevanceReport& report) {
  if (scene_.camera && scene_.asleep_beyond_m) {
    look_at_sleepers();
    eye_m_ = scene_.camera->position_m;
    gaze_ = scene_.camera->forward;
    saw_ = sees();
  } else {
    list_all_sleepers();
    gaze_ = {};
  }
  const std::size_t now = std::min<std::size_t>(waking_.size(), options_.wakes);
  const auto nearer = [](const Waking& a, const Waking& b) {
    return a.order != b.order ? a.order < b.order : a.human.index < b.human.index;
  };
  std::partial_sort(waking_.begin(), waking_.begin() + static_cast<std::ptrdiff_t>(now), waking_.end(), nearer);
  report.to_wake = waking_.size() - now;
  all_sleepers_ = report.to_wake > 0;
  waking_.resize(now);
  // Who is not seen yet has no pose until then; with forces there is one.
  const World& world = simulation_.world();
  const auto whole = [&](const Waking& one) {
    return !scene_.compact_unseen || one.seen || world.has<SleepsWithForces>(one.human) ||
           world.has<Footing>(one.human);
  };
  const auto compact = std::partition(waking_.begin(), waking_.end(), whole);
  for (const auto& [some, as] : {std::pair{std::span(waking_.begin(), compact), Woken::whole},
                                 std::pair{std::span(compact, waking_.end()), Woken::compact}}) {
    people_.clear();
    for (const Waking& one : some) people_.push_back(one.human);
    if (people_.empty()) continue;
    if (const auto done = SimulationWorld::wake(simulation_, people_, as); !done) {
      report.refused += people_.size();
      report.refusal = done.error().message;
    }
    report.woken += people_.size();
  }
}

/// Who misses most first.
void Relevance::make_whole(RelevanceReport& report) {
  const auto first = [](const Expanding& a, const Expanding& b) {
    return a.excess != b.excess ? a.excess > b.excess : a.human.index < b.human.index;
  };
  const std::size_t now = std::min<std::size_t>(now_.expanding.size(), options_.expands);
  std::partial_sort(now_.expanding.begin(), now_.expanding.begin() + static_cast<std::ptrdiff_t>(now),
                    now_.expanding.end(), first);
  report.to_expand = now_.expanding.size() - now;
  people_.clear();
  for (std::size_t i = 0; i < now; ++i) people_.push_back(now_.expanding[i].human);
  report.expanded = people_.size();
  if (people_.empty()) return;
  if (const auto done = SimulationWorld::expand(simulation_, people_); !done) {
    report.refused += people_.size();
    report.refusal = done.error().message;
  }
}

void Relevance::make_compact(RelevanceReport& report) {
  // People who cannot be compact do not count.
  for (std::span<const Entity> left(now_.unseen); !left.empty() && report.compacted < options_.compacts;) {
    const auto some = left.first(std::min<std::size_t>(left.size(), options_.compacts - report.compacted));
    report.compacted += SimulationWorld::compact(simulation_, some);
    left = left.subspan(some.size());
  }
}

/// Of who has woken without muscles; `choice`: what they are to be, null where there will be none.
Tiers<float> Relevance::begin_tiers(const LegMuscles* choice) const {
  Tiers<float> tiers{};
  tiers.view = static_cast<std::uint32_t>(View::out_of_reach);
  tiers.relative_size = options_.margin;
  tiers.tolerance_m = scene_.tolerance_m.value_or(default_tolerance_m);
  if (choice == nullptr) return tiers;
  tiers.effects = tier_bare;
  if (choice->inertia) tiers.effects |= tier_inertia;
  if (pulls_alive(*choice)) tiers.effects |= tier_living;
  tiers.muscles = static_cast<std::uint32_t>(choice->muscles.to_ulong());
  return tiers;
}

/// The rung that all of a person's muscles begin with: the dearest that one of them calls for.
void Relevance::decide_bare(Entity human, const Tiers<float>& tiers, std::uint32_t wanted_muscles, bool compact,
                            Looked& out) const {
  const auto view = static_cast<View>(tiers.view);
  const bool looked_at = view == View::seen, simulated = view <= View::near;
  const float size = tiers.relative_size / tiers.tolerance_m, limit = factor_ / size;
  Bare bare{0, human, 0, looked_at};
  std::int64_t dearest = -1;
  for (std::uint32_t left = simulated ? tiers.muscles & wanted_muscles : 0; left != 0; left &= left - 1) {
    const auto m = static_cast<std::uint32_t>(std::countr_zero(left));
    const RungCase of = rung_case(tiers, m, looked_at);
    if (scene_.budget_s) out.counting.add(ladder_, of, size);
    const std::uint32_t goal = ladder_.cheapest(of, limit);
    const std::int64_t cost = ladder_.cost_ps(of, goal);
    if (goal == 0 || cost <= dearest) continue;
    dearest = cost;
    bare.rung = goal;
    bare.excess = std::max(bare.excess, ladder_.error_m(of, 0) * size);
  }
  if (bare.rung != 0) out.bare.push_back(bare);
  decide_compact(human, compact, tiers, bare.rung == 0, bare.excess, out);
}

void Relevance::begin_muscles(RelevanceReport& report) {
  const auto first = [](const Bare& a, const Bare& b) {
    return a.excess != b.excess ? a.excess > b.excess : a.human.index < b.human.index;
  };
  const std::size_t count = std::min<std::size_t>(now_.bare.size(), options_.begins);
  std::partial_sort(now_.bare.begin(), now_.bare.begin() + static_cast<std::ptrdiff_t>(count), now_.bare.end(), first);
  report.to_begin = now_.bare.size() - count;
  now_.bare.resize(count);
  std::erase_if(now_.bare,
                [&](const Bare& one) { return simulation_.is_compact(one.human); });  // they wait to be whole
  // Those of one choice and rung together.
  const World& world = simulation_.world();
  for (std::size_t i = 0; i < now_.bare.size(); ++i) {
    if (now_.bare[i].rung == 0) continue;
    const Bare one = now_.bare[i];
    const LegMuscles* const choice = world.shared<LegMuscles>(one.human);
    people_.clear();
    for (std::size_t k = i; k < now_.bare.size(); ++k) {
      Bare& other = now_.bare[k];
      if (other.rung != one.rung || other.points != one.points || world.shared<LegMuscles>(other.human) != choice)
        continue;
      people_.push_back(other.human);
      other.rung = 0;
    }
    if (const auto done = begin_muscles(people_, one.rung, one.points); done) {
      report.begun += people_.size();
    } else {
      report.refused += people_.size();
      report.refusal = done.error().message;
    }
  }
}

/// What they are to be is kept on the person's row.
void Relevance::end_muscles(RelevanceReport& report) {
  World& world = world_of(simulation_);
  std::erase_if(now_.idle,
                [&](Entity human) { return simulation_.is_compact(human) || !world.alive(world.first_member(human)); });
  now_.idle.resize(std::min<std::size_t>(now_.idle.size(), options_.begins));
  people_.clear();
  for (const Entity human : now_.idle) {
    // What an earlier end has kept is that of muscles that may have changed since.
    LegMuscles now = *choice_of(world, human);
    const LegMuscles* const kept = world.shared<LegMuscles>(human);
    if (kept != nullptr) now.method = kept->method, now.reduced = kept->reduced;
    if (kept == nullptr || *kept != now) {
      const std::array part = {part_value(keep_choice(world, SimulationWorld::library(simulation_), now))};
      world.remake_many({&human, 1}, part, std::array{type_id<LegMuscles>()}, SimulationWorld::jobs(simulation_));
    }
  }
  for (const Entity human : now_.idle)
    world.each_member(human, [&](Entity member) {
      if (world.has<MuscleOwner>(member)) people_.push_back(member);
    });
  for (const Entity human : now_.idle) {  // who is marked must have none: nothing fails from here on
    auto tiers = *world.get<Tiers>(human);
    tiers.effects |= tier_bare;
    world.set(human, tiers);
  }
  world.destroy_many(people_, SimulationWorld::jobs(simulation_));
  report.ended = now_.idle.size();
}

Result<void> Relevance::begin_muscles(std::span<const Entity> people, std::uint32_t rung, bool points) {
  World& world = world_of(simulation_);
  LegMuscles choice = *world.shared<LegMuscles>(people.front());
  const MuscleMethod method = rung_method(rung, points, pulls_alive(choice));
  choice.method = method.method;
  choice.reduced = method.reduced;
  // Who is seen already has no time to come within the tolerance.
  float within_m = INFINITY;
  for (const Entity human : people)
    if (points) within_m = std::min(within_m, world.get<Tiers>(human)->tolerance_m);
  auto done = SimulationWorld::begin_muscles(simulation_, people, choice, within_m);
  for (const Entity human : people) {
    auto tiers = *world.get<Tiers>(human);
    tiers.effects &= ~std::uint32_t{tier_bare};
    for (std::uint32_t left = tiers.muscles; left != 0; left &= left - 1) {
      const auto m = static_cast<std::uint32_t>(std::countr_zero(left));
      set_rung(tiers.rung, m, done ? rung : refused_rung);
      set_rung(tiers.goal, m, done ? rung : refused_rung);
      set_bit(tiers.points, m, points && method.method != Method::none);
    }
    world.set(human, tiers);
  }
  return done;
}

Result<std::size_t> Relevance::manage_asleep(std::span<const Entity> people) {
  World& world = world_of(simulation_);
  if (!world.alive_once(people)) return fail(Status::stale_entity);
  for (const Entity human : people)
    if (!simulation_.is_person(human) || has_any_muscles(world, human))
      return fail("manage_asleep: somebody has muscles, or is no person; manage them instead", Status::already_there);
  LegMuscles choice = options_.leg_muscles;
  choice.muscles = scene_.muscles;
  choice.method = Method::none;
  if (choice.muscles.any()) {
    if (auto ok = check_choice(choice, simulation_.tick_s()); !ok) return tl::unexpected(ok.error());
    for (const Entity human : people)
      if (auto ok = check_leg_moments(world, human, choice); !ok) return tl::unexpected(ok.error());
  }
  all_sleepers_ = true;  // some may be in view of a camera that stands still
  const auto kept = keep_choice(world, SimulationWorld::library(simulation_), choice);
  const std::array keeps = {key_part(TagValue<SleepsManaged>{1}), key_part(kept)};
  const std::size_t slept = SimulationWorld::sleep(simulation_, people, keeps);
  for (const Entity human : people) {
    if (is_managed(world, human)) continue;
    if (auto done = manage(human); !done) return tl::unexpected(done.error());
  }
  return slept;
}

void Relevance::put_to_sleep(RelevanceReport& report) {
  if (now_.drowsy.empty()) return;
  const World& world = simulation_.world();
  constexpr std::array plain = {key_part(TagValue<SleepsManaged>{1})};
  constexpr std::array needy = {key_part(TagValue<SleepsManaged>{1}), component_part<Needs>()};
  now_.drowsy.resize(std::min<std::size_t>(now_.drowsy.size(), options_.sleeps));
  // Who has needs of their own keeps them.
  const auto own = std::stable_partition(now_.drowsy.begin(), now_.drowsy.end(),
                                         [&](Entity human) { return world.get<Needs>(human)->own == 0; });
  const auto without = static_cast<std::size_t>(own - now_.drowsy.begin());
  report.slept = SimulationWorld::sleep(simulation_, std::span(now_.drowsy).first(without), plain) +
                 SimulationWorld::sleep(simulation_, std::span(now_.drowsy).subspan(without), needy);
}

}  // namespace mobil::inline v0_3
