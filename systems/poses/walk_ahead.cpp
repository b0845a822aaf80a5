#include "systems/poses/walk_ahead.h"

#include <fmt/format.h>

#include <mobil/components/avoidance.h>
#include <mobil/each.h>
#include <mobil/rows.h>
#include "systems/gait/footing.h"
#include "systems/gait/gait.h"
#include "systems/gait/kinematics.h"
#include "systems/gait/shoulders.h"

namespace mobil::inline v0_3 {

WalkAhead::WalkAhead(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& gait,
                     const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                     const Footing<Lanes<float>>* footing, float ahead_s)
    : state_(state), plan_(&plan), uneven_(footing != nullptr) {
  if (uneven_) footing_ = *footing;
  // Rounding residue of a frame that ends with a tick is ignored. The clock's unit is a fraction of `ahead_s`; a
  // shorter time would give too many units.
  constexpr float min_s = 1e-6F;
  if (!(ahead_s > min_s)) return;
  advance_gait(plan, state_, ahead_s);
  if (const std::uint32_t lanes = lanes_to_plan(plan, gait, state_, ahead_s); lanes != 0) {
    StepPlan<Lanes<float>> solved = next_ = plan;
    plan_next_step(size, gait, state_, solved);
    for (std::size_t l = 0; l < lane_count; ++l)
      if ((lanes >> l & 1U) != 0) put_row(row_of(solved, l), next_, l);
    plan_ = &next_;
  }
  turn_gait(size, *plan_, gait, state_, ahead_s);
  if (uneven_) follow_feet(state_, footing_);
}

Result<void> check_ahead(double ahead_s) {
  if (ahead_s >= 0 && ahead_s <= furthest_ahead_s) return {};
  return fail(fmt::format("{} s after the last tick; 0 to {} s", ahead_s, furthest_ahead_s));
}

void pose_ahead(const Table& table, std::size_t block, float ahead_s, Pose<Lanes<float>>& pose) {
  const auto& size = TableColumn<BodySize>(table).at(table, block);
  const TableColumn<Footing> footing(table);
  const WalkAhead then(size, TableColumn<Gait>(table).at(table, block), TableColumn<StepPlan>(table).at(table, block),
                       TableColumn<GaitState>(table).at(table, block), footing ? &footing.at(table, block) : nullptr,
                       ahead_s);
  JointAngles<Lanes<float>> angles;
  Feet<Lanes<float>> feet;
  pose_skeleton(size, then.plan(), then.state(), then.footing(), pose, angles, feet);
  if (const TableColumn<AvoidanceState> courses(table); courses)
    turn_shoulders(courses.at(table, block).turn_rad, pose);
}

Pose<float> pose_ahead(const World& world, Entity person, float ahead_s) {
  const auto place = world.find(person);
  if (!TableColumn<GaitState>(*place.table)) return *world.get<Pose>(person);
  Pose<Lanes<float>> pose;
  pose_ahead(*place.table, place.row / lane_count, ahead_s, pose);
  return row_of(pose, place.row % lane_count);
}

}  // namespace mobil::inline v0_3
