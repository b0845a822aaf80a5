#include <mobil/terrain.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <mobil/components/avoidance.h>
#include <mobil/components/pose.h>
#include <mobil/each.h>
#include <mobil/engine/table_list.h>
#include <mobil/rows.h>
#include "engine/exact_math.h"
#include "systems/gait/step_events.h"
#include "systems/muscles/leg_muscles.h"
#include "systems/people/fat_wobble.h"
#include "systems/people/group_by_table.h"
#include "systems/people/person_requests.h"
#include "systems/states/person_states.h"
#include "systems/terrain/ground_profile.h"
#include "systems/terrain/sole_fit.h"
#include "systems/terrain/speed_scaling.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::size_t leaving = index(FootholdOf::leaving);
constexpr std::size_t stance = index(FootholdOf::stance);
constexpr std::size_t landing = index(FootholdOf::landing);

/// Distance beyond which a foothold counts as another one, m.
constexpr float moved_m = 0.05F;
/// Places queried under a standing foot, the ankle first.
constexpr std::size_t sole_places = 3;

/// Returns false if a height or slope is not a number or is out of range. Limits too steep slopes.
bool make_usable(TerrainHeight& answer) {
  constexpr float steepest = 1;
  if (!(std::fabs(answer.height_m) <= highest_ground_m) || !std::isfinite(answer.rise_x) ||
      !std::isfinite(answer.rise_z))
    return false;
  answer.rise_x = std::clamp(answer.rise_x, -steepest, steepest);
  answer.rise_z = std::clamp(answer.rise_z, -steepest, steepest);
  return true;
}

}  // namespace

/// The host's settings and scratch memory of queries, in the simulation's workspace. `asking` lists people, their step,
/// and the index of their first query. A person's queries are three along the sole of each standing foot, if all
/// footholds are queried, then those of the next foothold, then those on the way to it.
struct TerrainWork {
  struct Asking {
    Entity person;
    std::uint32_t steps, stance_side;
    float line_x_m, line_z_m;
    float stance_x_m, stance_z_m, landing_x_m, landing_z_m;
    std::size_t first;
    bool all;
  };
  explicit TerrainWork(std::pmr::memory_resource* memory) : tables({type_id<Footing<float>>()}, memory) {}

  TableList tables;
  TerrainHeights heights;
  TerrainOptions options;
  std::vector<Asking> asking;
  std::vector<TerrainQuery> queries;
  std::vector<TerrainHeight> answers;
  std::vector<Entity> people;  // whose speed must be checked
  SpeedScaling scaling;
  TerrainReport report;
  bool told = false;  // `report` is of past ticks

  void collect(World& world);
  void collect_block(const Table& table, std::uint32_t block);
  void ask_along(const Footholds<Lanes<float>>& at, std::size_t which, std::size_t lane, Entity person,
                 std::span<const float> ahead_m);
  std::size_t put_answers(const Frame& frame);
  std::size_t put_answers(World& world, const Asking& one, bool slows_down);
  static void stand_up(World& world, Entity person);
  void find_changed(World& world);
  Result<void> scale_speed(const Frame& frame, std::span<const Entity> some, std::optional<float> steepness = {});
  TerrainHeight foothold(std::size_t first) const;
  struct Landing {
    TerrainHeight plane;
    float moved_x_m, moved_z_m;
  };
  Landing fit_landing(std::size_t first, float height_m, float step_length_m) const;
  std::size_t mend_answers(std::size_t first, std::size_t count, std::size_t ankle, float usual_m);
};

void TerrainWork::ask_along(const Footholds<Lanes<float>>& at, std::size_t which, std::size_t lane, Entity person,
                            std::span<const float> ahead_m) {
  const float x = at.x_m[which][lane], z = at.z_m[which][lane], heading = at.heading_rad[which][lane];
  const float s = exact::sin(heading), c = exact::cos(heading);
  for (const float ahead : ahead_m) queries.push_back({x + ahead * s, z + ahead * c, person});
}

