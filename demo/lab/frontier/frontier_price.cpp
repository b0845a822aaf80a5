// Costs of each method in a crowd, with memory streamed, no reports and one thread. Methods alternate, so that other
// load affects all equally.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <mobil/engine/jobs.h>
#include "demo/lab/bench/bench_fem_bellies.h"
#include "demo/lab/frontier/frontier.h"
#include "demo/program/must.h"
#include "systems/deformation/deformation.h"
#include "systems/deformation/modal.h"

namespace mobil {
namespace {

void fill(const std::vector<float>& of, Lanes<float>* to) {
  for (std::size_t i = 0; i < of.size(); ++i) std::ranges::fill(to[i].lane, of[i]);
}

/// Returns one lane of a component's block, repeated in all of its lanes.
template <template <class> class C>
C<Lanes<float>> alike(const C<Lanes<float>>& of, std::size_t lane) {
  static_assert(sizeof(C<Lanes<float>>) % sizeof(Lanes<float>) == 0);
  C<Lanes<float>> all = of;
  auto* const fields = reinterpret_cast<Lanes<float>*>(&all);
  for (std::size_t i = 0; i < sizeof all / sizeof(Lanes<float>); ++i) {
    std::ranges::fill(fields[i].lane, fields[i].lane[lane]);
  }
  return all;
}

/// Blocks of sixteen identical individuals, as in a crowd's tables. There are as many of every muscle and individual as
/// fit in `bytes`: at most `max_blocks`, and at least one of each muscle.
class FrontierCrowd {
 public:
  /// `individuals`: sixteen or none for each drive, for at least one. They and `drives` must outlive the crowd.
  FrontierCrowd(const FrontierMethod& method, std::span<const FrontierDrive> drives,
                std::span<const std::vector<FrontierIndividual>> individuals, bool loads, Stiffness stiffness,
                std::size_t bytes, std::size_t max_blocks)
      : method_(method), loads_(loads), stiffness_(stiffness) {
    const std::size_t input =
        sizeof(EndDrive<float>) + sizeof(BellyScale<float>) + (loads ? sizeof(FrameLoad<float>) : 0);
    const auto there = [](const std::vector<FrontierIndividual>& sixteen) { return !sixteen.empty(); };
    const FrontierIndividual& first = std::ranges::find_if(individuals, there)->front();
    const auto muscles = static_cast<std::size_t>(std::ranges::count_if(individuals, there));
    if (method.modal()) {
      const ModalBasis& basis = *first.basis;
      points_ = modal_shape_width(basis.modes, basis.inputs);
      displacement_ = point_width;
      if (method.moving()) {
        state_ = modal_state_width(basis.modes);
        motion_ = modal_motion_width(basis.modes, basis.inputs);
      }
    } else {
      displacement_ = nodal_width(method.choice.cells);
      velocity_ = method.choice.method == Method::statics ? 0 : displacement_;
      scratch_.resize(scratch_floats(*first.shape, method.choice.method) / lane_count + 1);
    }
    const std::size_t numbers = state_ + motion_ + points_ + displacement_ + velocity_;
    bytes_each_ = input + numbers * sizeof(float);
    if (method.fixed_step) {
      fixed_steps_ = static_cast<std::uint32_t>(std::lround(frontier_tick_s / *method.choice.dt_s));
      ticks_a_call_ = fixed_steps_ * *method.choice.dt_s / frontier_tick_s;
    }
    const std::size_t wanted = bytes / (bytes_each_ * lane_count);
    const std::size_t each = std::max<std::size_t>(std::min(wanted, max_blocks) / muscles, 1);
    for (std::size_t m = 0; m < drives.size(); ++m) {
      if (individuals[m].empty()) continue;
      const FrontierDrive& drive = drives[m];
      for (std::size_t b = 0; b < each; ++b) {
        // The first walks contain each individual once. A few blocks take the middle ones.
        const std::size_t lane = each < lane_count ? (2 * b + 1) * lane_count / (2 * each) : b * lane_count / each;
        Block& block = blocks_.emplace_back();
        block.individual = &individuals[m][lane];
        block.scale = alike<BellyScale>(drive.scale, lane);
        if (stiffness == Stiffness::shared) fill({1, 1}, &block.scale.across);
        const double time_s =
            static_cast<double>(drive.first + 7 * b % (drive.ticks() - drive.first)) * frontier_tick_s;
        for (std::size_t way = 0; way < 2; ++way) {
          const double from_s = way == 0 ? time_s : time_s + frontier_tick_s,
                       to_s = 2 * time_s + frontier_tick_s - from_s;
          block.end[way] = alike<EndDrive>(drive.end(from_s, to_s), lane);
          if (loads) block.load[way] = alike<FrameLoad>(drive.load(from_s, to_s), lane);
        }
        block.first = numbers * (blocks_.size() - 1);
      }
    }
    numbers_.resize(numbers * blocks_.size());
    if (!method.modal()) return;
    for (const Block& block : blocks_) {
      if (method.moving()) fill(block.individual->motion, &numbers_[block.first + state_]);
      fill(block.individual->points, &numbers_[block.first + state_ + motion_]);
    }
  }

