#include "demo/frontier_costs.h"

#include <algorithm>
#include <cmath>

#include "engine/jobs.h"
#include "systems/deformation/reduced.h"

namespace mobil {
namespace {

std::vector<Lanes<float>> alike(const std::vector<float>& of) {
  std::vector<Lanes<float>> all(of.size());
  for (std::size_t i = 0; i < of.size(); ++i) std::ranges::fill(all[i].lane, of[i]);
  return all;
}

/// One lane of a component's block in all of its lanes.
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

}  // namespace

FrontierCrowd::FrontierCrowd(const FrontierMethod& method, std::span<const FrontierDrive> drives,
                             std::span<const std::vector<FrontierIndividual>> individuals, bool loads,
                             Stiffness stiffness, std::size_t bytes, std::size_t most_blocks)
    : method_(method), loads_(loads), stiffness_(stiffness) {
  const std::size_t input =
      sizeof(EndDisplacement<float>) + sizeof(BellyScale<float>) + (loads ? sizeof(FrameLoad<float>) : 0);
  const FrontierIndividual& first = individuals.front().front();
  std::size_t numbers = 0;
  if (method.reduced()) {
    const ReducedBasis& basis = *first.basis;
    numbers = reduced_shape_width(basis.vectors, basis.inputs) + point_width;
    if (method.moving()) {
      numbers += reduced_state_width(basis.vectors, basis.inputs) + reduced_motion_width(basis.vectors, basis.inputs);
    }
  } else {
    numbers = nodal_width(method.choice.cells) * (method.choice.method == Method::statics ? 1 : 2);
    scratch_.resize(scratch_floats(*first.shape, method.choice.method) / lane_count + 1);
  }
  bytes_each_ = input + numbers * sizeof(float);
  if (method.fixed_step) {
    fixed_steps_ = static_cast<std::uint32_t>(std::lround(frontier_tick_s / *method.choice.dt_s));
    ticks_a_call_ = fixed_steps_ * *method.choice.dt_s / frontier_tick_s;
  }
  const std::size_t wanted = bytes / (bytes_each_ * lane_count);
  const std::size_t each = std::max<std::size_t>(std::min(wanted, most_blocks) / drives.size(), 1);
  for (std::size_t m = 0; m < drives.size(); ++m) {
    const FrontierDrive& drive = drives[m];
    for (std::size_t b = 0; b < each; ++b) {
      // The first walks are everybody's once; of few blocks those in the middle.
      const std::size_t lane = each < lane_count ? (2 * b + 1) * lane_count / (2 * each) : b * lane_count / each;
      Block& block = blocks_.emplace_back();
      block.individual = &individuals[m][lane];
      block.scale = alike<BellyScale>(drive.scale, lane);
      if (stiffness == Stiffness::shared) block.scale = {alike({1.0F})[0], alike({1.0F})[0]};
      const double time_s = static_cast<double>(drive.first + 7 * b % (drive.ticks() - drive.first)) * frontier_tick_s;
      for (std::size_t way = 0; way < 2; ++way) {
        const double from_s = way == 0 ? time_s : time_s + frontier_tick_s,
                     to_s = 2 * time_s + frontier_tick_s - from_s;
        block.end[way] = alike<EndDisplacement>(drive.end(from_s, to_s), lane);
        if (loads) block.load[way] = alike<FrameLoad>(drive.load(from_s, to_s), lane);
      }
      if (method.reduced()) {
        block.state.resize(reduced_state_width(first.basis->vectors, first.basis->inputs));
        block.motion = alike(block.individual->motion);
        block.points = alike(block.individual->points);
        block.displacement.resize(point_width);
      } else {
        block.displacement.resize(nodal_width(method.choice.cells));
        block.velocity.resize(method.choice.method == Method::statics ? 0 : block.displacement.size());
      }
    }
  }
}

void FrontierCrowd::tick(bool control_points) {
  const FlushDenormals flush;
  for (Block& block : blocks_) {
    if (method_.reduced()) {
      tick_vectors(block, control_points);
    } else {
      tick_elements(block);
    }
  }
  turn_ = 1 - turn_;
}

void FrontierCrowd::tick_elements(Block& block) {
  const FrontierIndividual& own = *block.individual;
  BellyReport<Lanes<float>> unused;
  const BellyBlock bellies{*own.shape,
                           block.scale,
                           block.displacement.data()->lane,
                           block.velocity.empty() ? nullptr : block.velocity.data()->lane,
                           unused,
                           stiffness_,
                           loads_ ? &block.load[turn_] : nullptr,
                           false};
  const auto tick_s = static_cast<float>(ticks_a_call_ * frontier_tick_s);
  const std::uint32_t steps = method_.fixed_step ? fixed_steps_ : own.steps;
  if (own.solver == nullptr) {
    deform_explicit(bellies, block.end[turn_], steps, tick_s, scratch_.data()->lane);
  } else {
    deform_implicit(bellies, *own.solver, block.end[turn_], steps, tick_s, scratch_.data()->lane);
  }
}

void FrontierCrowd::tick_vectors(Block& block, bool control_points) {
  const ReducedBlock bellies{*block.individual->basis, block.scale, block.state.data()->lane, block.motion.data()->lane,
                             loads_ ? &block.load[turn_] : nullptr};
  const ControlPoints points{block.points.data()->lane, block.displacement.data()->lane};
  if (!method_.moving()) {
    place_static(bellies, points, block.end[turn_]);
    return;
  }
  deform_reduced(bellies, block.end[turn_], static_cast<float>(frontier_tick_s));
  if (control_points) place_control_points(bellies, points, block.end[turn_]);
}

double FrontierCrowd::steps_a_tick() const {
  if (method_.fixed_step) return frontier_tick_s / *method_.choice.dt_s;
  double sum = 0;
  for (const Block& block : blocks_) sum += block.individual->steps;
  return sum / static_cast<double>(blocks_.size());
}

bool FrontierCrowd::finite() const {
  return std::ranges::all_of(blocks_, [](const Block& block) {
    return std::ranges::all_of(block.displacement, [](const Lanes<float>& numbers) {
      return std::ranges::all_of(numbers.lane, [](float x) { return std::isfinite(x); });
    });
  });
}

}  // namespace mobil
