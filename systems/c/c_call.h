#pragma once
// What every call of the C interface goes through: the simulation behind the handle, structs of any version, people as
// ids, host's axes, and failures as a code with a line.

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <memory_resource>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <mobil/avoidance.h>
#include <mobil/engine/world.h>
#include <mobil/lod.h>
#include <mobil/mobil.h>
#include <mobil/pose_writer.h>
#include <mobil/simulation.h>
#include <mobil/skin_tables.h>
#include <mobil/skin_writer.h>
#include <mobil/surfaces.h>
#include <mobil/terrain.h>
#include "systems/poses/pose_axes.h"

namespace mobil::inline v0_3::c {

/// The host's memory.
class HostMemory final : public std::pmr::memory_resource {
 public:
  explicit HostMemory(const mobil_memory& host) : host_(host) {}

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    void* const memory = host_.allocate(host_.user, bytes, alignment);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
  }
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override {
    host_.release(host_.user, memory, bytes, alignment);
  }
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

  mobil_memory host_;
};

/// The axes and the unit of length that places come and go in.
struct HostAxes {
  PoseAxes axes = PoseAxes::y_up;
  float units_per_m = 1;

  bool ours() const { return axes == PoseAxes::y_up && units_per_m == 1; }
  bool mirrored() const { return axes_of[static_cast<std::size_t>(axes)].mirrored() < 0; }
  Vec3<float> place_from(const float* theirs) const { return from(theirs, units_per_m); }
  Vec3<float> direction_from(const float* theirs) const { return from(theirs, 1); }
  void place_to(const Vec3<float>& ours, float* theirs) const { to(ours, units_per_m, theirs); }
  void direction_to(const Vec3<float>& ours, float* theirs) const { to(ours, 1, theirs); }

 private:
  Vec3<float> from(const float* theirs, float units) const {
    const Vec3<double> at = mobil::place_from(axes, units, {theirs[0], theirs[1], theirs[2]});
    return {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)};
  }
  void to(const Vec3<float>& ours, float units, float* theirs) const {
    const AxisMap& map = axes_of[static_cast<std::size_t>(axes)];
    const float at[3] = {ours.x, ours.y, ours.z};
    for (std::size_t i = 0; i < 3; ++i) theirs[i] = map.sign[i] * units * at[map.ours[i]];
  }
};

/// The PoseAxes of MOBIL_AXES_…, or nothing.
std::optional<PoseAxes> pose_axes(int axes);

int code_of(Status status);

/// Why a call was refused: the line that mobil_message gives. Nothing is thrown, for not everywhere can one be.
struct Line {
  const char* call = "";
  char text[512] = "";

  /// Keeps the line, and returns the code.
  int refuse(int code, std::string_view what) noexcept;
  int refuse(const Error& error, std::string_view who = {}) noexcept;
  int refuse_null(const char* what) noexcept;
};
inline std::string person_number(std::size_t i) {
  return fmt::format("person {}: ", i);
}

/// A struct's usual values.
template <class S>
S usual();
template <>
mobil_options usual();
template <>
mobil_person usual();
template <>
mobil_walk usual();
template <>
mobil_method usual();
template <>
mobil_muscles usual();
template <>
mobil_pose_layout usual();
template <>
mobil_scene usual();
template <>
mobil_needs usual();
template <>
mobil_lod_options usual();
template <>
mobil_lod_counts usual();
template <>
mobil_surface_choice usual();
template <>
mobil_surface_target usual();
template <>
mobil_limits usual();
template <>
mobil_skin_target usual();
template <>
mobil_leg_mesh usual();
template <>
mobil_avoidance_options usual();
template <>
mobil_avoidance_counts usual();
template <>
mobil_terrain_counts usual();

/// Sizes that a struct may say it has.
constexpr bool is_struct_size(std::size_t size) {
  return size >= sizeof size && size <= 4096 && size % 4 == 0;
}
std::string unfilled(const char* name, std::size_t size);
std::string from_the_future(const char* name, std::size_t known);

/// A struct as the caller knows it, of an older or newer header: what it lacks is usual.
template <class S>
int read_struct(Line& line, const void* given, const char* name, S& out) {
  static_assert(std::is_trivially_copyable_v<S>);
  if (given == nullptr) return line.refuse_null(name);
  std::size_t size;
  std::memcpy(&size, given, sizeof size);
  if (!is_struct_size(size)) return line.refuse(MOBIL_STRUCT, unfilled(name, size));
  out = usual<S>();
  std::memcpy(static_cast<void*>(&out), given, std::min(size, sizeof out));
  out.size = sizeof out;
  const auto* const bytes = static_cast<const unsigned char*>(given);
  if (size > sizeof out && std::any_of(bytes + sizeof out, bytes + size, [](unsigned char b) { return b != 0; }))
    return line.refuse(MOBIL_STRUCT, from_the_future(name, sizeof out));
  return MOBIL_OK;
}
/// The other way round: as much of a struct as the caller knows; its size stays.
template <class S>
int write_struct(Line& line, const S& from, void* given, const char* name) {
  if (given == nullptr) return line.refuse_null(name);
  std::size_t size;
  std::memcpy(&size, given, sizeof size);
  if (!is_struct_size(size)) return line.refuse(MOBIL_STRUCT, unfilled(name, size));
  std::memcpy(given, &from, std::min(size, sizeof from));
  std::memcpy(given, &size, sizeof size);
  return MOBIL_OK;
}

