// People: bodies, walks, positions and states.

#include <algorithm>
#include <array>
#include <cmath>

#include <mobil/anthropometry.h>
#include <mobil/components/avoidance.h>
#include <mobil/components/compact.h>
#include <mobil/components/footing.h>
#include <mobil/components/lod.h>
#include <mobil/components/sleep.h>
#include <mobil/forces.h>
#include <mobil/systems/people/step_log.h>
#include <mobil/usual_gait.h>
#include "systems/c/c_call.h"
#include "systems/people/fat_wobble.h"
#include "systems/people/ground_forces.h"
#include "systems/people/person_requests.h"
#include "systems/states/sleep.h"

namespace {

using namespace mobil;
using namespace mobil::c;

constexpr int all_of_a_walk = MOBIL_SPEED | MOBIL_STEP_LENGTH | MOBIL_STEP_FREQUENCY | MOBIL_STYLE | MOBIL_HEADING;

/// Replaces the defaults of a style by the caller's numbers.
int style_of(Line& line, const float* style, std::size_t count, GaitStyle& out) {
  if (count == 0) return MOBIL_OK;
  if (style == nullptr) return line.refuse_null("style");
  if (count > gait_parameters.size())
    return line.refuse(MOBIL_REFUSED,
                       fmt::format("a style of {} numbers; there are {}", count, gait_parameters.size()));
  for (std::size_t i = 0; i < count; ++i) out.*gait_parameters[i].value = style[i];
  return MOBIL_OK;
}

int check_given(Line& line, int given) {
  if ((given & ~all_of_a_walk) == 0) return MOBIL_OK;
  return line.refuse(MOBIL_REFUSED, fmt::format("given {:#x} has bits that are none of MOBIL_SPEED, …", given));
}

/// Sets the given ones of speed, step length and step frequency in a GaitRequest or a GaitChange.
template <class From, class To>
void say_pace(const From& from, To& to) {
  if ((from.given & MOBIL_SPEED) != 0) to.speed_m_s = from.speed_m_s;
  if ((from.given & MOBIL_STEP_LENGTH) != 0) to.step_length_m = from.step_length_m;
  if ((from.given & MOBIL_STEP_FREQUENCY) != 0) to.step_frequency_hz = from.step_frequency_hz;
}

// New fields must not be in the padding of older structs.
static_assert(sizeof(void*) != 8 || (offsetof(mobil_person, sex) >= 88 && offsetof(mobil_person, age_y) >= 96));

int request_of(mobil_sim& sim, const mobil_person& person, SpawnRequest& to) {
  Line& line = sim.line;
  to.body.height_m = person.height_m;
  to.body.mass_kg = person.mass_kg;
  to.body.biotype = {person.endo, person.meso, person.ecto};
  if (const int code = one_of(line, person.constitution, Constitution::heavy, "constitution", to.body.constitution))
    return code;
  if (const int code = one_of(line, person.sex, Sex::woman, "sex", to.body.sex)) return code;
  to.body.age_y = person.age_y == 0 ? usual_age_y : person.age_y;
  if (const int code = check_given(line, person.given)) return code;
  say_pace(person, to.gait);
  if (const int code = style_of(line, person.style, person.style_count, to.gait.style)) return code;
  const Vec3<float> at = sim.axes.place_from(person.place);
  to.x_m = at.x;
  to.z_m = at.z;
  to.heading_rad = person.heading_rad;
  return MOBIL_OK;
}

/// Spawns posed people one by one. If one is refused, removes those before.
int spawn_posed(mobil_sim& sim, std::span<const SpawnRequest> asked, const LegMuscles* muscles, mobil_id* out) {
  Simulation& world = sim.world();
  sim.people.clear();
  sim.people.reserve(asked.size());
  const auto undo = [&] { (void)world.despawn(sim.people); };
  try {
    for (std::size_t i = 0; i < asked.size(); ++i) {
      check_interrupt();
      const auto person = world.spawn_posed(asked[i].body);
      if (person) sim.people.push_back(*person);
      auto done = person ? Result<void>{} : Result<void>(tl::unexpected(person.error()));
      if (done && muscles != nullptr) done = world.set_muscles(*person, *muscles);
      if (done) continue;
      undo();
      return sim.line.refuse(done.error(), person_number(i));
    }
  } catch (...) {
    undo();
    throw;
  }
  for (std::size_t i = 0; i < asked.size(); ++i) out[i] = id_of(sim.people[i]);
  return MOBIL_OK;
}

int change_of(Line& line, const mobil_walk& walk, std::size_t person, WalkChange& to) {
  if (const int code = check_given(line, walk.given)) return code;
  if ((walk.given & ~MOBIL_HEADING) != 0) {
    to.gait.emplace();
    say_pace(walk, *to.gait);
    if ((walk.given & MOBIL_STYLE) != 0) {
      if (const int code = style_of(line, walk.style, walk.style_count, to.gait->style.emplace())) return code;
    }
  }
  if ((walk.given & MOBIL_HEADING) == 0) return MOBIL_OK;
  if (!(std::fabs(walk.heading_rad) < 1e4F))
    return line.refuse(MOBIL_REFUSED, fmt::format("person {}: a heading of {} rad; choose one within 10000", person,
                                                  walk.heading_rad));
  to.heading_rad = walk.heading_rad;
  return MOBIL_OK;
}

/// Changes the walks of people, all or none.
int change_all(mobil_sim& sim, std::span<const WalkChange> changes) {
  Simulation& world = sim.world();
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const WalkChange& change = changes[i];
    const auto possible = changed_gait(world.world(), change.person, change.gait.value_or(GaitChange{}));
    if (!possible) return sim.line.refuse(possible.error(), person_number(i));
  }
  const auto done = world.change_gait(changes);
  return done ? int{MOBIL_OK} : sim.line.refuse(done.error());
}

