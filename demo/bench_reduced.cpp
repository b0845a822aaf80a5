// Bellies that move along a few vectors: a crowd's and one's that the caches hold, against memory and against this
// core's peak, and against the paper's choice, 81 nodes by explicit central differences at 2 ms.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "demo/bench.h"
#include "demo/bench_fem.h"
#include "demo/bench_fem_bellies.h"
#include "engine/jobs.h"
#include "systems/deformation/reduced.h"

namespace mobil {
namespace {

constexpr std::size_t muscles_a_human = 8, cached_blocks = 16;  // 256 muscles: half a megabyte at most
constexpr float tick_s = 1.0F / 60;
constexpr double paper_steps_a_second = 500, ticks_a_second = 60;
constexpr int rounds = 5;

enum class What { tick, placed, still };

struct Shape {
  std::uint32_t vectors;
  bool frame;
  What what;
};

/// Columns of bellies whose far face is held, as a world's table has them. What their numbers are makes no difference
/// to what they cost: each swings about a drive that grows evenly.
class ReducedCrowd {
 public:
  ReducedCrowd(const Shape& shape, std::size_t blocks) : what_(shape.what), blocks_(blocks) {
    basis_.vectors = basis_.options.vectors = shape.vectors;
    basis_.inputs = input_count(FarEnd::held, shape.frame);
    basis_.options.frame_loads = shape.frame;
    const std::uint32_t n = shape.vectors, inputs = basis_.inputs;
    const Cells& cells = basis_.options.control_cells;
    basis_.shape.resize(nodal_width(cells) * (n + 1));
    for (std::size_t i = 0; i < basis_.shape.size(); ++i) basis_.shape[i] = 0.01F * static_cast<float>(i % 97);
    end_.resize(blocks);
    for (auto& end : end_) std::ranges::fill(end.to_m.lane, 1e-4F);
    scale_.resize(blocks);
    if (shape.frame) frame_.resize(blocks);
    if (what_ != What::still) {
      state_.resize(blocks * reduced_state_width(n, inputs));
      motion_.resize(blocks * reduced_motion_width(n, inputs));
      const std::size_t each = reduced_motion_width(n, inputs) / n;
      for (std::size_t i = 0; i < motion_.size(); ++i) {
        const double omega = 20 + 3 * static_cast<double>(i / each % 400), turn = omega * static_cast<double>(tick_s);
        const std::array numbers = {0.93 * std::cos(turn), 0.93 * std::sin(turn), 8 / omega};
        const std::size_t number = i % each;
        std::ranges::fill(motion_[i].lane, number < 3 ? static_cast<float>(numbers[number]) : 0.01F);
      }
    }
    if (what_ != What::tick) {
      shape_.resize(blocks * reduced_shape_width(n, inputs));
      for (auto& lanes : shape_) std::ranges::fill(lanes.lane, 0.01F);
      displacement_.resize(blocks * nodal_width(cells));
    }
  }

  void tick() {
    const std::size_t state_width = state_.size() / blocks_, motion_width = motion_.size() / blocks_;
    const std::size_t shape_width = shape_.size() / blocks_, node_width = displacement_.size() / blocks_;
    for (std::size_t b = 0; b < blocks_; ++b) {
      const ReducedBlock block{basis_, scale_[b], floats(state_, b * state_width), floats(motion_, b * motion_width),
                               frame_.empty() ? nullptr : &frame_[b]};
      const ControlPoints points{floats(shape_, b * shape_width), floats(displacement_, b * node_width)};
      if (what_ != What::still) deform_reduced(block, end_[b], tick_s);
      if (what_ == What::placed) place_control_points(block, points, end_[b]);
      if (what_ == What::still) place_static(block, points, end_[b]);
    }
  }

  double muscles() const { return static_cast<double>(blocks_ * lane_count); }
  /// Read and written a muscle and tick, each once.
  double bytes() const {
    const double n = basis_.vectors, inputs = basis_.inputs;
    double floats = 2 * inputs;
    if (what_ != What::still) floats += 4 * n + (inputs > 1 ? 3 + inputs : 3) * n;
    if (what_ != What::tick) floats += n * (n + inputs) - (what_ == What::still ? n * n : 0);
    return 4 * (floats + (what_ == What::tick ? 0 : static_cast<double>(nodal_width(basis_.options.control_cells))));
  }
  double multiply_adds() const {
    const double n = basis_.vectors, inputs = basis_.inputs;
    const Cells& cells = basis_.options.control_cells;
    double sum = 0;
    if (what_ != What::still) sum += 8 * n + (inputs > 1 ? inputs * n : 0);
    if (what_ != What::tick) sum += n * inputs + (what_ == What::placed ? n * n : 0);
    if (what_ != What::tick) sum += 3.0 * plane_nodes(cells) * (cells[2] - 1) * (n + 1);
    return sum;
  }
  bool finite() const {
    return std::ranges::all_of(state_, [](const auto& x) { return std::isfinite(x[0]); }) &&
           std::ranges::all_of(displacement_, [](const auto& x) { return std::isfinite(x[0]); });
  }

 private:
  static float* floats(std::vector<Lanes<float>>& column, std::size_t at) {
    return column.empty() ? nullptr : column[at].lane;
  }

