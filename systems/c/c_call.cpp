#include "systems/c/c_call.h"

#include <unordered_set>

#include <mobil/muscle_table.h>
#include <mobil/systems/snapshot/restore_limits.h>

namespace mobil::inline v0_3::c {
namespace {

void put_text(char* to, std::size_t room, std::size_t& at, std::string_view text) noexcept {
  for (const char c : text) {
    if (at + 1 >= room) break;
    to[at++] = c == '\n' ? ' ' : c;
  }
  to[at] = 0;
}

}  // namespace

std::optional<PoseAxes> pose_axes(int axes) {
  switch (axes) {
    case MOBIL_AXES_Y_UP:
      return PoseAxes::y_up;
    case MOBIL_AXES_UNITY:
      return PoseAxes::y_up_left_handed;
    case MOBIL_AXES_UNREAL:
      return PoseAxes::z_up_left_handed;
    case MOBIL_AXES_GODOT:
      return PoseAxes::y_up_z_back;
    case MOBIL_AXES_Z_UP:
      return PoseAxes::z_up;
    default:
      return std::nullopt;
  }
}

int code_of(Status status) {
  switch (status) {
    case Status::ok:
      return MOBIL_OK;
    case Status::stale_entity:
      return MOBIL_STALE;
    case Status::missing:
      return MOBIL_MISSING;
    case Status::already_there:
      return MOBIL_ALREADY;
    case Status::no_memory:
      return MOBIL_MEMORY;
    case Status::wrong_width:
    case Status::not_valid:
    case Status::not_yours:
      return MOBIL_REFUSED;
  }
  return MOBIL_INTERNAL;
}

int Line::refuse(int code, std::string_view what) noexcept {
  std::size_t at = 0;
  put_text(text, sizeof text, at, call);
  put_text(text, sizeof text, at, ": ");
  put_text(text, sizeof text, at, what);
  return code;
}

int Line::refuse(const Error& error, std::string_view who) noexcept {
  std::size_t at = 0;
  for (const std::string_view part : {std::string_view(call), std::string_view(": "), who})
    put_text(text, sizeof text, at, part);
  put_text(text, sizeof text, at, error.message.empty() ? status_text(error.status) : error.message);
  return code_of(error.status);
}

int Line::refuse_null(const char* what) noexcept {
  std::size_t at = 0;
  for (const std::string_view part : {std::string_view(call), std::string_view(": "), std::string_view(what),
                                      std::string_view(" is null; give memory of your own")}) {
    put_text(text, sizeof text, at, part);
  }
  return MOBIL_REFUSED;
}

std::string unfilled(const char* name, std::size_t size) {
  return fmt::format("{} says it has {} bytes; fill it with mobil_defaults first", name, size);
}

std::string from_the_future(const char* name, std::size_t known) {
  return fmt::format(
      "{} asks for something that this library does not know; use a newer one, or leave zero what lies"
      " behind its first {} bytes",
      name, known);
}

int row_stride(Line& line, const void* rows, std::size_t count, std::size_t floats, const char* name,
               std::size_t& stride) {
  if (rows == nullptr && count > 0) return line.refuse_null(name);
  const std::size_t close = floats * sizeof(float);
  if (stride == 0) stride = close;
  if (stride % sizeof(float) != 0)
    return line.refuse(MOBIL_REFUSED, fmt::format("{} lie {} bytes apart; give a multiple of 4, or 0", name, stride));
  if (stride >= close) return MOBIL_OK;
  return line.refuse(MOBIL_REFUSED,
                     fmt::format("{} lie {} bytes apart and are {} long; give a stride of at least {}, or 0", name,
                                 stride, close, close));
}

int stream_of(Line& line, void* memory, std::size_t stride, std::size_t bytes, std::size_t close, const char* name,
              VertexStream& to) {
  to.stride = stride == 0 ? close : stride;
  if (memory == nullptr) return MOBIL_OK;
  if (bytes == 0)
    return line.refuse(MOBIL_ROOM, fmt::format("{} in 0 bytes; say how many there are, or leave them null", name));
  to.bytes = {static_cast<std::byte*>(memory), bytes};
  return MOBIL_OK;
}

int same_handedness(mobil_sim& sim, bool bound_mirrored) {
  if (bound_mirrored == sim.axes.mirrored()) return MOBIL_OK;
  return sim.line.refuse(MOBIL_REFUSED,
                         "bound in axes of the other handedness, so the triangles would be inside out; bind it in this "
                         "simulation");
}

void wind(std::span<const std::uint32_t> index, bool mirrored, unsigned int* out) {
  for (std::size_t i = 0; i < index.size(); ++i) {
    const std::size_t corner = i % 3;
    out[i] = index[mirrored && corner != 0 ? i + 3 - 2 * corner : i];
  }
}

int write_baked(Line& line, std::span<const std::byte> baked, void* out, std::size_t room, std::size_t* bytes) {
  if (bytes != nullptr) *bytes = baked.size();
  if (out == nullptr && bytes != nullptr) return MOBIL_OK;
  if (out == nullptr) return line.refuse_null("out");
  if (room < baked.size())
    return line.refuse(MOBIL_ROOM, fmt::format("{} bytes are needed, and there are {}", baked.size(), room));
  std::memcpy(out, baked.data(), baked.size());
  return MOBIL_OK;
}

int muscle_set(Line& line, unsigned int bits, unsigned int more, MuscleSet& out) {
  const std::size_t known = muscles().size();
  out = join_muscles(bits, more);
  if ((out >> known).none()) return MOBIL_OK;
  return line.refuse(MOBIL_REFUSED,
                     fmt::format("more_muscles {:#x} has bits of muscles that do not exist; there are {}, and muscle 32"
                                 " is its first bit",
                                 more, known));
}

int muscle_number(Line& line, int muscle, Muscle& out) {
  return one_of(line, muscle, static_cast<Muscle>(muscles().size() - 1), "muscle", out);
}

namespace {

/// Returns a struct of zeros with its size.
template <class S>
S sized() {
  S made{};
  made.size = sizeof made;
  return made;
}

}  // namespace

template <>
mobil_options usual() {
  const SimulationOptions as;
  return {sizeof(mobil_options), as.tick_s, as.max_frame_s, as.threads, MOBIL_AXES_Y_UP, 1, {}, {}};
}

template <>
mobil_person usual() {
  const BodyRequest as;
  mobil_person person{};
  person.size = sizeof person;
  person.height_m = as.height_m;
  person.mass_kg = as.mass_kg;
  person.endo = as.biotype.endo;
  person.meso = as.biotype.meso;
  person.ecto = as.biotype.ecto;
  person.constitution = static_cast<int>(as.constitution);
  person.sex = static_cast<int>(as.sex);
  person.age_y = as.age_y;
  return person;
}

template <>
mobil_walk usual() {
  return sized<mobil_walk>();
}

template <>
mobil_method usual() {
  const MuscleMethod as;
  const ModalOptions& r = as.modal;
  return {sizeof(mobil_method),
          static_cast<int>(as.method),
          {static_cast<int>(r.modes)},
          r.moving,
          r.corrected,
          r.control_points,
          r.reported,
          r.tuned,
          r.linear_shape,
          {r.cells[0], r.cells[1], r.cells[2]}};
}

template <>
mobil_muscles usual() {
  const LegMuscles as;
  const auto method = usual<mobil_method>();
  mobil_muscles to{};
  to.size = sizeof to;
  split_muscles(as.muscles, to.muscles, to.more_muscles);
  to.method = method.method;
  to.modes = method.modes;
  to.moving = method.moving;
  to.corrected = method.corrected;
  to.control_points = method.control_points;
  to.reported = method.reported;
  to.tuned = method.tuned;
  to.linear_shape = method.linear_shape;
  to.element = static_cast<int>(as.element);
  to.mass = static_cast<int>(as.mass);
  to.drive = static_cast<int>(as.drive);
  to.activation = static_cast<int>(as.activation);
  to.inertia = as.inertia;
  to.line_motion = as.line_motion;
  to.finite_shape = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    to.modal_cells[i] = method.modal_cells[i];
    to.cells[i] = as.cells[i];
  }
  to.density_kg_m3 = as.material.density_kg_m3;
  to.young_pa = as.material.young_pa;
  to.poisson = as.material.poisson;
  to.damping_per_s = as.damping_per_s;
  to.stiffness_damping_s = as.stiffness_damping_s;
  to.foundation_hz = -1;
  to.dt_s = -1;
  return to;
}