Pose<float> pose_from(const HostAxes& axes, const float* given) {
  Pose<float> pose;
  for (std::size_t s = 0; s < segment_count; ++s, given += 7) {
    pose.position_m[s] = axes.place_from(given);
    const Quat<double> q = rotation_from(axes.axes, {given[3], given[4], given[5], given[6]});
    pose.rotation[s] = {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
                        static_cast<float>(q.w)};
  }
  return pose;
}

// In the order of PersonState.
constexpr std::array<int, 4> state_numbers = {MOBIL_FULL, MOBIL_COMPACT, MOBIL_ASLEEP, MOBIL_POSED};

}  // namespace

int mobil_style(int number, mobil_style_number* out) {
  if (out == nullptr) return MOBIL_REFUSED;
  const auto at = static_cast<std::size_t>(number);
  if (number < 0 || at >= gait_parameters.size()) return MOBIL_MISSING;
  const GaitParameter& p = gait_parameters[at];
  *out = {p.name.data(), p.unit.data(), p.meaning.data(), p.low, p.high, GaitStyle{}.*p.value};
  return MOBIL_OK;
}

int mobil_typical_person(int sex, float age_y, float height_z, float mass_index_z, float* style, size_t room,
                         mobil_person* person) {
  if (person == nullptr || sex < MOBIL_MAN || sex > MOBIL_WOMAN) return MOBIL_REFUSED;
  if (person->size < offsetof(mobil_person, age_y) + sizeof(float)) return MOBIL_STRUCT;
  if (style != nullptr && room > gait_parameters.size()) return MOBIL_REFUSED;
  const BodyRequest body = typical_body(static_cast<Sex>(sex), age_y, height_z, mass_index_z);
  if (!check_body(body)) return MOBIL_REFUSED;
  person->sex = sex;
  person->age_y = body.age_y;
  person->height_m = body.height_m;
  person->mass_kg = body.mass_kg;
  person->given |= MOBIL_SPEED;
  person->speed_m_s = usual_speed_m_s(body);
  if (style == nullptr) return MOBIL_OK;
  const GaitStyle usual = usual_style(body);
  for (std::size_t i = 0; i < room; ++i) style[i] = usual.*gait_parameters[i].value;
  person->given |= MOBIL_STYLE;
  person->style = style;
  person->style_count = room;
  return MOBIL_OK;
}

int mobil_spawn(mobil_sim* sim, const mobil_person* people, size_t stride, size_t count, const mobil_muscles* muscles,
                mobil_id* out) {
  return call(sim, "mobil_spawn", [&](mobil_sim& s) {
    if (count == 0) return int{MOBIL_OK};
    if (out == nullptr) return s.line.refuse_null("out");
    if (const int code = struct_stride(s.line, people, count, "people", stride)) return code;
    std::optional<LegMuscles> choice;
    if (muscles != nullptr) {
      mobil_muscles known;
      if (const int code = read_struct(s.line, muscles, "muscles", known)) return code;
      if (const int code = leg_muscles(s.line, known, choice.emplace())) return code;
    }
    std::vector<SpawnRequest> asked(count);
    std::size_t posed = 0;
    for (std::size_t i = 0; i < count; ++i) {
      mobil_person person;
      if (const int code = read_struct(s.line, row_at(people, i, stride, 0), "people", person)) return code;
      if (const int code = request_of(s, person, asked[i])) return code;
      asked[i].muscles = choice;
      posed += person.posed != 0 ? 1 : 0;
    }
    if (posed == count) return spawn_posed(s, asked, choice ? &*choice : nullptr, out);
    if (posed != 0) return s.line.refuse(MOBIL_REFUSED, "walkers and posed people at once; spawn them in two calls");
    s.people.resize(count);
    const auto done = s.world().spawn(asked, s.people);
    if (!done) return s.line.refuse(done.error());
    for (std::size_t i = 0; i < count; ++i) out[i] = id_of(s.people[i]);
    return int{MOBIL_OK};
  });
}

