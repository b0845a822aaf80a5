#include "systems/states/compact.h"

#include <algorithm>
#include <array>
#include <tuple>

#include <mobil/components/compact.h>
#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include <mobil/components/leg_frames.h>
#include <mobil/components/pose.h>
#include <mobil/forces.h>
#include <mobil/rows.h>
#include "systems/lines/elongations.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/people/compact_pose.h"
#include "systems/states/compact_codes.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::uint8_t not_compact = 0xFF;

/// Returns the code of a muscle of that kind in a compact row, or not_compact if it cannot be in one.
std::uint8_t code_of(const MuscleKind& kind) {
  const ModalOptions& modal = kind.method.modal;
  const bool plain = !kind.inertia && !kind.line_motion && kind.activation == ExcitationSource::none && !kind.fading &&
                     kind.far_end == FarEnd::held && kind.choice->drive == Drive::displacement;
  if (!plain) return not_compact;
  if (kind.method.method == Method::none) return compact_none;
  if (kind.method.method != Method::modal || modal.control_points) return not_compact;
  if (!modal.moving) {
    return modal.modes == ModalOptions{}.modes ? static_cast<std::uint8_t>(compact_static) : not_compact;
  }
  return modal.modes < compact_static ? static_cast<std::uint8_t>(modal.modes) : not_compact;
}

MuscleMethod method_of(std::uint32_t code, const ModalOptions& mesh) {
  if (code == compact_none) return {Method::none, {}};
  ModalOptions modal = mesh;
  modal.moving = code != compact_static;
  if (modal.moving) modal.modes = code;
  return {Method::modal, modal};
}

/// Returns the part of a choice that is kept: everything except the methods, which the codes store.
LegMuscles kept_of(const LegMuscles& tissue, const std::optional<ModalOptions>& mesh, MuscleSet muscles) {
  LegMuscles kept = tissue;
  kept.muscles = muscles;
  kept.method = Method::none;
  kept.modal = {.control_points = false, .reported = false};
  if (!mesh) return kept;
  kept.modal.corrected = mesh->corrected;
  kept.modal.cells = mesh->cells;
  return kept;
}

/// Returns the kind of a table's muscles.
const CompactWork::Known& known_of(const World& world, std::uint32_t table, CompactWork& work) {
  if (work.known.size() < world.tables().size()) work.known.resize(world.tables().size());
  CompactWork::Known& known = work.known[table];
  if (known.looked) return known;
  known.looked = true;
  known.code = not_compact;
  const Archetype& key = world.tables()[table].key();
  const auto kind = muscle_kind(key, world);
  // A host's own component would be lost.
  if (!kind || key.size() != muscle_parts(*kind).size()) return known;
  known.code = code_of(*kind);
  known.number = static_cast<std::uint8_t>(kind->muscle);
  known.tissue = kind->choice.resource;
  known.mesh = kind->method.modal;
  return known;
}

bool same_mesh(const ModalOptions& a, const ModalOptions& b) {
  return a.corrected == b.corrected && a.cells == b.cells;
}

/// Lists a person and their muscles, if they can be compact.
void look_at(const MuscleScene& scene, Entity person, CompactWork& work) {
  const World& world = scene.world;
  const auto* const at = world.locate(person);
  if (at == nullptr || !world.has<Gait>(person) || !world.has<Pose>(person) || world.has<GroundReaction>(person) ||
      world.has<Footing>(person))
    return;
  const std::size_t first = work.muscles.size();
  bool fits = true;
  const LegMuscles* tissue = nullptr;
  std::optional<ModalOptions> mesh;
  MuscleSet set;
  world.each_member(person, [&](Entity member) {
    if (!world.has<MuscleOwner>(member)) return;
    const CompactWork::Known known = known_of(world, world.locate(member)->table, work);
    fits = fits && known.code != not_compact && (tissue == nullptr || tissue == known.tissue);
    tissue = known.tissue;
    if (known.code != compact_none && known.code != not_compact) {
      fits = fits && (!mesh || same_mesh(*mesh, known.mesh));
      mesh = known.mesh;
    }
    set.set(known.number);
    const auto side = static_cast<std::uint8_t>(world.get<MuscleOwner>(member)->side);
    work.muscles.push_back({member, known.number, side, known.code});
  });
  const auto own = std::span(work.muscles).subspan(first);
  const auto order = [](const CompactWork::Muscle& m) { return std::pair(m.number, m.side); };
  std::ranges::sort(own, {}, order);
  fits = fits && own.size() == 2 * set.count() && set.count() <= max_compact;
  std::uint64_t all = 0;
  for (std::size_t i = 0; fits && i < own.size(); i += 2) {
    fits = own[i].code == own[i + 1].code;
    all |= std::uint64_t{own[i].code} << (code_bits * (i / 2));
  }
  if (!fits) return work.muscles.resize(first);
  Shared<LegMuscles> kept{};
  if (tissue != nullptr) kept = keep_choice(scene.world, scene.library, kept_of(*tissue, mesh, set));
  work.people.push_back(
      {person, at->table, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(own.size()), all, kept});
}

