#pragma once
// Arithmetic of level of detail (mobil/lod.h), independent of people: the cheapest method within a tolerance, and the
// best one within a budget.

#include <array>
#include <cstddef>
#include <cstdint>

#include <mobil/components/muscle.h>
#include <mobil/systems/accuracy/accuracy_table.h>

namespace mobil::inline v0_3 {

/// Selects the figures of a table.
struct LevelCase {
  std::uint32_t muscle = 0;
  std::uint32_t speed_step = 0;  // LodTable::speed_step
  bool inertia = false, points = true, active = false;
};

/// An accuracy table prepared for lookup: errors at equal steps of speed, each the larger one of both ends, and levels
/// ordered by cost. All functions depend on the table alone.
class LodTable {
 public:
  /// Number and distance of the speeds at which errors are stored.
  static constexpr std::uint32_t speed_steps = 26;
  static constexpr float speed_step_m_s = 0.1F;

  explicit LodTable(const AccuracyTable& table);

  /// Returns the step for a speed (m/s) and a body height (m); the last step for NaN.
  static std::uint32_t speed_step(float speed_m_s, float height_m);

  /// Predicted error in a body of the reference height, m.
  float error_m(const LevelCase& of, std::uint32_t level) const {
    return error_[of.active][of.inertia][of.speed_step][of.muscle][level];
  }
  /// Predicted error in a body of height `height_m`, m.
  float error_m(const LevelCase& of, std::uint32_t level, float height_m) const;
  /// Relative error of the volume that the control points enclose; 0 if not measured.
  float volume_off(const LevelCase& of, std::uint32_t level) const {
    return volume_off_[of.active][of.inertia][of.muscle][level];
  }
  /// Cost of both legs' muscles in a tick of 1/60 s, picoseconds on the measured machine.
  std::int64_t cost_ps(const LevelCase& of, std::uint32_t level) const {
    return cost_[of.active][of.inertia][of.points][level];
  }
  /// Cost in microseconds, for display.
  float cost_us(const LevelCase& of, std::uint32_t level) const {
    return 1e-6F * static_cast<float>(cost_ps(of, level));
  }
  /// Levels by cost, the cheapest first; of two with equal cost the lower one first.
  const std::array<std::uint8_t, level_count>& by_cost(const LevelCase& of) const {
    return order_[of.active][of.inertia][of.points];
  }

  /// Returns the cheapest level with an error of at most `limit_m`, or the level with the smallest error.
  std::uint32_t cheapest(const LevelCase& of, float limit_m) const;
  /// Returns the next level of a muscle at level `current`. It changes to a cheaper level only if that is within
  /// `slack` (at most 1) of the limit, and to a dearer one only if its own exceeds the limit.
  std::uint32_t from(std::uint32_t current, const LevelCase& of, float limit_m, float slack) const;

 private:
  using Errors = std::array<std::array<std::array<float, level_count>, max_muscles>, speed_steps>;
  template <class T>
  using ByCase = std::array<std::array<T, 2>, 2>;  // active, inertia

  void set_errors(const AccuracyTable& table, bool inertia, bool active);
  void set_costs(const LevelCost& of, bool inertia, bool active);

  ByCase<Errors> error_{};
  ByCase<std::array<std::array<float, level_count>, max_muscles>> volume_off_{};
  ByCase<std::array<std::array<std::int64_t, level_count>, 2>> cost_{};
  ByCase<std::array<std::array<std::uint8_t, level_count>, 2>> order_{};
};

/// Cost of a crowd as a function of the common factor on all tolerances: a histogram of costs over the factors below
/// which they are incurred, sixteen bins an octave. Costs are integers, so their sum does not depend on the order.
class CostSpectrum {
 public:
  /// The range of factors that the spectrum covers.
  static constexpr float min_factor = 0x1p-10F, max_factor = 0x1p14F;

  /// Removes all costs.
  void clear() { due_.fill(0); }
  /// Adds a cost that is incurred while the common factor is below `factor`.
  void add(float factor, std::int64_t cost_ps) { due_[bin(factor)] += cost_ps; }
  void add(const CostSpectrum& more) {
    for (std::size_t i = 0; i < bins; ++i) due_[i] += more.due_[i];
  }
  /// Adds the costs of a muscle. `size`, 1/m, times an error of the table is that error over the muscle's tolerance.
  void add(const LodTable& lod_table, const LevelCase& of, float size);
  /// Returns the smallest factor in the range at which all costs are at most `budget_ps`, to within a bin (4 %).
  float factor_within(std::int64_t budget_ps) const;
  std::int64_t cost_at(float factor) const;
  /// Returns true if all costs are non-negative and small enough to be summed.
  bool is_sound() const;

 private:
  static constexpr std::size_t bins = 24 * 16;
  static std::size_t bin(float factor);
  static float lower_edge(std::size_t bin);

  std::array<std::int64_t, bins> due_{};
};

/// Time of this machine over that of the measured one: a smoothed mean of the ratio of measured and predicted time, and
/// its deviation.
class MachineFactor {
 public:
  MachineFactor() = default;
  explicit MachineFactor(double first) : mean_(first) {}
  /// Adds a tick, times in s. Ticks predicted below 1 µs are ignored, and a ratio is clamped to twice the mean.
  void observe(double measured_s, double predicted_s);
  double mean() const { return mean_; }
  /// Returns the factor with which 99 of 100 ticks take at most 1.1 times the planned time.
  double pessimistic() const;
  /// Returns true if the factor is finite and positive.
  bool is_sound() const;

 private:
  double mean_ = 1, deviation_ = 0;
  std::uint64_t seen_ = 0;
};

}  // namespace mobil::inline v0_3
