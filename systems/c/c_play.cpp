// Step events, root motion, present walks and placing of people.

#include <algorithm>
#include <string>

#include <mobil/step_report.h>
#include <mobil/systems/limits/limit_monitor.h>
#include <mobil/systems/poses/roots.h>
#include "systems/c/c_call.h"
#include "systems/people/person_requests.h"

namespace {

using namespace mobil;
using namespace mobil::c;

/// Converts a gait without its style.
mobil_walk walk_of(const Gait<float>& gait) {
  auto walk = usual<mobil_walk>();
  walk.given = gait.speed_m_s > 0 ? MOBIL_SPEED | MOBIL_STEP_LENGTH | MOBIL_HEADING : MOBIL_SPEED | MOBIL_HEADING;
  walk.speed_m_s = gait.speed_m_s;
  walk.step_length_m = gait.step_length_m;
  walk.step_frequency_hz = gait.step_frequency_hz;
  walk.heading_rad = gait.heading_rad;
  return walk;
}

const AxisMap& map_of(const HostAxes& axes) {
  return axes_of[static_cast<std::size_t>(axes.axes)];
}

Root root_from(const HostAxes& axes, const mobil_root& theirs) {
  const AxisMap& map = map_of(axes);
  double at[3] = {};
  for (std::size_t i = 0; i < 3; ++i)
    at[map.ours[i]] = double{map.sign[i]} * theirs.place[i] / double{axes.units_per_m};
  return {at[0], at[2], static_cast<float>(theirs.heading_rad)};
}

mobil_root root_to(const HostAxes& axes, const Root& ours) {
  mobil_root to{};
  const AxisMap& map = map_of(axes);
  const double at[3] = {ours.x_m, 0, ours.z_m};
  for (std::size_t i = 0; i < 3; ++i)
    to.place[i] = double{map.sign[i]} * double{axes.units_per_m} * at[map.ours[i]] + 0.0;  // no −0
  to.heading_rad = double{ours.heading_rad};
  return to;
}

/// Writes the roots of `sim.people` to `sim.roots`.
int read(mobil_sim& sim, double ahead_s) {
  sim.roots.resize(sim.people.size());
  const auto done = sim.world().roots(sim.people, sim.roots, ahead_s);
  return done ? int{MOBIL_OK} : sim.line.refuse(done.error());
}

}  // namespace

int mobil_get_walk(mobil_sim* sim, mobil_id id, mobil_walk* out, float* style, size_t room) {
  return call(sim, "mobil_get_walk", [&](mobil_sim& s) {
    const Entity person = entity_of(id);
    if (!s.world().is_person(person)) return s.line.refuse(Error{{}, Status::stale_entity});
    const auto gait = gait_of(s.world().world(), person);
    if (!gait) return s.line.refuse(MOBIL_MISSING, "a posed person does not walk; ask of a walker");
    if (style != nullptr && room < gait_parameters.size()) {
      return s.line.refuse(
          MOBIL_ROOM, fmt::format("there is room for {} numbers, and a style has {}", room, gait_parameters.size()));
    }
    mobil_walk walk = walk_of(*gait);
    const GaitStyle asked = gait->style;
    if (style != nullptr) {
      walk.given |= MOBIL_STYLE;
      walk.style = style;
      walk.style_count = gait_parameters.size();
    }
    if (const int code = write_struct(s.line, walk, out, "out")) return code;
    for (std::size_t i = 0; style != nullptr && i < gait_parameters.size(); ++i)
      style[i] = asked.*gait_parameters[i].value;
    return int{MOBIL_OK};
  });
}

int mobil_place_many(mobil_sim* sim, const mobil_id* ids, size_t count, const float* places, size_t stride) {
  return call(sim, "mobil_place_many", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    if (const int code = row_stride(s.line, places, count, 4, "places", stride)) return code;
    std::vector<PlaceRequest> to(count);
    for (std::size_t i = 0; i < count; ++i) {
      const float* const row = row_at(places, i, stride, 0);
      const Vec3<float> at = s.axes.place_from(row);
      to[i] = {s.people[i], at.x, at.z, row[3]};
    }
    const auto done = s.world().place(to);
    return done ? int{MOBIL_OK} : s.line.refuse(done.error());
  });
}

