#include "systems/deformation/deformation.h"

// Explicit central differences (ECD) with lumped mass and damping, sixteen bellies a block, with Δt = tick / substeps:
//
//   vₙ₊½ = keep·vₙ₋½ + push·(aₙ − ω²·uₙ) + push·M⁻¹·(fₙ − K·(uₙ + β·vₙ₋½)),   uₙ₊₁ = uₙ + Δt·vₙ₊½
//   keep = (1 − αΔt/2)/(1 + αΔt/2),   push = Δt/(1 + αΔt/2),   M = S²·l·M₁,   K = l·A + S·B + (S²/l)·C
//
// This uses displacement u, velocity v half a step back, frame acceleration a, fascia's foundation ω (x and y only),
// traction f on the far face, mass damping α and stiffness damping β. S across and l along are the sizes of each lane.
// M₁ is diagonal, so no system is solved. A held far face is placed by its drive at n + 1 instead.
//
// A displacement or velocity column is node-major. Lanes are bellies; nodes count x, y, then z from the origin face:
//
//   float            lane 0  lane 1  lane 2  …  lane 15
//     0   node 0  x [  .       .       .          .   ]  origin face: zero, never written
//    16           y [  .       .       .          .   ]
//    32           z [  .       .       .          .   ]
//    48   node 1  x [  .       .       .          .   ]  48 = node_stride
//     …
//         node N  z [  .       .       .          .   ]  insertion (far) face
//                   |<- vector_lanes ->|                 one register: 4, 8 or 16 lanes, for a whole tick
//
// Each coefficient of K is broadcast to all lanes. Lanes differ only by their factors l, S, S²/l and S²·l.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <numbers>

#include "engine/fused-inl.h"
#include "engine/wide-inl.h"
#include "systems/deformation/elastic-inl.h"
#include "systems/deformation/report-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

/// One register of lanes of a block during one tick.
struct ExplicitBellies {
  const KernelArrays& kernel;
  const Cells& cells;
  float *u, *v;
  const float* strained;  // operand of K: u, or u + β·v with stiffness damping
  Factors factor;
  V keep, push, step;  // (1 − αΔt/2)/(1 + αΔt/2), Δt/(S²·l·(1 + αΔt/2)), Δt
};

/// Updates the velocities of the node planes from `first` to `last`, in one of the three ways of the far face. Inner
/// planes are free and without load. With `energy`, adds uₙᵀ·K·uₙ₊₁ of these nodes to `work`. `end` is the total
/// traction or, for a held face, its next displacement along z.
template <Stiffness stiffness, FarEnd way, bool loaded, bool energy>
HWY_NOINLINE void advance_velocity(const ExplicitBellies& belly, std::uint32_t first, std::uint32_t last, const Vector& end,
                                   V& work) {
  const Cells cells = belly.cells;
  const Factors factor = belly.factor;
  const V keep = belly.keep, push = belly.push, step = belly.step;
  const float* const strained = belly.strained;
  V sum = work;
  std::uint32_t n = first * plane_nodes(cells);
  const float* coefficient = coefficients<stiffness>(belly.kernel, first);
  const float* inverse_mass = belly.kernel.inverse_mass.data() + n;
  const float* share = belly.kernel.far_share.data();
  float* v = belly.v + node_stride * n;
  const float* u = belly.u + node_stride * n;
  for (std::uint32_t k = first; k <= last; ++k) {
    for (std::uint32_t j = 0; j <= cells[1]; ++j) {
      for (std::uint32_t i = 0; i <= cells[0]; ++i, v += node_stride, u += node_stride) {
        const Vector elastic = elastic_force<stiffness>(cells, i, j, k, strained, factor, coefficient);
        if constexpr (way == FarEnd::held) {
          sum = mul_add(elastic.z, end.z, sum);
        } else {
          const V over_mass = hn::Mul(push, hn::Set(d, *inverse_mass++));
          const V part = loaded ? hn::Set(d, *share++) : hn::Zero(d);
          const auto component = [&](std::size_t at, V inner, V outer) HWY_ATTR {
            const V old = hn::Mul(keep, hn::Load(d, v + at));
            const V next =
                loaded ? mul_add(mul_sub(part, outer, inner), over_mass, old) : neg_mul_add(inner, over_mass, old);
            hn::Store(next, d, v + at);
            if constexpr (energy) sum = mul_add(inner, mul_add(step, next, hn::Load(d, u + at)), sum);
          };
          if constexpr (way == FarEnd::free) {
            component(0, elastic.x, end.x);
            component(lane_count, elastic.y, end.y);
          }
          component(2 * lane_count, elastic.z, end.z);
        }
      }
    }
  }
  work = sum;
}

