#include "systems/lod/lod_round.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <mobil/components/footing.h>
#include <mobil/components/sleep.h>
#include <mobil/each.h>
#include <mobil/lod.h>
#include <mobil/rows.h>
#include "engine/exact_math.h"
#include "systems/accuracy/packed_levels.h"
#include "systems/bellies/belly_library.h"
#include "systems/gait/asleep.h"
#include "systems/lod/sight.h"
#include "systems/muscles/leg_moments.h"
#include "systems/muscles/leg_muscles.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/states/person_states.h"
#include "systems/states/sleep.h"

namespace mobil::inline v0_3 {
namespace {

constexpr float fastest_m_s = 2.6F;  // of walkers
/// Maximum error of a sleeper's predicted position while the person turns or changes speed, m.
constexpr float unsettled_m = 8;

float length(const Vec3<float>& v) {
  return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

/// Returns the heights of sleepers' pelves, m, above the ground on which they fell asleep.
Lanes<float> pelvis_heights(const Table& table, std::size_t block) {
  Lanes<float> up_m;
  const TableColumn<Footing> footing(table);
  constexpr auto stance = index(FootholdOf::stance);
  for (std::size_t l = 0; l < lane_count; ++l)
    up_m[l] = footing ? pelvis_m + footing.at(table, block).height_m[stance][l] : pelvis_m;
  return up_m;
}

/// Returns an upper bound of how much closer to being seen a person has come by the camera's movement, m.
float camera_moved_m(const Viewpoint& now, const Vec3<float>& eye, const Vec3<float>& gaze) {
  if (length(gaze) == 0) return INFINITY;
  const Vec3<float>& p = now.position_m;
  const float along =
      (now.forward.x * gaze.x + now.forward.y * gaze.y + now.forward.z * gaze.z) / (length(now.forward) * length(gaze));
  const float turned = exact::acos(std::clamp(along, -1.0F, 1.0F));
  return length({p.x - eye.x, p.y - eye.y, p.z - eye.z}) + turned * now.reach_m;
}

}  // namespace

std::array<float, 4> LodRound::sees() const {
  const Viewpoint& camera = *work_.scene.camera;
  return {camera.half_angle_rad, camera.reach_m, camera.near_m, *work_.scene.asleep_beyond_m};
}

/// Lists all sleepers with equal priority, so that they wake in the order of their handles.
void LodRound::list_all_sleepers() {
  work_.waking.clear();
  const bool seen = !work_.scene.camera && work_.scene.looked_at;
  for (const Table* const table : work_.sleeping_tables)
    for (std::size_t b = 0; b < table->block_count(); ++b)
      for (std::uint32_t l = 0; l < table->live(b); ++l) work_.waking.push_back({0, table->entities(b)[l], seen});
}

/// Checks a part of the sleepers, which grows with the camera's movement. Each sleeper is checked again before camera
/// and walker together can have covered 0.9 × `asleep_beyond_m`.
void LodRound::look_at_sleepers() {
  const Viewpoint& camera = *work_.scene.camera;
  work_.sleeping_blocks.clear();
  std::size_t blocks = 0;
  for (const Table* const table : work_.sleeping_tables)
    work_.sleeping_blocks.push_back(blocks += table->block_count());
  const auto tick_s = frame_.tick.dt_s;
  // After a change of the angle or of a distance, any person can be in view.
  const float moved_m = sees() == progress_.saw
                            ? camera_moved_m(camera, progress_.eye_m, progress_.gaze) + fastest_m_s * tick_s
                            : INFINITY;
  const float part = moved_m / (0.9F * *work_.scene.asleep_beyond_m);
  std::size_t looked = blocks, first = 0;
  if (!progress_.all_sleepers && part < 1) {
    looked = std::min(blocks, static_cast<std::size_t>(std::ceil(part * static_cast<float>(blocks))));
    first = blocks == 0 ? 0 : progress_.sleepers_looked % blocks;
  }
  progress_.sleepers_looked = static_cast<std::uint32_t>(blocks == 0 ? 0 : (first + looked) % blocks);
  const auto place = [&](std::size_t i) {
    const std::size_t block = (first + i) % blocks;
    const auto after = std::upper_bound(work_.sleeping_blocks.begin(), work_.sleeping_blocks.end(), block);
    const auto table = static_cast<std::size_t>(after - work_.sleeping_blocks.begin());
    return std::pair{work_.sleeping_tables[table], block - (table == 0 ? 0 : work_.sleeping_blocks[table - 1])};
  };
  work_.near_lanes.assign(looked, 0);
  const std::uint32_t tick = frame_.tick.index;
  const Gap gap(camera, cone_cos_, cone_sin_);
  in_parallel(frame_.jobs, looked, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto [table, block] = place(i);
      const float within = *work_.scene.asleep_beyond_m + (TableColumn<Unsettled>(*table) ? unsettled_m : 0);
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
      work_.near_lanes[i] = static_cast<std::uint16_t>(lanes & ((1U << table->live(block)) - 1));
    }
  });
  work_.waking.clear();
  for (std::size_t i = 0; i < looked; ++i) {
    if (work_.near_lanes[i] == 0) continue;
    const auto [table, block] = place(i);
    Lanes<float> x_m, z_m;
    steady_places(TableColumn<Asleep>(*table).at(*table, block).walk, tick, tick_s, x_m, z_m);
    for (std::uint32_t left = work_.near_lanes[i]; left != 0; left &= left - 1) {
      const auto l = static_cast<std::uint32_t>(std::countr_zero(left));
      const float dx = x_m[l] - camera.position_m.x, dz = z_m[l] - camera.position_m.z;
      // Seen people come before unseen ones, then nearer people before farther ones.
      const float unseen_m = std::max(gap({x_m[l], pelvis_heights(*table, block)[l], z_m[l]}), 0.0F);
      work_.waking.push_back(
          {std::sqrt(dx * dx + dz * dz) + 1000 * unseen_m, table->entities(block)[l], unseen_m == 0});
    }
  }
}

