#pragma once
// People's poses in bulk, at any instant of a tick, as a renderer wants them.
//
//   PoseWriter writer;                                                      // keeps what it works in
//   const Ticks ticks = simulation.advance(frame_s);
//   writer.write(simulation.world(), people, ticks.alpha * simulation.tick_s(), {}, {buffer}, jobs);
//
// Walkers are where they will be that long after the last tick, exactly and without lag: a step's curves may be asked
// for at any time, and a step that begins in between is solved and not kept. Nothing in the world changes.

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

/// What is written of each segment, floats: place x y z and quaternion x y z w (28 bytes); three rows of four of the
/// matrix that takes points of the segment to the world, or to its parent (48); a dual quaternion, real part x y z w
/// first (32).
enum class PoseForm : std::uint8_t { place_and_quaternion, matrix, dual_quaternion };

/// The host's axes. Ours: y up, z ahead of who walks with heading 0, x to their left, right-handed (glTF, OpenGL).
enum class PoseAxes : std::uint8_t {
  y_up,              // ours
  y_up_left_handed,  // x to the right, z ahead (Unity)
  z_up,              // x ahead, y to the left (ROS)
  z_up_left_handed,  // x ahead, y to the right (Unreal)
  y_up_z_back,       // x to the right, z back (Godot)
};

/// How a pose is written.
struct PoseLayout {
  PoseForm form = PoseForm::place_and_quaternion;
  PoseAxes axes = PoseAxes::y_up;
  float units_per_m = 1;                   // 100: centimetres
  bool to_parent = false;                  // relative to the segment's parent; the pelvis to the world
  std::span<const Segment> segments = {};  // which, in this order; empty: all 48
};

/// Segment k of person i begins at byte i · person_stride + k · segment_stride; a stride of 0: close together.
struct PoseTarget {
  std::span<std::byte> bytes;
  std::size_t person_stride = 0, segment_stride = 0;
};

class PoseWriter {
 public:
  explicit PoseWriter(std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  /// Writes the poses of `people`, in their order, `ahead_s` after the last tick (0 to 0.2 s; a frame's alpha times the
  /// tick), with `jobs`; the same bytes for any number of threads. People whose host animates them are where it put
  /// them. Takes memory only where there are more people than ever before. Errors, in one line, before anything is
  /// written: a stale handle or somebody asleep, who is named by number; a time, a scale or a segment out of range; a
  /// stride that is too small, or a buffer.
  Result<void> write(const World& world, std::span<const Entity> people, double ahead_s, const PoseLayout& layout,
                     const PoseTarget& target, const Jobs& jobs = {});

 private:
  struct Place {
    const Table* table;
    std::uint32_t row, number;
  };
  struct Work;

  std::pmr::vector<Place> places_;
  std::pmr::vector<std::uint32_t> blocks_;  // where each block's people begin among the places, and the end
};

}  // namespace mobil::inline v0_3
