#include "systems/deformation/deformation.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <numbers>

#include "assets/fem/belly_solver.h"
#include "engine/fused-inl.h"
#include "engine/wide-inl.h"
#include "systems/deformation/band_solve-inl.h"
#include "systems/deformation/elastic-inl.h"
#include "systems/deformation/operator-inl.h"
#include "systems/deformation/report-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

/// Parameters of one step of a tick and of its far face.
struct Step {
  float dt, alpha, beta, foundation;
  V far_from, far_to, far_speed;  // of a held face along z
  Loads loads;
};

HWY_INLINE void set_far_z(const Bellies& belly, float* x, V value) {
  const std::size_t far = node_stride * first_insertion_node(belly.cells);
  for (std::size_t at = far; at < node_stride * node_count(belly.cells); at += node_stride) {
    hn::Store(value, d, x + at + 2 * lane_count);
  }
}

/// Calls f(component, offset) for each offset from the second plane of nodes on, components x, y, z in turn.
template <class F>
HWY_INLINE void for_each_component(const Bellies& belly, std::uint32_t past_node, F&& f) {
  for (std::size_t at = node_stride * belly.first; at < node_stride * past_node; at += node_stride) {
    f(0, at);
    f(1, at + lane_count);
    f(2, at + 2 * lane_count);
  }
}

/// Advances a step of constant average acceleration, solved for the change of velocity from vₙ to the step's mean.
template <Stiffness stiffness, Mass mass>
HWY_NOINLINE void step_newmark(const Bellies& belly, const Step& step, bool exact) {
  const bool held = belly.end == FarEnd::held;
  const float half = 0.5F * step.dt, strain_half = half + step.beta;
  float *const strained = belly.image, *const rates = belly.direction;
  const bool rated = step.alpha > 0 || step.foundation > 0;
  const V half_v = hn::Set(d, half), strain_v = hn::Set(d, strain_half), alpha = hn::Set(d, step.alpha),
          foundation = hn::Set(d, step.foundation);
  if (held) set_far_z(belly, belly.v, step.far_speed);
  for_each_component(belly, node_count(belly.cells), [&](std::size_t c, std::size_t at) HWY_ATTR {
    const V u = hn::Load(d, belly.u + at), v = hn::Load(d, belly.v + at);
    hn::Store(mul_add(strain_v, v, u), d, strained + at);
    const V middle = mul_add(half_v, v, u);
    hn::Store(middle, d, belly.u + at);
    if (rated) {
      const V rate = hn::Mul(alpha, v);
      hn::Store(c < 2 ? mul_add(foundation, middle, rate) : rate, d, rates + at);
    }
  });
  write_residual<stiffness, mass>(belly, strained, rated ? rates : nullptr, step.loads);
  const float inertia_factor = 2 / step.dt + step.alpha;
  const V sideways = hn::Mul(belly.factor.mass, hn::Set(d, inertia_factor + half * step.foundation));
  const V along = hn::Mul(belly.factor.mass, hn::Set(d, inertia_factor));
  solve<stiffness, mass>(belly, {sideways, sideways, along, strain_v}, exact, 2 * belly.solver.correction, belly.v);
  for_each_component(belly, belly.past, [&](std::size_t, std::size_t at) HWY_ATTR {
    hn::Store(mul_add(half_v, hn::Load(d, belly.v + at), hn::Load(d, belly.u + at)), d, belly.u + at);
  });
  if (held) set_far_z(belly, belly.u, step.far_to);
}