  What what_;
  std::size_t blocks_;
  ReducedBasis basis_;
  std::vector<EndDisplacement<Lanes<float>>> end_;
  std::vector<BellyScale<Lanes<float>>> scale_;
  std::vector<FrameLoad<Lanes<float>>> frame_;
  std::vector<Lanes<float>> state_, motion_, shape_, displacement_;
};

std::string stem_of(const Shape& shape, bool cached) {
  return fmt::format("reduced.n{}{}{}{}", shape.vectors, shape.frame ? ".frame_loads" : "",
                     shape.what == What::tick     ? ""
                     : shape.what == What::placed ? ".control_points"
                                                  : ".static",
                     cached ? ".cached" : "");
}

Result<BenchResult> measure_crowd(BenchRun& run, const Shape& shape, std::size_t blocks, bool cached) {
  ReducedCrowd crowd(shape, blocks);
  const Measured once = measure(1, [&] { crowd.tick(); });
  const int ticks = cached ? runs_a_repeat(once.best_s) : 1;
  Measured time = measure(run.rounds(cached ? bench_repeats : 25), [&] {
    for (int n = 0; n < ticks; ++n) crowd.tick();
  });
  if (!crowd.finite()) return fail("a reduced belly's state is not a number");
  BenchResult& result =
      run.add_time(stem_of(shape, cached) + ".us_per_tick", time, crowd.muscles() * ticks, 1e-6, "us");
  const double seconds = result.value * 1e-6;
  result.of_peak = 2 * crowd.multiply_adds() / seconds * 1e-9 / run.machine.fma_peak_gflops;
  result.of_bandwidth = crowd.bytes() / seconds * 1e-9 / run.machine.bandwidth_gbps;
  result.bound = fmt::format("{:.0f} muscles; {:.0f} bytes, {:.0f} multiply-adds each", crowd.muscles(), crowd.bytes(),
                             crowd.multiply_adds());
  return result;
}

struct Paper {
  double individual_us, shared_us;  // a muscle's step
};

Result<Paper> measure_paper(const BenchRun& run) {
  const auto muscle = paper_block({2, 2, 8});
  if (!muscle) return tl::unexpected(muscle.error());
  constexpr std::size_t blocks = 64;
  BenchBellies individual(*muscle, Stiffness::individual, blocks), shared(*muscle, Stiffness::shared, blocks);
  Rounds individual_time, shared_time;
  for (int round = 0; round < run.rounds(rounds); ++round) {
    individual_time.add(measure(run.rounds(10), [&] { individual.tick(steps_a_tick, paper_tick_s); }));
    shared_time.add(measure(run.rounds(10), [&] { shared.tick(steps_a_tick, paper_tick_s); }));
  }
  constexpr double steps = static_cast<double>(blocks * lane_count) * steps_a_tick;
  return Paper{individual_time.all().best_s / steps * 1e6, shared_time.all().best_s / steps * 1e6};
}

}  // namespace

Result<void> bench_reduced(BenchRun& run) {
  const FlushDenormals flushed;
  const std::size_t blocks = std::max<std::size_t>(1, run.humans * muscles_a_human / lane_count);
  const auto paper = measure_paper(run);
  if (!paper) return tl::unexpected(paper.error());
  std::map<std::string, double> us;
  for (const std::uint32_t vectors : {8U, 12U, 16U, 24U}) {
    for (const bool frame : {false, true}) {
      for (const What what : {What::tick, What::placed, What::still}) {
        for (const bool cached : {false, true}) {
          const Shape shape{vectors, frame, what};
          const auto result = measure_crowd(run, shape, cached ? std::min(blocks, cached_blocks) : blocks, cached);
          if (!result) return tl::unexpected(result.error());
          us[stem_of(shape, cached)] = result->value;
        }
      }
    }
  }
  const double line_us = us["reduced.n12"], points_us = us["reduced.n12.control_points"];
  add_figure(run, "reduced.us_per_tick", line_us, "us", "12 vectors, a line's drive, the whole crowd");
  add_figure(run, "reduced.us_per_tick_with_control_points", points_us, "us", "the same and its 81 nodes");
  add_figure(run, "reduced.us_per_tick_with_frame_loads", us["reduced.n16.frame_loads"], "us",
             "16 vectors, a line's drive and the frame's loads, the whole crowd");
  const auto ratio = [&](const char* name, double step_us, double tick_us, const char* whose) {
    add_figure(run, name, step_us * paper_steps_a_second / (tick_us * ticks_a_second), "1",
               fmt::format("{} us a step of 81 nodes at 2 ms, {}; per simulated second, 60 ticks against 500 steps",
                           fmt::format("{:.3f}", step_us), whose));
  };
  ratio("reduced.ratio_to_paper", paper->individual_us, line_us, "everybody's own size");
  ratio("reduced.ratio_to_paper_with_control_points", paper->individual_us, points_us, "everybody's own size");
  ratio("reduced.ratio_to_paper_shared", paper->shared_us, line_us, "one stiffness for all");
  ratio("reduced.ratio_to_paper_shared_with_control_points", paper->shared_us, points_us, "one stiffness for all");
  return {};
}

}  // namespace mobil
