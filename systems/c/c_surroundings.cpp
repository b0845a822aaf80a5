// Collision avoidance, obstacles and ground.

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <mobil/components/avoidance.h>
#include <mobil/components/footing.h>
#include "systems/c/c_call.h"
#include "systems/people/group_by_table.h"
#include "systems/people/person_requests.h"

namespace {

using namespace mobil;
using namespace mobil::c;

/// Checks that all people can be managed or released, before any of them is.
int check_avoiders(mobil_sim& sim, bool on) {
  for (std::size_t i = 0; i < sim.people.size(); ++i) {
    const Entity person = sim.people[i];
    if (!sim.world().is_person(person)) return sim.line.refuse(Error{{}, Status::stale_entity}, person_number(i));
    if (on && is_posed(sim.world().world(), person))
      return sim.line.refuse(
          MOBIL_MISSING, fmt::format("person {} is posed by the host; hand them over by mobil_avoidance_set_discs", i));
    if (!on && !sim.world().world().has<AvoidanceState>(person))
      return sim.line.refuse(MOBIL_MISSING,
                             fmt::format("person {} avoids nobody; mobil_avoidance_manage begins that", i));
  }
  return MOBIL_OK;
}

/// Manages or releases people, all or none. Managed people who are managed again keep their desired velocity.
int set_avoiding(mobil_sim& sim, bool on) {
  std::vector<Entity> changes;
  for (const Entity person : sim.people)
    if (sim.world().world().has<AvoidanceState>(person) != on) changes.push_back(person);
  drop_repeated(changes);
  const auto done = on ? sim.world().avoidance().manage(changes) : sim.world().avoidance().release(changes);
  return done ? int{MOBIL_OK} : sim.line.refuse(done.error());
}

GroundPoint ground_point(const HostAxes& axes, const float* theirs) {
  const Vec3<float> at = axes.place_from(theirs);
  return {at.x, at.z};
}

/// Determines the stride of rows of bottom and top, which can be null.
int height_stride(Line& line, const float* heights, std::size_t count, std::size_t& stride) {
  return heights == nullptr ? int{MOBIL_OK} : row_stride(line, heights, count, 2, "heights", stride);
}
HeightRange height_of(const HostAxes& axes, const float* heights, std::size_t i, std::size_t stride) {
  if (heights == nullptr) return {};
  const float* const row = row_at(heights, i, stride, 0);
  return {row[0] / axes.units_per_m, row[1] / axes.units_per_m};
}

/// Converts a row of height along the host's up axis and normal. A normal that does not point up gives NaN.
TerrainHeight height_from(const HostAxes& axes, const float* theirs) {
  const Vec3<float> n = axes.direction_from(theirs + 1);
  const float height_m = theirs[0] / axes.units_per_m;
  if (n.x == 0 && n.y == 0 && n.z == 0) return {height_m, 0, 0};
  if (!(n.y > 0)) return {std::numeric_limits<float>::quiet_NaN(), 0, 0};
  return {height_m, -n.x / n.y, -n.z / n.y};
}

/// Resolves queries by the host's function.
void ask_host(mobil_sim& sim, std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
  std::vector<float>& places = sim.row;
  std::vector<float>& ground = sim.ground_row;
  std::vector<mobil_id>& who = sim.ground_of;
  places.resize(3 * at.size());
  ground.assign(4 * at.size(), 0);
  who.resize(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    sim.axes.place_to({at[i].x_m, 0, at[i].z_m}, &places[3 * i]);
    who[i] = id_of(at[i].person);
  }
  if (const int code = sim.ground(sim.ground_user, places.data(), who.data(), at.size(), ground.data()); code != 0)
    throw Stopped(fmt::format("the function of mobil_terrain_set_heights returned {}", code));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = height_from(sim.axes, &ground[4 * i]);
}

}  // namespace

int mobil_avoidance_set_options(mobil_sim* sim, const mobil_avoidance_options* options) {
  return call(sim, "mobil_avoidance_set_options", [&](mobil_sim& s) {
    auto known = usual<mobil_avoidance_options>();
    if (options != nullptr) {
      if (const int code = read_struct(s.line, options, "options", known)) return code;
    }
    if (!std::isfinite(known.radius_h) || !std::isfinite(known.overlap_m) || !std::isfinite(known.shoulders_h))
      return s.line.refuse(MOBIL_REFUSED,
                           "radius_h, overlap_m or shoulders_h is not finite; mobil_defaults gives the usual ones");
    s.world().avoidance().set_options({known.radius_h, known.overlap_m, known.shoulders_h});
    return int{MOBIL_OK};
  });
}

int mobil_avoidance_manage(mobil_sim* sim, const mobil_id* ids, size_t count, int on) {
  return call(sim, "mobil_avoidance_manage", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    if (const int code = check_avoiders(s, on != 0)) return code;
    return set_avoiding(s, on != 0);
  });
}

int mobil_avoidance_set_desired_velocity(mobil_sim* sim, const mobil_id* ids, size_t count, const float* wishes,
                                         size_t stride) {
  return call(sim, "mobil_avoidance_set_desired_velocity", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    if (const int code = row_stride(s.line, wishes, count, 2, "wishes", stride)) return code;
    std::vector<DesiredVelocity> to(count);
    for (std::size_t i = 0; i < count; ++i) {
      const float* const row = row_at(wishes, i, stride, 0);
      to[i] = {s.people[i], row[0], row[1]};
    }
    return code_of(s.line, s.world().avoidance().set_desired_velocity(to));
  });
}

int mobil_avoidance_set_walls(mobil_sim* sim, const float* walls, size_t stride, size_t count) {
  return mobil_avoidance_set_walls_between(sim, walls, stride, nullptr, 0, count);
}

