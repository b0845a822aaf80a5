// Simulations: creation, time, snapshots and cost.

#include <mobil/version.h>

#include <mobil/schedule.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include "systems/c/c_call.h"

namespace {

using namespace mobil;
using namespace mobil::c;

/// Writes the defaults of the fields that the caller's struct has, with its own `size`.
template <class S>
int fill(void* filled, std::size_t size) {
  S values = usual<S>();
  values.size = size;
  std::memset(filled, 0, size);
  std::memcpy(filled, &values, std::min(size, sizeof values));
  return MOBIL_OK;
}

int make(mobil_sim& sim, const mobil_options* given) {
  mobil_options options;
  if (const int code = read_struct(sim.line, given, "options", options)) return code;
  const auto axes = pose_axes(options.axes);
  if (!axes)
    return sim.line.refuse(MOBIL_REFUSED, fmt::format("axes {} are none of MOBIL_AXES_…; choose 0 to {}", options.axes,
                                                      static_cast<int>(MOBIL_AXES_Z_UP)));
  if (!(options.units_per_m >= 1e-3F && options.units_per_m <= 1e6F))
    return sim.line.refuse(
        MOBIL_REFUSED, fmt::format("units_per_m of {} is out of range; choose 0.001 to 1000000", options.units_per_m));
  if (options.threads < 0)
    return sim.line.refuse(MOBIL_REFUSED, fmt::format("{} threads; choose 0 (all) or more", options.threads));
  sim.axes = {{*axes, options.units_per_m}};
  SimulationOptions as;
  as.tick_s = options.tick_s;
  as.max_frame_s = options.max_frame_s;
  if (options.jobs.parallel_for != nullptr)
    sim.jobs = {options.jobs.user, options.jobs.parallel_for, std::max<std::size_t>(1, options.jobs.threads)};
  else
    sim.jobs = sim.threads.emplace(options.threads).jobs();
  as.jobs = sim.jobs;
  if (options.memory.allocate != nullptr) as.memory = &sim.memory;
  auto made = Simulation::make(as);
  if (!made) return sim.line.refuse(made.error());
  sim.simulation.emplace(std::move(*made));
  sim.poses.emplace(as.memory);
  sim.surfaces.emplace(as.memory);
  return MOBIL_OK;
}

int restore(mobil_sim& s, const void* bytes, std::size_t count, const RestoreLimits& limits) {
  if (bytes == nullptr) return s.line.refuse_null("bytes");
  const auto done = s.world().restore({static_cast<const std::byte*>(bytes), count}, limits);
  return done ? int{MOBIL_OK} : s.line.refuse(done.error());
}

}  // namespace

int mobil_interface(void) {
  return MOBIL_INTERFACE;
}

const char* mobil_library_version(void) {
  return MOBIL_VERSION;
}

int mobil_defaults(int which, void* filled, size_t size) {
  if (filled == nullptr) return MOBIL_REFUSED;
  if (!is_struct_size(size)) return MOBIL_STRUCT;
  switch (which) {
    case MOBIL_OPTIONS:
      return fill<mobil_options>(filled, size);
    case MOBIL_PERSON:
      return fill<mobil_person>(filled, size);
    case MOBIL_WALK:
      return fill<mobil_walk>(filled, size);
    case MOBIL_MUSCLES:
      return fill<mobil_muscles>(filled, size);
    case MOBIL_METHOD:
      return fill<mobil_method>(filled, size);
    case MOBIL_POSE_LAYOUT:
      return fill<mobil_pose_layout>(filled, size);
    case MOBIL_SCENE:
      return fill<mobil_scene>(filled, size);
    case MOBIL_NEEDS:
      return fill<mobil_needs>(filled, size);
    case MOBIL_LOD_OPTIONS:
      return fill<mobil_lod_options>(filled, size);
    case MOBIL_LOD_COUNTS:
      return fill<mobil_lod_counts>(filled, size);
    case MOBIL_SURFACE_CHOICE:
      return fill<mobil_surface_choice>(filled, size);
    case MOBIL_SURFACE_TARGET:
      return fill<mobil_surface_target>(filled, size);
    case MOBIL_LIMITS:
      return fill<mobil_limits>(filled, size);
    case MOBIL_SKIN_TARGET:
      return fill<mobil_skin_target>(filled, size);
    case MOBIL_LEG_MESH:
      return fill<mobil_leg_mesh>(filled, size);
    case MOBIL_AVOIDANCE_OPTIONS:
      return fill<mobil_avoidance_options>(filled, size);
    case MOBIL_AVOIDANCE_COUNTS:
      return fill<mobil_avoidance_counts>(filled, size);
    case MOBIL_TERRAIN_COUNTS:
      return fill<mobil_terrain_counts>(filled, size);
    case MOBIL_SEGMENT:
      return fill<mobil_segment>(filled, size);
    case MOBIL_SKIN_BINDING:
      return fill<mobil_skin_binding>(filled, size);
    default:
      return MOBIL_REFUSED;
  }
}