/// Gathers sixteen-lane columns from the muscle rows of people of one kind.
void gather_compact(const World& world, std::span<const CompactWork::Person> people, const CompactLayout& width,
                    CompactWork& work) {
  const std::size_t blocks = (people.size() + lane_count - 1) / lane_count;
  work.state.assign(blocks * width.state, {});
  work.motion.assign(blocks * width.motion, {});
  for (std::size_t i = 0; i < blocks * lane_count; ++i) {
    const CompactWork::Person& person = people[std::min(i, people.size() - 1)];
    const std::size_t lane = i % lane_count, block = i / lane_count;
    const auto put = [&](std::vector<Lanes<float>>& column, std::uint32_t words, std::uint32_t word, float x) {
      column[block * words + word][lane] = x;
    };
    CompactLayout at;
    for (std::uint32_t m = 0; m < person.count; m += 2) {
      const CompactWork::Muscle& right = work.muscles[person.first + m];
      const LegScale<float> scale = *world.get<LegScale>(right.entity);
      put(work.motion, width.motion, 0, scale.thigh);
      put(work.motion, width.motion, 1, scale.shank);
      put(work.motion, width.motion, 2, scale.across);
      if (!moves(right.code)) continue;
      const std::uint32_t modes = right.code;
      for (std::uint32_t side = 0; side < 2; ++side) {
        const Entity muscle = work.muscles[person.first + m + side].entity;
        work.row.resize(std::size_t{2} * modes);
        world.get_field<ModalState>(muscle, work.row);
        const std::uint32_t first = at.state + side * (1 + 2 * modes);
        put(work.state, width.state, first, world.get<EndDrive>(muscle)->to);
        for (std::uint32_t w = 0; w < 2 * modes; ++w) put(work.state, width.state, first + 1 + w, work.row[w]);
      }
      const MuscleLines& lines = lines_of(static_cast<Muscle>(right.number));
      const double rest = double{world.get<LineOfAction>(right.entity)->rest_length_m};
      put(work.motion, width.motion, at.motion, static_cast<float>(rest - constant_length_m(lines, scale)));
      work.row.resize(std::size_t{3} * modes);
      world.get_field<ModalMotion>(right.entity, work.row);
      for (std::uint32_t w = 0; w < 3 * modes; ++w) put(work.motion, width.motion, at.motion + 1 + w, work.row[w]);
      at.skip(modes);
    }
  }
}

/// Makes people of one table, choice and kind of muscles compact.
void compact_alike(const MuscleScene& scene, std::span<const CompactWork::Person> people, CompactWork& work) {
  World& world = scene.world;
  const Shared<LegMuscles>& choice = people.front().choice;
  std::vector<std::uint64_t> owned(pose_part_ids().begin(), pose_part_ids().end());
  std::vector<PartValue> parts;
  if (choice.resource != nullptr) {
    const CompactLayout width = compact_width(people.front().codes);
    if (width.state > 0) {
      gather_compact(world, people, width, work);
      parts.push_back({component_id(FieldWidth<CompactState>{width.state}), work.state.data()});
      parts.push_back({component_id(FieldWidth<CompactMotion>{width.motion}), work.motion.data()});
    }
    parts.push_back(part_value(TagValue<CompactMuscles>{people.front().codes}));
    parts.push_back(part_value(choice));
    owned.push_back(type_id<LegMuscles>());
    for (const CompactWork::Person& person : people)
      for (std::uint32_t m = 0; m < person.count; ++m) work.rows.push_back(work.muscles[person.first + m].entity);
  }
  std::ranges::sort(owned);
  work.entities.clear();
  for (const CompactWork::Person& person : people) work.entities.push_back(person.entity);
  world.change_archetype(work.entities, parts, owned, scene.jobs);
}

/// Data of a compact person, read before the change to full.
struct Kept {
  std::uint64_t codes;
  const LegMuscles* choice;
  bool begun;  // has muscles; if not, the choice is kept for later
};
Kept kept_by(const World& world, Entity person) {
  const auto codes = world.get<CompactMuscles>(person);
  return {codes.value_or(0), world.shared<LegMuscles>(person), codes.has_value()};
}

constexpr std::array<std::uint64_t, 4> compact_part_ids() {
  std::array ids = {type_id<CompactState>(), type_id<CompactMotion>(), type_id<CompactMuscles>(),
                    type_id<LegMuscles>()};
  std::ranges::sort(ids);
  return ids;
}