void TerrainWork::collect_block(const Table& table, std::uint32_t block) {
  const auto& size = TableColumn<BodySize>(table).at(table, block);
  const auto& state = TableColumn<GaitState>(table).at(table, block);
  const auto& footing = TableColumn<Footing>(table).at(table, block);
  Footholds<Lanes<float>> at;
  footholds(TableColumn<StepPlan>(table).at(table, block), state, at);
  const Entity* const entities = table.entities(block);
  for (std::uint32_t l = 0; l < table.live(block); ++l) {
    const auto elsewhere = [&](std::size_t which, float x_m, float z_m) {
      return std::fabs(at.x_m[which][l] - x_m) > moved_m || std::fabs(at.z_m[which][l] - z_m) > moved_m;
    };
    const bool same_step = footing.steps[l] == state.steps[l] && footing.stance_side[l] == state.stance_side[l];
    const bool known = footing.known[l] == footing_all;
    const bool all = footing.known[l] == footing_unknown || !same_step ||
                     (known && elsewhere(stance, footing.stance_x_m[l], footing.stance_z_m[l]));
    if (!all && known && !elsewhere(landing, footing.landing_x_m[l], footing.landing_z_m[l])) continue;
    asking.push_back({entities[l], state.steps[l], state.stance_side[l], state.line_x_m[l], state.line_z_m[l],
                      at.x_m[stance][l], at.z_m[stance][l], at.x_m[landing][l], at.z_m[landing][l], queries.size(),
                      all});
    const float height_m = size.leg_scale_m[l];
    const std::array<float, sole_places> sole = {0, -SoleGround::back_h * height_m, SoleGround::front_h * height_m};
    std::array<float, SoleGround::places> about;
    for (std::size_t i = 0; i < SoleGround::places; ++i) about[i] = SoleGround::ahead_h(i) * height_m;
    if (all) ask_along(at, leaving, l, entities[l], sole);
    if (all) ask_along(at, stance, l, entities[l], sole);
    ask_along(at, landing, l, entities[l], about);
    for (std::size_t i = 0; i < GroundProfile::asked; ++i) {
      const float part = GroundProfile::part(i);
      queries.push_back({std::lerp(at.x_m[leaving][l], at.x_m[landing][l], part),
                         std::lerp(at.z_m[leaving][l], at.z_m[landing][l], part), entities[l]});
    }
  }
}

void TerrainWork::collect(World& world) {
  asking.clear();
  queries.clear();
  report.people = 0;
  for (const Table* const table : tables.find(world)) {
    if (!TableColumn<GaitState>(*table) || !TableColumn<StepPlan>(*table)) continue;
    for (std::size_t b = 0; b < table->block_count(); ++b) {
      report.people += table->live(b);
      collect_block(*table, static_cast<std::uint32_t>(b));
    }
  }
  answers.assign(queries.size(), {});
}

/// Returns a foot's plane: that of the ground under its ankle, raised where heel or toes would be in the ground.
TerrainHeight TerrainWork::foothold(std::size_t first) const {
  TerrainHeight plane = answers[first];
  const TerrainQuery& ankle = queries[first];
  float raised_m = 0;
  for (std::size_t i = first + 1; i < first + sole_places; ++i) {
    const float x = queries[i].x_m - ankle.x_m, z = queries[i].z_m - ankle.z_m;
    raised_m = std::max(raised_m, answers[i].height_m - plane.height_m - x * plane.rise_x - z * plane.rise_z);
  }
  plane.height_m = std::clamp(plane.height_m + raised_m, -highest_ground_m, highest_ground_m);
  return plane;
}

/// Returns the next foothold, clear of edges where possible.
TerrainWork::Landing TerrainWork::fit_landing(std::size_t first, float height_m, float step_length_m) const {
  const TerrainQuery &heel = queries[first], &toes = queries[first + SoleGround::places - 1];
  const float sole_m = SoleGround::apart_h * height_m * static_cast<float>(SoleGround::places - 1);
  const float x = (toes.x_m - heel.x_m) / sole_m, z = (toes.z_m - heel.z_m) / sole_m;  // direction of the toes
  SoleGround sole;
  for (std::size_t i = 0; i < SoleGround::places; ++i) {
    sole.height_m[i] = answers[first + i].height_m;
    sole.rise[i] = x * answers[first + i].rise_x + z * answers[first + i].rise_z;
  }
  const SoleFit fit = fit_sole(sole, height_m, step_length_m);
  const TerrainHeight& under = answers[first + fit.place];
  return {{fit.height_m, under.rise_x, under.rise_z}, fit.ahead_m * x, fit.ahead_m * z};
}