int mobil_create(const mobil_options* options, mobil_sim** out, char* line, size_t room) {
  const auto say = [&](const Line& of) {
    if (line == nullptr || room == 0) return;
    const std::size_t length = std::min(room - 1, std::strlen(of.text));
    std::memcpy(line, of.text, length);
    line[length] = 0;
  };
  Line nobody{"mobil_create"};
  if (out == nullptr) {
    const int code = nobody.refuse_null("out");
    say(nobody);
    return code;
  }
  *out = nullptr;
  mobil_memory host{};
  int refused = MOBIL_OK;
  std::unique_ptr<mobil_sim> sim;
  try {
    mobil_options known;
    if (options != nullptr && read_struct(nobody, options, "options", known) == MOBIL_OK) host = known.memory;
    if ((host.allocate == nullptr) != (host.release == nullptr))
      refused = nobody.refuse(MOBIL_REFUSED, "memory needs both allocate and release, or neither");
    else
      sim = std::make_unique<mobil_sim>(host);
  } catch (const std::bad_alloc&) {
    refused = nobody.refuse(MOBIL_MEMORY, status_text(Status::no_memory));
  }
  if (refused != MOBIL_OK) {
    say(nobody);
    return refused;
  }
  const int code = call(sim.get(), "mobil_create", [&](mobil_sim& made) { return make(made, options); });
  say(sim->line);
  if (code == MOBIL_OK) *out = sim.release();
  return code;
}

void mobil_destroy(mobil_sim* sim) {
  delete sim;
}

const char* mobil_message(const mobil_sim* sim) {
  return sim == nullptr ? "there is no simulation; mobil_create makes one" : sim->line.text;
}

int mobil_advance(mobil_sim* sim, double seconds, mobil_ticks* out) {
  return call(sim, "mobil_advance", [&](mobil_sim& s) {
    const Ticks ticks = s.world().advance(seconds);
    if (!ticks.valid)
      return s.line.refuse(MOBIL_REFUSED, fmt::format("{} s; give a frame's time, finite and not negative", seconds));
    if (out != nullptr) *out = {ticks.count, ticks.alpha, ticks.dropped_s};
    return int{MOBIL_OK};
  });
}

int mobil_tick(mobil_sim* sim, unsigned int ticks) {
  return call(sim, "mobil_tick", [&](mobil_sim& s) {
    s.world().tick(ticks);
    return int{MOBIL_OK};
  });
}

int mobil_set_interrupt(mobil_sim* sim, mobil_interrupt interrupt, void* user) {
  return call(sim, "mobil_set_interrupt", [&](mobil_sim& s) {
    s.interrupt = {user, interrupt};
    return int{MOBIL_OK};
  });
}

double mobil_time_s(const mobil_sim* sim) {
  return sim == nullptr ? 0 : sim->simulation->time_s();
}

