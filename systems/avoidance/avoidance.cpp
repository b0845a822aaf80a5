#include <mobil/avoidance.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include <mobil/components/footing.h>
#include <mobil/each.h>
#include <mobil/engine/access.h>
#include <mobil/engine/table_list.h>
#include <mobil/rows.h>
#include "assets/gait/slope_pace.h"
#include "engine/row_hash.h"
#include "systems/avoidance/choice.h"
#include "systems/avoidance/narrow.h"
#include "systems/gait/gait.h"
#include "systems/gait/step_limits.h"
#include "systems/people/group_by_table.h"
#include "systems/people/person_requests.h"
#include "systems/states/person_states.h"

namespace mobil::inline v0_3 {

/// The host's settings and scratch memory of choosing, in the simulation's workspace.
struct AvoidanceWork {
  explicit AvoidanceWork(std::pmr::memory_resource* memory) : tables({type_id<AvoidanceState<float>>()}, memory) {}

  TableList tables;
  AvoidanceOptions options;
  std::vector<BoxedWall> walls;
  std::vector<Disc> discs;
  AvoidanceReport report;
  ReservationBook book;
  std::vector<Chosen> chosen;             // by striker
  std::vector<std::uint32_t> striker_of;  // by reservation: the striker that leaves it
  std::vector<char> gives_way;            // by striker

  static constexpr std::uint32_t nobody = 0xFFFFFFFFU;