  /// Advances all by a tick or, with a fixed step, by the integer number of steps nearest to a tick. `control_points`
  /// also places those of a modal method.
  void tick(bool control_points) {
    const FloatMode mode;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (method_.modal()) {
        tick_modes(b, control_points);
      } else {
        tick_elements(blocks_[b]);
      }
    }
    turn_ = 1 - turn_;
  }

  std::size_t muscles() const { return blocks_.size() * lane_count; }
  /// Returns the ticks in one call of tick().
  double ticks_a_call() const { return ticks_a_call_; }
  /// Returns the bytes of one individual that a tick reads or writes, control points included.
  std::size_t bytes_each() const { return bytes_each_; }
  /// Returns the mean number of steps in a tick.
  double steps_a_tick() const {
    if (method_.fixed_step) return frontier_tick_s / *method_.choice.dt_s;
    double sum = 0;
    for (const Block& block : blocks_) sum += block.individual->steps;
    return sum / static_cast<double>(blocks_.size());
  }
  bool finite() const {
    const std::size_t before = method_.modal() ? state_ + motion_ + points_ : 0;
    return std::ranges::all_of(blocks_, [&](const Block& block) {
      const auto shown = std::span(numbers_).subspan(block.first + before, displacement_);
      return std::ranges::all_of(shown, [](const Lanes<float>& numbers) {
        return std::ranges::all_of(numbers.lane, [](float x) { return std::isfinite(x); });
      });
    });
  }

 private:
  /// Its columns are in a row, as in a world's table.
  struct Block {
    const FrontierIndividual* individual;
    BellyScale<Lanes<float>> scale;
    EndDrive<Lanes<float>> end[2];  // to and fro
    FrameLoad<Lanes<float>> load[2];
    std::size_t first;  // of numbers_
  };

  float* column(const Block& block, std::size_t after) { return numbers_[block.first + after].lane; }
  void tick_elements(Block& block) {
    const FrontierIndividual& own = *block.individual;
    BellyReport<Lanes<float>> unused;
    const BellyBlock bellies{*own.shape,
                             block.scale,
                             column(block, 0),
                             velocity_ == 0 ? nullptr : column(block, displacement_),
                             unused,
                             stiffness_,
                             loads_ ? &block.load[turn_] : nullptr,
                             false};
    const auto tick_s = static_cast<float>(ticks_a_call_ * frontier_tick_s);
    const std::uint32_t steps = method_.fixed_step ? fixed_steps_ : own.steps;
    if (own.solver == nullptr) {
      deform_explicit(bellies, {FarEnd::held, block.end[turn_]}, steps, tick_s, scratch_.data()->lane);
    } else {
      deform_implicit(bellies, *own.solver, {FarEnd::held, block.end[turn_]}, steps, tick_s, scratch_.data()->lane);
    }
  }
  void tick_modes(std::size_t b, bool control_points) {
    const Block& block = blocks_[b];
    const Block& next = blocks_[std::min(b + 1, blocks_.size() - 1)];
    const ModalBlock bellies{*block.individual->basis,
                             block.scale,
                             column(block, 0),
                             column(block, state_),
                             loads_ ? &block.load[turn_] : nullptr,
                             column(next, 0),
                             column(next, state_)};
    const ControlPoints points{column(block, state_ + motion_), column(block, state_ + motion_ + points_), true,
                               column(next, state_ + motion_)};
    if (!method_.moving()) {
      place_static(bellies, points, {FarEnd::held, block.end[turn_]});
      return;
    }
    deform_modal(bellies, {FarEnd::held, block.end[turn_]}, static_cast<float>(frontier_tick_s));
    if (control_points) place_control_points(bellies, points, {FarEnd::held, block.end[turn_]});
  }

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

constexpr int repeats = 3;

struct Meter {
  std::unique_ptr<FrontierCrowd> crowd;
  Rounds ticks, points;