double mobil_tick_s(const mobil_sim* sim) {
  return sim == nullptr ? 0 : sim->simulation->tick_s();
}

int mobil_cost(mobil_sim* sim, int system, mobil_system* out) {
  return call(sim, "mobil_cost", [&](mobil_sim& s) {
    const Schedule& schedule = s.world().schedule();
    if (out == nullptr) return s.line.refuse_null("out");
    const auto at = static_cast<std::size_t>(system);
    if (system < 0 || at >= schedule.systems().size())
      return s.line.refuse(MOBIL_MISSING, fmt::format("system {}; there are {}", system, schedule.systems().size()));
    const System& one = schedule.systems()[at];
    const Timing& timing = schedule.timings()[at];
    *out = {one.name.c_str(), one.module.c_str(), timing.last_seconds, static_cast<double>(timing.last_rows)};
    return int{MOBIL_OK};
  });
}

int mobil_phase_cost(mobil_sim* sim, int phase, mobil_phase* out) {
  return call(sim, "mobil_phase_cost", [&](mobil_sim& s) {
    const std::span before = std::as_const(s.world().schedule()).before(), after = s.world().schedule().after();
    if (out == nullptr) return s.line.refuse_null("out");
    const auto at = static_cast<std::size_t>(phase);
    const std::size_t count = before.size() + after.size();
    if (phase < 0 || at >= count)
      return s.line.refuse(MOBIL_MISSING, fmt::format("phase {}; there are {}", phase, count));
    const bool is_after = at >= before.size();
    const TimedPhase& one = is_after ? after[at - before.size()] : before[at];
    *out = {one.phase.name.c_str(), one.module.c_str(), is_after ? 1 : 0, one.last_seconds};
    return int{MOBIL_OK};
  });
}

size_t mobil_snapshot_bytes(mobil_sim* sim) {
  size_t bytes = 0;
  call(sim, "mobil_snapshot_bytes", [&](mobil_sim& s) {
    bytes = s.world().snapshot_bytes();
    return int{MOBIL_OK};
  });
  return bytes;
}

int mobil_save(mobil_sim* sim, void* out, size_t room, size_t* bytes) {
  return call(sim, "mobil_save", [&](mobil_sim& s) {
    const std::size_t needed = s.world().snapshot_bytes();
    if (bytes != nullptr) *bytes = needed;
    if (out == nullptr || room < needed)
      return s.line.refuse(MOBIL_ROOM, fmt::format("{} bytes are needed, and there are {}", needed, room));
    const auto saved = s.world().save({static_cast<std::byte*>(out), room});
    return saved ? int{MOBIL_OK} : s.line.refuse(saved.error());
  });
}

int mobil_restore(mobil_sim* sim, const void* bytes, size_t count) {
  return call(sim, "mobil_restore", [&](mobil_sim& s) { return restore(s, bytes, count, {}); });
}

int mobil_restore_within(mobil_sim* sim, const void* bytes, size_t count, const mobil_limits* limits) {
  return call(sim, "mobil_restore_within", [&](mobil_sim& s) {
    mobil_limits known;
    if (const int code = read_struct(s.line, limits, "limits", known); code != MOBIL_OK) return code;
    if (!(known.seconds >= 0))
      return s.line.refuse(MOBIL_REFUSED, "seconds are negative or no number; choose 0 or more");
    return restore(s, bytes, count,
                   {known.rows, known.mesh_nodes, known.seconds, known.numbers != 0, known.resources, known.steps});
  });
}

int mobil_hash(mobil_sim* sim, unsigned int out[2]) {
  return call(sim, "mobil_hash", [&](mobil_sim& s) {
    if (out == nullptr) return s.line.refuse_null("out");
    const std::uint64_t hash = s.world().state_hash();
    out[0] = static_cast<std::uint32_t>(hash);
    out[1] = static_cast<std::uint32_t>(hash >> 32);
    return int{MOBIL_OK};
  });
}
