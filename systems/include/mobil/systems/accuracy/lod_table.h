#pragma once
// The cheapest method that is good enough, and the best that a budget affords: the arithmetic of level of detail
// (mobil/lod.h), which knows nothing of people.

#include <array>
#include <cstddef>
#include <cstdint>

#include <mobil/components/muscle.h>
#include <mobil/systems/accuracy/accuracy_table.h>

namespace mobil::inline v0_3 {

/// Which of a table's figures apply.
struct LevelCase {
  std::uint32_t muscle = 0;
  std::uint32_t speed_step = 0;  // LodTable::speed_step
  bool inertia = false, points = true, active = false;
};

/// An accuracy table prepared for choosing: errors at even steps of speed, each the larger of its ends'; levels by
/// cost. Pure functions of the table.
class LodTable {
 public:
  /// The lod_table has errors at so many speeds, so far apart.
  static constexpr std::uint32_t speed_steps = 26;
  static constexpr float speed_step_m_s = 0.1F;

  explicit LodTable(const AccuracyTable& table);

  /// The step of a walk of that speed (m/s) by a body of that height (m); NaN gives the last step.
  static std::uint32_t speed_step(float speed_m_s, float height_m);

  /// Predicted error in a body of the reference's height, m.
  float error_m(const LevelCase& of, std::uint32_t level) const {
    return error_[of.active][of.inertia][of.speed_step][of.muscle][level];
  }
  /// The same in a body of that height.
  float error_m(const LevelCase& of, std::uint32_t level, float height_m) const;
  /// How much of the volume at rest its control points enclose more or less; 0 where that was not measured.
  float volume_off(const LevelCase& of, std::uint32_t level) const {
    return volume_off_[of.active][of.inertia][of.muscle][level];
  }
  /// Of both legs' muscles, a tick of 1/60 s, picoseconds on the machine that was measured.
  std::int64_t cost_ps(const LevelCase& of, std::uint32_t level) const {
    return cost_[of.active][of.inertia][of.points][level];
  }
  /// The same in microseconds, for people to read.
  float cost_us(const LevelCase& of, std::uint32_t level) const {
    return 1e-6F * static_cast<float>(cost_ps(of, level));
  }
  /// Levels by cost, the cheapest first; of equal cost the lower.
  const std::array<std::uint8_t, level_count>& by_cost(const LevelCase& of) const {
    return order_[of.active][of.inertia][of.points];
  }

  /// The cheapest level whose error is at most `limit_m`; where none is, the one of the least error.
  std::uint32_t cheapest(const LevelCase& of, float limit_m) const;
  /// The same for a muscle that has a level already: it goes to a cheaper one only where that meets `slack` (at most 1)
  /// of the limit, and stays else while its own meets the limit.
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

/// What a crowd costs as a function of the factor by which everybody may miss their tolerance: a histogram of costs
/// over the factors at which they fall due, sixteen bins an octave. Whole numbers: the same in any order of adding.
class CostSpectrum {
 public:
  /// The range of factors that the spectrum covers.
  static constexpr float min_factor = 0x1p-10F, max_factor = 0x1p14F;

  /// Removes all costs.
  void clear() { due_.fill(0); }
  /// `cost_ps` falls due while the factor is below `factor`.
  void add(float factor, std::int64_t cost_ps) { due_[bin(factor)] += cost_ps; }
  void add(const CostSpectrum& more) {
    for (std::size_t i = 0; i < bins; ++i) due_[i] += more.due_[i];
  }
  /// What a muscle costs whose errors are `size` times the table's parts of its tolerance (`size` in 1/m).
  void add(const LodTable& lod_table, const LevelCase& of, float size);
  /// The least factor, min_factor ≤ … ≤ max_factor, at which all costs at most `budget_ps`, up to a bin (4 %).
  float factor_within(std::int64_t budget_ps) const;
  std::int64_t cost_at(float factor) const;
  /// Whether no cost is negative or larger than sums can hold.
  bool is_sound() const;

 private:
  static constexpr std::size_t bins = 24 * 16;
  static std::size_t bin(float factor);
  static float lower_edge(std::size_t bin);

  std::array<std::int64_t, bins> due_{};
};

/// How much slower this machine is than the one that was measured: a smoothed mean of measured over predicted time, and
/// how it scatters.
class MachineFactor {
 public:
  MachineFactor() = default;
  explicit MachineFactor(double first) : mean_(first) {}
  /// One tick, both in seconds. Ticks predicted below 1 µs tell nothing; a single one counts at most twice the mean.
  void observe(double measured_s, double predicted_s);
  double mean() const { return mean_; }
  /// A factor to plan by so that 99 of 100 ticks stay within 1.1 of what is planned.
  double pessimistic() const;
  /// Whether it is finite and positive.
  bool is_sound() const;

 private:
  double mean_ = 1, deviation_ = 0;
  std::uint64_t seen_ = 0;
};

}  // namespace mobil::inline v0_3