/// Gives unusable places along a sole the plane of the usable one nearest to the ankle, or level ground at `usual_m`.
/// Returns their number.
std::size_t TerrainWork::mend_answers(std::size_t first, std::size_t count, std::size_t ankle, float usual_m) {
  std::size_t unusable = 0;
  const auto nearer = [&](std::size_t a, std::size_t b) {
    return std::max(a, ankle) - std::min(a, ankle) < std::max(b, ankle) - std::min(b, ankle);
  };
  std::array<bool, SoleGround::places> usable{};
  std::size_t best = first + count;
  for (std::size_t i = first; i < first + count; ++i) {
    usable[i - first] = make_usable(answers[i]);
    if (usable[i - first] && (best == first + count || nearer(i, best))) best = i;
  }
  for (std::size_t i = first; i < first + count; ++i) {
    if (usable[i - first]) continue;
    ++unusable;
    answers[i] = {usual_m};
    if (best == first + count) continue;
    answers[i] = answers[best];
    answers[i].height_m += (queries[i].x_m - queries[best].x_m) * answers[best].rise_x +
                           (queries[i].z_m - queries[best].z_m) * answers[best].rise_z;
  }
  return unusable;
}

/// Moves a person whose pose is not on this ground onto it at once, without inertia: a person who was placed, woke or
/// is newly managed.
void TerrainWork::stand_up(World& world, Entity person) {
  constexpr float more_than_a_step_m = 0.4F, fat_feels_m = 0.05F;
  const auto feet = world.get<Feet>(person);
  const auto state = world.get<GaitState>(person);
  if (!feet || !state) return;
  const std::size_t side = state->stance_side & 1U;
  const float lowest_m = std::min({feet->heel_m[side].y, feet->toe_m[side].y, feet->tip_m[side].y});
  const float by_m = world.get<Footing>(person)->height_m[stance] - lowest_m;
  if (std::fabs(by_m) > fat_feels_m) settle_fat(world, person);
  if (!(std::fabs(by_m) > more_than_a_step_m)) return;
  Pose<float> pose = *world.get<Pose>(person);
  for (auto& at : pose.position_m) at.y += by_m;
  Feet<float> moved = *feet;
  for (auto* const points : {moved.heel_m, moved.toe_m, moved.tip_m}) points[0].y += by_m, points[1].y += by_m;
  CentreOfMass<float> centre = *world.get<CentreOfMass>(person);
  centre.position_m.y += by_m;
  world.set(person, pose);
  world.set(person, moved);
  world.set(person, centre);
  forget_motion(world, person);
}

/// Returns the number of unusable answers.
std::size_t TerrainWork::put_answers(const Frame& frame) {
  people.clear();
  people.reserve(asking.size());
  scaling.reserve(asking.size());
  std::size_t unusable = 0;
  for (const Asking& one : asking) unusable += put_answers(frame.world, one, options.slows_down);
  report.asked += asking.size();
  report.places += queries.size();
  report.unusable += unusable;
  asking.clear();
  queries.clear();
  if (options.slows_down) find_changed(frame.world);
  drop_repeated(people);
  if (!people.empty()) (void)scale_speed(frame, people);  // failed requests are repeated
  return unusable;
}

/// Adds the walkers on a slope whose gait the host has changed since they were checked.
void TerrainWork::find_changed(World& world) {
  for (const Table* const one : tables.find(world)) {
    const Table& table = *one;
    const TableColumn<Footing> footings(table);
    const TableColumn<Gait> gaits(table);
    if (!gaits || TableColumn<AvoidanceState>(table)) continue;
    for (std::size_t b = 0; b < table.block_count(); ++b) {
      const auto& footing = footings.at(table, b);
      const auto& gait = gaits.at(table, b);
      for (std::uint32_t l = 0; l < table.live(b); ++l)
        if (footing.slows_for[l] != 0 && gait.revision[l] != footing.looked_at[l])
          people.push_back(table.entities(b)[l]);
    }
  }
}

/// Changes the speed of these walkers to suit the steepness of their ground, or one steepness for all (find_slowed).
Result<void> TerrainWork::scale_speed(const Frame& frame, std::span<const Entity> some,
                                      std::optional<float> steepness) {
  find_slowed(frame.world, frame.jobs, some, scaling, steepness);
  if (scaling.changes.empty()) return {};
  const auto done = change_walks(frame, scaling.changes);
  keep_slowed(frame.world, scaling);
  if (!done) return tl::unexpected(done.error());
  return {};
}

