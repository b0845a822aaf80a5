// Who is seen, what their muscles need, and which method each gets.
#include <mobil/relevance.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include <mobil/components/footing.h>
#include <mobil/components/sleep.h>
#include <mobil/rows.h>
#include "engine/exact_math.h"
#include "engine/state_hash.h"
#include "systems/gait/asleep.h"
#include "systems/relevance/basis_orders.h"
#include "systems/relevance/packed_rungs.h"
#include "systems/relevance/sight.h"
#include "systems/simulation_world.h"

namespace mobil::inline v0_3 {
namespace {

constexpr float closest_m = 0.3F;
constexpr float leave_m = 0.5F;  // how much farther out somebody seen must be to be seen no more
constexpr float reference_height = static_cast<float>(reference_body_height_m);
/// How far a pelvis is from the point of the line beside the stance foot, at most.
constexpr float off_the_line_m = 0.6F;
/// How much farther out than where they would wake people must be to fall asleep.
constexpr float falls_asleep = 1.5F;

struct Sight {
  View view;
  float tolerance_m;  // by distance; 0 without a camera
};

/// `cosine`, `sine`: of the camera's half angle; `blur_m`: how far somebody may be from `at`.
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

Result<void> check(const RelevanceOptions& options) {
  if (options.slack > 0 && options.slack <= 1 && options.stagger > 0 && positive(double{options.margin}) &&
      positive(options.machine_factor.value_or(1)) && positive(options.switching_s)) {
    return {};
  }
  return fail(
      "Relevance: slack must be within 0 and 1, stagger at least 1, margin, switching_s and machine_factor positive");
}

}  // namespace

Relevance::Relevance(Simulation& simulation, const RelevanceOptions& options)
    : simulation_(simulation),
      options_(options),
      ladder_(options.table != nullptr ? *options.table : accuracy_table()),
      machine_(options.machine_factor.value_or(1)),
      orders_(std::make_unique<BasisOrders>(options.background, options.making_ticks)) {
  if (auto ok = check(options); !ok) throw std::invalid_argument(ok.error().message);
}

Relevance::~Relevance() = default;
Relevance::Relevance(Relevance&&) noexcept = default;

Result<Relevance> Relevance::make(Simulation& simulation, const RelevanceOptions& options) {
  if (auto ok = check(options); !ok) return tl::unexpected(ok.error());
  return Relevance(simulation, options);
}

/// Where somebody's pelvis is; of who is compact, within off_the_line_m.
Vec3<float> Relevance::pelvis_of(const Table& table, const Columns& at, std::size_t b, std::uint32_t lane) {
  if (!at.pose) {
    const auto& state = at.state.at(table, b);
    return {state.line_x_m[lane], pelvis_m, state.line_z_m[lane]};
  }
  const auto& pelvis = at.pose.at(table, b).position_m[index(Segment::pelvis)];
  return {pelvis.x[lane], pelvis.y[lane], pelvis.z[lane]};
}

/// Who is to be whole, and who may be compact: of whom nothing is seen and who waits for nothing.
void Relevance::decide_compact(Entity human, bool compact, const Tiers<float>& tiers, bool settled, float excess,
                               Looked& out) const {
  const bool looked_at = static_cast<View>(tiers.view) == View::seen;
  if ((tiers.effects & (tier_inertia | tier_living)) != 0 && !compact) return;
  if (compact && (looked_at || !settled || !scene_.compact_unseen)) out.expanding.push_back({excess, human});
  if (!compact && scene_.compact_unseen && !looked_at && settled && !simulation_.world().has<Footing>(human))
    out.unseen.push_back(human);
}

/// Tables come and stay. Their order follows from what they are, not from which came first: where not everybody's turn
/// can be at once, the same people come first in a world that was restored.
void Relevance::find_tables() {
  World& world = world_of(simulation_);
  if (tables_seen_ == world.tables().size()) return;
  for (; tables_seen_ < world.tables().size(); ++tables_seen_) {
    Table& table = world.tables()[tables_seen_];
    const Columns at{TableColumn<Needs>(table),    TableColumn<Tiers>(table), TableColumn<Pose>(table),
                     TableColumn<BodySize>(table), TableColumn<Gait>(table),  TableColumn<StepPlan>(table),
                     TableColumn<GaitState>(table)};
    if (find_part(table.key(), type_id<SleepsManaged>()) != nullptr) sleeping_tables_.push_back(&table);
    if (!at.needs || !at.tiers || !at.size || !(at.pose || at.state)) continue;
    tables_.emplace_back(&table, at);
  }
  const auto hash_of = [&](const Table* table) { return key_hash(world, table->key()); };
  std::ranges::stable_sort(sleeping_tables_, {}, hash_of);
  std::ranges::stable_sort(tables_, {}, [&](const auto& one) { return hash_of(one.first); });
}

RelevanceState Relevance::state() const {
  return {crowd_,     counting_,          machine_, cost_ps_, counted_ps_, budget_ps_,       factor_,      turn_,
          last_tick_, orders_->ordered(), eye_m_,   gaze_,    saw_,        sleepers_looked_, all_sleepers_};
}

void Relevance::set_state(const RelevanceState& state) {
  crowd_ = state.crowd;
  counting_ = state.counting;
  machine_ = state.machine;
  cost_ps_ = state.cost_ps;
  counted_ps_ = state.counted_ps;
  budget_ps_ = state.budget_ps;
  factor_ = state.factor;
  turn_ = state.turn % options_.stagger;
  last_tick_ = state.last_tick;
  orders_->set_ordered(state.ordered);
  eye_m_ = state.eye_m;
  gaze_ = state.gaze;
  saw_ = state.saw;
  sleepers_looked_ = state.sleepers_looked;
  all_sleepers_ = state.all_sleepers;
}

void Relevance::Looked::clear() {
  dearer.clear();
  cheaper.clear();
  bare.clear();
  expanding.clear();
  drowsy.clear();
  idle.clear();
  unseen.clear();
  counted_ps = 0;
}

void Relevance::Looked::add(const Looked& more) {
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

/// This turn's part of the crowd, in runs of blocks on all threads; the lists are joined in the order of the blocks.
std::size_t Relevance::look_at_the_awake() {
  constexpr std::size_t together = 16;  // blocks
  now_.clear();
  blocks_.clear();
  std::size_t people = 0;
  for (std::uint32_t t = 0; t < tables_.size(); ++t) {
    Table& table = *tables_[t].first;
    for (std::size_t b = turn_; b < table.block_count(); b += options_.stagger) {
      blocks_.push_back({t, static_cast<std::uint32_t>(b)});
      people += table.live(b);
    }
  }
  const std::size_t runs = (blocks_.size() + together - 1) / together;
  if (looked_.size() < runs) looked_.resize(runs);
  in_parallel(SimulationWorld::jobs(simulation_), runs, [&](std::size_t begin, std::size_t end) {
    for (std::size_t run = begin; run < end; ++run) {
      Looked& out = looked_[run];
      out.clear();
      if (scene_.budget_s) out.counting.clear();
      for (std::size_t i = run * together; i < std::min((run + 1) * together, blocks_.size()); ++i) {
        auto& [table, columns] = tables_[blocks_[i].table];
        evaluate(*table, columns, blocks_[i].block, out);
      }
    }
  });
  for (std::size_t run = 0; run < runs; ++run) {
    now_.add(looked_[run]);
    if (scene_.budget_s) counting_.add(looked_[run].counting);
  }
  counted_ps_ += now_.counted_ps;
  return people;
}

RelevanceReport Relevance::update() {
  RelevanceReport report;
  find_tables();
  if (scene_.camera) {
    cone_cos_ = exact::cos(scene_.camera->half_angle_rad);
    cone_sin_ = exact::sin(scene_.camera->half_angle_rad);
  }
  observe_machine();
  wake_sleepers(report);
  report.evaluated = look_at_the_awake();
  if (++turn_ >= options_.stagger) {
    turn_ = 0;
    crowd_ = counting_;
    cost_ps_ = counted_ps_;
    counting_.clear();
    counted_ps_ = 0;
  }
  make_whole(report);
  begin_muscles(report);
  end_muscles(report);
  carry_out(report);
  put_to_sleep(report);
  make_compact(report);
  report.factor = factor_;
  report.machine = machine_.pessimistic();
  report.predicted_s = 1e-12 * static_cast<double>(cost_ps_) * machine_.mean();
  return report;
}

void Relevance::evaluate(Table& table, const Columns& at, std::size_t b, Looked& out) const {
  const auto& all_needs = at.needs.at(table, b);
  auto& all_tiers = at.tiers.at(table, b);
  const bool compact = !at.pose;
  const auto* const kept = find_part(table.key(), type_id<LegMuscles>());
  const auto* const choice =
      kept == nullptr ? nullptr : static_cast<const LegMuscles*>(simulation_.world().resource(kept->value));
  const std::uint32_t live = table.live(b);
  const Gap gap(scene_.camera.value_or(Viewpoint{}), cone_cos_, cone_sin_);
  for (std::uint32_t lane = 0; lane < live; ++lane) {
    const Needs<float> needs = row_of(all_needs, lane);
    Tiers<float> tiers = row_of(all_tiers, lane);
    if (tiers.relative_size == 0) tiers = begin_tiers(choice);
    const float height = at.size.at(table, b).height_m[lane];
    float speed = INFINITY;
    if (at.gait && at.plan) {
      const auto& plan = at.plan.at(table, b);
      speed = std::max({at.gait.at(table, b).speed_m_s[lane], plan.from.speed_m_s[lane], plan.to.speed_m_s[lane]});
    }
    tiers.speed_step = RungLadder::speed_step(speed, height);
    tiers.relative_size = options_.margin * height / reference_height;

    tiers.tolerance_m = scene_.tolerance_m.value_or(default_tolerance_m);
    const bool own_view = (needs.own & own_look) != 0;
    View view = scene_.looked_at ? View::seen : View::near;
    if (scene_.camera) {
      const Vec3<float> pelvis = pelvis_of(table, at, b, lane);
      const Sight of = sight(*scene_.camera, cone_cos_, cone_sin_, scene_.tolerance_px, pelvis,
                             static_cast<View>(tiers.view), compact ? off_the_line_m : 0);
      view = of.view;
      tiers.tolerance_m = of.tolerance_m;
      if (scene_.asleep_beyond_m && view > View::near) {
        view = View::near;  // soon, perhaps
        if (!(own_view && needs.looked_at != 0) && at.plan && gap(pelvis) > falls_asleep * *scene_.asleep_beyond_m &&
            may_be_steady(at.gait.at(table, b), at.plan.at(table, b), at.state.at(table, b), lane))
          out.drowsy.push_back(table.entities(b)[lane]);
      }
    }
    if (own_view) view = needs.looked_at != 0 ? View::seen : View::near;
    if ((needs.own & own_tolerance) != 0) tiers.tolerance_m = needs.tolerance_m;
    tiers.view = static_cast<std::uint32_t>(view);

    decide(table.entities(b)[lane], tiers, wanted(needs), compact, out);
    put_row(tiers, all_tiers, lane);
  }
}

std::uint32_t Relevance::wanted(const Needs<float>& needs) const {
  return (needs.own & own_muscles) != 0 ? needs.muscles : static_cast<std::uint32_t>(scene_.muscles.to_ulong());
}

void Relevance::decide(Entity human, Tiers<float>& tiers, std::uint32_t wanted_muscles, bool compact,
                       Looked& out) const {
  const auto view = static_cast<View>(tiers.view);
  const bool looked_at = view == View::seen, simulated = view <= View::near;
  const float size = tiers.relative_size / tiers.tolerance_m;  // errors as parts of the tolerance, over the table's
  const float limit = factor_ / size;
  if ((tiers.effects & tier_bare) != 0) return decide_bare(human, tiers, wanted_muscles, compact, out);
  const bool over = scene_.budget_s && cost_ps_ > budget_ps_;
  // Where nothing is seen of any of them, and nothing was forced, all go at once.
  bool idle = scene_.asleep_beyond_m && tiers.muscles != 0, settled = true;
  float excess = 0;
  const std::size_t dearer = out.dearer.size(), cheaper = out.cheaper.size();
  for (std::uint32_t left = tiers.muscles; left != 0; left &= left - 1) {
    const auto m = static_cast<std::uint32_t>(std::countr_zero(left));
    const std::uint32_t now = rung_at(tiers.rung, m);
    if (now >= refused_rung) {
      idle = settled = false;
      continue;
    }
    const bool points = bit_at(tiers.points, m);
    const RungCase as_is = rung_case(tiers, m, points);
    RungCase as_seen = as_is;
    as_seen.points = looked_at;
    const std::int64_t cost = ladder_.cost_ps(as_is, now);
    if (!compact) out.counted_ps += cost;  // what is compact is no part of what a budget is for
    std::uint32_t goal = 0;
    if (simulated && bit_at(wanted_muscles, m)) {
      if (scene_.budget_s && !compact) out.counting.add(ladder_, as_seen, size);
      goal = ladder_.from(now, as_seen, limit, over ? 1.0F : options_.slack);
    }
    idle = idle && goal == 0;
    const bool shown = looked_at && goal != 0;
    set_rung(tiers.goal, m, goal);
    set_bit(tiers.goal_points, m, shown);
    const bool reduced = rungs_of(as_is.living)[goal].method == Method::reduced;
    if (goal == now && (points == shown || !reduced)) continue;
    const std::int64_t more = ladder_.cost_ps(as_seen, goal) - cost;
    const bool lit = shown && !points;  // until then there is nothing to be seen of it
    const std::uint32_t worst = more > 0 ? (lit ? 0 : now) : goal;
    settled = false;
    const float misses = ladder_.error_m(as_seen, worst) * size;
    excess = std::max(excess, misses);
    (more > 0 ? out.dearer : out.cheaper)
        .push_back(
            {misses, human, static_cast<std::uint8_t>(m), static_cast<std::uint8_t>(goal), shown, as_is.living, more});
  }
  decide_compact(human, compact, tiers, settled, excess, out);
  if (!idle) return;
  out.dearer.resize(dearer);
  out.cheaper.resize(cheaper);
  out.idle.push_back(human);
}

}  // namespace mobil::inline v0_3