void LodRound::wake_sleepers() {
  if (work_.scene.camera && work_.scene.asleep_beyond_m) {
    look_at_sleepers();
    progress_.eye_m = work_.scene.camera->position_m;
    progress_.gaze = work_.scene.camera->forward;
    progress_.saw = sees();
  } else {
    list_all_sleepers();
    progress_.gaze = {};
  }
  const std::size_t now = std::min<std::size_t>(work_.waking.size(), work_.options.wakes);
  const auto nearer = [](const WakingSleeper& a, const WakingSleeper& b) {
    return a.order != b.order ? a.order < b.order : a.person.index < b.person.index;
  };
  std::partial_sort(work_.waking.begin(), work_.waking.begin() + static_cast<std::ptrdiff_t>(now), work_.waking.end(),
                    nearer);
  report_.to_wake = work_.waking.size() - now;
  progress_.all_sleepers = report_.to_wake > 0;
  work_.waking.resize(now);
  // An unseen person wakes compact, without a pose, unless the person has forces or a footing.
  const auto whole = [&](const WakingSleeper& one) {
    return !work_.scene.compact_unseen || one.seen || world_.has<SleepsWithForces>(one.person) ||
           world_.has<Footing>(one.person);
  };
  const auto compact = std::partition(work_.waking.begin(), work_.waking.end(), whole);
  for (const auto& [some, as] : {std::pair{std::span(work_.waking.begin(), compact), Woken::full_detail},
                                 std::pair{std::span(compact, work_.waking.end()), Woken::compact}}) {
    work_.people.clear();
    for (const WakingSleeper& one : some) work_.people.push_back(one.person);
    if (work_.people.empty()) continue;
    if (const auto done = wake_managed(frame_, work_.people, as); !done) {
      report_.refused += work_.people.size();
      report_.refusal = done.error().message;
    } else {
      report_.woken += work_.people.size();
    }
  }
}

