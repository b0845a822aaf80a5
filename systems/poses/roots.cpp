#include <mobil/systems/poses/roots.h>

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/components/step_plan.h>
#include <mobil/each.h>
#include <mobil/engine/access.h>
#include <mobil/rows.h>
#include "engine/exact_math.h"
#include "systems/gait/root_place.h"
#include "systems/people/person_requests.h"
#include "systems/poses/walk_ahead.h"
#include "systems/states/waking.h"

namespace mobil::inline v0_3 {
namespace {

/// Roots of sixteen walkers.
struct RootBlock {
  RootPlace<Lanes<float>> place;
  Lanes<float> line_x_m, line_z_m;

  void make(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& gait, const StepPlan<Lanes<float>>& plan,
            const GaitState<Lanes<float>>& state, float ahead_s) {
    if (ahead_s > 0) {
      const WalkAhead then(size, gait, plan, state, nullptr, ahead_s);
      make(then.plan(), then.state());
    } else {
      make(plan, state);
    }
  }
  Root of(std::size_t lane) const {
    return {double{line_x_m[lane]} + double{place.x_m[lane]}, double{line_z_m[lane]} + double{place.z_m[lane]},
            place.heading_rad[lane]};
  }

 private:
  void make(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state) {
    root_place(plan, state, place);
    line_x_m = state.line_x_m;
    line_z_m = state.line_z_m;
  }
};

/// Returns the root of a posed person: the point under the pelvis, and the direction of the pelvis' front.
Root posed_root(const Pose<float>& pose) {
  const std::size_t pelvis = index(Segment::pelvis);
  const Quat<float>& q = pose.rotation[pelvis];
  const double ahead_x = 2 * (double{q.x} * double{q.z} + double{q.w} * double{q.y});
  const double ahead_z = 1 - 2 * (double{q.x} * double{q.x} + double{q.y} * double{q.y});
  return {double{pose.position_m[pelvis].x}, double{pose.position_m[pelvis].z},
          static_cast<float>(exact::atan2(ahead_x, ahead_z))};
}

Root sleeping_root(const World& world, Entity person, const SleepTime& time, float ahead_s) {
  struct Walker {
    Gait<float> gait;
    StepPlan<float> plan;
    GaitState<float> state;
  };
  const auto walker = std::make_unique<Walker>();
  read_asleep(world, person, time, type_id<Gait<float>>(), &walker->gait);
  read_asleep(world, person, time, type_id<StepPlan<float>>(), &walker->plan);
  read_asleep(world, person, time, type_id<GaitState<float>>(), &walker->state);
  RootBlock block;
  block.make(broadcast(body_size(world, person)), broadcast(walker->gait), broadcast(walker->plan),
             broadcast(walker->state), ahead_s);
  return block.of(0);
}

/// Reads the roots of people in order; computes a block when the next person is in a different one.
void read_some(const World& world, std::span<const Entity> people, const SleepTime& time, float ahead_s, Root* out) {
  RootBlock block;
  const Table* made = nullptr;
  std::size_t made_block = 0;
  for (const Entity person : people) {
    const auto place = world.find(person);
    const Table& table = *place.table;
    const std::size_t b = place.row / lane_count, lane = place.row % lane_count;
    if (const TableColumn<GaitState> state(table); state) {
      if (made != &table || made_block != b) {
        block.make(TableColumn<BodySize>(table).at(table, b), TableColumn<Gait>(table).at(table, b),
                   TableColumn<StepPlan>(table).at(table, b), state.at(table, b), ahead_s);
      }
      made = &table;
      made_block = b;
      *out++ = block.of(lane);
    } else if (is_asleep(world, person)) {
      *out++ = sleeping_root(world, person, time, ahead_s);
    } else {
      *out++ = posed_root(*world.get<Pose>(person));
    }
  }
}

}  // namespace

RootMotion root_motion(const Root& from, const Root& to) {
  const double s = exact::sin(double{from.heading_rad}), c = exact::cos(double{from.heading_rad});
  const double x = to.x_m - from.x_m, z = to.z_m - from.z_m;
  const double turn = double{to.heading_rad} - double{from.heading_rad};
  return {static_cast<float>(x * c - z * s), static_cast<float>(x * s + z * c),
          static_cast<float>(std::remainder(turn, 2 * std::numbers::pi))};
}

Root moved(const Root& from, const RootMotion& by) {
  const double s = exact::sin(double{from.heading_rad}), c = exact::cos(double{from.heading_rad});
  const double left = double{by.left_m}, ahead = double{by.ahead_m};
  return {from.x_m + left * c + ahead * s, from.z_m - left * s + ahead * c, from.heading_rad + by.turn_rad};
}

Result<void> read_roots(const World& world, std::span<const Entity> people, const SleepTime& time, double ahead_s,
                        std::span<Root> out) {
  if (out.size() != people.size())
    return fail(fmt::format("roots: {} people, and room for {}; give as much", people.size(), out.size()));
  if (auto done = check_ahead(ahead_s); !done) return fail(fmt::format("roots: {}", done.error().message));
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (!is_person(world, people[i]))
      return fail(fmt::format("roots: person {} of the list is not there (a stale handle)", i), Status::stale_entity);
  }
  read_some(world, people, time, static_cast<float>(ahead_s), out.data());
  return {};
}

}  // namespace mobil::inline v0_3