template <>
mobil_pose_layout usual() {
  return sized<mobil_pose_layout>();
}

template <>
mobil_scene usual() {
  const LodScene as;
  const Viewpoint camera;
  mobil_scene scene{};
  scene.size = sizeof scene;
  split_muscles(as.muscles, scene.muscles, scene.more_muscles);
  scene.tolerance_px = as.tolerance_px;
  scene.half_angle_rad = camera.half_angle_rad;
  scene.radians_per_pixel = camera.radians_per_pixel;
  scene.near_m = camera.near_m;
  scene.reach_m = camera.reach_m;
  scene.looked_at = as.looked_at;
  return scene;
}

template <>
mobil_needs usual() {
  auto needs = sized<mobil_needs>();
  needs.looked_at = -1;
  return needs;
}

template <>
mobil_lod_options usual() {
  const LodOptions as;
  return {sizeof(mobil_lod_options), as.slack, as.switches, as.switching_s, as.stagger, as.margin, 0};
}

template <>
mobil_lod_counts usual() {
  auto chosen = sized<mobil_lod_counts>();
  chosen.factor = 1;
  chosen.machine = 1;
  return chosen;
}

template <>
mobil_surface_choice usual() {
  const SurfaceChoice as;
  auto choice = sized<mobil_surface_choice>();
  choice.bones = as.bones;
  choice.side = MOBIL_BOTH;
  split_muscles(as.simulated, choice.muscles, choice.more_muscles);
  std::ranges::copy(as.cells, choice.cells);
  choice.detail = as.detail;
  choice.textured = as.textured;
  return choice;
}