/// Expands people in the order of their excess, largest first.
void LodRound::make_full() {
  const auto first = [](const Expanding& a, const Expanding& b) {
    return a.excess != b.excess ? a.excess > b.excess : a.person.index < b.person.index;
  };
  const std::size_t now = std::min<std::size_t>(work_.now.expanding.size(), work_.options.expands);
  std::partial_sort(work_.now.expanding.begin(), work_.now.expanding.begin() + static_cast<std::ptrdiff_t>(now),
                    work_.now.expanding.end(), first);
  report_.to_expand = work_.now.expanding.size() - now;
  work_.people.clear();
  for (std::size_t i = 0; i < now; ++i) work_.people.push_back(work_.now.expanding[i].person);
  if (work_.people.empty()) return;
  if (const auto done = expand(frame_, work_.people); !done) {
    report_.refused += work_.people.size();
    report_.refusal = done.error().message;
  } else {
    report_.expanded = work_.people.size();
  }
}

void LodRound::make_compact() {
  // People who cannot be compact do not count toward the limit.
  for (std::span<const Entity> left(work_.now.unseen); !left.empty() && report_.compacted < work_.options.compacts;) {
    const auto some = left.first(std::min<std::size_t>(left.size(), work_.options.compacts - report_.compacted));
    report_.compacted += compact(frame_, some);
    left = left.subspan(some.size());
  }
}

/// Returns the state of a person who woke without muscles. `choice`: the muscles to come, null without any.
LodState<float> LodRound::begin_tiers(const LegMuscles* choice) const {
  LodState<float> lod_state{};
  lod_state.view = static_cast<std::uint32_t>(View::out_of_reach);
  lod_state.relative_size = work_.options.margin;
  lod_state.tolerance_m = work_.scene.tolerance_m.value_or(default_tolerance_m);
  if (choice == nullptr) return lod_state;
  lod_state.effects = lod_bare;
  if (choice->inertia) lod_state.effects |= lod_inertia;
  if (pulls_alive(*choice)) lod_state.effects |= lod_active;
  set_bits(lod_state.muscles, choice->muscles);
  return lod_state;
}

/// Chooses the level with which all of a person's muscles begin: the dearest that one of them needs.
void LodRound::decide_bare(Entity person, const LodState<float>& lod_state, std::uint64_t wanted_muscles, bool compact,
                           Looked& out) const {
  const auto view = static_cast<View>(lod_state.view);
  const bool looked_at = view == View::seen, simulated = view <= View::near;
  const float size = lod_state.relative_size / lod_state.tolerance_m, limit = progress_.factor / size;
  Bare bare{0, person, 0, looked_at};
  std::int64_t dearest = -1;
  for (std::uint64_t left = simulated ? all_bits(lod_state.muscles) & wanted_muscles : 0; left != 0; left &= left - 1) {
    const auto m = static_cast<std::uint32_t>(std::countr_zero(left));
    const LevelCase of = level_case(lod_state, m, looked_at);
    if (work_.scene.budget_s) out.counting.add(work_.lod_table, of, size);
    const std::uint32_t goal = work_.lod_table.cheapest(of, limit);
    const std::int64_t cost = work_.lod_table.cost_ps(of, goal);
    if (goal == 0 || cost <= dearest) continue;
    dearest = cost;
    bare.level = goal;
    bare.excess = std::max(bare.excess, work_.lod_table.error_m(of, 0) * size);
  }
  if (bare.level != 0) out.bare.push_back(bare);
  decide_compact(person, compact, lod_state, bare.level == 0, bare.excess, out);
}

void LodRound::begin_muscles() {
  const auto first = [](const Bare& a, const Bare& b) {
    return a.excess != b.excess ? a.excess > b.excess : a.person.index < b.person.index;
  };
  const std::size_t count = std::min<std::size_t>(work_.now.bare.size(), work_.options.begins);
  std::partial_sort(work_.now.bare.begin(), work_.now.bare.begin() + static_cast<std::ptrdiff_t>(count),
                    work_.now.bare.end(), first);
  report_.to_begin = work_.now.bare.size() - count;
  work_.now.bare.resize(count);
  std::erase_if(work_.now.bare,
                [&](const Bare& one) { return is_compact(world_, one.person); });  // they wait until they are full
  // People with the same choice and level are handled together.
  for (std::size_t i = 0; i < work_.now.bare.size(); ++i) {
    if (work_.now.bare[i].level == 0) continue;
    const Bare one = work_.now.bare[i];
    const LegMuscles* const choice = world_.shared<LegMuscles>(one.person);
    work_.people.clear();
    for (std::size_t k = i; k < work_.now.bare.size(); ++k) {
      Bare& other = work_.now.bare[k];
      if (other.level != one.level || other.points != one.points || world_.shared<LegMuscles>(other.person) != choice)
        continue;
      work_.people.push_back(other.person);
      other.level = 0;
    }
    if (const auto done = begin_muscles(work_.people, one.level, one.points); done) {
      report_.begun += work_.people.size();
    } else {
      report_.refused += work_.people.size();
      report_.refusal = done.error().message;
    }
  }
}

