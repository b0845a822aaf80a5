#include "systems/states/compact_module.h"

#include <algorithm>
#include <array>

#include <mobil/components/body.h>
#include <mobil/components/compact.h>
#include <mobil/components/gait.h>
#include <mobil/components/leg_frames.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/components/muscle.h>
#include <mobil/components/pose.h>
#include <mobil/components/step_plan.h>
#include <mobil/schedule.h>
#include "engine/fetch_ahead.h"
#include "engine/snapshot.h"
#include "systems/deformation/modal.h"
#include "systems/deformation/restart.h"
#include "systems/gait/knee_frames.h"
#include "systems/lines/elongations.h"
#include "systems/states/compact_codes.h"

namespace mobil::inline v0_3 {
namespace {

/// Advances all moving muscles of a person, right and left, by a tick.
void move_compact(float tick_s, const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                  Ahead<StepPlan> next, const GaitState<Lanes<float>>& gait, Ahead<GaitState> next_gait,
                  Shared<LegMuscles> choice, TagValue<CompactMuscles> codes, Field<const CompactMotion> motion,
                  Field<CompactState> state, const Rows& rows, Tally<RestartedBellies> restarted) {
  LegPlanAhead plans(next.block);
  FetchAhead motions(motion.next, std::size_t{motion.words} * sizeof(Lanes<float>));
  FetchAhead states(state.next, std::size_t{state.words} * sizeof(Lanes<float>));
  FetchAhead(next_gait.block).fetch(all_lines);
  KneeFrame<Lanes<float>> leg[2];
  knee_frames(size, plan, gait, leg, plans);
  const auto* const words = reinterpret_cast<const Lanes<float>*>(motion.data);
  const LegScale<Lanes<float>> scale = {words[0], words[1], words[2]};
  struct Moving {
    std::uint32_t modes;
    CompactLayout at;
  };
  std::array<Moving, max_compact> moving;
  std::array<ElongatedLine, max_compact> lines;
  std::array<Lanes<float>, max_compact> now;
  std::size_t count = 0, place = 0;
  CompactLayout at;
  for (std::size_t m = 0; m < choice->muscles.size(); ++m) {
    if (!choice->muscles[m]) continue;
    const std::uint32_t code = code_at(codes.value, place++);
    if (!moves(code)) continue;
    moving[count] = {code, at};
    lines[count] = {&lines_of(static_cast<Muscle>(m)), &words[at.motion], &now[count]};
    at.skip(code);
    ++count;
  }
  const std::size_t places = std::max<std::size_t>(2 * count, 1);
  const auto of_each = [&](std::size_t all) { return (all + places - 1) / places; };
  const std::size_t motion_lines = of_each(motion.words), state_lines = of_each(state.words);
  for (std::uint32_t side = 0; side < 2; ++side) {
    elongations({lines.data(), count}, scale, leg[side]);
    for (std::size_t i = 0; i < count; ++i) {
      motions.fetch(motion_lines);
      states.fetch(state_lines);
      const auto& [modes, from] = moving[i];
      float* const own = state.data + lane_count * (from.state + side * (1 + 2 * modes));
      auto& before = *reinterpret_cast<Lanes<float>*>(own);
      restarted.add(count_rows(
          swing_modal(modes, before, now[i], tick_s, own + lane_count, motion.data + lane_count * (from.motion + 1)),
          rows));
      before = now[i];
    }
  }
}

/// Checks that a compact person is a walker without a pose, and that the fields' widths match the codes.
Result<void> check_compact_key(const Archetype& key, const World& world) {
  const auto words = [&](std::uint64_t id) {
    const ComponentId* const part = find_component(key, id);
    return part == nullptr ? 0 : part->value;
  };
  const auto has = [&](std::uint64_t id) { return find_component(key, id) != nullptr; };
  const ComponentId* const codes = find_component(key, type_id<CompactMuscles>());
  const ComponentId* const choice = find_component(key, type_id<LegMuscles>());
  bool sound = codes != nullptr || (!has(type_id<CompactState>()) && !has(type_id<CompactMotion>()));
  if (codes != nullptr) {
    const CompactLayout width = compact_width(codes->value);
    sound = choice != nullptr && has(type_id<Gait<float>>()) && !has(type_id<Pose<float>>()) &&
            words(type_id<CompactState>()) == width.state &&
            words(type_id<CompactMotion>()) == (width.state > 0 ? width.motion : 0);
  }
  if (sound && codes != nullptr) {
    const auto& set = static_cast<const LegMuscles*>(world.resource(choice->value))->muscles;
    sound = set.count() <= max_compact && codes->value >> (code_bits * set.count()) == 0 &&
            (set >> muscles().size()).none();
  }
  if (sound) return {};
  return damaged("somebody's compact muscles");
}

}  // namespace

Module compact_module() {
  return {.name = "compact",
          .parts = {component_id(FieldWidth<CompactState>{}), component_id(FieldWidth<CompactMotion>{}),
                    component_id(TagValue<CompactMuscles>{})},
          .systems = [](ScheduleBuilder& systems) { systems.add("compact muscles", &move_compact); },
          .check_key = &check_compact_key};
}

}  // namespace mobil::inline v0_3
