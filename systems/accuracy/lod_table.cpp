#include <mobil/systems/accuracy/lod_table.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {
namespace {

constexpr float reference_height_m = static_cast<float>(reference_body_height_m);
constexpr std::array classes = {SpeedClass::slow, SpeedClass::free, SpeedClass::fast};

/// Interpolates linearly between the classes and holds the value of the slowest class below it. Beyond the fastest
/// class it extrapolates, rising or constant, and multiplies by the seventh power of speed. Walks close to running have
/// hard heel strikes (measured by lod_show_test).
float at_speed(const std::array<float, 3>& error, float speed_m_s) {
  if (speed_m_s <= speed_class_m_s[0]) return error[0];
  const std::size_t c = speed_m_s <= speed_class_m_s[1] ? 0 : 1;
  const float part = (speed_m_s - speed_class_m_s[c]) / (speed_class_m_s[c + 1] - speed_class_m_s[c]);
  const float rise = error[c + 1] - error[c];
  if (part <= 1) return error[c] + rise * part;
  const float faster = speed_m_s / speed_class_m_s[2], cubed = faster * faster * faster;
  return (error[2] + std::max(rise, 0.0F) * (part - 1)) * cubed * cubed * faster;
}

}  // namespace

LodTable::LodTable(const AccuracyTable& table) {
  for (const bool active : {false, true}) {
    for (const bool inertia : {false, true}) {
      set_errors(table, inertia, active);
      set_costs(table.cost_of(inertia, active), inertia, active);
    }
  }
}

void LodTable::set_errors(const AccuracyTable& table, bool inertia, bool active) {
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    std::array<const AccuracyRow*, 3> rows{};
    for (std::size_t c = 0; c < 3; ++c) rows[c] = table.find(static_cast<Muscle>(m), classes[c], inertia, active);
    if (rows[0] == nullptr || rows[1] == nullptr || rows[2] == nullptr) continue;
    for (std::size_t r = 0; r < level_count; ++r) {
      const std::array<float, 3> at = {rows[0]->error_m[r], rows[1]->error_m[r], rows[2]->error_m[r]};
      for (std::size_t step = 0; step < speed_steps; ++step) {
        const auto low = static_cast<float>(step) * speed_step_m_s;
        error_[active][inertia][step][m][r] = std::max(at_speed(at, low), at_speed(at, low + speed_step_m_s));
      }
      volume_off_[active][inertia][m][r] =
          std::max({rows[0]->volume_off[r], rows[1]->volume_off[r], rows[2]->volume_off[r]});
    }
  }
}

void LodTable::set_costs(const LevelCost& of, bool inertia, bool active) {
  for (const bool points : {false, true}) {
    auto& cost = cost_[active][inertia][points];
    for (std::size_t r = 0; r < level_count; ++r) {
      const float us = of.state_us[r] + (points ? of.points_us[r] : 0.0F);
      cost[r] = std::llround(2e6 * static_cast<double>(us));
    }
    auto& order = order_[active][inertia][points];
    for (std::size_t r = 0; r < level_count; ++r) order[r] = static_cast<std::uint8_t>(r);
    std::ranges::stable_sort(order, [&](auto a, auto b) { return cost[a] < cost[b]; });
  }
}

std::uint32_t LodTable::speed_step(float speed_m_s, float height_m) {
  const float as_reference = speed_m_s * std::sqrt(reference_height_m / height_m);
  if (!(as_reference < speed_step_m_s * static_cast<float>(speed_steps - 1))) return speed_steps - 1;
  return static_cast<std::uint32_t>(std::max(as_reference, 0.0F) / speed_step_m_s);
}

float LodTable::error_m(const LevelCase& of, std::uint32_t level, float height_m) const {
  return error_m(of, level) * height_m / reference_height_m;
}

std::uint32_t LodTable::cheapest(const LevelCase& of, float limit_m) const {
  std::uint32_t best = 0;
  float least = INFINITY;
  for (const std::uint8_t level : by_cost(of)) {
    const float error = error_m(of, level);
    if (error <= limit_m) return level;
    if (error < least) {
      least = error;
      best = level;
    }
  }
  return best;
}

std::uint32_t LodTable::from(std::uint32_t current, const LevelCase& of, float limit_m, float slack) const {
  const std::uint32_t needed = cheapest(of, limit_m);
  if (error_m(of, current) > limit_m) return needed;
  const std::uint32_t cheaper = cheapest(of, slack * limit_m);
  return cost_ps(of, cheaper) < cost_ps(of, current) ? cheaper : current;
}

void CostSpectrum::add(const LodTable& lod_table, const LevelCase& of, float size) {
  std::int64_t before = 0;
  float due_below = INFINITY;
  for (const std::uint8_t level : lod_table.by_cost(of)) {
    const float factor = lod_table.error_m(of, level) * size;
    if (!(factor < due_below)) continue;  // more expensive but not more accurate
    const std::int64_t cost = lod_table.cost_ps(of, level);
    if (cost > before) add(due_below, cost - before);
    before = cost;
    due_below = factor;
  }
}

float CostSpectrum::factor_within(std::int64_t budget_ps) const {
  std::int64_t cost = 0;
  for (std::size_t b = bins; b > 0; --b) {
    cost += due_[b - 1];
    if (cost > budget_ps) return b == bins ? max_factor : lower_edge(b);
  }
  return min_factor;
}

std::int64_t CostSpectrum::cost_at(float factor) const {
  std::int64_t cost = 0;
  for (std::size_t b = bin(factor); b < bins; ++b) cost += due_[b];
  return cost;
}

/// Computes the bin from the exponent and the first four fraction bits of the number.
std::size_t CostSpectrum::bin(float factor) {
  if (!(factor > min_factor)) return 0;
  if (!(factor < max_factor)) return bins - 1;
  return (std::bit_cast<std::uint32_t>(factor) >> 19) - (std::bit_cast<std::uint32_t>(min_factor) >> 19);
}

float CostSpectrum::lower_edge(std::size_t bin) {
  return std::bit_cast<float>(static_cast<std::uint32_t>((std::bit_cast<std::uint32_t>(min_factor) >> 19) + bin) << 19);
}

void MachineFactor::observe(double measured_s, double predicted_s) {
  if (!(predicted_s > 1e-6) || !(measured_s > 0)) return;
  const double ratio = measured_s / predicted_s;
  if (seen_ == 0) mean_ = ratio;
  const double counted = std::min(ratio, 2 * mean_);
  const double weight = std::max(0.04, 1.0 / static_cast<double>(++seen_));
  deviation_ += std::max(0.04, std::min(0.5, weight)) * (std::abs(counted - mean_) - deviation_);
  mean_ += weight * (counted - mean_);
  if (seen_ > 1000) seen_ = 1000;
}

double MachineFactor::pessimistic() const {
  constexpr double deviations =
      3.3;  // 2.33 standard deviations of a bell curve, each 1.25 mean absolute ones, and a margin for estimates
  return std::max(mean_, (mean_ + deviations * deviation_) / 1.1);
}

bool CostSpectrum::is_sound() const {
  constexpr std::int64_t max_ps = std::int64_t{1} << 52;
  return std::ranges::all_of(due_, [](std::int64_t due) { return due >= 0 && due <= max_ps; });
}

bool MachineFactor::is_sound() const {
  return std::isfinite(mean_) && mean_ > 0 && std::isfinite(deviation_) && deviation_ >= 0;
}

}  // namespace mobil::inline v0_3
