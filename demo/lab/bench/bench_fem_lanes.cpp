#include "demo/lab/bench/bench_fem_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "assets/fem/muscle_template.h"
#include "demo/lab/bench/bench_fem_bellies.h"
#include "engine/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

void own_steps(OwnStiffness& block, std::uint32_t steps) {
  using V = hn::Vec<FloatTag>;
  constexpr FloatTag d;
  const std::size_t first = plane_nodes(block.cells), past = node_count(block.cells);
  const V keep = hn::Set(d, block.keep), dt = hn::Set(d, static_cast<float>(paper_step_s));
  for (std::size_t lane = 0; lane < lane_count; lane += vector_lanes) {
    const float* const u = block.displacement.data()->lane + lane;
    float* const v = block.velocity.data()->lane + lane;
    for (std::uint32_t s = 0; s < steps; ++s) {
      const float* c = block.coefficient.data()->lane + lane;
      for (std::size_t n = first; n < past; ++n) {
        V fx = hn::Load(d, block.load[3 * n].lane + lane), fy = hn::Load(d, block.load[3 * n + 1].lane + lane),
          fz = hn::Load(d, block.load[3 * n + 2].lane + lane);
        V gx = hn::Zero(d), gy = gx, gz = gx;
        for (std::uint32_t pair = block.first[n]; pair < block.first[n + 1]; ++pair, c += 9 * lane_count) {
          const float* const at = u + 3 * lane_count * block.node[pair];
          const V x = hn::Load(d, at), y = hn::Load(d, at + lane_count), z = hn::Load(d, at + 2 * lane_count);
          const auto k = [&](std::size_t word) HWY_ATTR { return hn::Load(d, c + word * lane_count); };
          fx = hn::NegMulAdd(k(0), x, fx);
          gx = hn::MulAdd(k(1), y, gx);
          fx = hn::NegMulAdd(k(2), z, fx);
          fy = hn::NegMulAdd(k(3), x, fy);
          gy = hn::MulAdd(k(4), y, gy);
          fy = hn::NegMulAdd(k(5), z, fy);
          fz = hn::NegMulAdd(k(6), x, fz);
          gz = hn::MulAdd(k(7), y, gz);
          fz = hn::NegMulAdd(k(8), z, fz);
        }
        const V push = hn::Load(d, block.push[n].lane + lane);
        float* const p = v + 3 * lane_count * n;
        hn::Store(hn::MulAdd(push, hn::Sub(fx, gx), hn::Mul(keep, hn::Load(d, p))), d, p);
        hn::Store(hn::MulAdd(push, hn::Sub(fy, gy), hn::Mul(keep, hn::Load(d, p + lane_count))), d, p + lane_count);
        hn::Store(hn::MulAdd(push, hn::Sub(fz, gz), hn::Mul(keep, hn::Load(d, p + 2 * lane_count))), d,
                  p + 2 * lane_count);
      }
      for (std::size_t at = 3 * first; at < 3 * past; ++at) {
        float* const p = block.displacement[at].lane + lane;
        hn::Store(hn::MulAdd(dt, hn::Load(d, v + at * lane_count), hn::Load(d, p)), d, p);
      }
    }
  }
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil {
namespace {
HWY_EXPORT(own_steps);
}  // namespace

OwnStiffness::OwnStiffness(const MuscleTemplate& muscle, const BellyScale<Lanes<float>>& scale)
    : cells(muscle.mesh.cells) {
  const double half = 0.5 * muscle.options.damping_per_s * paper_step_s;
  keep = static_cast<float>((1 - half) / (1 + half));
  const std::size_t nodes = node_count(cells);
  displacement.resize(3 * nodes);
  velocity.resize(3 * nodes);
  load.resize(3 * nodes);
  push.resize(nodes);
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(cells, i, j, k);
    first.push_back(static_cast<std::uint32_t>(node.size()));
    if (k == 0) return;
    for_each_neighbour(cells, i, j, k, [&](std::uint32_t neighbour, std::size_t slot) {
      if (neighbour < plane_nodes(cells)) return;
      node.push_back(neighbour);
      const std::size_t at = coefficient.size();
      coefficient.resize(at + 9);
      for (std::size_t l = 0; l < lane_count; ++l) {
        const auto block = stiffness_block(muscle.terms.pair[stencil_size * n + slot],
                                           static_cast<double>(scale.across[l]), static_cast<double>(scale.along[l]));
        for (std::size_t word = 0; word < 9; ++word) coefficient[at + word][l] = static_cast<float>(block[word]);
      }
    });
    for (std::size_t l = 0; l < lane_count; ++l) {
      const auto s = static_cast<double>(scale.across[l]), along = static_cast<double>(scale.along[l]);
      push[n][l] = static_cast<float>(paper_step_s / (1 + half) / (s * s * along * muscle.terms.lumped_mass_kg[n]));
      if (k == cells[2]) load[3 * n + 2][l] = 0.1F * muscle.kernel.far_share[n - first_insertion_node(cells)];
    }
  });
  first.push_back(static_cast<std::uint32_t>(node.size()));
}

void step_own(OwnStiffness& block, std::uint32_t steps) {
  HWY_DYNAMIC_DISPATCH(own_steps)(block, steps);
}

}  // namespace mobil
#endif