/// One of an enumeration's values.
template <class E>
int one_of(Line& line, int value, E last, const char* what, E& out) {
  if (value < 0 || value > static_cast<int>(last))
    return line.refuse(MOBIL_REFUSED,
                       fmt::format("{} {} is out of range; choose 0 to {}", what, value, static_cast<int>(last)));
  out = static_cast<E>(value);
  return MOBIL_OK;
}

inline Entity entity_of(mobil_id id) {
  return {id.index, id.generation};
}
inline mobil_id id_of(Entity entity) {
  return {entity.index, entity.generation};
}

/// Row i of the caller's memory; `close`: bytes of one where no stride is given.
template <class T>
T* row_at(T* rows, std::size_t i, std::size_t stride, std::size_t close) {
  using Byte = std::conditional_t<std::is_const_v<T>, const std::byte, std::byte>;
  return reinterpret_cast<T*>(reinterpret_cast<Byte*>(rows) + i * (stride == 0 ? close : stride));
}

/// How far apart structs lie, as the caller knows them.
template <class S>
int struct_stride(Line& line, const S* rows, std::size_t count, const char* name, std::size_t& stride) {
  if (count == 0) return MOBIL_OK;
  if (rows == nullptr) return line.refuse_null(name);
  std::size_t size;
  std::memcpy(&size, rows, sizeof size);
  if (stride == 0) stride = size;
  if (!is_struct_size(size)) return line.refuse(MOBIL_STRUCT, unfilled(name, size));
  if (stride >= size) return MOBIL_OK;
  return line.refuse(MOBIL_REFUSED, fmt::format("{} lie {} bytes apart and are {} long", name, stride, size));
}

/// How far apart rows of so many floats lie; `stride` 0: close together.
int row_stride(Line& line, const void* rows, std::size_t count, std::size_t floats, const char* name,
               std::size_t& stride);

/// A stream of the caller's, `close` bytes apart where no stride is given; without bytes where it is left out.
int stream_of(Line& line, void* memory, std::size_t stride, std::size_t bytes, std::size_t close, const char* name,
              VertexStream& to);
/// Triangles for the host: of mirrored axes the second and the third corner change places.
void wind(std::span<const std::uint32_t> index, bool mirrored, unsigned int* out);
/// Vertices from `begin` up to `end` of a stream that was written, in the host's axes.
template <class F>
void turn_vertices(const VertexStream& stream, std::size_t begin, std::size_t end, std::size_t floats,
                   const F& convert) {
  if (stream.bytes.empty()) return;
  for (std::size_t v = begin; v < end; ++v) {
    float value[4];
    std::byte* const at = stream.bytes.data() + v * stream.stride;
    std::memcpy(value, at, floats * sizeof(float));
    convert(value);
    std::memcpy(at, value, floats * sizeof(float));
  }
}

/// Vertices of ours into a stream, if there is one, in the host's axes.
template <class F>
void write_vertices(std::span<const Vec3<float>> from, const VertexStream& to, const F& convert) {
  for (std::size_t v = 0; v < from.size() && !to.bytes.empty(); ++v) {
    float value[3];
    convert(from[v], value);
    std::memcpy(to.bytes.data() + v * to.stride, value, sizeof value);
  }
}

int muscle_set(Line& line, unsigned int bits, MuscleSet& out);
int muscle_number(Line& line, int muscle, Muscle& out);
int leg_muscles(Line& line, const mobil_muscles& given, LegMuscles& out);

/// MOBIL_OK, or why not.
template <class T>
int code_of(Line& line, const Result<T>& done) {
  return done ? int{MOBIL_OK} : line.refuse(done.error());
}

}  // namespace mobil::inline v0_3::c

/// What a mobil_sim* points to.
struct mobil_sim {
  explicit mobil_sim(const mobil_memory& host) : memory(host) {}

  mobil::c::HostMemory memory;  // goes after everything that lives in it
  std::optional<mobil::Threads> threads;
  mobil::Jobs jobs;  // the host's, or those of `threads`
  std::optional<mobil::Simulation> simulation;
  mobil::c::HostAxes axes;
  std::optional<mobil::PoseWriter> poses;
  std::optional<mobil::SurfaceWriter> surfaces;
  mobil::BodySkins skins;
  mobil::SkinTables skin_tables;
  mobil::SkinWriter skin_writer;
  mobil::c::Line line;
  mobil_heights ground = nullptr;  // of terrain, and what it is called with
  void* ground_user = nullptr;
  // What calls work in.
  std::vector<mobil::Entity> people;
  std::vector<float> row;
  std::vector<mobil::Root> roots;
  std::vector<mobil::TerrainHeight> heights;
  std::vector<float> ground_row;
  std::vector<mobil_id> ground_of;

  mobil::Simulation& world() { return *simulation; }
  /// `people` become those named.
  int name_people(const mobil_id* ids, std::size_t count);
  /// Each of `people` is one.
  int check_people();
  /// Each of them is one, and is named once from now on.
  int people_once();
};

namespace mobil::inline v0_3::c {

/// A function of the host's ended a tick.
struct Stopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs a call, f(sim), which returns its code.
template <class F>
int call(const mobil_sim* asked, const char* name, F f) noexcept {
  if (asked == nullptr) return MOBIL_REFUSED;
  auto* const sim = const_cast<mobil_sim*>(asked);
  sim->line.call = name;
  try {
    return f(*sim);
  } catch (const std::bad_alloc&) {
    return sim->line.refuse(MOBIL_MEMORY, status_text(Status::no_memory));
  } catch (const Stopped& host) {
    return sim->line.refuse(MOBIL_REFUSED, host.what());
  } catch (const std::exception& error) {
    return sim->line.refuse(MOBIL_INTERNAL, error.what());
  }
}

}  // namespace mobil::inline v0_3::c