int mobil_events(mobil_sim* sim, mobil_event* out, size_t room, size_t* count) {
  return call(sim, "mobil_events", [&](mobil_sim& s) {
    const std::span<const StepEvent> events = s.world().events();
    if (count != nullptr) *count = events.size();
    if (out == nullptr && count != nullptr) return int{MOBIL_OK};
    if (out == nullptr) return s.line.refuse_null("out");
    if (room < events.size())
      return s.line.refuse(MOBIL_ROOM, fmt::format("there are {} events, and room for {}", events.size(), room));
    for (const StepEvent& event : events) {
      mobil_event& to = *out++;
      to.id = id_of(event.person);
      to.kind = static_cast<int>(event.kind);
      to.side = event.side == Side::right ? MOBIL_RIGHT : MOBIL_LEFT;
      to.tick = event.tick;
      to.part = event.part;
      s.axes.place_to(event.place_m, to.place);
      to.heading_rad = event.heading_rad;
    }
    return int{MOBIL_OK};
  });
}

int mobil_limit_violations(mobil_sim* sim, mobil_id id, char* text, size_t room, size_t* length) {
  return call(sim, "mobil_limit_violations", [&](mobil_sim& s) {
    const Entity person = entity_of(id);
    if (!s.world().is_person(person)) return s.line.refuse(Error{{}, Status::stale_entity});
    std::string lines;
    for (const LimitViolation& broken : limit_violations(s.world().world(), person)) lines += described(broken) + '\n';
    if (length != nullptr) *length = lines.size();
    if (text == nullptr && length != nullptr) return int{MOBIL_OK};
    if (text == nullptr) return s.line.refuse_null("text");
    if (room <= lines.size())
      return s.line.refuse(MOBIL_ROOM,
                           fmt::format("there are {} characters and a 0, and room for {}", lines.size(), room));
    std::copy_n(lines.c_str(), lines.size() + 1, text);
    return int{MOBIL_OK};
  });
}

int mobil_limit_violation_counts(mobil_sim* sim, size_t* people, size_t* all) {
  return call(sim, "mobil_limit_violation_counts", [&](mobil_sim& s) {
    if (people != nullptr) *people = static_cast<std::size_t>(s.world().report().limit_violations);
    if (all != nullptr) *all = static_cast<std::size_t>(s.world().report().total_limit_violations);
    return int{MOBIL_OK};
  });
}

int mobil_roots(mobil_sim* sim, const mobil_id* ids, size_t count, double ahead_s, mobil_root* out) {
  return call(sim, "mobil_roots", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    if (out == nullptr && count > 0) return s.line.refuse_null("out");
    if (const int code = read(s, ahead_s)) return code;
    for (std::size_t i = 0; i < count; ++i) out[i] = root_to(s.axes, s.roots[i]);
    return int{MOBIL_OK};
  });
}

int mobil_root_motion(mobil_sim* sim, const mobil_id* ids, size_t count, double ahead_s, mobil_root* roots,
                      mobil_motion* out) {
  return call(sim, "mobil_root_motion", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    if (roots == nullptr && count > 0) return s.line.refuse_null("roots");
    if (out == nullptr && count > 0) return s.line.refuse_null("out");
    if (const int code = read(s, ahead_s)) return code;
    for (std::size_t i = 0; i < count; ++i) {
      const RootMotion way = root_motion(root_from(s.axes, roots[i]), s.roots[i]);
      s.axes.place_to({way.left_m, 0, way.ahead_m}, out[i].way);
      out[i].turn_rad = way.turn_rad;
      roots[i] = root_to(s.axes, s.roots[i]);
    }
    return int{MOBIL_OK};
  });
}