int mobil_despawn(mobil_sim* sim, const mobil_id* ids, size_t count) {
  return call(sim, "mobil_despawn", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    return code_of(s.line, s.world().despawn(s.people));
  });
}

int mobil_people(mobil_sim* sim, mobil_id* out, size_t room, size_t* count) {
  return call(sim, "mobil_people", [&](mobil_sim& s) {
    const std::vector<Entity> all = s.world().people();
    if (count != nullptr) *count = all.size();
    if (out == nullptr && count != nullptr) return int{MOBIL_OK};
    if (out == nullptr) return s.line.refuse_null("out");
    if (room < all.size())
      return s.line.refuse(MOBIL_ROOM, fmt::format("there are {} people, and room for {}", all.size(), room));
    for (std::size_t i = 0; i < all.size(); ++i) out[i] = id_of(all[i]);
    return int{MOBIL_OK};
  });
}

int mobil_get_style(mobil_sim* sim, mobil_id id, float* out, size_t room) {
  return call(sim, "mobil_get_style", [&](mobil_sim& s) {
    const Entity person = entity_of(id);
    if (!s.world().is_person(person)) return s.line.refuse(Error{{}, Status::stale_entity});
    if (out == nullptr) return s.line.refuse_null("out");
    const auto gait = s.world().gait_request(person);
    if (!gait) return s.line.refuse(MOBIL_MISSING, "a posed person has no style; ask of a walker");
    if (room < gait_parameters.size()) {
      return s.line.refuse(
          MOBIL_ROOM, fmt::format("there is room for {} numbers, and a style has {}", room, gait_parameters.size()));
    }
    for (std::size_t i = 0; i < gait_parameters.size(); ++i) out[i] = gait->style.*gait_parameters[i].value;
    return int{MOBIL_OK};
  });
}

int mobil_get_person(mobil_sim* sim, mobil_id id, mobil_person* out) {
  return call(sim, "mobil_get_person", [&](mobil_sim& s) {
    const Simulation& world = s.world();
    const Entity person = entity_of(id);
    if (!world.is_person(person)) return s.line.refuse(Error{{}, Status::stale_entity});
    const BodyRequest body = body_request(world.world(), person);
    auto to = usual<mobil_person>();
    to.height_m = body.height_m;
    to.mass_kg = body.mass_kg;
    to.endo = body.biotype.endo;
    to.meso = body.biotype.meso;
    to.ecto = body.biotype.ecto;
    to.constitution = static_cast<int>(body.constitution);
    to.sex = static_cast<int>(body.sex);
    to.age_y = body.age_y;
    to.posed = is_posed(world.world(), person) ? 1 : 0;
    if (const auto gait = world.gait_request(person)) {
      to.given = MOBIL_SPEED | MOBIL_STEP_LENGTH | MOBIL_STEP_FREQUENCY;
      to.speed_m_s = gait->speed_m_s.value_or(0);
      to.step_length_m = gait->step_length_m.value_or(0);
      to.step_frequency_hz = gait->step_frequency_hz.value_or(0);
      if (to.speed_m_s == 0) to.given = MOBIL_SPEED;
    }
    if (const auto state = world.get<GaitState>(person)) {
      s.axes.place_to({state->line_x_m, 0, state->line_z_m}, to.place);
      to.heading_rad = state->heading_rad;
    } else if (const auto pose = world.get<Pose>(person)) {
      const Vec3<float> at = pose->position_m[index(Segment::pelvis)];
      s.axes.place_to({at.x, 0, at.z}, to.place);
    }
    return write_struct(s.line, to, out, "out");
  });
}

int mobil_has(mobil_sim* sim, mobil_id id, int* bits) {
  return call(sim, "mobil_has", [&](mobil_sim& s) {
    if (bits == nullptr) return s.line.refuse_null("bits");
    const World& world = s.world().world();
    const Entity person = entity_of(id);
    if (!s.world().is_person(person)) return s.line.refuse(Error{{}, Status::stale_entity});
    *bits = (has_any_muscles(world, person) ? MOBIL_HAS_MUSCLES : 0) |
            (has_forces(world, person) ? MOBIL_HAS_FORCES : 0) | (is_managed(world, person) ? MOBIL_MANAGED : 0) |
            (has_step_events(world, person) ? MOBIL_WATCHED : 0) |
            (world.has<AvoidanceState>(person) ? MOBIL_AVOIDS : 0) |
            (world.has<Footing>(person) ? MOBIL_ON_GROUND : 0) | (has_fat(world, person) ? MOBIL_HAS_FAT : 0);
    return int{MOBIL_OK};
  });
}