/// Advances a step of implicit (consistent-mass) central differences.
template <Stiffness stiffness>
HWY_NOINLINE void step_implicit(const Bellies& belly, const Step& step) {
  const bool held = belly.end == FarEnd::held;
  const float* strained = belly.u;
  if (held) set_far_z(belly, belly.v, step.far_speed);
  if (step.beta > 0) {
    const V beta = hn::Set(d, step.beta);
    for_each_component(belly, node_count(belly.cells), [&](std::size_t, std::size_t at) HWY_ATTR {
      hn::Store(mul_add(beta, hn::Load(d, belly.v + at), hn::Load(d, belly.u + at)), d, belly.image + at);
    });
    strained = belly.image;
  }
  write_residual<stiffness, Mass::consistent>(belly, strained, nullptr, step.loads);
  const std::uint32_t far = first_insertion_node(belly.cells);
  if (held && step.alpha > 0 && belly.past > belly.first) {
    const V drag = hn::Mul(hn::Mul(hn::Set(d, step.alpha), step.far_speed), belly.factor.mass);
    float* r = belly.residual + node_stride * (far - plane_nodes(belly.cells)) + 2 * lane_count;
    for (std::uint32_t i = 0; i < plane_nodes(belly.cells); ++i, r += node_stride) {
      hn::Store(neg_mul_add(hn::Set(d, belly.solver.far_mass_kg[i]), drag, hn::Load(d, r)), d, r);
    }
  }
  const float half_damping = 0.5F * step.alpha * step.dt;
  const V keep = hn::Set(d, (1 - half_damping) / (1 + half_damping));
  const V field_push = hn::Set(d, step.dt / (1 + half_damping));
  const V push = hn::Div(field_push, belly.factor.mass);
  const V dt = hn::Set(d, step.dt), foundation = hn::Set(d, step.foundation);
  const std::size_t from = node_stride * belly.first;
  const bool sliding = belly.end == FarEnd::sliding;
  const auto held_sideways = [&](std::uint32_t n) { return sliding && n + belly.first >= far; };
  solve_forward<1>(belly.solver.factor, belly.residual + from,
                   [&](std::uint32_t n) HWY_ATTR { return load_vector(belly.residual + from + node_stride * n); });
  if (sliding) {  // x and y, and their factor, end one plane earlier
    for (std::size_t at = node_stride * far; at < node_stride * node_count(belly.cells); at += node_stride) {
      hn::Store(hn::Zero(d), d, belly.residual + at);
      hn::Store(hn::Zero(d), d, belly.residual + at + lane_count);
    }
  }
  solve_backward<1>(belly.solver.factor, belly.residual + from, [&](std::uint32_t n, const Vector& a) HWY_ATTR {
    const std::size_t at = from + node_stride * n;
    const auto component = [&](std::size_t offset, V acceleration, V stiff) HWY_ATTR {
      const V u = hn::Load(d, belly.u + offset);
      V v = mul_add(push, acceleration, hn::Mul(keep, hn::Load(d, belly.v + offset)));
      v = neg_mul_add(hn::Mul(field_push, stiff), u, v);
      hn::Store(v, d, belly.v + offset);
      hn::Store(mul_add(dt, v, u), d, belly.u + offset);
    };
    if (!held_sideways(n)) {
      component(at, a.x, foundation);
      component(at + lane_count, a.y, foundation);
    }
    component(at + 2 * lane_count, a.z, hn::Zero(d));
  });
  if (held) set_far_z(belly, belly.u, step.far_to);
}

template <Stiffness stiffness, Mass mass>
HWY_NOINLINE void step_static(const Bellies& belly, const Step& step, bool exact) {
  if (exact) {  // from zero: rounding of K·u would add some per mille of a slender belly's bending per tick
    for_each_component(belly, belly.past,
                       [&](std::size_t, std::size_t at) HWY_ATTR { hn::Store(hn::Zero(d), d, belly.u + at); });
  }
  if (belly.end == FarEnd::held) set_far_z(belly, belly.u, step.far_to);
  const V foundation = hn::Set(d, step.foundation);
  const float* rates = nullptr;
  if (step.foundation > 0) {
    for_each_component(belly, node_count(belly.cells), [&](std::size_t c, std::size_t at) HWY_ATTR {
      hn::Store(c < 2 ? hn::Mul(foundation, hn::Load(d, belly.u + at)) : hn::Zero(d), d, belly.direction + at);
    });
    rates = belly.direction;
  }
  write_residual<stiffness, mass>(belly, belly.u, rates, step.loads);
  const V sideways = hn::Mul(belly.factor.mass, foundation);
  solve<stiffness, mass>(belly, {sideways, sideways, hn::Zero(d), hn::Set(d, 1.0F)}, exact, 1, belly.u);
}