/// Returns the number of unusable answers. Skips people who were removed, placed elsewhere or have taken a step since
/// the query.
std::size_t TerrainWork::put_answers(World& world, const Asking& one, bool slows_down) {
  const auto [table, row] = world.find(one.person);
  if (table == nullptr || !TableColumn<Footing>(*table) || !TableColumn<GaitState>(*table) ||
      !TableColumn<StepPlan>(*table))
    return 0;
  const std::size_t first = one.first, block = row / lane_count, l = row % lane_count;
  const bool all = one.all;
  auto& footing = TableColumn<Footing>(*table).at(*table, block);
  const auto& state = TableColumn<GaitState>(*table).at(*table, block);
  const auto& plan = TableColumn<StepPlan>(*table).at(*table, block);
  if (one.steps != state.steps[l] || one.stance_side != state.stance_side[l] || one.line_x_m != state.line_x_m[l] ||
      one.line_z_m != state.line_z_m[l])
    return 0;
  const std::size_t next = first + (all ? 2 * sole_places : 0), on_way = next + SoleGround::places;
  const float usual_m = footing.height_m[stance][l],
              height_m = TableColumn<BodySize>(*table).at(*table, block).leg_scale_m[l];
  std::size_t unusable = 0;
  for (std::size_t i = first; i < next; i += sole_places) unusable += mend_answers(i, sole_places, i, usual_m);
  unusable += mend_answers(next, SoleGround::places, next + SoleGround::ankle, usual_m);
  for (std::size_t i = on_way; i < on_way + GroundProfile::asked; ++i) unusable += mend_answers(i, 1, i, usual_m);

  const auto put = [&](std::size_t which, const TerrainHeight& plane, float moved_x_m, float moved_z_m) {
    footing.height_m[which][l] = std::clamp(plane.height_m, -highest_ground_m, highest_ground_m);
    footing.rise_x[which][l] = plane.rise_x;
    footing.rise_z[which][l] = plane.rise_z;
    footing.moved_x_m[which][l] = moved_x_m;
    footing.moved_z_m[which][l] = moved_z_m;
  };
  if (all) put(leaving, foothold(first), 0, 0);
  if (all) put(stance, foothold(first + sole_places), 0, 0);
  if (plan.landing[l] > 0) {
    const Landing at = fit_landing(next, height_m, plan.step_length_m[l]);
    put(landing, at.plane, at.moved_x_m, at.moved_z_m);
  } else {  // standing walkers move no foot
    for (auto* values : by_foothold(footing)) (*values)[landing][l] = (*values)[leaving][l];
  }
  footing.steps[l] = one.steps;
  footing.stance_side[l] = one.stance_side;
  footing.stance_x_m[l] = one.stance_x_m;
  footing.stance_z_m[l] = one.stance_z_m;
  footing.landing_x_m[l] = one.landing_x_m;
  footing.landing_z_m[l] = one.landing_z_m;
  footing.known[l] = footing_all;
  // Steepness from the foothold behind to the one ahead: a kerb affects two steps.
  constexpr float steepest = 1, shortest_m = 0.2F;
  const float way_m = std::max(plan.length_before_m[l] + plan.step_length_m[l], shortest_m);
  const float steepness = (footing.height_m[landing][l] - footing.height_m[leaving][l]) / way_m;
  if (slows_down || footing.slows_for[l] != 0 || footing.level_speed_m_s[l] > 0) people.push_back(one.person);
  footing.slows_for[l] = slows_down ? std::clamp(steepness, -steepest, steepest) : 0;
  if (all) stand_up(world, one.person);

  const float part = GroundProfile::part(0);
  const TerrainQuery& on = queries[on_way];
  GroundProfile ground = {(on.x_m - part * one.landing_x_m) / (1 - part),
                          (on.z_m - part * one.landing_z_m) / (1 - part),
                          one.landing_x_m,
                          one.landing_z_m,
                          {}};
  ground.height_m.front() = footing.height_m[leaving][l];
  ground.height_m.back() = footing.height_m[landing][l];
  for (std::size_t i = 0; i < GroundProfile::asked; ++i) ground.height_m[i + 1] = answers[on_way + i].height_m;
  const FootLift lift = lift_over(ground, row_of(TableColumn<BodySize>(*table).at(*table, block), l), row_of(plan, l),
                                  row_of(state, l), row_of(footing, l));
  footing.lift_early_m[l] = lift.early_m;
  footing.lift_late_m[l] = lift.late_m;
  return unusable;
}

