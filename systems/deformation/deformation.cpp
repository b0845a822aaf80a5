#include "systems/deformation/deformation.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/deformation/deformation.cpp"
#include <hwy/foreach_target.h>

#include <algorithm>

#include "engine/wide-inl.h"

#ifndef MOBIL_SYSTEMS_DEFORMATION_TASK
#define MOBIL_SYSTEMS_DEFORMATION_TASK
namespace mobil {
namespace {

/// One call, whichever way the far face is driven: `from` and `to` are a displacement (z alone) or a force, per axis.
struct Task {
  const MuscleTemplate& muscle;
  const BellyScale<Lanes<float>>& scale;
  const Lanes<float>*from[3], *to[3];
  float *displacement, *velocity;
  std::uint32_t substeps;
  float tick_s;
  BellyReport<Lanes<float>>& report;
};

}  // namespace
}  // namespace mobil
#endif

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {
namespace {

// The kernel works through one register of lanes at a time, a whole tick long: nine sums, three displacements and a
// coefficient then fit the sixteen registers of AVX2.
using V = hn::Vec<FloatTag>;
constexpr FloatTag d;
constexpr std::size_t node_stride = 3 * lane_count;

/// Factors of A, B and C for each lane. S²/l goes in two parts: a slender belly bends some ten thousand times more
/// easily than it stretches, so that the three terms must cancel to all the digits there are.
struct Factors {
  V a, b, c, c_rest;
};

using Vector = Vec3<V>;

/// A value that is used several times, loaded once. gcc would fold the load into every use, and loads, not arithmetic,
/// would then bound the kernel.
HWY_INLINE V load_once(const float* p) {
  V value = hn::Load(d, p);
#if HWY_ARCH_X86 && HWY_COMPILER_GCC_ACTUAL
  asm("" : "+v"(value.raw));
#endif
  return value;
}

template <Stiffness stiffness>
constexpr std::size_t words =
    stiffness == Stiffness::individual ? KernelArrays::individual_words : KernelArrays::shared_words;

/// (K·u) of node (i, j, k), N. `coefficient` points at its row and moves to the next one, `rest` at the rest of its own
/// coupling.
template <Stiffness stiffness>
HWY_INLINE Vector elastic_force(const Cells& cells, std::uint32_t i, std::uint32_t j, std::uint32_t k, const float* u,
                                const Factors& factor, const float*& coefficient, const float* rest) {
  const std::uint32_t width = cells[0] + 1;
  const std::uint32_t i_low = i > 0 ? i - 1 : 0;
  const std::uint32_t j_low = j > 0 ? j - 1 : 0;
  const std::uint32_t k_low = k > 1 ? k - 1 : 1;  // the first plane is fixed
  const std::uint32_t i_high = std::min(i + 1, cells[0]);
  const std::uint32_t j_high = std::min(j + 1, cells[1]);
  const std::uint32_t k_high = std::min(k + 1, cells[2]);
  const float* c = coefficient;
  V s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0, s8 = s0;
  const auto add_neighbour = [&](const float* p, const float* q) HWY_ATTR {
    const V x = load_once(p);
    const V y = load_once(p + lane_count);
    const V z = load_once(p + 2 * lane_count);
    const auto add = [q](std::size_t word, V value, V sum)
                         HWY_ATTR { return hn::MulAdd(hn::Set(d, q[word]), value, sum); };
    if constexpr (stiffness == Stiffness::individual) {
      s0 = add(0, x, s0);  // A: xx xy yx yy zz
      s1 = add(2, x, s1);
      s2 = add(4, z, s2);
      s3 = add(5, z, s3);  // B: xz yz zx zy
      s4 = add(6, z, s4);
      s5 = add(7, x, s5);
      s6 = add(9, x, s6);  // C: xx yy zz
      s7 = add(10, y, s7);
      s8 = add(11, z, s8);
      s0 = add(1, y, s0);
      s1 = add(3, y, s1);
      s5 = add(8, y, s5);
    } else {
      s0 = add(0, x, s0);
      s1 = add(3, x, s1);
      s2 = add(6, x, s2);
      s3 = add(1, y, s3);
      s4 = add(4, y, s4);
      s5 = add(7, y, s5);
      s6 = add(2, z, s6);
      s7 = add(5, z, s7);
      s8 = add(8, z, s8);
    }
  };
  for (std::uint32_t kk = k_low; kk <= k_high; ++kk) {
    for (std::uint32_t jj = j_low; jj <= j_high; ++jj) {
      const float* p = u + node_stride * ((kk * (cells[1] + 1) + jj) * width + i_low);
      for (std::uint32_t ii = i_low; ii <= i_high; ++ii, p += node_stride) {
        add_neighbour(p, c);
        c += words<stiffness>;
      }
    }
  }
  add_neighbour(u + node_stride * ((k * (cells[1] + 1) + j) * width + i), rest);
  coefficient = c;
  if constexpr (stiffness == Stiffness::individual) {
    const auto join = [&factor](V a, V b, V e) HWY_ATTR {
      return hn::MulAdd(factor.a, a, hn::MulAdd(factor.b, b, hn::MulAdd(factor.c, e, hn::Mul(factor.c_rest, e))));
    };
    return {join(s0, s3, s6), join(s1, s4, s7), join(s2, s5, s8)};
  } else {
    return {hn::Add(hn::Add(s0, s3), s6), hn::Add(hn::Add(s1, s4), s7), hn::Add(hn::Add(s2, s5), s8)};
  }
}

/// Volume inside the deformed boundary, m³: each bilinear patch sweeps the mean of its two triangulations.
HWY_INLINE V enclosed_volume(const KernelArrays& kernel, V across, V along, const float* u) {
  const auto determinant = [](const Vector& a, const Vector& b, const Vector& c) HWY_ATTR {
    const V x = hn::NegMulAdd(b.z, c.y, hn::Mul(b.y, c.z));
    const V y = hn::NegMulAdd(b.x, c.z, hn::Mul(b.z, c.x));
    const V z = hn::NegMulAdd(b.y, c.x, hn::Mul(b.x, c.y));
    return hn::MulAdd(a.x, x, hn::MulAdd(a.y, y, hn::Mul(a.z, z)));
  };
  const auto minus = [](const Vector& a, const Vector& b) HWY_ATTR {
    return Vector{hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
  };
  const auto place = [&](std::uint32_t n) HWY_ATTR {
    const float* p = u + node_stride * n;
    const float* rest = kernel.rest_m.data() + 3 * std::size_t{n};
    return Vector{hn::MulAdd(across, hn::Set(d, rest[0]), hn::Load(d, p)),
                  hn::MulAdd(across, hn::Set(d, rest[1]), hn::Load(d, p + lane_count)),
                  hn::MulAdd(along, hn::Set(d, rest[2]), hn::Load(d, p + 2 * lane_count))};
  };
  V sum = hn::Zero(d);
  for (const Quad& quad : kernel.skin) {
    const Vector a = place(quad[0]), b = place(quad[1]), c = place(quad[2]), e = place(quad[3]);
    sum = hn::Add(sum, hn::Add(determinant(a, minus(b, e), c), determinant(e, minus(a, c), b)));
  }
  return hn::Mul(sum, hn::Set(d, 1.0F / 12.0F));
}

/// One register of lanes of a block during one tick.
struct Bellies {
  const KernelArrays& kernel;
  const Cells& cells;
  float *u, *v;
  Factors factor;
  V mass_scale;
  V keep, push, step;  // (1 − αΔt/2)/(1 + αΔt/2), Δt/(S²·l·(1 + αΔt/2)), Δt
};

/// What single precision left of a node's coupling to itself.
template <Stiffness stiffness>
HWY_INLINE const float* rests(const KernelArrays& kernel, std::uint32_t node) {
  return (stiffness == Stiffness::individual ? kernel.individual_rest : kernel.shared_rest).data() +
         words<stiffness> * std::size_t{node};
}

/// Velocities of the planes of nodes from `first` to `last`, in one of the three ways of the far face (inner planes:
/// free, no load). With `energy`, adds uₙᵀ·K·uₙ₊₁ of these nodes to `work`. `end` is the traction's total, or, of a
/// held face, its next displacement along z.
template <Stiffness stiffness, FarEnd way, bool loaded, bool energy>
HWY_NOINLINE void advance_velocity(const Bellies& belly, std::uint32_t first, std::uint32_t last, const Vector& end,
                                   const float* coefficient, V& work) {
  const Cells cells = belly.cells;
  const Factors factor = belly.factor;
  const V keep = belly.keep, push = belly.push, step = belly.step;
  const float* const u = belly.u;
  V sum = work;
  std::uint32_t n = first * plane_nodes(cells);
  const float* rest = rests<stiffness>(belly.kernel, n);
  const float* inverse_mass = belly.kernel.inverse_mass.data() + n;
  const float* share = belly.kernel.far_share.data();
  float* v = belly.v + node_stride * n;
  for (std::uint32_t k = first; k <= last; ++k) {
    for (std::uint32_t j = 0; j <= cells[1]; ++j) {
      for (std::uint32_t i = 0; i <= cells[0]; ++i, ++n, v += node_stride) {
        const Vector elastic = elastic_force<stiffness>(cells, i, j, k, u, factor, coefficient, rest);
        rest += words<stiffness>;
        if constexpr (way == FarEnd::held) {
          sum = hn::MulAdd(elastic.z, end.z, sum);
        } else {
          const V over_mass = hn::Mul(push, hn::Set(d, *inverse_mass++));
          const V part = loaded ? hn::Set(d, *share++) : hn::Zero(d);
          const auto component = [&](std::size_t at, V inner, V outer) HWY_ATTR {
            const V force = loaded ? hn::MulSub(part, outer, inner) : hn::Neg(inner);
            const V next = hn::MulAdd(force, over_mass, hn::Mul(keep, hn::Load(d, v + at)));
            hn::Store(next, d, v + at);
            if constexpr (energy) {
              sum = hn::MulAdd(inner, hn::MulAdd(step, next, hn::Load(d, u + node_stride * n + at)), sum);
            }
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

/// One substep. `end`: traction at its start; of a held face, the displacement at its end.
template <Stiffness stiffness, FarEnd far_end, bool energy>
HWY_INLINE void substep(const Bellies& belly, const Vector& end, const float* coefficients,
                        const float* far_coefficients, V& work) {
  const Cells& cells = belly.cells;
  advance_velocity<stiffness, FarEnd::free, false, energy>(belly, 1, cells[2] - 1, end, coefficients, work);
  if constexpr (far_end != FarEnd::held || energy) {
    advance_velocity<stiffness, far_end, true, energy>(belly, cells[2], cells[2], end, far_coefficients, work);
  }
  const std::size_t far = node_stride * first_insertion_node(cells), past = node_stride * node_count(cells);
  const std::size_t moving_end = far_end == FarEnd::held ? far : past;
  for (std::size_t at = node_stride * plane_nodes(cells); at < moving_end; at += lane_count) {
    hn::Store(hn::MulAdd(belly.step, hn::Load(d, belly.v + at), hn::Load(d, belly.u + at)), d, belly.u + at);
  }
  if constexpr (far_end == FarEnd::held) {
    for (std::size_t at = far; at < past; at += node_stride) hn::Store(end.z, d, belly.u + at + 2 * lane_count);
  }
}

/// Holds the far face sideways, and a held one at the tick's start and speed along z.
template <FarEnd far_end>
HWY_INLINE void hold_far_face(const Bellies& belly, V from_z, V speed_z) {
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

/// What can be read off the state after the tick: all but the strain energy.
template <Stiffness stiffness>
HWY_INLINE void report_state(const Bellies& belly, V across, V along, const float* far_coefficients,
                             BellyReport<Lanes<float>>& report, std::size_t first_lane) {
  const Cells& cells = belly.cells;
  const KernelArrays& kernel = belly.kernel;
  const std::uint32_t far = first_insertion_node(cells);
  V elongation = hn::Zero(d), reaction = elongation, kinetic = elongation;
  std::uint32_t n = far;
  for (std::uint32_t j = 0; j <= cells[1]; ++j) {
    for (std::uint32_t i = 0; i <= cells[0]; ++i, ++n) {
      const Vector f = elastic_force<stiffness>(cells, i, j, cells[2], belly.u, belly.factor, far_coefficients,
                                                rests<stiffness>(kernel, n));
      reaction = hn::Add(reaction, f.z);
      elongation = hn::MulAdd(hn::Set(d, kernel.far_share[n - far]),
                              hn::Load(d, belly.u + node_stride * n + 2 * lane_count), elongation);
    }
  }
  for (std::uint32_t m = plane_nodes(cells); m < node_count(cells); ++m) {
    V square = hn::Zero(d);
    for (std::size_t c = 0; c < node_stride; c += lane_count) {
      const V speed = hn::Load(d, belly.v + node_stride * m + c);
      square = hn::MulAdd(speed, speed, square);
    }
    kinetic = hn::MulAdd(square, hn::Set(d, kernel.mass_kg[m]), kinetic);
  }
  const V rest_volume = hn::Mul(belly.mass_scale, hn::Set(d, kernel.volume_m3));
  const V volume_ratio = hn::Div(enclosed_volume(kernel, across, along, belly.u), rest_volume);
  hn::Store(elongation, d, report.elongation_m.lane + first_lane);
  hn::Store(reaction, d, report.reaction_n.lane + first_lane);
  hn::Store(volume_ratio, d, report.volume_ratio.lane + first_lane);
  hn::Store(hn::Mul(hn::Set(d, 0.5F), hn::Mul(belly.mass_scale, kinetic)), d,
            report.kinetic_energy_j.lane + first_lane);
}

template <Stiffness stiffness, FarEnd far_end>
void tick_of_lanes(const Task& task, std::size_t first_lane) {
  const KernelArrays& kernel = task.muscle.kernel;
  const Cells& cells = task.muscle.mesh.cells;
  constexpr bool individual = stiffness == Stiffness::individual;
  const float* const coefficients = individual ? kernel.individual.data() : kernel.shared.data();
  const float* const far_coefficients = coefficients + kernel.plane_pair[cells[2]] * words<stiffness>;
  const auto lanes = [first_lane](const Lanes<float>* l)
                         HWY_ATTR { return l == nullptr ? hn::Zero(d) : hn::Load(d, l->lane + first_lane); };

  const V across = lanes(&task.scale.across), along = lanes(&task.scale.along);
  const V area_scale = hn::Mul(across, across);
  const V c = hn::Div(area_scale, along);
  const V c_rest = hn::Div(hn::Add(hn::NegMulAdd(c, along, area_scale), hn::MulSub(across, across, area_scale)), along);
  const V mass_scale = hn::Mul(area_scale, along);
  const float dt = task.tick_s / static_cast<float>(task.substeps);
  const float half_damping = 0.5F * kernel.damping_per_s * dt;
  const Bellies belly{kernel,
                      cells,
                      task.displacement + first_lane,
                      task.velocity + first_lane,
                      {along, across, c, c_rest},
                      mass_scale,
                      hn::Set(d, (1.0F - half_damping) / (1.0F + half_damping)),
                      hn::Div(hn::Set(d, dt / (1.0F + half_damping)), mass_scale),
                      hn::Set(d, dt)};

  const Vector from{lanes(task.from[0]), lanes(task.from[1]), lanes(task.from[2])};
  const Vector to{lanes(task.to[0]), lanes(task.to[1]), lanes(task.to[2])};
  const Vector change{hn::Sub(to.x, from.x), hn::Sub(to.y, from.y), hn::Sub(to.z, from.z)};
  const auto at_substep = [&](std::uint32_t s) HWY_ATTR {
    const V part = hn::Set(d, static_cast<float>(s) / static_cast<float>(task.substeps));
    return Vector{hn::MulAdd(change.x, part, from.x), hn::MulAdd(change.y, part, from.y),
                  hn::MulAdd(change.z, part, from.z)};
  };
  if constexpr (far_end != FarEnd::free) {
    hold_far_face<far_end>(belly, from.z, hn::Div(change.z, hn::Set(d, task.tick_s)));
  }
  constexpr std::uint32_t ahead = far_end == FarEnd::held ? 1 : 0;
  V work = hn::Zero(d);
  for (std::uint32_t s = 0; s + 1 < task.substeps; ++s) {
    substep<stiffness, far_end, false>(belly, at_substep(s + ahead), coefficients, far_coefficients, work);
  }
  substep<stiffness, far_end, true>(belly, ahead == 1 ? to : at_substep(task.substeps - 1), coefficients,
                                    far_coefficients, work);
  hn::Store(hn::Mul(hn::Set(d, 0.5F), work), d, task.report.strain_energy_j.lane + first_lane);
  report_state<stiffness>(belly, across, along, far_coefficients, task.report, first_lane);
}

template <Stiffness stiffness>
void tick_of_stiffness(const Task& task, FarEnd far_end) {
  for (std::size_t lane = 0; lane < lane_count; lane += vector_lanes) {
    switch (far_end) {
      case FarEnd::held:
        tick_of_lanes<stiffness, FarEnd::held>(task, lane);
        break;
      case FarEnd::sliding:
        tick_of_lanes<stiffness, FarEnd::sliding>(task, lane);
        break;
      case FarEnd::free:
        tick_of_lanes<stiffness, FarEnd::free>(task, lane);
        break;
    }
  }
}

void deform_tick(const Task& task, FarEnd far_end, Stiffness stiffness) {
  if (stiffness == Stiffness::individual) {
    tick_of_stiffness<Stiffness::individual>(task, far_end);
  } else {
    tick_of_stiffness<Stiffness::shared>(task, far_end);
  }
}

}  // namespace
}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil {
namespace {
HWY_EXPORT(deform_tick);
}  // namespace

void deform_explicit(const MuscleTemplate& muscle, const BellyScale<Lanes<float>>& scale,
                     const EndDisplacement<Lanes<float>>& end, float* displacement, float* velocity,
                     std::uint32_t substeps, float tick_s, BellyReport<Lanes<float>>& report, Stiffness stiffness) {
  const Task task{
      muscle, scale, {nullptr, nullptr, &end.from_m}, {nullptr, nullptr, &end.to_m}, displacement, velocity, substeps,
      tick_s, report};
  HWY_DYNAMIC_DISPATCH(deform_tick)(task, FarEnd::held, stiffness);
}

void deform_explicit(const MuscleTemplate& muscle, const BellyScale<Lanes<float>>& scale,
                     const EndForce<Lanes<float>>& end, float* displacement, float* velocity, std::uint32_t substeps,
                     float tick_s, BellyReport<Lanes<float>>& report, Stiffness stiffness) {
  const Task task{
      muscle, scale, {nullptr, nullptr, &end.from_n}, {nullptr, nullptr, &end.to_n}, displacement, velocity, substeps,
      tick_s, report};
  HWY_DYNAMIC_DISPATCH(deform_tick)(task, FarEnd::sliding, stiffness);
}

void deform_explicit(const MuscleTemplate& muscle, const BellyScale<Lanes<float>>& scale,
                     const EndTraction<Lanes<float>>& end, float* displacement, float* velocity, std::uint32_t substeps,
                     float tick_s, BellyReport<Lanes<float>>& report, Stiffness stiffness) {
  const Task task{muscle,
                  scale,
                  {&end.from_n.x, &end.from_n.y, &end.from_n.z},
                  {&end.to_n.x, &end.to_n.y, &end.to_n.z},
                  displacement,
                  velocity,
                  substeps,
                  tick_s,
                  report};
  HWY_DYNAMIC_DISPATCH(deform_tick)(task, FarEnd::free, stiffness);
}

}  // namespace mobil
#endif