/// Reports ½·vᵀ·M·v with the consistent mass.
HWY_NOINLINE void report_consistent_kinetic_energy(const Bellies& belly) {
  Bellies all = belly;
  all.past = node_count(belly.cells);
  const float* pair = belly.kernel.consistent_mass_kg.data();
  V sum = hn::Zero(d);
  for_each_moving_node(all, [&](std::uint32_t n, std::uint32_t i, std::uint32_t j, std::uint32_t k) HWY_ATTR {
    const Vector m = inertia<Mass::consistent>(belly, n, i, j, k, belly.v, pair);
    const Vector v = load_vector(belly.v + node_stride * n);
    sum = mul_add(v.x, m.x, mul_add(v.y, m.y, mul_add(v.z, m.z, sum)));
  });
  hn::Store(hn::Mul(hn::Set(d, 0.5F), hn::Mul(belly.factor.mass, sum)), d,
            belly.block.report.kinetic_energy_j.lane + belly.first_lane);
}

/// Reports ½·uₙᵀ·K·uₙ₊₁ from uₙ₊₁ and the velocity between them.
template <Stiffness stiffness>
HWY_NOINLINE void report_strain_across_step(const Bellies& belly, const Step& step) {
  const Cells cells = belly.cells;
  Bellies all = belly;
  all.past = node_count(cells);
  const V dt = hn::Set(d, step.dt);
  const float* coefficient = coefficients<stiffness>(belly.kernel, 1);
  V sum = hn::Zero(d);
  for_each_moving_node(all, [&](std::uint32_t n, std::uint32_t i, std::uint32_t j, std::uint32_t k) HWY_ATTR {
    const Vector f = elastic_force<stiffness>(cells, i, j, k, belly.u, belly.factor, coefficient);
    const Vector u = load_vector(belly.u + node_stride * n), v = load_vector(belly.v + node_stride * n);
    sum = mul_add(f.x, neg_mul_add(dt, v.x, u.x), sum);
    sum = mul_add(f.y, neg_mul_add(dt, v.y, u.y), sum);
    sum = mul_add(f.z, neg_mul_add(dt, v.z, u.z), sum);
  });
  hn::Store(hn::Mul(hn::Set(d, 0.5F), sum), d, belly.block.report.strain_energy_j.lane + belly.first_lane);
}

HWY_INLINE void hold_far_face_sideways(const Bellies& belly, bool moving) {
  const std::size_t past = node_stride * node_count(belly.cells);
  for (std::size_t at = node_stride * first_insertion_node(belly.cells); at < past; at += node_stride) {
    for (const std::size_t c : {std::size_t{0}, lane_count}) {
      hn::Store(hn::Zero(d), d, belly.u + at + c);
      if (moving) hn::Store(hn::Zero(d), d, belly.v + at + c);
    }
  }
}

