#include "systems/muscles/muscle_parts.h"

#include <algorithm>
#include <array>
#include <string>

#include <mobil/components/fade.h>
#include <mobil/components/sleep.h>
#include <mobil/schedule.h>
#include "engine/fetch_ahead.h"
#include "engine/snapshot.h"
#include "systems/bellies/leg_muscles_io.h"
#include "systems/deformation/fade.h"
#include "systems/lines/line_of_action.h"
#include "systems/muscles/finite_shape_effect.h"
#include "systems/muscles/muscle_effect.h"
#include "systems/muscles/owner_legs.h"

namespace mobil::inline v0_3 {
namespace {

void follow_lines(LegsOfOwners posts, const MuscleOwner<Lanes<float>>& owner, Ahead<MuscleOwner> ahead,
                  Shared<MuscleLines> lines, TagValue<FarEnd> far_end, const LegScale<Lanes<float>>& scale,
                  Ahead<LegScale> next_scale, LineOfAction<Lanes<float>>& line, Ahead<LineOfAction> next_line,
                  EndDrive<Lanes<float>>& end, Ahead<EndDrive> next_end, MaybeField<MemberLength> member,
                  Later<ModalState> state, Later<ModalMotion> motion) {
  FetchAhead(next_scale.block).fetch(all_lines);
  FetchAhead(next_line.block).fetch(all_lines);
  FetchAhead(next_end.block).fetch(all_lines);
  // Modal muscles have too little work of their own to hide the latency of memory.
  std::array later = {FetchAhead(state.data, std::size_t{state.words} * sizeof(Lanes<float>)),
                      FetchAhead(motion.data, std::size_t{motion.words} * sizeof(Lanes<float>))};
  lines_of_action(*lines, scale, legs_of(posts, owner, ahead), static_cast<FarEnd>(far_end.value), line, end,
                  reinterpret_cast<Lanes<float>*>(member.data), later);
}

void fade(const Table& table, float tick_s, Field<const NodalDisplacement> displacement, Field<const FadeStart> start,
          Fade<Lanes<float>>& since, Field<ShownDisplacement> shown) {
  const float* const before = shows_apart(table.key()) ? shown.data : displacement.data;
  fade_out(before, start.data, displacement.words, since, shown.data, tick_s);
}

Result<void> check_key(const Archetype& key, const World& world) {
  const auto is_ours = [](const ComponentId& part) { return std::ranges::binary_search(muscle_part_ids(), part.id); };
  const bool ours = std::ranges::any_of(key, is_ours);
  // The choice of muscles that do not exist yet is kept on the person's row.
  const bool person = (find_component(key, type_id<Asleep<float>>()) != nullptr ||
                       find_component(key, type_id<Physique<float>>()) != nullptr) &&
                      find_component(key, type_id<LegMuscles>()) != nullptr && std::ranges::count_if(key, is_ours) == 1;
  if (!ours || person || muscle_kind(key, world)) return {};
  return damaged("the parts of a muscle");
}

/// Checks sides, which index arrays, also in lanes without a row.
Result<void> check_rows(const SavedWorld& saved, std::uint32_t table) {
  const std::uint32_t owner = saved.column(table, type_id<MuscleOwner<float>>());
  if (owner == Table::no_column) return {};
  const auto lanes = static_cast<std::uint32_t>((saved.tables[table].rows + lane_count - 1) / lane_count * lane_count);
  std::uint32_t all = 0;
  for (std::uint32_t row = 0; row < lanes; ++row) all |= saved.word(table, row, owner + 2);
  if (all <= 1) return {};
  return damaged("the side of a muscle");
}

/// Returns the kind that an archetype's tags and resources describe; nothing if they do not describe a muscle.
std::optional<MuscleKind> recognised(const Archetype& key, const World& world) {
  const auto has = [&](std::uint64_t id) { return find_component(key, id) != nullptr; };
  const auto shared = [&]<class T>(Shared<T>& to) {
    if (const ComponentId* const part = find_component(key, type_id<T>()))
      to = {static_cast<const T*>(world.resource(part->value)), part->value};
  };
  const ComponentId* const muscle = find_component(key, type_id<Muscle>());
  const ComponentId* const far_end = find_component(key, type_id<FarEnd>());
  if (muscle == nullptr || far_end == nullptr || muscle->value >= max_muscles) return std::nullopt;
  if (far_end->value > static_cast<std::uint64_t>(FarEnd::sliding)) return std::nullopt;
  MuscleKind kind;
  kind.muscle = static_cast<Muscle>(muscle->value);
  kind.far_end = static_cast<FarEnd>(far_end->value);
  kind.inertia = has(type_id<FrameLoad<float>>());
  kind.line_motion = has(type_id<LineMotion<float>>());
  if (const ComponentId* const source = find_component(key, type_id<ExcitationSource>())) {
    if (source->value < 1 || source->value >= excitation_source_name.size()) return std::nullopt;
    kind.activation = static_cast<ExcitationSource>(source->value);
  }
  kind.fading = has(type_id<Fade<float>>());
  shared(kind.choice);
  shared(kind.lines);
  shared(kind.shape);
  shared(kind.solver);
  shared(kind.basis);
  shared(kind.finite);
  if (kind.lines.resource == nullptr || kind.choice.resource == nullptr) return std::nullopt;
  kind.method.method = Method::none;
  for (const DeformationMethod& method : deformation_methods()) {
    if (method.recognise(key, kind)) break;
  }
  LegMuscles choice = *kind.choice;
  choice.method = kind.method.method;
  choice.modal = kind.method.modal;
  kind.method.modal.linear_shape =
      choice.method == Method::modal && has_finite_shape(choice) && kind.finite.resource == nullptr;
  return kind;
}

/// Returns true if the shared resources fit the kind and each other.
bool fits_together(const MuscleKind& kind) {
  const auto* shape = kind.shape.resource;
  const auto* basis = kind.basis.resource;
  if (kind.steps < 1 || kind.steps > max_steps) return false;
  if (shape != nullptr && shape->options.far_end != kind.far_end) return false;
  const auto* finite = kind.finite.resource;
  if (kind.activation != ExcitationSource::none && kind.far_end != FarEnd::held) return false;
  if (is_tuned(kind.method) && kind.activation == ExcitationSource::none) return false;
  if (finite != nullptr && (shape == nullptr || finite->cells != shape->mesh.cells || kind.far_end != FarEnd::held))
    return false;
  if (basis == nullptr) return true;
  return basis->options.far_end == kind.far_end && (!basis->options.frame_loads || kind.inertia) &&
         (shape == nullptr || basis->options.control_cells == shape->mesh.cells);
}

bool same_parts(std::vector<ComponentId> due, const Archetype& key) {
  std::ranges::sort(due, {}, &ComponentId::id);
  std::vector<ComponentId> there;
  std::ranges::copy_if(key, std::back_inserter(there),
                       [](const ComponentId& part) { return std::ranges::binary_search(muscle_part_ids(), part.id); });
  return due == there;
}

}  // namespace

Module muscles_module() {
  return {.name = "muscles",
          .parts = {component_id<MuscleOwner>(), component_id<LegScale>(), component_id<LineOfAction>(),
                    component_id<EndDrive>(), component_id(TagValue<FarEnd>{}), component_id(TagValue<Muscle>{}),
                    component_id(Shared<LegMuscles>{}), component_id(Shared<MuscleLines>{}), component_id<BellyScale>(),
                    component_id(Shared<MuscleTemplate>{}), component_id(FieldWidth<NodalDisplacement>{}),
                    component_id<BellyReport>(), component_id(TagValue<ScratchFloats>{})},
          .systems = [](ScheduleBuilder& systems) { systems.add("lines of action", &follow_lines); },
          .check_key = &check_key,
          .check_rows = &check_rows};
}

Module fade_module() {
  return {.name = "fade",
          .parts = {component_id<Fade>(), component_id(FieldWidth<FadeStart>{}),
                    component_id(FieldWidth<ShownDisplacement>{})},
          .systems = [](ScheduleBuilder& systems) { systems.add("fade", &fade).after("finite shape"); },
          .after = {{"faded muscles", [](const Frame& frame) {
                       end_fades(frame.world, frame.tick.dt_s, frame.workspace.get<MuscleWork>());
                     }}}};
}

std::vector<Module> muscle_modules() {
  std::vector<Module> all = {muscles_module()};
  for (const MuscleEffect& effect : muscle_effects()) all.push_back(effect.module());
  for (const DeformationMethod& method : deformation_methods()) {
    if (method.module != nullptr) all.push_back(method.module());
  }
  all.push_back(fade_module());
  return all;
}

MuscleKind kind_of(World& world, BellyLibrary& library, Muscle muscle, const LegMuscles& choice,
                   const SharedBelly& belly) {
  MuscleKind kind;
  kind.muscle = muscle;
  kind.method = {choice.method, choice.modal};
  kind.far_end = far_end_of(choice);
  kind.inertia = feels_frame(choice);
  kind.line_motion = choice.line_motion;
  kind.activation = choice.activation;
  kind.steps = belly.steps;
  const auto kept = library.choice(choice);
  kind.choice = world.share(kept, hash_of(*kept));
  kind.lines = world.share(belly.shape->lines);
  if (has_control_points(choice)) kind.shape = world.share(belly.shape->shape);
  if (belly.solver != nullptr) kind.solver = world.share(belly.solver);
  if (belly.basis != nullptr) kind.basis = world.share(belly.basis);
  if (belly.finite != nullptr && has_finite_shape(choice)) kind.finite = world.share(belly.finite);
  return kind;
}

std::vector<ComponentId> muscle_parts(const MuscleKind& kind) {
  std::vector<ComponentId> parts = {component_id<MuscleOwner>(),
                                    component_id<LegScale>(),
                                    component_id<LineOfAction>(),
                                    component_id<EndDrive>(),
                                    component_id(TagValue<FarEnd>{static_cast<std::uint64_t>(kind.far_end)}),
                                    component_id(TagValue<Muscle>{static_cast<std::uint64_t>(kind.muscle)}),
                                    component_id(kind.choice),
                                    component_id(kind.lines)};
  if (const DeformationMethod* const method = deformation_method(kind.method.method)) {
    parts.push_back(component_id<BellyScale>());
    method->parts(kind, parts);
  }
  if (kind.shape.resource != nullptr) {
    const auto width = static_cast<std::uint32_t>(nodal_width(kind.shape->mesh.cells));
    parts.push_back(component_id(kind.shape));
    parts.push_back(component_id(FieldWidth<NodalDisplacement>{width}));
    if (kind.method.method != Method::modal || kind.method.modal.reported) {
      parts.push_back(component_id<BellyReport>());
    }
    if (kind.fading) {
      parts.push_back(component_id<Fade>());
      parts.push_back(component_id(FieldWidth<FadeStart>{2 * width}));
    }
    if (kind.fading || shows_apart(kind)) parts.push_back(component_id(FieldWidth<ShownDisplacement>{width}));
  }
  for (const MuscleEffect& effect : muscle_effects()) {
    if (effect.wanted(kind)) effect.parts(kind, parts);
  }
  return parts;
}

std::optional<MuscleKind> muscle_kind(const Archetype& key, const World& world) {
  const auto kind = recognised(key, world);
  if (!kind || !fits_together(*kind) || !same_parts(muscle_parts(*kind), key)) return std::nullopt;
  return kind;
}

MuscleMethod muscle_method(const World& world, Entity muscle) {
  const auto place = world.find(muscle);
  const auto kind = place ? recognised(place.table->key(), world) : std::nullopt;
  return kind ? kind->method : MuscleMethod{Method::none};
}

std::optional<MuscleKind> muscle_kind(const World& world, Entity muscle) {
  const auto place = world.find(muscle);
  return place ? muscle_kind(place.table->key(), world) : std::nullopt;
}

std::span<const std::uint64_t> muscle_part_ids() {
  static const std::vector<std::uint64_t> ids = [] {
    std::vector<std::uint64_t> all;
    for (const Module& module : muscle_modules()) {
      for (const ComponentId& part : module.parts) all.push_back(part.id);
    }
    std::ranges::sort(all);
    return all;
  }();
  return ids;
}

}  // namespace mobil::inline v0_3