  void measure_once(bool also_points) {
    ticks.add(measure(repeats, [this] { crowd->tick(false); }));
    if (also_points) points.add(measure(repeats, [this] { crowd->tick(true); }));
  }
  /// Returns µs of one muscle in a tick of 1/60 s: the minimum of the thread's processor time.
  double us(const Rounds& rounds) const {
    return *rounds.all().cpu_s / (static_cast<double>(crowd->muscles()) * crowd->ticks_a_call()) * 1e6;
  }
};

/// Returns as many blocks as fill the memory, or as fit in the time.
std::unique_ptr<FrontierCrowd> crowd_of(const FrontierPriced& priced, std::span<const FrontierDrive> drives, bool loads,
                                        Stiffness stiffness, const FrontierRequest& request) {
  const FrontierMethod& method = priced.level->method;
  FrontierCrowd few(method, drives, priced.individuals, loads, stiffness, request.bytes, 1);
  const double block_s = measure(1, [&] { few.tick(true); }).best_s * lane_count / static_cast<double>(few.muscles());
  const auto most = static_cast<std::size_t>(request.call_s / block_s);
  return std::make_unique<FrontierCrowd>(method, drives, priced.individuals, loads, stiffness, request.bytes, most);
}

}  // namespace

void price(std::span<const FrontierPriced> all, std::span<const FrontierDrive> drives, bool loads, Frontier& frontier) {
  if (all.empty()) throw Stopped("frontier: no method is left to be measured; choose others");
  const FrontierRequest& request = frontier.request;
  std::vector<Meter> meters(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    meters[i].crowd = crowd_of(all[i], drives, loads, Stiffness::individual, request);
  }
  Meter shared{crowd_of(all.front(), drives, loads, Stiffness::shared, request), {}, {}};
  const auto has_choice = [&](std::size_t i) { return all[i].level->method.modal() && all[i].level->method.moving(); };
  for (int round = 0; round < request.rounds; ++round) {
    request.progress(loads ? "costs with the frame's loads" : "costs", static_cast<double>(round) / request.rounds);
    for (std::size_t i = 0; i < all.size(); ++i) meters[i].measure_once(has_choice(i));
    if (!loads) shared.measure_once(false);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Meter& meter = meters[i];
    if (!meter.crowd->finite()) {
      throw Stopped(
          fmt::format("frontier: {} of {}: a displacement is not a number", all[i].row->method, all[i].row->cells));
    }
    FrontierRow& row = *all[i].row;
    row.cost_us = meter.us(meter.ticks);
    row.points_us = has_choice(i) ? meter.us(meter.points) : row.cost_us;
    row.memory_bytes = meter.crowd->bytes_each();
    row.dt_s = frontier_tick_s / meter.crowd->steps_a_tick();
    row.ratio = all.front().row->cost_us / row.cost_us;
    row.points_ratio = all.front().row->cost_us / row.points_us;
    const bool least = frontier.min_muscles == 0 || meter.crowd->muscles() < frontier.min_muscles;
    if (least) frontier.min_muscles = meter.crowd->muscles();
  }
  if (!loads) frontier.shared_us = shared.us(shared.ticks);
}

}  // namespace mobil
