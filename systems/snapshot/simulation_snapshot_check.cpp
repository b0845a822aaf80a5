// Whether bytes that claim to be people are some.
#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>

#include "assets/body/anthropometry.h"
#include "components/fade.h"
#include "components/forces.h"
#include "components/gait.h"
#include "components/leg_frames.h"
#include "components/pose.h"
#include "components/relevance.h"
#include "systems/deformation/deformation.h"
#include "systems/lines/muscle_lines.h"
#include "systems/relevance/accuracy_table.h"
#include "systems/relevance/simulation_ladder.h"
#include "systems/relevance/simulation_relevance_rows.h"
#include "systems/snapshot/simulation_snapshot_work.h"

namespace mobil {
namespace {

constexpr std::uint32_t most_steps = 1'000'000;

constexpr std::array known_parts = {
    component_part<BodySize>(),
    component_part<Gait>(),
    component_part<StepPlan>(),
    component_part<GaitState>(),
    component_part<Pose>(),
    component_part<JointAngles>(),
    component_part<Feet>(),
    component_part<CentreOfMass>(),
    component_part<MotionHistory>(),
    component_part<GroundReaction>(),
    component_part<JointMoments>(),
    component_part<Needs>(),
    component_part<Tiers>(),
    component_part<MuscleOwner>(),
    component_part<LegScale>(),
    component_part<BellyScale>(),
    component_part<LineOfAction>(),
    component_part<LineMotion>(),
    component_part<EndDisplacement>(),
    component_part<EndForce>(),
    component_part<FrameLoad>(),
    component_part<FrameHistory>(),
    component_part<BellyReport>(),
    component_part<Fade>(),
    key_part(FieldWidth<NodalDisplacement>{}),
    key_part(FieldWidth<NodalVelocity>{}),
    key_part(FieldWidth<ReducedState>{}),
    key_part(FieldWidth<ReducedMotion>{}),
    key_part(FieldWidth<ReducedShape>{}),
    key_part(FieldWidth<FadeStart>{}),
    key_part(FieldWidth<ShownDisplacement>{}),
    key_part(TagValue<Substeps>{}),
    key_part(TagValue<SolvedSteps>{}),
    key_part(TagValue<StaticSteps>{}),
    key_part(TagValue<ReducedStatic>{}),
    key_part(TagValue<ScratchFloats>{}),
    key_part(Publishes<LegPost>{}),
    key_part(Shared<MuscleTemplate>{}),
    key_part(Shared<MuscleLines>{}),
    key_part(Shared<BellySolver>{}),
    key_part(Shared<ReducedBasis>{}),
};

tl::unexpected<Error> damaged(const char* what) {
  return fail(std::string("the snapshot does not agree with itself (") + what + "); give one that `save` made");
}

bool has_all(const SavedWorld& world, std::uint32_t table, std::initializer_list<std::uint64_t> ids) {
  return std::all_of(ids.begin(), ids.end(), [&](std::uint64_t id) { return world.part(table, id).has_value(); });
}

TableFacts facts_of(const SavedFront& front, const SavedWorld& world, std::uint32_t table) {
  TableFacts facts{};
  const bool person = has_all(world, table, {type_id<BodySize<float>>(), type_id<Pose<float>>()});
  facts.walker =
      person && has_all(world, table,
                        {type_id<Gait<float>>(), type_id<StepPlan<float>>(), type_id<GaitState<float>>(),
                         type_id<JointAngles<float>>(), type_id<Feet<float>>(), type_id<CentreOfMass<float>>()});
  facts.posed = person && !world.part(table, type_id<Gait<float>>());
  facts.owner_column = world.column(table, type_id<MuscleOwner<float>>());
  facts.muscle = most_muscles;
  const auto lines = world.part(table, type_id<MuscleLines>());
  if (!lines) return facts;
  if (const auto resource = find_resource(front, lines->value)) facts.muscle = resource->recipe.muscle;
  return facts;
}

/// Sides that lists are read by, those of the lanes without a row too.
bool sides_are_sound(const SavedWorld& world, std::uint32_t table, std::uint32_t owner_column) {
  const auto lanes = static_cast<std::uint32_t>((world.tables[table].rows + lane_count - 1) / lane_count * lane_count);
  std::uint32_t all = 0;
  for (std::uint32_t row = 0; row < lanes; ++row) all |= world.word(table, row, owner_column + 2);
  return all <= 1;
}

bool tiers_are_sound(const SavedWorld& world, std::uint32_t table, std::uint32_t column) {
  constexpr auto words = static_cast<std::uint32_t>(ComponentLayout<Tiers>::words);
  for (std::uint32_t row = 0; row < world.tables[table].rows; ++row) {
    std::array<std::uint32_t, words> word;
    for (std::uint32_t w = 0; w < words; ++w) word[w] = world.word(table, row, column + w);
    const auto tiers = std::bit_cast<Tiers<float>>(word);
    for (std::uint32_t m = 0; m < most_muscles; ++m) {
      const std::uint32_t rung = rung_at(tiers.rung, m), goal = rung_at(tiers.goal, m);
      if ((rung >= rung_count && rung < refused_rung) || (goal >= rung_count && goal < refused_rung)) return false;
    }
    if (tiers.view >= view_name.size() || tiers.speed_step >= RungLadder::speed_steps) return false;
  }
  return true;
}

bool same_body(const SavedPerson& saved, const BodyRequest& body) {
  const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
  return saved.height == bits(body.height_m) && saved.mass == bits(body.mass_kg) &&
         saved.endo == bits(body.biotype.endo) && saved.meso == bits(body.biotype.meso) &&
         saved.ecto == bits(body.biotype.ecto) && saved.constitution == static_cast<std::uint32_t>(body.constitution);
}

bool can_live(const SavedPerson& saved, const People& present) {
  const PersonRecord* now = present.find({saved.index, saved.generation});
  if (now != nullptr && same_body(saved, now->body)) return true;
  if (saved.constitution > static_cast<std::uint32_t>(Constitution::heavy)) return false;
  const auto number = [](std::uint32_t bits) { return std::bit_cast<float>(bits); };
  return make_body({number(saved.height),
                    number(saved.mass),
                    {number(saved.endo), number(saved.meso), number(saved.ecto)},
                    static_cast<Constitution>(saved.constitution)})
      .has_value();
}

/// One of a person's muscles, as far as it is alive.
bool is_theirs(const SavedWorld& world, const std::vector<TableFacts>& facts, const SavedMuscle& muscle,
               std::uint32_t side, const SavedPerson& person) {
  const auto slot = world.find(muscle.entity[side]);
  if (!slot) return true;
  const TableFacts& table = facts[slot->table];
  if (table.owner_column == Table::no_column || table.muscle != muscle.muscle) return false;
  const auto word = [&](std::uint32_t w) { return world.word(slot->table, slot->row, table.owner_column + w); };
  return word(0) == person.index && word(1) == person.generation && word(2) == side;
}

}  // namespace

std::span<const KeyPart> front_parts() {
  return known_parts;
}

Result<void> check_people(const SavedFront& front, const SavedWorld& world, const People& present,
                          std::vector<TableFacts>& facts) {
  facts.clear();
  for (std::uint32_t t = 0; t < world.tables.size(); ++t) {
    for (const KeyPart& known : known_parts) {  // before anything is read by them
      const auto part = world.part(t, known.id);
      if (part &&
          (part->kind != static_cast<std::uint32_t>(known.kind) ||
           ((known.kind == PartKind::component || known.kind == PartKind::published) && part->value != known.value))) {
        return fail("the snapshot's " + std::string(known.name) +
                    " is laid out otherwise than this program's; restore it with the program that made it");
      }
    }
    facts.push_back(facts_of(front, world, t));
    const std::uint32_t tiers = world.column(t, type_id<Tiers<float>>());
    if (facts.back().owner_column != Table::no_column && !sides_are_sound(world, t, facts.back().owner_column))
      return damaged("the side of a muscle");
    if (tiers != Table::no_column && !tiers_are_sound(world, t, tiers)) return damaged("a choice of methods");
  }
  for (std::size_t i = 0; i < front.choices.size(); ++i) {
    if (!unpack(front.choices[i])) return damaged("a choice of muscles");
  }
  std::uint64_t muscle = 0;
  for (std::size_t i = 0; i < front.people.size(); ++i) {
    const SavedPerson person = front.people[i];
    const auto slot = world.find({person.index, person.generation});
    if (!slot || person.posed > 1 || !(person.posed != 0 ? facts[slot->table].posed : facts[slot->table].walker) ||
        person.choice >= front.choices.size()) {
      return damaged("a person");
    }
    if (!can_live(person, present)) return damaged("a person's body");
    if (person.muscles > muscles().size() || muscle + person.muscles > front.muscles.size())
      return damaged("how many muscles a person has");
    std::uint32_t least = 0;
    for (std::uint32_t m = 0; m < person.muscles; ++m) {
      const SavedMuscle own = front.muscles[muscle++];
      if (own.muscle < least || own.muscle >= muscles().size() || !unpack(own.method) ||
          !is_theirs(world, facts, own, right, person) || !is_theirs(world, facts, own, left, person)) {
        return damaged("a person's muscle");
      }
      least = own.muscle + 1;
    }
  }
  if (muscle != front.muscles.size()) return damaged("the number of muscles");
  return {};
}

Result<void> check_key(const TableKey& key, const World& world, const ResourceList& resources) {
  const auto words = [&]<class Tag>(Tag) {
    const KeyPart* part = find_part(key, type_id<Tag>());
    return part == nullptr ? 0 : part->value;
  };
  const auto has = [&]<class... T>(T*...) { return (... && (find_part(key, type_id<T>()) != nullptr)); };
  const auto resource = [&]<class T>(T*) -> const T* {
    const KeyPart* part = find_part(key, type_id<T>());
    return part == nullptr ? nullptr : static_cast<const T*>(world.resource(part->value));
  };
  const auto recipe = [&](std::uint64_t id) { return resources.known()[find_part(key, id)->value].recipe; };
  const auto* shape = resource(static_cast<MuscleTemplate*>(nullptr));
  const auto* solver = resource(static_cast<BellySolver*>(nullptr));
  const auto* basis = resource(static_cast<ReducedBasis*>(nullptr));
  const auto wrong = damaged("the parts of a muscle");

  std::uint32_t muscle = most_muscles;
  for (const KeyPart& part : key) {
    if (part.kind != PartKind::shared) continue;
    const std::uint32_t of = resources.known()[part.value].recipe.muscle;
    if (muscle != most_muscles && of != muscle) return wrong;
    muscle = of;
  }
  const std::uint64_t nodal = words(NodalDisplacement{}), steps = words(Substeps{}), solved = words(SolvedSteps{}),
                      still = words(StaticSteps{}), scratch = words(ScratchFloats{});
  const auto fits = [](std::uint64_t actual, std::uint64_t due) { return actual == 0 || actual == due; };
  const bool held = has(static_cast<EndDisplacement<float>*>(nullptr)),
             pulled = has(static_cast<EndForce<float>*>(nullptr));
  const auto ends_as = [&](FarEnd end) { return held != pulled && held == (end == FarEnd::held); };

  if (nodal != (shape == nullptr ? 0 : nodal_width(shape->mesh.cells))) return wrong;
  if (!fits(words(NodalVelocity{}), nodal) || !fits(words(ShownDisplacement{}), nodal) ||
      !fits(words(FadeStart{}), 2 * nodal)) {
    return wrong;
  }
  if (shape != nullptr && !ends_as(shape->options.far_end)) return wrong;
  if (int{steps != 0} + int{solved != 0} + int{still != 0} + int{basis != nullptr} !=
      int{shape != nullptr || basis != nullptr})
    return wrong;
  if (std::max({steps, solved, still}) > most_steps) return wrong;
  const bool stepped = steps != 0 || solved != 0 || still != 0;
  if (stepped) {
    const Method method = steps != 0 ? Method::ecd : solver != nullptr ? solver->method : Method::none;
    if ((solver != nullptr) != (steps == 0) || scratch != scratch_floats(*shape, method)) return wrong;
    if (solver != nullptr) {
      if ((still != 0) != (method == Method::statics)) return wrong;
      if (!(recipe(type_id<BellySolver>()).choice == recipe(type_id<MuscleTemplate>()).choice)) return wrong;
    }
    if (still == 0 && words(NodalVelocity{}) != nodal) return wrong;
  } else if (scratch != 0 || solver != nullptr) {
    return wrong;
  }
  const std::uint64_t state = words(ReducedState{}), motion = words(ReducedMotion{}), bent = words(ReducedShape{});
  if (basis == nullptr) {
    if (state != 0 || motion != 0 || bent != 0) return wrong;
    return {};
  }
  const bool feels = has(static_cast<FrameLoad<float>*>(nullptr)),
             reports = has(static_cast<BellyReport<float>*>(nullptr));
  if (!fits(state, reduced_state_width(basis->vectors)) ||
      !fits(motion, reduced_motion_width(basis->vectors, basis->inputs)) ||
      !fits(bent, reduced_shape_width(basis->vectors, basis->inputs)) || !ends_as(basis->options.far_end) ||
      (state == 0) != (words(ReducedStatic{}) != 0) || (state != 0 && motion == 0) ||
      (bent == 0) != (shape == nullptr) || (shape != nullptr && basis->options.control_cells != shape->mesh.cells) ||
      (basis->options.frame_loads && !feels && (state != 0 || bent != 0)) ||
      (reports && basis->inputs > 1 && motion == 0)) {
    return wrong;
  }
  return {};
}

}  // namespace mobil
