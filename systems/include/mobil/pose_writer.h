#pragma once
// Writes poses of many people for a renderer, at any instant of a tick.
//
//   PoseWriter writer;                                                      // keeps its scratch memory
//   const Ticks ticks = simulation.advance(frame_s);
//   writer.write(simulation.world(), people, ticks.alpha * simulation.tick_s(), {}, {buffer}, jobs);
//
// The poses of walkers are exact at that instant, without lag, because a step is a function of time. A step that begins
// between the tick and that instant is solved and not kept. The world does not change.

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/components/segments.h>
#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// Format of a segment, in floats: position x y z and quaternion x y z w (28 bytes); three rows of four of the matrix
/// from the segment to the world or its parent (48 bytes); dual quaternion, real part x y z w first (32 bytes).
enum class PoseForm : std::uint8_t { place_and_quaternion, matrix, dual_quaternion };

/// Axes of the host. The library's are y up, z ahead of a walker with heading 0, x to the left, right-handed (glTF,
/// OpenGL).
enum class PoseAxes : std::uint8_t {
  y_up,              // the library's
  y_up_left_handed,  // x to the right, z ahead (Unity)
  z_up,              // x ahead, y to the left (ROS)
  z_up_left_handed,  // x ahead, y to the right (Unreal)
  y_up_z_back,       // x to the right, z back (Godot)
};

/// Layout of a written pose.
struct PoseLayout {
  PoseForm form = PoseForm::place_and_quaternion;
  PoseAxes axes = PoseAxes::y_up;
  float units_per_m = 1;                   // 100: centimetres
  bool to_parent = false;                  // relative to the parent segment; the pelvis relative to the world
  std::span<const Segment> segments = {};  // written segments, in this order; empty: all 48
};

/// The caller's buffer. Segment k of person i begins at byte i · person_stride + k · segment_stride. A stride of 0
/// means tightly packed.
struct PoseTarget {
  std::span<std::byte> bytes;
  std::size_t person_stride = 0, segment_stride = 0;
};

class PoseWriter {
 public:
  explicit PoseWriter(std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  /// Writes the poses of `people`, in their order, `ahead_s` after the last tick (0 to 0.2 s; a frame's alpha times the
  /// tick), with `jobs`. The bytes are the same for any number of threads. Posed people have the pose that the host
  /// set. Allocates only for more people than in any earlier call. Errors, before anything is written: a stale handle
  /// or a sleeper, with the index; a time, a scale or a segment out of range; a stride or a buffer that is too small.
  Result<void> write(const World& world, std::span<const Entity> people, double ahead_s, const PoseLayout& layout,
                     const PoseTarget& target, const Jobs& jobs = {});

 private:
  struct Place {
    const Table* table;
    std::uint32_t row, number;
  };
  struct Work;

  std::pmr::vector<Place> places_;
  std::pmr::vector<std::uint32_t> blocks_;  // index of each block's first place, and the end
};

}  // namespace mobil::inline v0_3