int mobil_avoidance_set_discs(mobil_sim* sim, const float* discs, size_t stride, size_t count) {
  return mobil_avoidance_set_discs_between(sim, discs, stride, nullptr, 0, count);
}

int mobil_avoidance_set_walls_between(mobil_sim* sim, const float* walls, size_t stride, const float* heights,
                                      size_t heights_stride, size_t count) {
  return call(sim, "mobil_avoidance_set_walls_between", [&](mobil_sim& s) {
    if (const int code = row_stride(s.line, walls, count, 6, "walls", stride)) return code;
    if (const int code = height_stride(s.line, heights, count, heights_stride)) return code;
    std::vector<Wall> to(count);
    for (std::size_t i = 0; i < count; ++i) {
      const float* const row = row_at(walls, i, stride, 0);
      to[i] = {ground_point(s.axes, row), ground_point(s.axes, row + 3), height_of(s.axes, heights, i, heights_stride)};
    }
    return code_of(s.line, s.world().avoidance().set_walls(to));
  });
}

int mobil_avoidance_set_discs_between(mobil_sim* sim, const float* discs, size_t stride, const float* heights,
                                      size_t heights_stride, size_t count) {
  return call(sim, "mobil_avoidance_set_discs_between", [&](mobil_sim& s) {
    if (const int code = row_stride(s.line, discs, count, 7, "discs", stride)) return code;
    if (const int code = height_stride(s.line, heights, count, heights_stride)) return code;
    std::vector<Disc> to(count);
    for (std::size_t i = 0; i < count; ++i) {
      const float* const row = row_at(discs, i, stride, 0);
      const Vec3<float> velocity = s.axes.place_from(row + 3);
      to[i] = {ground_point(s.axes, row), row[6] / s.axes.units_per_m, velocity.x, velocity.z,
               height_of(s.axes, heights, i, heights_stride)};
    }
    return code_of(s.line, s.world().avoidance().set_discs(to));
  });
}

int mobil_avoidance_report(mobil_sim* sim, mobil_avoidance_counts* out) {
  return call(sim, "mobil_avoidance_report", [&](mobil_sim& s) {
    const AvoidanceReport& did = s.world().avoidance().report();
    const mobil_avoidance_counts to = {sizeof to,     did.people, did.chose, {did.kept_reservation},
                                       {did.yielded}, did.waiting};
    return write_struct(s.line, to, out, "out");
  });
}

int mobil_terrain_set_heights(mobil_sim* sim, mobil_heights heights, void* user) {
  return call(sim, "mobil_terrain_set_heights", [&](mobil_sim& s) {
    s.ground = heights;
    s.ground_user = user;
    TerrainHeights asks;
    if (heights != nullptr)
      asks = [&s](std::span<const TerrainQuery> at, std::span<TerrainHeight> out) { ask_host(s, at, out); };
    s.world().terrain().set_heights(std::move(asks));
    return int{MOBIL_OK};
  });
}

int mobil_terrain_manage(mobil_sim* sim, const mobil_id* ids, size_t count, int on) {
  return call(sim, "mobil_terrain_manage", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    return code_of(s.line, on != 0 ? s.world().terrain().manage(s.people) : s.world().terrain().release(s.people));
  });
}

int mobil_terrain_set_speed_scaling(mobil_sim* sim, int on) {
  return call(sim, "mobil_terrain_set_speed_scaling", [&](mobil_sim& s) {
    s.world().terrain().set_options({.slows_down = on != 0});
    return int{MOBIL_OK};
  });
}

int mobil_terrain_query(mobil_sim* sim, float* places, size_t stride, mobil_id* who, size_t room, size_t* count) {
  return call(sim, "mobil_terrain_query", [&](mobil_sim& s) {
    const std::span<const TerrainQuery> asked = s.world().terrain().query();
    if (count != nullptr) *count = asked.size();
    if (places == nullptr && count != nullptr) return int{MOBIL_OK};
    if (const int code = row_stride(s.line, places, asked.size(), 3, "places", stride)) return code;
    if (room < asked.size())
      return s.line.refuse(MOBIL_ROOM,
                           fmt::format("{} places are asked for, and there is room for {}", asked.size(), room));
    for (std::size_t i = 0; i < asked.size(); ++i) {
      s.axes.place_to({asked[i].x_m, 0, asked[i].z_m}, row_at(places, i, stride, 0));
      if (who != nullptr) who[i] = id_of(asked[i].person);
    }
    return int{MOBIL_OK};
  });
}

int mobil_terrain_resolve(mobil_sim* sim, const float* ground, size_t stride, size_t count, size_t* unusable) {
  return call(sim, "mobil_terrain_resolve", [&](mobil_sim& s) {
    if (const int code = row_stride(s.line, ground, count, 4, "ground", stride)) return code;
    std::vector<TerrainHeight>& heights = s.heights;
    heights.resize(count);
    for (std::size_t i = 0; i < count; ++i) heights[i] = height_from(s.axes, row_at(ground, i, stride, 0));
    const auto done = s.world().terrain().resolve(heights);
    if (!done) return s.line.refuse(done.error());
    if (unusable != nullptr) *unusable = *done;
    return int{MOBIL_OK};
  });
}

int mobil_terrain_report(mobil_sim* sim, mobil_terrain_counts* out) {
  return call(sim, "mobil_terrain_report", [&](mobil_sim& s) {
    const TerrainReport& did = s.world().terrain().report();
    const mobil_terrain_counts to = {sizeof to, did.people, did.asked, did.places, did.unusable};
    return write_struct(s.line, to, out, "out");
  });
}