/// Removes muscles that are not simulated. The person's row keeps their choice.
void LodRound::end_muscles() {
  std::erase_if(work_.now.idle, [&](Entity person) {
    return is_compact(world_, person) || !world_.alive(world_.first_member(person));
  });
  work_.now.idle.resize(std::min<std::size_t>(work_.now.idle.size(), work_.options.begins));
  work_.people.clear();
  for (const Entity person : work_.now.idle) {
    // A choice kept earlier gives only method and modes, because the muscles can have changed since.
    LegMuscles now = *choice_of(world_, person);
    const LegMuscles* const kept = world_.shared<LegMuscles>(person);
    if (kept != nullptr) now.method = kept->method, now.modal = kept->modal;
    if (kept == nullptr || *kept != now) {
      const std::array part = {part_value(keep_choice(world_, library(), now))};
      world_.change_archetype({&person, 1}, part, std::array{type_id<LegMuscles>()}, frame_.jobs);
    }
  }
  for (const Entity person : work_.now.idle)
    world_.each_member(person, [&](Entity member) {
      if (world_.has<MuscleOwner>(member)) work_.people.push_back(member);
    });
  for (const Entity person : work_.now.idle) {  // people so marked must have no muscles: nothing fails from here on
    auto lod_state = *world_.get<LodState>(person);
    lod_state.effects |= lod_bare;
    world_.set(person, lod_state);
  }
  world_.destroy_many(work_.people, frame_.jobs);
  report_.ended = work_.now.idle.size();
}

Result<void> LodRound::begin_muscles(std::span<const Entity> people, std::uint32_t level, bool points) {
  LegMuscles choice = *world_.shared<LegMuscles>(people.front());
  const MuscleMethod method = level_method(level, points, pulls_alive(choice));
  choice.method = method.method;
  choice.modal = method.modal;
  // Muscles of people in view must begin within the tolerance.
  float within_m = INFINITY;
  for (const Entity person : people)
    if (points) within_m = std::min(within_m, world_.get<LodState>(person)->tolerance_m);
  auto done = mobil::begin_muscles(frame_, people, choice, within_m);
  for (const Entity person : people) {
    auto lod_state = *world_.get<LodState>(person);
    lod_state.effects &= ~std::uint32_t{lod_bare};
    for (std::uint64_t left = all_bits(lod_state.muscles); left != 0; left &= left - 1) {
      const auto m = static_cast<std::uint32_t>(std::countr_zero(left));
      set_level(lod_state.level, m, done ? level : refused_level);
      set_level(lod_state.goal, m, done ? level : refused_level);
      set_bit(lod_state.points, m, points && method.method != Method::none);
    }
    world_.set(person, lod_state);
  }
  return done;
}

void LodRound::put_to_sleep() {
  if (work_.now.drowsy.empty()) return;
  constexpr std::array plain = {component_id(TagValue<SleepsManaged>{1})};
  constexpr std::array needy = {component_id(TagValue<SleepsManaged>{1}), component_id<LodRequest>()};
  work_.now.drowsy.resize(std::min<std::size_t>(work_.now.drowsy.size(), work_.options.sleeps));
  // People with requests of their own keep them.
  const auto own = std::stable_partition(work_.now.drowsy.begin(), work_.now.drowsy.end(),
                                         [&](Entity person) { return world_.get<LodRequest>(person)->own == 0; });
  const auto without = static_cast<std::size_t>(own - work_.now.drowsy.begin());
  report_.slept = sleep_managed(frame_, std::span(work_.now.drowsy).first(without), plain) +
                  sleep_managed(frame_, std::span(work_.now.drowsy).subspan(without), needy);
}

}  // namespace mobil::inline v0_3