TerrainWork& Terrain::work() const {
  return frame_.workspace.get<TerrainWork>();
}

namespace {

/// Returns those people who are managed, or those who are not, each once.
std::vector<Entity> those(const World& world, std::span<const Entity> people, bool managed) {
  std::vector<Entity> some;
  for (const Entity person : people)
    if (world.has<Footing>(person) == managed) some.push_back(person);
  drop_repeated(some);
  return some;
}

}  // namespace

Result<void> Terrain::manage(std::span<const Entity> people) {
  const FloatMode mode;
  World& world = frame_.world;
  const Jobs& jobs = frame_.jobs;
  for (const Entity person : people) {
    if (!is_person(world, person)) return fail("Terrain: a person is not there (a stale handle)", Status::stale_entity);
    if (!is_asleep(world, person) && !world.has<Gait>(person))
      return fail("Terrain: this person's host animates the skeleton; pose them on the ground", Status::missing);
  }
  const std::vector<Entity> changes = those(world, people, false);
  World::Transaction transaction(world, jobs);
  if (auto done = make_full(frame_, changes); !done) return done;
  group_by_table(world, changes, [&](std::span<const Entity> together) {
    world.change_archetype(together, std::array{PartValue{component_id<Footing>(), nullptr}}, {}, jobs);
  });
  transaction.commit();
  return {};
}

Result<void> Terrain::release(std::span<const Entity> people) {
  const FloatMode mode;
  World& world = frame_.world;
  const Jobs& jobs = frame_.jobs;
  for (const Entity person : people) {
    if (!world.alive(person)) return fail("Terrain: a person is not there (a stale handle)", Status::stale_entity);
    if (!world.has<Footing>(person)) return fail("Terrain: a person is not managed", Status::missing);
  }
  constexpr std::array part = {type_id<Footing<float>>()};
  const std::vector<Entity> changes = those(world, people, true);
  // Slowed walkers first return to the walk on level ground. If memory runs out after that, they are slowed again.
  if (auto done = work().scale_speed(frame_, changes, 0); !done) return done;
  World::Transaction transaction(world, jobs);
  group_by_table(world, changes,
                 [&](std::span<const Entity> together) { world.change_archetype(together, {}, part, jobs); });
  transaction.commit();
  for (const Entity person : changes) settle_fat(world, person);  // they drop to the plane at once
  return {};
}

void Terrain::set_heights(TerrainHeights heights) {
  work().heights = std::move(heights);
}

void Terrain::set_options(const TerrainOptions& options) {
  work().options = options;
}

const TerrainReport& Terrain::report() const {
  return work().report;
}

std::span<const TerrainQuery> Terrain::query() {
  const FloatMode mode;
  work().collect(frame_.world);
  return work().queries;
}

Result<std::size_t> Terrain::resolve(std::span<const TerrainHeight> heights) {
  const FloatMode mode;
  TerrainWork& of = work();
  if (heights.size() != of.queries.size())
    return fail(
        fmt::format("Terrain: there are {} answers, and {} places were asked for; answer those of the last ask, once",
                    heights.size(), of.queries.size()),
        Status::not_valid);
  std::ranges::copy(heights, of.answers.begin());
  if (std::exchange(of.told, false)) of.report = {.people = of.report.people};
  return of.put_answers(frame_);
}

Phase ground_under_feet() {
  return {"ground", [](const Frame& frame) {
            TerrainWork& work = frame.workspace.get<TerrainWork>();
            if (!work.heights || !work.tables.any_rows(frame.world)) return;
            work.collect(frame.world);
            if (!work.asking.empty()) work.heights(work.queries, work.answers);
            work.put_answers(frame);
          }};
}

void begin_terrain_report(const Frame& frame) {
  auto* const work = frame.workspace.find<TerrainWork>();
  if (work != nullptr && std::exchange(work->told, true)) work->report = {};
}

}  // namespace mobil::inline v0_3