/// Advances one substep. `end` is the traction at its start or, for a held face, the displacement at its end.
template <Stiffness stiffness, FarEnd far_end, bool energy>
HWY_INLINE void substep(const ExplicitBellies& belly, const Vector& end, V& work) {
  const Cells& cells = belly.cells;
  advance_velocity<stiffness, FarEnd::free, false, energy>(belly, 1, cells[2] - 1, end, work);
  V unused = work;
  if constexpr (far_end != FarEnd::held || energy) {  // one plane: its work is too cheap for a version without it
    advance_velocity<stiffness, far_end, true, true>(belly, cells[2], cells[2], end, energy ? work : unused);
  }
  const std::size_t far = node_stride * first_insertion_node(cells), past = node_stride * node_count(cells);
  const std::size_t moving_end = far_end == FarEnd::held ? far : past;
  for (std::size_t at = node_stride * plane_nodes(cells); at < moving_end; at += lane_count) {
    hn::Store(mul_add(belly.step, hn::Load(d, belly.v + at), hn::Load(d, belly.u + at)), d, belly.u + at);
  }
  if constexpr (far_end == FarEnd::held) {
    for (std::size_t at = far; at < past; at += node_stride) hn::Store(end.z, d, belly.u + at + 2 * lane_count);
  }
}

/// Holds the far face sideways, and sets position and speed along z of a held one at the tick's start.
template <FarEnd far_end>
HWY_INLINE void hold_far_face(const ExplicitBellies& belly, V from_z, V speed_z) {
  const std::size_t past = node_stride * node_count(belly.cells);
  for (std::size_t at = node_stride * first_insertion_node(belly.cells); at < past; at += node_stride) {
    for (std::size_t c = 0; c < 2 * lane_count; c += lane_count) {
      hn::Store(hn::Zero(d), d, belly.u + at + c);
      hn::Store(hn::Zero(d), d, belly.v + at + c);
    }
    if constexpr (far_end == FarEnd::held) {
      hn::Store(from_z, d, belly.u + at + 2 * lane_count);
      hn::Store(speed_z, d, belly.v + at + 2 * lane_count);
    }
  }
}

/// Applies damping, frame field and sideways foundation of one substep to the velocities: v ← keep·v + push·(field −
/// ω²·u), push = Δt/(1 + αΔt/2). Only the elastic part remains.
template <FarEnd far_end>
HWY_NOINLINE void push_masses(const ExplicitBellies& belly, const FrameField& field, V push, V foundation) {
  const Cells& cells = belly.cells;
  const std::uint32_t far = first_insertion_node(cells);
  const std::uint32_t past = far_end == FarEnd::held ? far : node_count(cells);
  for (std::uint32_t n = plane_nodes(cells); n < past; ++n) {
    const Vector a = field.at(belly.kernel.rest_m.data() + 3 * std::size_t{n});
    float* const v = belly.v + node_stride * n;
    const float* const u = belly.u + node_stride * n;
    const auto component = [&](std::size_t at, V acceleration) HWY_ATTR {
      hn::Store(mul_add(push, acceleration, hn::Mul(belly.keep, hn::Load(d, v + at))), d, v + at);
    };
    if (far_end == FarEnd::free || n < far) {
      component(0, neg_mul_add(foundation, hn::Load(d, u), a.x));
      component(lane_count, neg_mul_add(foundation, hn::Load(d, u + lane_count), a.y));
    }
    component(2 * lane_count, a.z);
  }
}

/// scratch ← u + β·v.
HWY_INLINE void add_rates(const ExplicitBellies& belly, V beta, float* scratch) {
  for (std::size_t at = 0; at < node_stride * node_count(belly.cells); at += lane_count) {
    hn::Store(mul_add(beta, hn::Load(d, belly.v + at), hn::Load(d, belly.u + at)), d, scratch + at);
  }
}

