// Bellies that move in a few modes: a crowd's, and a set that fits in the caches, compared with memory and with this
// core's peak.

#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <new>

#include <mobil/engine/jobs.h>
#include "assets/reduction/modal_basis.h"
#include "demo/lab/bench/bench.h"
#include "systems/deformation/modal.h"

namespace mobil {
namespace {

constexpr std::size_t cached_blocks = 16;  // 256 muscles: half a megabyte at most
constexpr double tick_s = 1.0 / 60;

enum class What { tick, placed };

struct Shape {
  std::uint32_t modes;
  bool frame;
  What what;
};

/// Memory for a crowd, in huge pages where the system gives them.
class Pages {
 public:
  explicit Pages(std::size_t floats) {
    constexpr std::size_t page = std::size_t{2} << 20;
    const std::size_t bytes = (floats * sizeof(float) / page + 1) * page;
    floats_.reset(static_cast<float*>(std::aligned_alloc(page, bytes)));
    if (floats_ == nullptr) throw std::bad_alloc();
    madvise(floats_.get(), bytes, MADV_HUGEPAGE);
    std::fill_n(floats_.get(), floats, 0.0F);
  }
  float* begin() const { return floats_.get(); }

 private:
  struct Free {
    void operator()(float* p) const { std::free(p); }
  };
  std::unique_ptr<float, Free> floats_;
};

/// Blocks of bellies whose far face is held, each with all its columns in a row, as in a world's table. The values do
/// not affect the cost: each belly swings about a drive that grows evenly.
class ModalCrowd {
 public:
  ModalCrowd(const Shape& shape, std::size_t blocks)
      : what_(shape.what),
        blocks_(blocks),
        basis_(make_basis(shape)),
        state_width_(modal_state_width(basis_.modes)),
        motion_width_(modal_motion_width(basis_.modes, basis_.inputs)),
        shape_width_(what_ == What::tick ? 0 : modal_shape_width(basis_.modes, basis_.inputs)),
        node_width_(what_ == What::tick ? 0 : nodal_width(basis_.options.control_cells)),
        head_width_(shape.frame ? 4 + 2 * frame_inputs : 4),
        words_(head_width_ + state_width_ + motion_width_ + shape_width_ + node_width_),
        pages_(blocks * words_ * lane_count) {
    const std::size_t each = modal_motion_width(1, basis_.inputs);
    for (std::size_t b = 0; b < blocks; ++b) {
      Columns column = columns(b);
      std::ranges::fill(column.end->to.lane, 1e-4F);
      std::ranges::fill(column.scale->across.lane, 1.0F);
      std::ranges::fill(column.scale->along.lane, 1.0F);
      for (std::size_t i = 0; i < motion_width_; ++i) {
        const double omega = 20 + 3 * static_cast<double>((i / each + b) % 400), turn = omega * tick_s;
        const std::array numbers = {0.93 * std::cos(turn), 0.93 * std::sin(turn), 8 / omega};
        const float number = i % each < 3 ? static_cast<float>(numbers[i % each]) : 0.01F;
        std::fill_n(column.motion + i * lane_count, lane_count, number);
      }
      std::fill_n(column.shape, shape_width_ * lane_count, 0.01F);
    }
  }

  /// Advances part `number` of `of` by one tick.
  void tick(std::size_t number, std::size_t of, bool streamed) {
    for (std::size_t b = number * blocks_ / of; b < (number + 1) * blocks_ / of; ++b) {
      const Columns column = columns(b);
      const bool last = b + 1 == blocks_ || of == 1;  // cached data need no prefetch
      const Columns next = last ? Columns{} : columns(b + 1);
      const ModalBlock block{
          basis_,     *column.scale, column.state, column.motion, basis_.options.frame_loads ? column.frame : nullptr,
          next.state, next.motion};
      const ControlPoints points{column.shape, column.displacement, streamed, next.shape};
      deform_modal(block, {FarEnd::held, *column.end}, static_cast<float>(tick_s));
      if (what_ == What::placed) place_control_points(block, points, {FarEnd::held, *column.end});
    }
  }

  double muscles() const { return static_cast<double>(blocks_ * lane_count); }
  /// Returns the bytes read and written a muscle and tick, each once.
  double bytes() const {
    const double n = basis_.modes, inputs = basis_.inputs;
    double floats = 2 * inputs + 4 * n + static_cast<double>(motion_width_);
    if (what_ == What::placed) floats += n * (n + inputs) + static_cast<double>(node_width_);
    return 4 * floats;
  }
  double multiply_adds() const {
    const double n = basis_.modes, inputs = basis_.inputs;
    const Cells& cells = basis_.options.control_cells;
    double sum = 8 * n + (inputs > 1 ? inputs * n : 0);
    if (what_ == What::placed) sum += n * (n + inputs) + 3.0 * plane_nodes(cells) * (cells[2] - 1) * (n + 1);
    return sum;
  }
  bool finite() const {
    for (std::size_t b = 0; b < blocks_; ++b) {
      const Columns column = columns(b);
      const std::size_t count = (state_width_ + motion_width_ + shape_width_ + node_width_) * lane_count;
      if (!std::all_of(column.state, column.state + count, [](float x) { return std::isfinite(x); })) return false;
    }
    return true;
  }

