#pragma once
// Blocks of bellies as the engine steps them: sixteen individuals a block, one tick at a time.

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

/// Returns the paper's body (30 × 30 × 120 mm, its material, a free far face) in these elements; 2×2×8 are 15 mm cubes.
MuscleTemplate paper_block(const Cells& cells);
double paper_limit_s(const MuscleTemplate& muscle, Mass mass = Mass::lumped);

/// Returns the multiply-adds of one step's K·u without clamped rows and columns: 9702 on 81 nodes.
double useful_multiply_adds(const Cells& cells);

/// Returns the pull along z, N, as in the comparison program; `bench_sideways` of it is sideways.
double bench_pull_n(double time_s);
inline constexpr double bench_sideways = 0.05;

class BenchBellies {
 public:
  /// All are at rest. Individuals are 0.8–1.3 times as wide and 0.85–1.15 times as long; the first equals the template,
  /// and with Stiffness::shared all do. Each is pulled a little more than the previous one.
  BenchBellies(const MuscleTemplate& muscle, Stiffness stiffness, std::size_t blocks);

  /// Advance all bellies, or one block, by a tick: explicit central differences or `solver`. Write no BellyReport.
  void tick(std::uint32_t substeps, float tick_s, const BellySolver* solver = nullptr);
  void tick_block(std::size_t block, std::uint32_t substeps, float tick_s, const BellySolver* solver = nullptr);

  std::size_t blocks() const { return blocks_.size(); }
  std::size_t muscles() const { return blocks_.size() * lane_count; }
  /// Returns true if every elongation is finite.
  bool finite() const;

  // Return data of the first block: mean far-face displacement along z, m; sizes; relative pull of each lane.
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

/// Far-face elongations over time, one a step, for each lane of a block.
using Histories = std::array<std::vector<double>, lane_count>;
/// Returns the first block's elongations for `seconds` in steps of `dt_s`, by explicit central differences or `solver`.
Histories bench_histories(const MuscleTemplate& muscle, Stiffness stiffness, double dt_s, double seconds,
                          const BellySolver* solver = nullptr);

/// Returns the root mean square of the difference over the largest of `truth`, which has an integer number of samples
/// for each of `history`.
double history_error(const std::vector<double>& history, const std::vector<double>& truth);

/// Best of several rounds, with other work in between.
class Rounds {
 public:
  void add(const Measured& round);
  Measured all() const;

 private:
  std::vector<Measured> rounds_;
};

}  // namespace mobil
