#pragma once
// Blocks of bellies as the engine steps them: sixteen individuals a block, a tick at a time.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "assets/fem/muscle_template.h"
#include "demo/measure/measure.h"
#include "systems/deformation/deformation.h"

namespace mobil {

inline constexpr double paper_step_s = 0.002;
inline constexpr std::uint32_t steps_a_tick = 8;  // of 2 ms: about 60 Hz
inline constexpr float paper_tick_s = 0.016F;
inline constexpr std::size_t crowd_blocks = 64;  // 1024 muscles

/// The paper's body (30 × 30 × 120 mm, its material, a free far face) in so many elements; 2×2×8 are 15 mm cubes.
MuscleTemplate paper_block(const Cells& cells);
double paper_limit_s(const MuscleTemplate& muscle, Mass mass = Mass::lumped);

/// Multiply-adds of one step's K·u without clamped rows and columns: 9702 on 81 nodes.
double useful_multiply_adds(const Cells& cells);

/// Pull along z, N: the load that the comparison program has, and what part of it is sideways.
double bench_pull_n(double time_s);
inline constexpr double bench_sideways = 0.05;

class BenchBellies {
 public:
  /// All at rest. Individuals are 0.8–1.3 times as wide and 0.85–1.15 times as long; the first is as the template, and
  /// with Stiffness::shared all are. Each is pulled a little more than the one before.
  BenchBellies(const MuscleTemplate& muscle, Stiffness stiffness, std::size_t blocks);

  /// One tick of everybody, or of one block: by ECD or by the method of `solver`. Writes no BellyReport.
  void tick(std::uint32_t substeps, float tick_s, const BellySolver* solver = nullptr);
  void tick_block(std::size_t block, std::uint32_t substeps, float tick_s, const BellySolver* solver = nullptr);

  std::size_t blocks() const { return blocks_.size(); }
  std::size_t muscles() const { return blocks_.size() * lane_count; }
  /// Whether every elongation is a number.
  bool finite() const;

  // Of the first block: mean displacement of the far face along z, m; sizes; how much harder each is pulled.
  Lanes<float> elongation_m() const { return elongation_m(blocks_.front()); }
  const BellyScale<Lanes<float>>& scale() const { return blocks_.front().scale; }
  const Lanes<float>& strength() const { return blocks_.front().strength; }

 private:
  struct Block {
    std::vector<Lanes<float>> displacement, velocity, scratch;
    BellyScale<Lanes<float>> scale;
    Lanes<float> strength;
    double time_s = 0;
  };

  Lanes<float> elongation_m(const Block& block) const;

  const MuscleTemplate& muscle_;
  Stiffness stiffness_;
  std::vector<Block> blocks_;
};

/// Far-face elongations over time, one a step; of each lane of a block.
using Histories = std::array<std::vector<double>, lane_count>;
/// The first block of such bellies for `seconds` in steps of `dt_s`, by ECD or by the method of `solver`.
Histories bench_histories(const MuscleTemplate& muscle, Stiffness stiffness, double dt_s, double seconds,
                          const BellySolver* solver = nullptr);

/// Root mean square of the difference over the largest of `truth`, which has a whole number of samples for each of
/// `history`.
double history_error(const std::vector<double>& history, const std::vector<double>& truth);

/// The best of several rounds, other work in between.
class Rounds {
 public:
  void add(const Measured& round);
  Measured all() const;

 private:
  std::vector<Measured> rounds_;
};

}  // namespace mobil
