#include "systems/muscles/activation_effect.h"

#include <algorithm>
#include <array>
#include <vector>

#include <mobil/components/activation.h>
#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/step_plan.h>
#include <mobil/rows.h>
#include "systems/activation/excitation.h"
#include "systems/activation/musculotendon.h"
#include "systems/lines/line_of_action.h"
#include "systems/muscles/member_design.h"
#include "systems/muscles/owner_legs.h"

namespace mobil::inline v0_3 {
namespace {
namespace of_activation {

constexpr std::uint32_t design_words = sizeof(MemberDesign<float>) / sizeof(float);
constexpr std::uint32_t state_words = sizeof(MemberState<float>) / sizeof(float);
using Excitations = std::array<Lanes<float>, max_row_members>;

/// Constants common to all muscles of a row of the table.
struct RowMembers {
  RowExcitation excitation;
  std::array<float, max_row_members> weight{};
  std::array<std::size_t, max_row_members> number{};  // among the leg's members
};

const RowMembers& row_members(Muscle muscle) {
  static const std::vector<RowMembers> all = [] {
    std::vector<RowMembers> rows;
    for (std::size_t m = 0; m < muscles().size(); ++m) {
      const auto members = members_of(static_cast<Muscle>(m));
      RowMembers row{row_excitation(static_cast<Muscle>(m)), {}, {}};
      for (std::size_t i = 0; i < members.size(); ++i) {
        row.weight[i] = static_cast<float>(member_weight(members, members[i]));
        row.number[i] = leg_member_number(members[i]);
      }
      rows.push_back(row);
    }
    return rows;
  }();
  return all[static_cast<std::size_t>(muscle)];
}

/// Returns the columns of a block as members.
MemberBlock block_of(const RowMembers& row, const float* design, const float* length, const Excitations& excitation,
                     float* state) {
  return {row.excitation.members,
          row.weight.data(),
          reinterpret_cast<const MemberDesign<Lanes<float>>*>(design),
          reinterpret_cast<const Lanes<float>*>(length),
          excitation.data(),
          reinterpret_cast<MemberState<Lanes<float>>*>(state)};
}

/// Gathers the requested forces of muscles; 0 for a person without requests.
void take_forces(const LookupPublished<AskedForces>& asked, const MuscleOwner<Lanes<float>>& owner,
                 const RowMembers& row, Excitations& of_most) {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const AskedForces* const of = asked.find({owner.index[lane], owner.generation[lane]});
    for (std::size_t i = 0; i < row.excitation.members; ++i)
      of_most[i][lane] = of == nullptr ? 0 : of->leg[owner.side[lane] & 1U].of_most[row.number[i]];
  }
}

void pull(LegsOfOwners posts, LookupPublished<AskedForces> asked, const MuscleOwner<Lanes<float>>& owner,
          TagValue<Muscle> muscle, TagValue<ExcitationSource> source, Field<const MemberLength> length,
          Field<const MemberDesignField> design, Field<MemberStateField> state, Activation<Lanes<float>>& activation,
          Musculotendon<Lanes<float>>& tendon, EndDrive<Lanes<float>>& end, float tick_s) {
  const RowMembers& row = row_members(static_cast<Muscle>(muscle.value));
  Excitations excitation;
  const MemberBlock block = block_of(row, design.data, length.data, excitation, state.data);
  switch (static_cast<ExcitationSource>(source.value)) {
    case ExcitationSource::phase:
      excite(row.excitation, clocks_of(posts, owner), excitation.data());
      break;
    case ExcitationSource::moments: {
      Excitations of_most;
      take_forces(asked, owner, row, of_most);
      ask_forces(block, of_most.data(), tick_s, excitation.data());
      break;
    }
    default:
      excitation.fill(activation.excitation);
  }
  contract(block, tick_s, activation, tendon);
  end.to = tendon.belly_m;
}

Module module() {
  row_members(Muscle{});  // made here, not during a tick
  return {.name = "activation",
          .parts = {component_id<Activation>(), component_id<Musculotendon>(),
                    component_id(TagValue<ExcitationSource>{}), component_id(FieldWidth<MemberLength>{}),
                    component_id(FieldWidth<MemberDesignField>{}), component_id(FieldWidth<MemberStateField>{})},
          .systems = [](ScheduleBuilder& systems) { systems.add("activation", &pull).after("lines of action"); }};
}

bool wanted(const MuscleKind& kind) {
  return kind.activation != ExcitationSource::none;
}

void parts(const MuscleKind& kind, std::vector<ComponentId>& to) {
  const auto members = static_cast<std::uint32_t>(members_of(kind.muscle).size());
  to.push_back(component_id<Activation>());
  to.push_back(component_id<Musculotendon>());
  to.push_back(component_id(TagValue<ExcitationSource>{static_cast<std::uint64_t>(kind.activation)}));
  to.push_back(component_id(FieldWidth<MemberLength>{members}));
  to.push_back(component_id(FieldWidth<MemberDesignField>{design_words * members}));
  to.push_back(component_id(FieldWidth<MemberStateField>{state_words * members}));
}

Lanes<float> in_all_lanes(float x) {
  Lanes<float> lanes;
  std::ranges::fill(lanes.lane, x);
  return lanes;
}

LegClock<Lanes<float>> present_clock(const World& world, Entity person, Side side) {
  LegClock<Lanes<float>> clock{};
  const auto plan = world.get<StepPlan>(person);
  const auto state = world.get<GaitState>(person);
  if (!plan || !state) return clock;
  std::array<PublishedLeg, lane_count> posts{};
  set_clocks(broadcast(*world.get<BodySize>(person)), broadcast(*plan), broadcast(*state), posts.data());
  return broadcast(posts[0].leg[side].clock);
}

/// Returns the first lane of a block of members, in the layout of a row's field.
template <class T>
std::vector<float> first_words(const T* block, std::size_t members) {
  std::vector<float> words;
  const auto* const lanes = reinterpret_cast<const Lanes<float>*>(block);
  for (std::size_t w = 0; w < members * sizeof(T) / sizeof(Lanes<float>); ++w) words.push_back(lanes[w][0]);
  return words;
}

/// Starts at rest at the activation of the current excitation; for `moments`, not known yet, that of the phase. With
/// excitation by the host, starts at min_activation.
void begin(const EffectStart& start, RowValues& values) {
  if (start.world.has<Activation>(start.entity)) return;
  const auto members = members_of(start.kind.muscle);
  const RowMembers& row = row_members(start.kind.muscle);
  std::array<MemberDesign<Lanes<float>>, max_row_members> design;
  std::array<MemberState<Lanes<float>>, max_row_members> state{};
  std::array<Lanes<float>, max_row_members> length;
  for (std::size_t i = 0; i < members.size(); ++i) {
    design[i] = broadcast(member_design(members[i], start.size.member[i]));
    length[i] = in_all_lanes(static_cast<float>(start.size.member[i].rest_length_m));
  }
  find_rest_bellies(members.size(), length.data(), design.data());

  auto line = broadcast(start.line);
  EndDrive<Lanes<float>> end{};
  lines_of_action(*start.kind.lines, broadcast(start.size.leg_scale),
                  leg_of(*start.world.get<Pose>(start.person), start.side), start.kind.far_end, line, end,
                  length.data());
  Excitations excitation;
  excitation.fill(in_all_lanes(min_activation));
  if (start.kind.activation != ExcitationSource::host)
    excite(row.excitation, present_clock(start.world, start.person, start.side), excitation.data());
  Activation<Lanes<float>> activation{};
  Musculotendon<Lanes<float>> tendon{};
  settle(block_of(row, design[0].fibre_m.lane, length[0].lane, excitation, state[0].activation.lane), activation,
         tendon);

  values.set(first_lane(activation));
  values.set(first_lane(tendon));
  values.set_field<MemberLength>(first_words(length.data(), members.size()));
  values.set_field<MemberDesignField>(first_words(design.data(), members.size()));
  values.set_field<MemberStateField>(first_words(state.data(), members.size()));
  values.set(EndDrive<float>{tendon.belly_m[0], tendon.belly_m[0]});
}

}  // namespace of_activation
}  // namespace

constinit const MuscleEffect activation_effect = {&of_activation::module, &of_activation::wanted, &of_activation::begin,
                                                  &of_activation::parts};

}  // namespace mobil::inline v0_3