int mobil_get_state(mobil_sim* sim, mobil_id id, int* state) {
  return call(sim, "mobil_get_state", [&](mobil_sim& s) {
    if (state == nullptr) return s.line.refuse_null("state");
    const auto is = s.world().state(entity_of(id));
    if (!is) return s.line.refuse(Error{{}, Status::stale_entity});
    *state = state_numbers[static_cast<std::size_t>(*is)];
    return int{MOBIL_OK};
  });
}

int mobil_set_state(mobil_sim* sim, const mobil_id* ids, size_t count, int state, float within_m, size_t* changed) {
  return call(sim, "mobil_set_state", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    const auto to = std::ranges::find(state_numbers, state);
    if (to == state_numbers.end())
      return s.line.refuse(MOBIL_REFUSED,
                           fmt::format("state {}; choose MOBIL_FULL, MOBIL_COMPACT or MOBIL_ASLEEP", state));
    const auto done = s.world().set_state(s.people, static_cast<PersonState>(to - state_numbers.begin()), within_m);
    if (!done) return s.line.refuse(done.error());
    if (changed != nullptr) *changed = *done;
    return int{MOBIL_OK};
  });
}

int mobil_enable(mobil_sim* sim, const mobil_id* ids, size_t count, int feature, int on) {
  return call(sim, "mobil_enable", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    Feature what{};
    if (const int code = one_of(s.line, feature, Feature::forces, "feature", what)) return code;
    const auto done = s.world().enable(s.people, what, on != 0);
    if (!done && done.error().status == Status::missing)
      return s.line.refuse(MOBIL_MISSING, "one of them is posed and takes no steps; leave them out");
    return code_of(s.line, done);
  });
}

int mobil_change_walks(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_walk* walks, size_t stride) {
  return call(sim, "mobil_change_walks", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    if (const int code = struct_stride(s.line, walks, count, "walks", stride)) return code;
    std::vector<WalkChange> changes(count);
    for (std::size_t i = 0; i < count; ++i) {
      mobil_walk walk;
      if (const int code = read_struct(s.line, row_at(walks, i, stride, 0), "walks", walk)) return code;
      changes[i].person = s.people[i];
      if (const int code = change_of(s.line, walk, i, changes[i])) return code;
    }
    return change_all(s, changes);
  });
}

int mobil_change_walk(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_walk* walk) {
  return call(sim, "mobil_change_walk", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    mobil_walk known;
    if (const int code = read_struct(s.line, walk, "walk", known)) return code;
    WalkChange one;
    if (const int code = change_of(s.line, known, 0, one)) return code;
    std::vector<WalkChange> changes(count, one);
    for (std::size_t i = 0; i < count; ++i) changes[i].person = s.people[i];
    return change_all(s, changes);
  });
}

int mobil_step_aside(mobil_sim* sim, mobil_id id, float left_m, float ahead_m) {
  return call(sim, "mobil_step_aside", [&](mobil_sim& s) {
    const auto done = s.world().step_aside(entity_of(id), left_m, ahead_m);
    return done ? int{MOBIL_OK} : s.line.refuse(done.error());
  });
}

int mobil_place(mobil_sim* sim, mobil_id id, const float place[3], float heading_rad) {
  return call(sim, "mobil_place", [&](mobil_sim& s) {
    if (place == nullptr) return s.line.refuse_null("place");
    const Vec3<float> at = s.axes.place_from(place);
    const auto done = s.world().place(entity_of(id), at.x, at.z, heading_rad);
    return done ? int{MOBIL_OK} : s.line.refuse(done.error());
  });
}

int mobil_shift_origin(mobil_sim* sim, const float to[3]) {
  return call(sim, "mobil_shift_origin", [&](mobil_sim& s) {
    if (to == nullptr) return s.line.refuse_null("to");
    const Vec3<float> at = s.axes.place_from(to);
    const auto done = s.world().shift_origin(at.x, at.z);
    return done ? int{MOBIL_OK} : s.line.refuse(done.error());
  });
}

int mobil_set_poses(mobil_sim* sim, const mobil_id* ids, size_t count, const float* poses, size_t stride, int jumped) {
  return call(sim, "mobil_set_poses", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    if (const int code = row_stride(s.line, poses, count, std::size_t{7} * segment_count, "poses", stride)) return code;
    // The first pass checks all poses, the second sets them.
    for (const bool take : {false, true}) {
      for (std::size_t i = 0; i < count; ++i) {
        const Pose<float> pose = pose_from(s.axes, row_at(poses, i, stride, 0));
        const auto done = take ? s.world().set_pose(s.people[i], pose, jumped != 0 ? Arrival::jumped : Arrival::moved)
                               : check_pose(s.world().world(), s.people[i], pose);
        if (!done) return s.line.refuse(done.error(), person_number(i));
      }
    }
    return int{MOBIL_OK};
  });
}