  void give_way(const Jobs& jobs, std::uint32_t tick);
  void choose(const Frame& frame);
};

AvoidanceWork& Avoidance::work() const {
  return frame_.workspace.get<AvoidanceWork>();
}

Result<void> Avoidance::set_options(const AvoidanceOptions& options) {
  const FloatMode mode;
  for (const float number : {options.radius_h, options.overlap_m, options.shoulders_h})
    if (!std::isfinite(number))
      return fail("set_options: radius_h, overlap_m or shoulders_h is not a number; give one, or AvoidanceOptions{}");
  AvoidanceOptions& to = work().options;
  to.radius_h = std::clamp(options.radius_h, 0.02F, 0.5F);
  to.overlap_m = std::clamp(options.overlap_m, 0.0F, 0.2F);
  to.shoulders_h = std::clamp(options.shoulders_h, to.radius_h, 0.5F);
  return {};
}

const AvoidanceReport& Avoidance::report() const {
  return work().report;
}

/// Returns a walker's first state. A new walker wants the last request, on level ground. A managed one keeps the
/// desired velocity and the turn of the shoulders.
static AvoidanceState<float> first_course(const World& world, const AvoidanceOptions& options, Entity person) {
  const BodySize<float> size = *world.get<BodySize>(person);
  const auto before = world.get<AvoidanceState>(person);
  AvoidanceState<float> course = before.value_or(AvoidanceState<float>{});
  course.radius_m = options.radius_h * size.shoulders_scale_m;
  course.shoulders_m = options.shoulders_h * size.shoulders_scale_m;
  if (before) return course;
  const Gait<float> gait = *world.get<Gait>(person);
  const LevelWalk asked = level_walk(gait, world.get<Footing>(person).value_or(Footing<float>{}));
  course.speed_m_s = asked.speed_m_s;
  course.heading_rad = gait.heading_rad;
  course.usual = static_cast<float>(usual_step_factor(age_of(world.get<Physique>(person)->build)));
  if (asked.speed_m_s > 0) {
    const auto usual = resolve_gait(size.leg_scale_m, {.speed_m_s = asked.speed_m_s});
    if (usual) course.usual = asked.step_length_m / usual->step_length_m;
  }
  return course;
}

Result<void> Avoidance::manage(Entity person) {
  return manage(std::span(&person, 1));
}

Result<void> Avoidance::manage(std::span<const Entity> people) {
  const FloatMode mode;
  World& world = frame_.world;
  const Jobs& jobs = frame_.jobs;
  if (!world.alive_once(people) ||
      !std::ranges::all_of(people, [&](Entity person) { return is_person(world, person); }))
    return fail("Avoidance: that person is not there (a stale handle), or is named twice", Status::stale_entity);
  std::vector<Entity> asleep;
  for (const Entity person : people) {
    if (is_posed(world, person))
      return fail("Avoidance: this person's host animates the skeleton; hand them over as discs", Status::missing);
    if (is_asleep(world, person)) asleep.push_back(person);
  }
  const AvoidanceOptions& options = work().options;
  World::Transaction transaction(world, jobs);
  if (!asleep.empty()) {
    if (auto done = wake(frame_, asleep); !done) return done;
  }
  std::vector<Entity> begin, again;
  for (const Entity person : people) (world.has<AvoidanceState>(person) ? again : begin).push_back(person);
  std::vector<AvoidanceState<Lanes<float>>> course;
  group_by_table(world, begin, [&](std::span<const Entity> together) {
    course.resize((together.size() + lane_count - 1) / lane_count);
    for (std::size_t i = 0; i < together.size(); ++i)
      put_row(first_course(world, options, together[i]), course[i / lane_count], i % lane_count);
    world.change_archetype(together, std::array{PartValue{component_id<AvoidanceState>(), course.data()}}, {}, jobs);
  });
  for (const Entity person : again) world.set(person, first_course(world, options, person));
  transaction.commit();
  return {};
}

/// Returns the desired walk on level ground; zeros for a person who wants to stand.
static LevelWalk level_wish(const AvoidanceState<float>& course, float height_m) {
  const auto usual = resolve_gait(height_m, {.speed_m_s = course.speed_m_s});
  if (!(course.speed_m_s > 0) || !usual) return {};
  return {course.speed_m_s, course.usual * usual->step_length_m};
}

/// Stores with the gait whether a slope alone slows the walker below the desired speed. The walker then returns to that
/// speed after the slope, however it ends (is_slowed).
static void keep_level_wish(const AvoidanceState<float>& course, const Gait<float>& asked, float height_m,
                            Footing<Lanes<float>>& footing, std::size_t lane) {
  constexpr float hindered = 0.99F;
  const float slowed_m_s = slope_speed(course.speed_m_s, footing.slows_for[lane]);
  LevelWalk level{};
  if (slowed_m_s < course.speed_m_s && asked.speed_m_s >= hindered * slowed_m_s) level = level_wish(course, height_m);
  footing.looked_at[lane] = asked.revision;
  footing.level_speed_m_s[lane] = level.speed_m_s;
  footing.level_length_m[lane] = level.step_length_m;
}

/// Returns the footing of a slowed walker on release, with the desired velocity; nothing if the walker is not slowed. A
/// walker who wants to stand keeps the current gait.
static std::optional<Footing<float>> released_footing(const World& world, Entity person) {
  auto footing = world.get<Footing>(person);
  const auto asked = asked_body(world, person);
  if (!footing || !asked || !is_slowed(asked->gait, *footing)) return {};
  const LevelWalk level = level_wish(*world.get<AvoidanceState>(person), asked->size.leg_scale_m);
  footing->level_speed_m_s = level.speed_m_s;
  footing->level_length_m = level.step_length_m;
  return *footing;
}

Result<void> Avoidance::release(Entity person) {
  return release(std::span(&person, 1));
}

Result<void> Avoidance::release(std::span<const Entity> people) {
  const FloatMode mode;
  World& world = frame_.world;
  const Jobs& jobs = frame_.jobs;
  if (!world.alive_once(people))
    return fail("Avoidance: a person is not there (a stale handle), or is named twice", Status::stale_entity);
  for (const Entity person : people)
    if (!world.has<AvoidanceState>(person)) return fail("Avoidance: a person is not managed", Status::missing);
  constexpr std::array part = {type_id<AvoidanceState<float>>()};
  std::vector<std::optional<Footing<float>>> footing;
  for (const Entity person : people) footing.push_back(released_footing(world, person));
  World::Transaction transaction(world, jobs);
  group_by_table(world, people,
                 [&](std::span<const Entity> together) { world.change_archetype(together, {}, part, jobs); });
  transaction.commit();
  for (std::size_t i = 0; i < people.size(); ++i)
    if (footing[i]) world.set(people[i], *footing[i]);
  return {};
}

Result<void> Avoidance::set_desired_velocity(std::span<const DesiredVelocity> wishes) {
  const FloatMode mode;
  World& world = frame_.world;
  for (const auto& [person, speed, heading] : wishes) {
    if (!world.alive(person)) return fail("Avoidance: a person is not there (a stale handle)", Status::stale_entity);
    if (!world.has<AvoidanceState>(person))
      return fail("Avoidance: a person is not managed; call manage first", Status::missing);
    if (!(std::fabs(heading) < 1e4F))
      return fail(fmt::format("Avoidance: a heading of {} rad is not within ±10000; give an angle about +Y", heading));
    if (speed == 0) continue;
    if (auto gait = resolve_gait(body_size(world, person).leg_scale_m, {.speed_m_s = speed}); !gait)
      return tl::unexpected(gait.error());
  }
  for (const auto& [person, speed, heading] : wishes) {
    AvoidanceState<float> course = *world.get<AvoidanceState>(person);
    course.speed_m_s = speed;
    course.heading_rad = heading;
    world.set(person, course);
  }
  return {};
}

static Result<void> check_height(const HeightRange& height) {
  if (height.low_m < height.high_m) return {};
  return fail(fmt::format("Avoidance: an obstacle from {} to {} m; its top must be above its bottom", height.low_m,
                          height.high_m));
}

Result<void> Avoidance::set_walls(std::span<const Wall> walls) {
  const FloatMode mode;
  for (const Wall& wall : walls) {
    for (const GroundPoint& at : {wall.from, wall.to}) {
      if (!(std::fabs(at.x_m) <= farthest_m && std::fabs(at.z_m) <= farthest_m))
        return fail(fmt::format("Avoidance: a wall's end at ({}, {}) m is not within 1000 km", at.x_m, at.z_m));
    }
    if (auto good = check_height(wall.height); !good) return good;
  }
  std::vector<BoxedWall>& to = work().walls;
  to.clear();
  for (const Wall& wall : walls) to.push_back({wall, box_of(wall.from, wall.to, 0)});
  return {};
}

Result<void> Avoidance::set_discs(std::span<const Disc> discs) {
  const FloatMode mode;
  for (const Disc& disc : discs) {
    if (!(std::fabs(disc.at.x_m) <= farthest_m && std::fabs(disc.at.z_m) <= farthest_m && disc.radius_m >= 0 &&
          disc.radius_m <= farthest_m))
      return fail(fmt::format("Avoidance: a disc at ({}, {}) m with a radius of {} m; give a place within 1000 km and a "
                              "radius of 0 to 1000 km",
                              disc.at.x_m, disc.at.z_m, disc.radius_m));
    if (!(std::fabs(disc.x_m_s) <= 1e3F && std::fabs(disc.z_m_s) <= 1e3F))
      return fail(fmt::format("Avoidance: a disc with a velocity of ({}, {}) m/s; give at most 1000 m/s each way",
                              disc.x_m_s, disc.z_m_s));
    if (auto good = check_height(disc.height); !good) return good;
  }
  work().discs.assign(discs.begin(), discs.end());
  return {};
}

static float length_m(const GroundBox& way) {
  return std::hypot(way.high_x_m - way.low_x_m, way.high_z_m - way.low_z_m);
}

/// Resolves conflicts of two walkers who strike in one tick and whose new ways meet. The one with the lower draw goes;
/// the other keeps to the reservation, which the first has kept clear of.
void AvoidanceWork::give_way(const Jobs& jobs, std::uint32_t tick) {
  const std::vector<Striker>& strikers = book.strikers();
  striker_of.assign(book.reservations(), nobody);
  for (std::size_t i = 0; i < strikers.size(); ++i)
    if (chosen[i].trial != reserved) striker_of[strikers[i].reservation] = static_cast<std::uint32_t>(i);
  gives_way.assign(strikers.size(), 0);
  const auto goes_first = [&](std::uint32_t a, std::uint32_t b) {
    const auto draw = [&](std::uint32_t reservation) {
      return mix64(mix64(book.reservation(reservation).who.index) ^ tick);
    };
    return draw(a) < draw(b);
  };
  // The search finds reservations. A new way begins on its walker's reservation and can extend longest_m from there.
  float longest_m = 0;
  for (std::size_t i = 0; i < strikers.size(); ++i)
    if (chosen[i].trial != reserved) longest_m = std::max(longest_m, length_m(chosen[i].box));
  in_parallel(jobs, strikers.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t reservation = strikers[i].reservation;
      if (striker_of[reservation] == nobody) continue;
      const GroundBox& way = chosen[i].box;
      const Reservation& mine = book.reservation(reservation);
      const float reach_m = 0.5F * length_m(way) + longest_m + mine.radius_m + book.broadest_m();
      const GroundPoint middle = {0.5F * (way.low_x_m + way.high_x_m), 0.5F * (way.low_z_m + way.high_z_m)};
      book.near(middle.x_m, middle.z_m, mine, reach_m, [&](const Nearby& near) {
        const std::uint32_t other = near.reservation, rival = striker_of[other];
        if (rival == nobody || other == reservation || !goes_first(other, reservation)) return;
        const Reservation& theirs = book.reservation(other);
        const float apart = mine.radius_m + theirs.radius_m - options.overlap_m;
        if (meet(chosen[i], chosen[rival], apart)) gives_way[i] = 1;
      });
    }
  });
}