 private:
  /// Start of each column of one block.
  struct Columns {
    EndDrive<Lanes<float>>* end;
    BellyScale<Lanes<float>>* scale;
    FrameLoad<Lanes<float>>* frame;
    float *state, *motion, *shape, *displacement;
  };

  static ModalBasis make_basis(const Shape& shape) {
    ModalBasis basis;
    basis.modes = basis.options.modes = shape.modes;
    basis.inputs = input_count(FarEnd::held, shape.frame);
    basis.options.frame_loads = shape.frame;
    basis.shape.resize(nodal_width(basis.options.control_cells) * (shape.modes + 1));
    for (std::size_t i = 0; i < basis.shape.size(); ++i) basis.shape[i] = 0.01F * static_cast<float>(i % 97);
    return basis;
  }

  Columns columns(std::size_t b) const {
    float* const at = pages_.begin() + b * words_ * lane_count;
    float* const state = at + head_width_ * lane_count;
    float* const motion = state + state_width_ * lane_count;
    float* const shape = motion + motion_width_ * lane_count;
    return {reinterpret_cast<EndDrive<Lanes<float>>*>(at),
            reinterpret_cast<BellyScale<Lanes<float>>*>(at + 2 * lane_count),
            reinterpret_cast<FrameLoad<Lanes<float>>*>(at + 4 * lane_count),
            state,
            motion,
            shape,
            shape + shape_width_ * lane_count};
  }

  What what_;
  std::size_t blocks_;
  ModalBasis basis_;
  std::size_t state_width_, motion_width_, shape_width_, node_width_;
  std::size_t head_width_, words_;  // head_width_: drives, sizes, and the frame's loads if any
  Pages pages_;
};

std::string stem_of(const Shape& shape, bool cached) {
  return fmt::format("modal.n{}{}{}{}", shape.modes, shape.frame ? ".frame_loads" : "",
                     shape.what == What::tick ? "" : ".control_points", cached ? ".cached" : "");
}

BenchResult measure_crowd(BenchRun& run, const Shape& shape, std::size_t blocks, bool cached) {
  ModalCrowd crowd(shape, blocks);
  // One part at a time, so that some fall into our time slice on a busy machine. Until its next turn the others have
  // evicted it from the caches.
  const std::size_t parts = cached ? 1 : std::max<std::size_t>(1, blocks / 200);
  std::size_t part = 0;
  const auto tick_some = [&] { crowd.tick(part++ % parts, parts, !cached); };
  const auto times = cached ? static_cast<std::size_t>(runs_a_repeat(measure(1, tick_some).best_s)) : 1;
  const Measured time = measure(run.rounds(cached ? bench_repeats : 10 * static_cast<int>(parts)), [&] {
    for (std::size_t n = 0; n < times; ++n) tick_some();
  });
  if (!crowd.finite()) throw Stopped("a modal belly's state is not a number");
  BenchResult& result =
      run.add_time(stem_of(shape, cached) + ".us_per_tick", time,
                   crowd.muscles() / static_cast<double>(parts) * static_cast<double>(times), 1e-6, "us");
  const double seconds = result.value * 1e-6;
  result.of_peak = 2 * crowd.multiply_adds() / seconds * 1e-9 / run.machine.fma_peak_gflops;
  result.of_bandwidth = crowd.bytes() / seconds * 1e-9 / run.machine.bandwidth_gbps;
  result.bound = fmt::format("{:.0f} muscles; {:.0f} bytes, {:.0f} multiply-adds each", crowd.muscles(), crowd.bytes(),
                             crowd.multiply_adds());
  return result;
}

}  // namespace

void bench_modal(BenchRun& run) {
  const FloatMode mode;
  const std::size_t blocks = std::max<std::size_t>(1, run.people * muscles_a_person / lane_count);
  std::map<std::string, double> us;
  for (const Shape& shape : {Shape{12, false, What::tick}, Shape{12, false, What::placed}, Shape{16, true, What::tick},
                             Shape{16, true, What::placed}}) {
    for (const bool cached : {false, true}) {
      const auto result = measure_crowd(run, shape, cached ? std::min(blocks, cached_blocks) : blocks, cached);
      us[stem_of(shape, cached)] = result.value;
    }
  }
  run.add_figure("modal.us_per_tick", us["modal.n12"], "us", "12 modes, a line's drive, the whole crowd");
  run.add_figure("modal.us_per_tick_with_control_points", us["modal.n12.control_points"], "us",
                 "the same and its 81 nodes");
  run.add_figure("modal.us_per_tick_with_frame_loads", us["modal.n16.frame_loads"], "us",
                 "16 modes, a line's drive and the frame's loads, the whole crowd");
}

}  // namespace mobil