template <Stiffness stiffness, Mass mass>
void tick_of_lanes(const BellyBlock& block, const BellySolver& solver, const FarFaceDrive& end, std::uint32_t substeps,
                   float tick_s, float* scratch, std::size_t first_lane) {
  const Cells& cells = block.muscle.mesh.cells;
  const std::size_t floats = nodal_width(cells) * lane_count;
  const std::uint32_t first = plane_nodes(cells);
  const Method method = solver.method;
  const Bellies belly{block,
                      solver,
                      block.muscle.kernel,
                      cells,
                      end.way,
                      first,
                      end.way == FarEnd::held ? first_insertion_node(cells) : node_count(cells),
                      block.displacement + first_lane,
                      block.velocity + first_lane,
                      scratch + first_lane,
                      scratch + floats + first_lane,
                      scratch + 2 * floats + first_lane,
                      factors(block.scale, first_lane),
                      first_lane};
  const MuscleOptions& options = block.muscle.options;
  const float circular = 2 * std::numbers::pi_v<float> * static_cast<float>(options.foundation_hz);
  const auto at = [&](const Lanes<float>* const lanes[3]) HWY_ATTR {
    return Vector{lanes_or_zero(lanes[0], first_lane), lanes_or_zero(lanes[1], first_lane),
                  lanes_or_zero(lanes[2], first_lane)};
  };
  const Vector from = at(end.from), to = at(end.to);
  const Vector change{hn::Sub(to.x, from.x), hn::Sub(to.y, from.y), hn::Sub(to.z, from.z)};
  const auto place = [&](V part) HWY_ATTR {
    return Vector{mul_add(change.x, part, from.x), mul_add(change.y, part, from.y), mul_add(change.z, part, from.z)};
  };
  const auto loads_at = [&](V part) HWY_ATTR {
    Loads loads{end.way == FarEnd::held ? zero_vector() : place(part), {}};
    if (block.frame != nullptr) loads.field = frame_field(*block.frame, block.scale, part, first_lane);
    return loads;
  };
  const float count = static_cast<float>(substeps);
  const auto fraction = [&](float steps) HWY_ATTR { return hn::Set(d, steps / count); };
  const bool exact = stiffness == Stiffness::shared && solver.across == 1 && solver.along == 1;
  if (end.way != FarEnd::free) hold_far_face_sideways(belly, method != Method::statics);
  Step step{tick_s / count,
            static_cast<float>(options.damping_per_s),
            static_cast<float>(options.stiffness_damping_s),
            circular * circular,
            from.z,
            to.z,
            hn::Div(change.z, hn::Set(d, tick_s)),
            {}};
  if (method == Method::statics) {
    step.loads = loads_at(hn::Set(d, 1.0F));
    step_static<stiffness, mass>(belly, step, exact);
    if (!block.reported) return;
    report_strain_energy<stiffness>(block, belly.factor, first_lane);
    hn::Store(hn::Zero(d), d, block.report.kinetic_energy_j.lane + first_lane);
    return report_shape<stiffness>(block, belly.factor, first_lane);
  }
  if (end.way == FarEnd::held) set_far_z(belly, belly.u, from.z);
  for (std::uint32_t s = 0; s < substeps; ++s) {
    step.far_to = s + 1 == substeps ? to.z : place(fraction(static_cast<float>(s + 1))).z;
    const float moment = static_cast<float>(s) + (method == Method::newmark ? 0.5F : 0.0F);
    step.loads = loads_at(fraction(moment));
    if (method == Method::newmark) {
      step_newmark<stiffness, mass>(belly, step, exact);
    } else {
      step_implicit<stiffness>(belly, step);
    }
  }
  if (!block.reported) return;
  if (method == Method::implicit_central) {
    report_strain_across_step<stiffness>(belly, step);
  } else {
    report_strain_energy<stiffness>(block, belly.factor, first_lane);
  }
  if constexpr (mass == Mass::consistent) {
    report_consistent_kinetic_energy(belly);
  } else {
    report_kinetic_energy(block, belly.factor, first_lane);
  }
  report_shape<stiffness>(block, belly.factor, first_lane);
}

template <Stiffness stiffness, Mass mass>
void tick_of_block(const BellyBlock& block, const BellySolver& solver, const FarFaceDrive& end, std::uint32_t substeps,
                   float tick_s, float* scratch) {
  for (std::size_t lane = 0; lane < lane_count; lane += vector_lanes) {
    tick_of_lanes<stiffness, mass>(block, solver, end, substeps, tick_s, scratch, lane);
  }
}

void implicit_tick(const BellyBlock& block, const BellySolver& solver, const FarFaceDrive& end, std::uint32_t substeps,
                   float tick_s, float* scratch) {
  const bool lumped = solver.mass == Mass::lumped;
  if (block.stiffness == Stiffness::individual) {
    lumped ? tick_of_block<Stiffness::individual, Mass::lumped>(block, solver, end, substeps, tick_s, scratch)
           : tick_of_block<Stiffness::individual, Mass::consistent>(block, solver, end, substeps, tick_s, scratch);
  } else {
    lumped ? tick_of_block<Stiffness::shared, Mass::lumped>(block, solver, end, substeps, tick_s, scratch)
           : tick_of_block<Stiffness::shared, Mass::consistent>(block, solver, end, substeps, tick_s, scratch);
  }
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(implicit_tick);
}  // namespace

std::size_t scratch_floats(const MuscleTemplate& muscle, Method method) {
  const std::size_t column = nodal_width(muscle.mesh.cells) * lane_count;
  if (method == Method::explicit_central) return muscle.options.stiffness_damping_s > 0 ? column : 0;
  if (method == Method::finite) {
    const Cells& cells = muscle.mesh.cells;  // forces of two planes, and each plane's mean sideways
    return 2 * (3 * std::size_t{plane_nodes(cells)} + cells[2] + 1) * lane_count;
  }
  return 3 * column;
}

void deform_implicit(const BellyBlock& block, const BellySolver& solver, const FarFaceDrive& end,
                     std::uint32_t substeps, float tick_s, float* scratch) {
  HWY_DYNAMIC_DISPATCH(implicit_tick)(block, solver, end, substeps, tick_s, scratch);
}

}  // namespace mobil::inline v0_3
#endif
