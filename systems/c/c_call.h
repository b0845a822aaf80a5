#pragma once
// Common parts of all C calls: the simulation behind a handle, structs of any version, people by id, axes of the host,
// and errors as a code with a message.

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
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
#include <mobil/engine/interrupt.h>
#include <mobil/engine/world.h>
#include <mobil/lod.h>
#include <mobil/mobil.h>
#include <mobil/pose_writer.h>
#include <mobil/simulation.h>
#include <mobil/skin_tables.h>
#include <mobil/skin_writer.h>
#include <mobil/surfaces.h>
#include <mobil/systems/poses/roots.h>
#include <mobil/terrain.h>
#include "systems/poses/pose_axes.h"

namespace mobil::inline v0_3::c {

/// Memory resource that calls the host's functions.
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

/// Axes and unit of length of the host. Converts positions and directions from and to them.
struct HostAxes : VertexAxes {
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

/// Returns the PoseAxes of a MOBIL_AXES_… value; nothing for other values.
std::optional<PoseAxes> pose_axes(int axes);

int code_of(Status status);

/// The message of a refused call, for mobil_message. Its functions do not throw: some callers cannot catch.
struct Line {
  const char* call = "";
  char text[512] = "";

  /// Stores the message and returns the code.
  int refuse(int code, std::string_view what) noexcept;
  int refuse(const Error& error, std::string_view who = {}) noexcept;
  int refuse_null(const char* what) noexcept;
};
inline std::string person_number(std::size_t i) {
  return fmt::format("person {}: ", i);
}

/// Returns the defaults of a struct.
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
mobil_segment usual();
template <>
mobil_skin_binding usual();
template <>
mobil_avoidance_options usual();
template <>
mobil_avoidance_counts usual();
template <>
mobil_terrain_counts usual();

/// Returns true for valid values of a struct's `size`.
constexpr bool is_struct_size(std::size_t size) {
  return size >= sizeof size && size <= 4096 && size % 4 == 0;
}
std::string unfilled(const char* name, std::size_t size);
std::string from_the_future(const char* name, std::size_t known);

/// Reads a caller's struct of an older or newer header. Fields that it lacks have their defaults.
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
/// Writes the fields of a struct that the caller's header has. Its `size` stays.
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

/// Converts an integer to an enumeration value from 0 to `last`.
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

/// Returns row i of the caller's memory. With stride 0 rows are `close` bytes apart.
template <class T>
T* row_at(T* rows, std::size_t i, std::size_t stride, std::size_t close) {
  using Byte = std::conditional_t<std::is_const_v<T>, const std::byte, std::byte>;
  return reinterpret_cast<T*>(reinterpret_cast<Byte*>(rows) + i * (stride == 0 ? close : stride));
}

/// Determines the stride of the caller's structs; 0 becomes their size.
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

/// Determines the stride of rows of floats; 0 means tightly packed.
int row_stride(Line& line, const void* rows, std::size_t count, std::size_t floats, const char* name,
               std::size_t& stride);

/// Makes a stream in the caller's memory, empty if null. With stride 0 vertices are `close` bytes apart.
int stream_of(Line& line, void* memory, std::size_t stride, std::size_t bytes, std::size_t close, const char* name,
              VertexStream& to);
/// Refuses to write what was bound in axes of the other handedness: its triangles would be inside out.
int same_handedness(mobil_sim& sim, bool bound_mirrored);

/// Writes triangles for the host. For mirrored axes the second and third corners are swapped.
void wind(std::span<const std::uint32_t> index, bool mirrored, unsigned int* out);
/// Converts vertices [begin, end) of a written stream to the host's axes.
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

/// Writes vertices to a stream in the host's axes, unless the stream is empty.
template <class F>
void write_vertices(std::span<const Vec3<float>> from, const VertexStream& to, const F& convert) {
  for (std::size_t v = 0; v < from.size() && !to.bytes.empty(); ++v) {
    float value[3];
    convert(from[v], value);
    std::memcpy(to.bytes.data() + v * to.stride, value, sizeof value);
  }
}

/// Writes baked bytes to the caller's memory, and their number to `bytes` unless it is null. A null `out` asks for the
/// number only.
int write_baked(Line& line, std::span<const std::byte> baked, void* out, std::size_t room, std::size_t* bytes);
int muscle_set(Line& line, unsigned int bits, unsigned int more, MuscleSet& out);
int muscle_number(Line& line, int muscle, Muscle& out);
int leg_muscles(Line& line, const mobil_muscles& given, LegMuscles& out);

/// Returns MOBIL_OK, or stores the error and returns its code.
template <class T>
int code_of(Line& line, const Result<T>& done) {
  return done ? int{MOBIL_OK} : line.refuse(done.error());
}

}  // namespace mobil::inline v0_3::c

/// The object behind a mobil_sim*.
struct mobil_sim {
  explicit mobil_sim(const mobil_memory& host) : memory(host) {}

  mobil::c::HostMemory memory;  // destroyed after everything that it allocated
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
  mobil::Interrupt interrupt;
  std::atomic<bool> busy = false;  // a call runs
  mobil_heights ground = nullptr;  // the host's function of heights, and its argument
  void* ground_user = nullptr;
  // Scratch memory of calls.
  std::vector<mobil::Entity> people;
  std::vector<float> row;
  std::vector<mobil::Root> roots;
  std::vector<mobil::TerrainHeight> heights;
  std::vector<float> ground_row;
  std::vector<mobil_id> ground_of;

  mobil::Simulation& world() { return *simulation; }
  /// Stores the people of `ids` in `people`.
  int name_people(const mobil_id* ids, std::size_t count);
  /// Checks that all of `people` exist.
  int check_people();
  /// Checks that all of `people` exist, and removes duplicates.
  int people_once();
};

namespace mobil::inline v0_3::c {

/// Thrown if a function of the host ended a tick.
struct Stopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs f(sim), which returns a code, and converts exceptions to codes.
template <class F>
int call(const mobil_sim* asked, const char* name, F f) noexcept {
  if (asked == nullptr) return MOBIL_REFUSED;
  auto* const sim = const_cast<mobil_sim*>(asked);
  if (sim->busy.exchange(true, std::memory_order_acquire)) return MOBIL_BUSY;
  const struct Use {
    mobil_sim& of;
    ~Use() { of.busy.store(false, std::memory_order_release); }
  } use{*sim};
  sim->line.call = name;
  try {
    const InterruptScope interruptible(sim->interrupt);
    const FloatMode mode;
    return f(*sim);
  } catch (const Interrupted&) {
    return sim->line.refuse(MOBIL_INTERRUPTED, "ended by the function of mobil_set_interrupt");
  } catch (const std::bad_alloc&) {
    return sim->line.refuse(MOBIL_MEMORY, status_text(Status::no_memory));
  } catch (const std::length_error&) {  // a count beyond any memory
    return sim->line.refuse(MOBIL_MEMORY, status_text(Status::no_memory));
  } catch (const Stopped& host) {
    return sim->line.refuse(MOBIL_REFUSED, host.what());
  } catch (const std::exception& error) {
    return sim->line.refuse(MOBIL_INTERNAL, error.what());
  }
}

}  // namespace mobil::inline v0_3::c
