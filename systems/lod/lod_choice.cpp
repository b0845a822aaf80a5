#include <mobil/lod.h>
#include "systems/lod/lod_round.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <mobil/components/footing.h>
#include <mobil/components/sleep.h>
#include <mobil/rows.h>
#include "engine/exact_math.h"
#include "engine/state_hash.h"
#include "systems/accuracy/packed_levels.h"
#include "systems/gait/asleep.h"
#include "systems/lod/sight.h"
#include "systems/states/person_states.h"

namespace mobil::inline v0_3 {
namespace {

constexpr float closest_m = 0.3F;
constexpr float leave_m = 0.5F;  // how much farther out a seen person must be to become unseen
constexpr float reference_height = static_cast<float>(reference_body_height_m);
/// Maximum distance of a pelvis from the point of the line at the stance foot.
constexpr float off_the_line_m = 0.6F;
/// Factor on the waking distance, beyond which people fall asleep.
constexpr float falls_asleep = 1.5F;

struct Sight {
  View view;
  float tolerance_m;  // from the distance to the camera
};

/// `cosine` and `sine` are of the camera's half-angle. `blur_m` is the person's maximum distance from `at`.
Sight sight(const Viewpoint& camera, float cosine, float sine, float tolerance_px, const Vec3<float>& at, View before,
            float blur_m) {
  const Vec3<float> v = {at.x - camera.position_m.x, at.y - camera.position_m.y, at.z - camera.position_m.z};
  const Vec3<float>& f = camera.forward;
  const float distance = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  const float along = (v.x * f.x + v.y * f.y + v.z * f.z) / std::sqrt(f.x * f.x + f.y * f.y + f.z * f.z);
  const float aside = std::sqrt(std::max(distance * distance - along * along, 0.0F));
  const float outside_m = aside * cosine - along * sine;
  const float grace = (before == View::seen ? leave_m : 0.0F) + blur_m;
  const bool reached = distance <= camera.reach_m + grace, in_cone = outside_m <= person_radius_m + grace;
  const bool near = distance <= camera.near_m + (before == View::near ? leave_m : 0.0F) + blur_m;
  const View view = reached && in_cone ? View::seen
                    : near             ? View::near
                    : reached          ? View::out_of_sight
                                       : View::out_of_reach;
  const float nearest = std::max(view == View::near ? camera.near_m : distance - person_radius_m, closest_m);
  return {view, tolerance_px * camera.radians_per_pixel * nearest};
}

}  // namespace

/// Returns the position of a person's pelvis; for a compact person it is within off_the_line_m.
Vec3<float> LodRound::pelvis_of(const Table& table, const Columns& at, std::size_t b, std::uint32_t lane) {
  if (!at.pose) {
    const auto& state = at.state.at(table, b);
    return {state.line_x_m[lane], pelvis_m, state.line_z_m[lane]};
  }
  const auto& pelvis = at.pose.at(table, b).position_m[index(Segment::pelvis)];
  return {pelvis.x[lane], pelvis.y[lane], pelvis.z[lane]};
}

/// Queues a compact person for expansion if seen or with a pending change, and a full one for compaction if neither.
void LodRound::decide_compact(Entity person, bool compact, const LodState<float>& lod_state, bool settled, float excess,
                              Looked& out) const {
  const bool looked_at = static_cast<View>(lod_state.view) == View::seen;
  if ((lod_state.effects & (lod_inertia | lod_active)) != 0 && !compact) return;
  if (compact && (looked_at || !settled || !work_.scene.compact_unseen)) out.expanding.push_back({excess, person});
  if (!compact && work_.scene.compact_unseen && !looked_at && settled && !world_.has<Footing>(person))
    out.unseen.push_back(person);
}

/// Adds new tables; none is ever removed. Their order follows from archetypes, not from creation, so that a restored
/// world processes the same people first under limits per tick.
void LodRound::find_tables() {
  const auto& managed = frame_.workspace.get<ManagedPeople>().tables.found();
  if (work_.tables_seen == managed.size()) return;
  for (; work_.tables_seen < managed.size(); ++work_.tables_seen) {
    Table& table = *managed[work_.tables_seen];
    const Columns at{TableColumn<LodRequest>(table), TableColumn<LodState>(table), TableColumn<Pose>(table),
                     TableColumn<BodySize>(table),   TableColumn<Gait>(table),     TableColumn<StepPlan>(table),
                     TableColumn<GaitState>(table)};
    if (find_component(table.key(), type_id<SleepsManaged>()) != nullptr) work_.sleeping_tables.push_back(&table);
    if (!at.needs || !at.lod_state || !at.size || !(at.pose || at.state)) continue;
    work_.tables.emplace_back(&table, at);
  }
  const auto hash_of = [&](const Table* table) { return key_hash(world_, table->key()); };
  std::ranges::stable_sort(work_.sleeping_tables, {}, hash_of);
  std::ranges::stable_sort(work_.tables, {}, [&](const auto& one) { return hash_of(one.first); });
}

void LodWork::Looked::clear() {
  dearer.clear();
  cheaper.clear();
  bare.clear();
  expanding.clear();
  drowsy.clear();
  idle.clear();
  unseen.clear();
  counted_ps = 0;
}

void LodWork::Looked::add(const Looked& more) {
  const auto join = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  join(dearer, more.dearer);
  join(cheaper, more.cheaper);
  join(bare, more.bare);
  join(expanding, more.expanding);
  join(drowsy, more.drowsy);
  join(idle, more.idle);
  join(unseen, more.unseen);
  counted_ps += more.counted_ps;
}

/// Evaluates this turn's part of the crowd in runs of blocks on all threads. Joins the lists in block order.
std::size_t LodRound::look_at_the_awake() {
  constexpr std::size_t together = 16;  // blocks
  work_.now.clear();
  work_.blocks.clear();
  std::size_t people = 0;
  for (std::uint32_t t = 0; t < work_.tables.size(); ++t) {
    Table& table = *work_.tables[t].first;
    for (std::size_t b = progress_.turn; b < table.block_count(); b += work_.options.stagger) {
      work_.blocks.push_back({t, static_cast<std::uint32_t>(b)});
      people += table.live(b);
    }
  }
  const std::size_t runs = (work_.blocks.size() + together - 1) / together;
  if (work_.looked.size() < runs) work_.looked.resize(runs);
  in_parallel(frame_.jobs, runs, [&](std::size_t begin, std::size_t end) {
    for (std::size_t run = begin; run < end; ++run) {
      Looked& out = work_.looked[run];
      out.clear();
      if (work_.scene.budget_s) out.counting.clear();
      for (std::size_t i = run * together; i < std::min((run + 1) * together, work_.blocks.size()); ++i) {
        auto& [table, columns] = work_.tables[work_.blocks[i].table];
        evaluate(*table, columns, work_.blocks[i].block, out);
      }
    }
  });
  for (std::size_t run = 0; run < runs; ++run) {
    work_.now.add(work_.looked[run]);
    if (work_.scene.budget_s) progress_.counting.add(work_.looked[run].counting);
  }
  progress_.counted_ps += work_.now.counted_ps;
  return people;
}

/// After an exception the same people are evaluated again. Changes made before it stay.
void LodRound::run() {
  const LodProgress before = progress_;
  try {
    choose();
  } catch (...) {
    progress_ = before;
    throw;
  }
}

void LodRound::choose() {
  find_tables();
  if (work_.scene.camera) {
    cone_cos_ = exact::cos(work_.scene.camera->half_angle_rad);
    cone_sin_ = exact::sin(work_.scene.camera->half_angle_rad);
  }
  progress_.turn %= work_.options.stagger;
  observe_machine();
  wake_sleepers();
  report_.evaluated = look_at_the_awake();
  if (++progress_.turn >= work_.options.stagger) {
    progress_.turn = 0;
    progress_.crowd = progress_.counting;
    progress_.cost_ps = progress_.counted_ps;
    progress_.counting.clear();
    progress_.counted_ps = 0;
  }
  make_full();
  begin_muscles();
  end_muscles();
  carry_out();
  put_to_sleep();
  make_compact();
  report_.factor = progress_.factor;
  report_.machine = machine().pessimistic();
  report_.predicted_s = 1e-12 * static_cast<double>(progress_.cost_ps) * machine().mean();
  add_report();
}

/// Adds this tick's report to that of the ticks before.
void LodRound::add_report() {
  const LodReport before = std::exchange(work_.report, report_);
  for (const auto count :
       {&LodReport::evaluated, &LodReport::switched, &LodReport::refused, &LodReport::woken, &LodReport::slept,
        &LodReport::begun, &LodReport::ended, &LodReport::compacted, &LodReport::expanded})
    work_.report.*count += before.*count;
  if (work_.report.refusal.empty()) work_.report.refusal = before.refusal;
}

MachineFactor LodRound::machine() const {
  return work_.options.machine_factor ? MachineFactor(*work_.options.machine_factor) : progress_.machine;
}

void LodRound::evaluate(Table& table, const Columns& at, std::size_t b, Looked& out) const {
  const auto& all_needs = at.needs.at(table, b);
  auto& all_tiers = at.lod_state.at(table, b);
  const bool compact = !at.pose;
  const auto* const kept = find_component(table.key(), type_id<LegMuscles>());
  const auto* const choice = kept == nullptr ? nullptr : static_cast<const LegMuscles*>(world_.resource(kept->value));
  const std::uint32_t live = table.live(b);
  const Gap gap(work_.scene.camera.value_or(Viewpoint{}), cone_cos_, cone_sin_);
  for (std::uint32_t lane = 0; lane < live; ++lane) {
    const LodRequest<float> needs = row_of(all_needs, lane);
    LodState<float> lod_state = row_of(all_tiers, lane);
    if (lod_state.relative_size == 0) lod_state = begin_tiers(choice);
    const float height = at.size.at(table, b).leg_scale_m[lane];
    float speed = INFINITY;
    if (at.gait && at.plan) {
      const auto& plan = at.plan.at(table, b);
      speed = std::max({at.gait.at(table, b).speed_m_s[lane], plan.from.speed_m_s[lane], plan.to.speed_m_s[lane]});
    }
    lod_state.speed_step = LodTable::speed_step(speed, height);
    lod_state.relative_size = work_.options.margin * height / reference_height;

    lod_state.tolerance_m = work_.scene.tolerance_m.value_or(default_tolerance_m);
    const bool own_view = (needs.own & own_look) != 0;
    View view = work_.scene.looked_at ? View::seen : View::near;
    if (work_.scene.camera) {
      const Vec3<float> pelvis = pelvis_of(table, at, b, lane);
      const Sight of = sight(*work_.scene.camera, cone_cos_, cone_sin_, work_.scene.tolerance_px, pelvis,
                             static_cast<View>(lod_state.view), compact ? off_the_line_m : 0);
      view = of.view;
      lod_state.tolerance_m = of.tolerance_m;
      if (work_.scene.asleep_beyond_m && view > View::near) {
        view = View::near;  // can be near soon
        if (!(own_view && needs.looked_at != 0) && at.plan &&
            gap(pelvis) > falls_asleep * *work_.scene.asleep_beyond_m &&
            may_be_steady(at.gait.at(table, b), at.plan.at(table, b), at.state.at(table, b), lane))
          out.drowsy.push_back(table.entities(b)[lane]);
      }
    }
    if (own_view) view = needs.looked_at != 0 ? View::seen : View::near;
    if ((needs.own & own_tolerance) != 0) lod_state.tolerance_m = needs.tolerance_m;
    lod_state.view = static_cast<std::uint32_t>(view);

    decide(table.entities(b)[lane], lod_state, wanted(needs), compact, out);
    put_row(lod_state, all_tiers, lane);
  }
}

std::uint64_t LodRound::wanted(const LodRequest<float>& needs) const {
  return (needs.own & own_muscles) != 0 ? all_bits(needs.muscles) : work_.scene.muscles.to_ullong();
}

void LodRound::decide(Entity person, LodState<float>& lod_state, std::uint64_t wanted_muscles, bool compact,
                      Looked& out) const {
  const auto view = static_cast<View>(lod_state.view);
  const bool looked_at = view == View::seen, simulated = view <= View::near;
  const float size =
      lod_state.relative_size / lod_state.tolerance_m;  // from errors of the table to multiples of the tolerance
  const float limit = progress_.factor / size;
  if ((lod_state.effects & lod_bare) != 0) return decide_bare(person, lod_state, wanted_muscles, compact, out);
  const bool over = work_.scene.budget_s && progress_.cost_ps > progress_.budget_ps;
  // If no muscle is simulated and none was forced, all are removed together.
  bool idle = work_.scene.asleep_beyond_m && all_bits(lod_state.muscles) != 0, settled = true;
  float excess = 0;
  const std::size_t dearer = out.dearer.size(), cheaper = out.cheaper.size();
  for (std::uint64_t left = all_bits(lod_state.muscles); left != 0; left &= left - 1) {
    const auto m = static_cast<std::uint32_t>(std::countr_zero(left));
    const std::uint32_t now = level_at(lod_state.level, m);
    if (now >= refused_level) {
      idle = settled = false;
      continue;
    }
    const bool points = bit_at(lod_state.points, m);
    const LevelCase as_is = level_case(lod_state, m, points);
    LevelCase as_seen = as_is;
    as_seen.points = looked_at;
    const std::int64_t cost = work_.lod_table.cost_ps(as_is, now);
    if (!compact) out.counted_ps += cost;  // the budget excludes compact people
    std::uint32_t goal = 0;
    if (simulated && (wanted_muscles >> m & 1U) != 0) {
      if (work_.scene.budget_s && !compact) out.counting.add(work_.lod_table, as_seen, size);
      goal = work_.lod_table.from(now, as_seen, limit, over ? 1.0F : work_.options.slack);
    }
    idle = idle && goal == 0;
    const bool shown = looked_at && goal != 0;
    set_level(lod_state.goal, m, goal);
    set_bit(lod_state.goal_points, m, shown);
    const bool modal = levels_of(as_is.active)[goal].method == Method::modal;
    if (goal == now && (points == shown || !modal)) continue;
    const std::int64_t more = work_.lod_table.cost_ps(as_seen, goal) - cost;
    const bool lit = shown && !points;  // not visible until then
    const std::uint32_t worst = more > 0 ? (lit ? 0 : now) : goal;
    settled = false;
    const float misses = work_.lod_table.error_m(as_seen, worst) * size;
    excess = std::max(excess, misses);
    (more > 0 ? out.dearer : out.cheaper)
        .push_back(
            {misses, person, static_cast<std::uint8_t>(m), static_cast<std::uint8_t>(goal), shown, as_is.active, more});
  }
  decide_compact(person, compact, lod_state, settled, excess, out);
  if (!idle) return;
  out.dearer.resize(dearer);
  out.cheaper.resize(cheaper);
  out.idle.push_back(person);
}

}  // namespace mobil::inline v0_3
