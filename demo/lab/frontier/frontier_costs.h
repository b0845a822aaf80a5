#pragma once
// What a method costs in a crowd, for `mobil frontier`: memory streamed, no reports, one thread.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/engine/error.h>
#include "demo/lab/frontier/frontier_method.h"
#include "demo/lab/frontier/frontier_walks.h"
#include "systems/deformation/deformation.h"

namespace mobil {

/// Blocks of sixteen alike, as a crowd's tables have them, of every muscle and individual as many as `bytes` ask for;
/// at most `most_blocks`, and at least one of each muscle.
class FrontierCrowd {
 public:
  /// `individuals`: of each drive its sixteen, or none; of one at least. They and `drives` must outlive the crowd.
  FrontierCrowd(const FrontierMethod& method, std::span<const FrontierDrive> drives,
                std::span<const std::vector<FrontierIndividual>> individuals, bool loads, Stiffness stiffness,
                std::size_t bytes, std::size_t most_blocks);

  /// Everybody by a tick, or with a fixed step by the whole number of steps that is nearest to one. With
  /// `control_points` those of a reduced method are placed too.
  void tick(bool control_points);

  std::size_t muscles() const { return blocks_.size() * lane_count; }
  /// How much of a tick one call of tick() is.
  double ticks_a_call() const { return ticks_a_call_; }
  /// Of one individual's own numbers that a tick reads or writes, with what the control points take.
  std::size_t bytes_each() const { return bytes_each_; }
  /// Steps in a tick, the mean of all.
  double steps_a_tick() const;
  bool finite() const;

 private:
  /// Its columns stand in a row, as in a world's table.
  struct Block {
    const FrontierIndividual* individual;
    BellyScale<Lanes<float>> scale;
    EndDrive<Lanes<float>> end[2];  // to and fro
    FrameLoad<Lanes<float>> load[2];
    std::size_t first;  // of numbers_
  };

  float* column(const Block& block, std::size_t after) { return numbers_[block.first + after].lane; }
  void tick_elements(Block& block);
  void tick_vectors(std::size_t b, bool control_points);

  const FrontierMethod method_;
  const bool loads_;
  const Stiffness stiffness_;
  std::size_t bytes_each_ = 0, turn_ = 0;
  double ticks_a_call_ = 1;
  std::uint32_t fixed_steps_ = 0;
  std::size_t state_ = 0, motion_ = 0, points_ = 0, displacement_ = 0, velocity_ = 0;  // widths
  std::vector<Block> blocks_;
  std::vector<Lanes<float>> numbers_;
  std::vector<Lanes<float>> scratch_;
};

}  // namespace mobil