template <Stiffness stiffness, FarEnd far_end>
void tick_of_lanes(const BellyBlock& block, const FarFaceDrive& end, std::uint32_t substeps, float tick_s,
                   float* scratch, std::size_t first_lane) {
  const MuscleOptions& options = block.muscle.options;
  const Factors factor = factors(block.scale, first_lane);
  const float dt = tick_s / static_cast<float>(substeps);
  const float half_damping = 0.5F * static_cast<float>(options.damping_per_s) * dt;
  const V keep = hn::Set(d, (1.0F - half_damping) / (1.0F + half_damping));
  const V push = hn::Set(d, dt / (1.0F + half_damping));
  ExplicitBellies belly{block.muscle.kernel,
                block.muscle.mesh.cells,
                block.displacement + first_lane,
                block.velocity + first_lane,
                block.displacement + first_lane,
                factor,
                keep,
                hn::Div(push, factor.mass),
                hn::Set(d, dt)};

  const Vector from{lanes_or_zero(end.from[0], first_lane), lanes_or_zero(end.from[1], first_lane),
                    lanes_or_zero(end.from[2], first_lane)};
  const Vector to{lanes_or_zero(end.to[0], first_lane), lanes_or_zero(end.to[1], first_lane),
                  lanes_or_zero(end.to[2], first_lane)};
  const Vector change{hn::Sub(to.x, from.x), hn::Sub(to.y, from.y), hn::Sub(to.z, from.z)};
  const auto part_of_tick = [&](std::uint32_t s)
                                HWY_ATTR { return hn::Set(d, static_cast<float>(s) / static_cast<float>(substeps)); };
  const auto at_substep = [&](std::uint32_t s) HWY_ATTR {
    if (s == substeps) return to;
    const V part = part_of_tick(s);
    return Vector{mul_add(change.x, part, from.x), mul_add(change.y, part, from.y), mul_add(change.z, part, from.z)};
  };
  if constexpr (far_end != FarEnd::free) {
    hold_far_face<far_end>(belly, from.z, hn::Div(change.z, hn::Set(d, tick_s)));
  }
  const bool viscous = options.stiffness_damping_s > 0;
  const float circular = 2 * std::numbers::pi_v<float> * static_cast<float>(options.foundation_hz);
  const V foundation = hn::Set(d, circular * circular);
  const bool pushed = block.frame != nullptr || circular > 0;
  const auto prepare = [&](std::uint32_t s) HWY_ATTR {
    if (viscous) {
      add_rates(belly, hn::Set(d, static_cast<float>(options.stiffness_damping_s)), scratch + first_lane);
      belly.strained = scratch + first_lane;
    }
    if (!pushed) return;
    FrameField field{};
    if (block.frame != nullptr) {
      field = frame_field(*block.frame, block.scale, part_of_tick(s), first_lane);
    } else {
      const V none = hn::Zero(d);
      field = {{none, none, none}, {none, none, none}, {none, none, none}, {none, none, none}};
    }
    belly.keep = keep;
    push_masses<far_end>(belly, field, push, foundation);
    belly.keep = hn::Set(d, 1.0F);
  };

  constexpr std::uint32_t ahead = far_end == FarEnd::held ? 1 : 0;
  V work = hn::Zero(d);
  for (std::uint32_t s = 0; s + 1 < substeps; ++s) {
    prepare(s);
    substep<stiffness, far_end, false>(belly, at_substep(s + ahead), work);
  }
  prepare(substeps - 1);
  if (!block.reported) return substep<stiffness, far_end, false>(belly, at_substep(substeps - 1 + ahead), work);
  substep<stiffness, far_end, true>(belly, at_substep(substeps - 1 + ahead), work);
  hn::Store(hn::Mul(hn::Set(d, 0.5F), work), d, block.report.strain_energy_j.lane + first_lane);
  if (viscous) report_strain_energy<stiffness>(block, factor, first_lane);
  report_kinetic_energy(block, factor, first_lane);
  report_shape<stiffness>(block, factor, first_lane);
}

template <Stiffness stiffness>
void tick_of_stiffness(const BellyBlock& block, const FarFaceDrive& end, std::uint32_t substeps, float tick_s,
                       float* scratch) {
  for (std::size_t lane = 0; lane < lane_count; lane += vector_lanes) {
    switch (end.way) {
      case FarEnd::held:
        tick_of_lanes<stiffness, FarEnd::held>(block, end, substeps, tick_s, scratch, lane);
        break;
      case FarEnd::sliding:
        tick_of_lanes<stiffness, FarEnd::sliding>(block, end, substeps, tick_s, scratch, lane);
        break;
      case FarEnd::free:
        tick_of_lanes<stiffness, FarEnd::free>(block, end, substeps, tick_s, scratch, lane);
        break;
    }
  }
}

void explicit_tick(const BellyBlock& block, const FarFaceDrive& end, std::uint32_t substeps, float tick_s,
                   float* scratch) {
  if (block.stiffness == Stiffness::individual) {
    tick_of_stiffness<Stiffness::individual>(block, end, substeps, tick_s, scratch);
  } else {
    tick_of_stiffness<Stiffness::shared>(block, end, substeps, tick_s, scratch);
  }
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(explicit_tick);
}  // namespace

void deform_explicit(const BellyBlock& block, const FarFaceDrive& end, std::uint32_t substeps, float tick_s,
                     float* scratch) {
  HWY_DYNAMIC_DISPATCH(explicit_tick)(block, end, substeps, tick_s, scratch);
}

}  // namespace mobil::inline v0_3
#endif