void AvoidanceWork::choose(const Frame& frame) {
  const std::uint32_t tick = frame.tick.index;
  book.refresh(frame.world, frame.jobs, tick, frame.tick.dt_s, options.shoulders_h);
  const std::vector<Striker>& strikers = book.strikers();
  const Surroundings around = {book, walls, discs, options.overlap_m};
  chosen.resize(strikers.size());
  in_parallel(frame.jobs, strikers.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) choose_step(around, strikers[i], chosen[i]);
  });
  give_way(frame.jobs, tick);
  narrow_shoulders(book, frame.jobs, tick);

  report.people = book.people();
  for (std::size_t i = 0; i < strikers.size(); ++i) {
    const Chosen& own = chosen[i];
    if (own.under_way) continue;
    auto& [table, block, lane, reservation] = strikers[i];
    Gait<Lanes<float>>& gaits = TableColumn<Gait>(*table).at(*table, block);
    AvoidanceState<Lanes<float>>& courses = TableColumn<AvoidanceState>(*table).at(*table, block);
    const bool yields = gives_way[i] != 0, aside = !yields && own.kind == TrialKind::aside;
    const bool wants = courses.speed_m_s[lane] > 0;
    const Gait<float> before = row_of(gaits, lane);
    Gait<float> asked = yields ? own.as_reserved : own.gait;
    const bool other = asked.speed_m_s != before.speed_m_s || asked.step_length_m != before.step_length_m || aside;
    asked.displacement = (before.displacement + (aside ? 1U : 0U)) & 0xFFFFU;
    asked.revision = (before.revision + (other ? 1U : 0U)) & 0xFFFFU;
    put_row(asked, gaits, lane);
    if (const TableColumn<Footing> ground(*table); ground) {
      const float height_m = TableColumn<BodySize>(*table).at(*table, block).leg_scale_m[lane];
      keep_level_wish(row_of(courses, lane), asked, height_m, ground.at(*table, block), lane);
    }
    const bool stands = TableColumn<StepPlan>(*table).at(*table, block).to.speed_m_s[lane] <= 0;
    const bool waits = wants && stands && asked.speed_m_s <= 0;
    courses.waits_s[lane] = waits ? courses.waits_s[lane] + own.duration_s : 0;
    ++report.chose;
    report.yielded += yields;
    report.kept_reservation += wants && own.trial == reserved;
    report.waiting += waits;
  }
}

Phase steps_chosen() {
  return {"avoidance", [](const Frame& frame) {
            AvoidanceWork& work = frame.workspace.get<AvoidanceWork>();
            work.report.people = 0;
            if (work.tables.any_rows(frame.world)) work.choose(frame);
          }};
}

void begin_avoidance_report(const Frame& frame) {
  if (auto* const work = frame.workspace.find<AvoidanceWork>()) work->report = {.people = work->report.people};
}

}  // namespace mobil::inline v0_3