/// Starts muscles of one choice and codes on people who are full again. `states`: their former fields, person by
/// person.
Result<void> begin_alike(const MuscleScene& scene, std::span<const Entity> people, const Kept& kept,
                         std::span<const float> states) {
  World& world = scene.world;
  const std::uint32_t width = compact_width(kept.codes).state;
  std::uint32_t begun = 0;  // a bit for each place
  std::array<std::uint8_t, max_compact> numbers{};
  std::size_t count = 0;
  for (std::size_t m = 0; m < kept.choice->muscles.size(); ++m)
    if (kept.choice->muscles[m]) numbers[count++] = static_cast<std::uint8_t>(m);
  for (std::size_t first = 0; first < count; ++first) {
    if ((begun >> first & 1U) != 0) continue;
    const std::uint32_t code = code_at(kept.codes, first);
    LegMuscles choice = *kept.choice;
    const MuscleMethod method = method_of(code, kept.choice->modal);
    choice.method = method.method;
    choice.modal = method.modal;
    choice.muscles.reset();
    for (std::size_t place = first; place < count; ++place) {
      if (code_at(kept.codes, place) != code) continue;
      begun |= 1U << place;
      choice.muscles.set(numbers[place]);
    }
    if (auto done = begin_leg_muscles(scene, people, choice); !done) return done;
  }
  for (std::size_t i = 0; i < people.size() && width > 0; ++i) {
    world.each_member(people[i], [&](Entity member) {
      const auto owner = world.get<MuscleOwner>(member);
      const auto number = world.get<Muscle>(member);
      if (!owner || !number) return;
      CompactLayout at;
      std::size_t place = 0;
      for (; numbers[place] != *number; ++place)
        if (const std::uint32_t code = code_at(kept.codes, place); moves(code)) at.skip(code);
      const std::uint32_t modes = code_at(kept.codes, place);
      if (!moves(modes)) return;
      const float* const own = &states[i * width + at.state + owner->side * (1 + 2 * modes)];
      world.set(member, EndDrive<float>{own[0], own[0]});
      world.set_field<ModalState>(member, std::span(own + 1, std::size_t{2} * modes));
    });
  }
  return {};
}

}  // namespace

std::size_t compact_people(const MuscleScene& scene, std::span<const Entity> people, CompactWork& work) {
  work.muscles.clear();
  work.people.clear();
  std::size_t compact = 0;
  for (const Entity person : people) {
    if (is_compact(scene.world, person)) ++compact;
    look_at(scene, person, work);
  }
  const auto order = [](const CompactWork::Person& p) {
    return std::tuple(p.table, p.codes, p.choice.resource == nullptr ? 0 : p.choice.index + 1);
  };
  std::ranges::stable_sort(work.people, {}, order);
  // Muscles are destroyed last: becoming compact allocates memory, and can be undone.
  work.rows.clear();
  World::Transaction transaction(scene.world, scene.jobs);
  for (auto first = work.people.begin(); first != work.people.end();) {
    const auto end = std::find_if(first, work.people.end(), [&](const auto& p) { return order(p) != order(*first); });
    compact_alike(scene, {first, end}, work);
    first = end;
  }
  transaction.commit();
  scene.world.destroy_many(work.rows, scene.jobs);
  if (!work.people.empty()) scene.work.recent = {};
  return compact + work.people.size();
}

Result<void> expand_people(const MuscleScene& scene, std::span<const Entity> people, CompactWork& work) {
  World& world = scene.world;
  work.entities.clear();
  for (const Entity person : people)
    if (is_compact(world, person)) work.entities.push_back(person);
  // People of one table have the same muscles.
  std::ranges::stable_sort(work.entities, {}, [&](Entity person) { return world.locate(person)->table; });
  for (std::span<const Entity> left = work.entities; !left.empty();) {
    const std::uint32_t table = world.locate(left.front())->table;
    std::size_t count = 1;
    while (count < left.size() && world.locate(left[count])->table == table) ++count;
    const auto some = left.first(count);
    left = left.subspan(count);
    const Kept kept = kept_by(world, some.front());
    const std::uint32_t width = compact_width(kept.codes).state;
    work.state_rows.resize(count * width);
    for (std::size_t i = 0; i < count && width > 0; ++i)
      world.get_field<CompactState>(some[i], std::span(work.state_rows).subspan(i * width, width));
    constexpr auto all = compact_part_ids();
    make_full(world, scene.jobs, some, std::span(all).first(kept.begun ? all.size() : 0), work.whole);
    if (!kept.begun) continue;
    if (auto done = begin_alike(scene, some, kept, work.state_rows); !done) return done;
  }
  return {};
}

MuscleMethod compact_method(const World& world, Entity person, Muscle muscle) {
  const auto* const choice = world.shared<LegMuscles>(person);
  const auto codes = world.get<CompactMuscles>(person);
  const auto number = static_cast<std::size_t>(muscle);
  if (choice == nullptr || !codes || number >= choice->muscles.size() || !choice->muscles[number])
    return {Method::none, {}};
  std::size_t place = 0;
  for (std::size_t m = 0; m < number; ++m) place += choice->muscles[m] ? 1 : 0;
  return method_of(code_at(*codes, place), choice->modal);
}

}  // namespace mobil::inline v0_3