template <>
mobil_surface_target usual() {
  return sized<mobil_surface_target>();
}
template <>
mobil_skin_target usual() {
  auto target = sized<mobil_skin_target>();
  target.detail = MOBIL_NEAR;
  target.sex = -1;
  return target;
}
template <>
mobil_segment usual() {
  return sized<mobil_segment>();
}
template <>
mobil_skin_binding usual() {
  auto binding = sized<mobil_skin_binding>();
  binding.detail = MOBIL_NEAR;
  binding.sex = -1;
  return binding;
}
template <>
mobil_leg_mesh usual() {
  auto mesh = sized<mobil_leg_mesh>();
  mesh.detail = MOBIL_NEAR;
  return mesh;
}

template <>
mobil_avoidance_options usual() {
  const AvoidanceOptions as;
  return {sizeof(mobil_avoidance_options), as.radius_h, as.overlap_m, as.shoulders_h};
}
template <>
mobil_avoidance_counts usual() {
  return sized<mobil_avoidance_counts>();
}
template <>
mobil_terrain_counts usual() {
  return {sizeof(mobil_terrain_counts), 0, 0, 0, 0};
}
template <>
mobil_limits usual() {
  const RestoreLimits of;
  mobil_limits limits{};
  limits.size = sizeof limits;
  limits.rows = of.rows;
  limits.mesh_nodes = of.mesh_nodes;
  limits.seconds = of.seconds;
  limits.resources = of.resources;
  limits.steps = of.steps;
  limits.numbers = of.numbers ? 1 : 0;
  return limits;
}

}  // namespace mobil::inline v0_3::c

int mobil_sim::name_people(const mobil_id* ids, std::size_t count) {
  if (ids == nullptr && count > 0) return line.refuse_null("ids");
  people.clear();
  for (std::size_t i = 0; i < count; ++i) people.push_back(mobil::c::entity_of(ids[i]));
  return MOBIL_OK;
}

int mobil_sim::check_people() {
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (!world().is_person(people[i]))
      return line.refuse(mobil::Error{{}, mobil::Status::stale_entity}, mobil::c::person_number(i));
  }
  return MOBIL_OK;
}

int mobil_sim::people_once() {
  if (const int code = check_people()) return code;
  std::unordered_set<std::uint32_t> named;
  std::erase_if(people, [&](mobil::Entity person) { return !named.insert(person.index).second; });
  return MOBIL_OK;
}
