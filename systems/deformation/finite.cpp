#include "systems/deformation/finite.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "engine/fused-inl.h"
#include "engine/wide-inl.h"
#include "systems/deformation/finite_element-inl.h"
#include "systems/deformation/finite_layer-inl.h"
#include "systems/deformation/modal.h"
#include "systems/deformation/report-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

/// A plane of nodes: sums of its forces, its mean sideways displacement, and the force on that mean.
struct FinitePlane {
  float* force;
  V mean[2], on_mean[2];
};

/// One register of lanes of a block during one tick.
struct FiniteBellies {
  const MuscleTemplate& muscle;
  const Cells& cells;
  FarEnd way;
  FiniteLaw law;
  V keep, push, push_over_mass, step, foundation;  // push: Δt', also over S²·l; foundation: ω²
  bool pushed;                                     // has a field or a foundation
  float *u, *v;
  float* mean;  // sideways, for each plane: x, y
  FinitePlane low, high;
  std::size_t first_lane;
};

/// Inputs of a substep: the field and the end's traction at its start or, for a held end, displacement at the substep's
/// end and its speed.
struct FiniteSubstep {
  FrameField field;
  Vector end;
  V speed;
};

Vector read_ends(const Lanes<float>* const (&ends)[3], std::size_t first_lane) {
  return {lanes_or_zero(ends[0], first_lane), lanes_or_zero(ends[1], first_lane), lanes_or_zero(ends[2], first_lane)};
}

V mean_elongation(const FiniteBellies& belly) {
  const std::uint32_t far = first_insertion_node(belly.cells);
  V sum = hn::Zero(d);
  for (std::uint32_t n = far; n < node_count(belly.cells); ++n) {
    sum = mul_add(hn::Set(d, belly.muscle.kernel.far_share[n - far]),
                  hn::Load(d, belly.u + node_stride * n + 2 * lane_count), sum);
  }
  return sum;
}

FiniteLaw law_of(const MuscleTemplate& muscle, const Factors& size) {
  const FiniteTissue& tissue = muscle.finite.tissue;
  const auto number = [](double x) { return static_cast<float>(x); };
  constexpr double steepness = 4, strain = 0.6;  // fibre_tension
  constexpr double most = 53.598150033144236;    // e⁴ − 1
  constexpr double z = max_passive_exponent;
  FiniteLaw law;
  law.size = size;
  const V one = hn::Set(d, 1.0F);
  law.over_across = hn::Div(one, size.b);
  law.over_along = hn::Div(one, size.a);
  law.over_volume = hn::Div(one, size.mass);
  law.across2 = hn::Mul(size.b, size.b);
  law.along2 = hn::Mul(size.a, size.a);
  law.shear_pa = number(tissue.shear_pa);
  law.shear_across = hn::Mul(size.a, hn::Set(d, law.shear_pa));
  law.shear_along = hn::Mul(size.c, hn::Set(d, law.shear_pa));
  law.bulk_pa = number(tissue.shear_pa * tissue.bulk_over_shear);
  law.passive_pa = number(tissue.passive_pa / most);
  law.slope = number(tissue.force_slope);
  law.min_share = number(tissue.min_share);
  law.passive_slope = number(steepness / strain * tissue.rest_over_optimal);
  law.passive_start = number(-steepness / strain);
  law.linear_slope = number(1 + z * (1 + z * (0.5 + z / 6)));
  return law;
}

/// Returns the damping, 1/s: the muscle's, or with activation that of tuned bellies.
V damping_of(const MuscleTemplate& muscle, const Lanes<float>* activation, std::size_t first_lane) {
  if (activation == nullptr) return hn::Set(d, static_cast<float>(muscle.options.damping_per_s));
  constexpr auto slack = static_cast<float>(tuned_damping_per_s(0)), taut = static_cast<float>(tuned_damping_per_s(1));
  return mul_add(hn::Set(d, taut - slack), hn::Load(d, activation->lane + first_lane), hn::Set(d, slack));
}

/// Sets the drive of fibres: activation, effect of slackness (pulling_activation), and the stretch about which they
/// pull.
void set_activity(FiniteBellies& belly, V elongation, const Lanes<float>* activation) {
  const FiniteTissue& tissue = belly.muscle.finite.tissue;
  const V one = hn::Set(d, 1.0F);
  const V mean = mul_add(hn::Mul(elongation, belly.law.over_along),
                         hn::Set(d, static_cast<float>(1 / belly.muscle.finite.length_m)), one);
  const V shortening = hn::Min(hn::Max(hn::Sub(one, mean), hn::Zero(d)), one);
  const V tone = hn::Mul(hn::Set(d, static_cast<float>(tissue.slack_tone)), hn::Mul(shortening, shortening));
  const V active = lanes_or_zero(activation, belly.first_lane);
  const V pulling = neg_mul_add(hn::Sub(one, active), hn::Sub(one, tone), one);
  belly.law.active_pa = hn::Mul(pulling, hn::Set(d, static_cast<float>(tissue.active_pa)));
  belly.law.share_at_none = neg_mul_add(hn::Set(d, belly.law.slope), mean, one);
}

/// Computes the mean sideways displacement of plane `k`.
void find_mean(const FiniteBellies& belly, std::uint32_t k) {
  const std::uint32_t nodes = plane_nodes(belly.cells);
  V mean[2] = {hn::Zero(d), hn::Zero(d)};
  const float* u = belly.u + node_stride * k * nodes;
  const float* share = belly.muscle.finite.plane_share.data() + std::size_t{k} * nodes;
  for (std::uint32_t i = 0; i < nodes; ++i, u += node_stride) {
    const V part = hn::Set(d, *share++);
    for (std::size_t c = 0; c < 2; ++c) mean[c] = mul_add(part, hn::Load(d, u + c * lane_count), mean[c]);
  }
  for (std::size_t c = 0; c < 2; ++c) hn::Store(mean[c], d, belly.mean + (2 * k + c) * lane_count);
}

/// Prepares plane `k` before the elements below it.
HWY_INLINE void begin_plane(const FiniteBellies& belly, std::uint32_t k, FinitePlane& plane) {
  for (std::size_t c = 0; c < 2; ++c) {
    plane.mean[c] = hn::Load(d, belly.mean + (2 * k + c) * lane_count);
    plane.on_mean[c] = hn::Zero(d);
  }
}

HWY_INLINE void clear_forces(const FiniteBellies& belly, const FinitePlane& plane) {
  const std::size_t past = node_stride * plane_nodes(belly.cells);
  for (std::size_t at = 0; at < past; at += lane_count) hn::Store(hn::Zero(d), d, plane.force + at);
}

/// Advances the nodes of plane `k`, which is `belly.low`, by a substep and computes their mean.
template <FarEnd way, bool loaded>
HWY_NOINLINE void move_plane(const FiniteBellies& belly, std::uint32_t k, const FiniteSubstep& now) {
  const std::uint32_t nodes = plane_nodes(belly.cells), n = k * nodes;
  float* u = belly.u + node_stride * n;
  float* v = belly.v + node_stride * n;
  const float* force = belly.low.force;
  // Values that stores could change, as far as the compiler can see, are read once.
  const float *const inverse_mass = &belly.muscle.kernel.inverse_mass[n],
                     *const far_share = belly.muscle.kernel.far_share.data(),
                     *const rest_m = &belly.muscle.kernel.rest_m[3 * std::size_t{n}],
                     *const plane_share = &belly.muscle.finite.plane_share[n];
  const V keep = belly.keep, step = belly.step, push = belly.push, push_over_mass = belly.push_over_mass,
          foundation = belly.foundation;
  const V aside_of[2] = {belly.low.mean[0], belly.low.mean[1]},
          on_mean[2] = {belly.low.on_mean[0], belly.low.on_mean[1]};
  const bool pushed = belly.pushed;
  V mean[2] = {hn::Zero(d), hn::Zero(d)};
  for (std::uint32_t i = 0; i < nodes; ++i, u += node_stride, v += node_stride, force += node_stride) {
    const V over_mass = hn::Mul(push_over_mass, hn::Set(d, inverse_mass[i]));
    const V share = loaded ? hn::Set(d, far_share[i]) : hn::Zero(d);
    Vector field{};
    if (pushed) field = now.field.at(rest_m + 3 * std::size_t{i});
    const V in_mean = hn::Set(d, plane_share[i]);
    const auto component = [&](std::size_t at, V acceleration, V traction, bool aside) HWY_ATTR {
      const V place = hn::Load(d, u + at);
      V speed = hn::Mul(keep, hn::Load(d, v + at));
      if (pushed) {
        if (aside) acceleration = neg_mul_add(foundation, aside_of[at / lane_count], acceleration);
        speed = mul_add(push, acceleration, speed);
      }
      V resisting = hn::Load(d, force + at);
      if (aside) resisting = mul_add(in_mean, on_mean[at / lane_count], resisting);
      if constexpr (loaded) resisting = neg_mul_add(share, traction, resisting);
      speed = neg_mul_add(over_mass, resisting, speed);
      const V now_at = mul_add(step, speed, place);
      hn::Store(speed, d, v + at);
      hn::Store(now_at, d, u + at);
      if (aside) mean[at / lane_count] = mul_add(in_mean, now_at, mean[at / lane_count]);
    };
    if constexpr (way == FarEnd::free) {
      component(0, field.x, now.end.x, true);
      component(lane_count, field.y, now.end.y, true);
    }
    component(2 * lane_count, field.z, now.end.z, false);
  }
  for (std::size_t c = 0; c < 2; ++c) hn::Store(mean[c], d, belly.mean + (2 * k + c) * lane_count);
}

/// Places the far face as its end requires.
HWY_INLINE void hold_plane(const FiniteBellies& belly, bool along, V place_z, V speed_z) {
  const std::size_t past = node_stride * node_count(belly.cells);
  for (std::size_t at = node_stride * first_insertion_node(belly.cells); at < past; at += node_stride) {
    for (std::size_t c = 0; c < 2 * lane_count; c += lane_count) {
      hn::Store(hn::Zero(d), d, belly.u + at + c);
      hn::Store(hn::Zero(d), d, belly.v + at + c);
    }
    if (!along) continue;
    hn::Store(place_z, d, belly.u + at + 2 * lane_count);
    hn::Store(speed_z, d, belly.v + at + 2 * lane_count);
  }
}

/// Adds the forces of the elements between planes k and k + 1. The upper plane, and the first plane, have no other
/// forces yet.
template <bool energy>
HWY_NOINLINE void add_layer(FiniteBellies& belly, std::uint32_t k, V at_rest, V& work) {
  const std::uint32_t nodes = plane_nodes(belly.cells), count = belly.cells[0] * belly.cells[1];
  const FiniteKernelElement* const layer_element = belly.muscle.finite.element.data() + std::size_t{k} * count;
  const float* const u = belly.u + node_stride * nodes * k;
  constexpr std::uint32_t together = 4;  // as many as fit into the first-level cache
  ElementState state[together];
  const bool is_small = belly.cells[0] == 2 && belly.cells[1] == 2;
  static_assert(together == small_layer);
  if (k == 0) clear_forces(belly, belly.low);
  if (!is_small) clear_forces(belly, belly.high);
  FiniteLayer layer;
  for (std::size_t c = 0; c < 2; ++c) {
    const V aside = hn::Sub(belly.high.mean[c], belly.low.mean[c]);
    layer.sway[c] = hn::Add(aside, aside);
    layer.on_mean[c] = hn::Zero(d);
  }
  for (std::uint32_t first = 0; first < count; first += together) {
    const FiniteKernelElement* const element = layer_element + first;
    const std::uint32_t some = std::min(together, count - first);
    if (is_small) {
      gather_small_layer(element, u, state);
    } else {
      for (std::uint32_t e = 0; e < some; ++e) gather_element(element[e], u, state[e]);
    }
    stretch_fibres(belly.law, element, some, layer, state);
    if (some == together) {
      pull_fibres<together>(belly.law, element, state);
    } else {
      for (std::uint32_t e = 0; e < some; ++e) pull_fibres<1>(belly.law, element + e, state + e);
    }
    stress_elements<energy>(belly.law, element, some, state, layer, at_rest, work);
    if (is_small) {
      scatter_small_layer(element, state, belly.low.force, belly.high.force);
    } else {
      for (std::uint32_t e = 0; e < some; ++e)
        scatter_element(element[e], nodes, state[e], belly.low.force, belly.high.force);
    }
  }
  for (std::size_t c = 0; c < 2; ++c) {
    belly.low.on_mean[c] = hn::Add(belly.low.on_mean[c], layer.on_mean[c]);
    belly.high.on_mean[c] = hn::Sub(belly.high.on_mean[c], layer.on_mean[c]);
  }
}

void substep(FiniteBellies& belly, const FiniteSubstep& now) {
  begin_plane(belly, 0, belly.low);
  V unused = hn::Zero(d);
  for (std::uint32_t k = 0; k < belly.cells[2]; ++k) {
    begin_plane(belly, k + 1, belly.high);
    add_layer<false>(belly, k, unused, unused);
    if (k > 0) move_plane<FarEnd::free, false>(belly, k, now);
    std::swap(belly.low, belly.high);
  }
  switch (belly.way) {
    case FarEnd::held:
      return hold_plane(belly, true, now.end.z, now.speed);
    case FarEnd::sliding:
      return move_plane<FarEnd::sliding, true>(belly, belly.cells[2], now);
    case FarEnd::free:
      return move_plane<FarEnd::free, true>(belly, belly.cells[2], now);
  }
}

void report(FiniteBellies& belly, const BellyBlock& block) {
  const V one = hn::Set(d, 1.0F);
  const V at_rest = fibre_energy(belly.law, one, fibre_stress(belly.law, one));
  V work = hn::Zero(d), reaction = work;
  begin_plane(belly, 0, belly.low);
  for (std::uint32_t k = 0; k < belly.cells[2]; ++k) {
    begin_plane(belly, k + 1, belly.high);
    add_layer<true>(belly, k, at_rest, work);
    std::swap(belly.low, belly.high);
  }
  for (std::uint32_t i = 0; i < plane_nodes(belly.cells); ++i)
    reaction = hn::Add(reaction, hn::Load(d, belly.low.force + node_stride * i + 2 * lane_count));
  const Factors& size = belly.law.size;
  const V volume = enclosed_volume(belly.muscle.kernel, size.b, size.a, belly.u);
  const V rest_volume = hn::Mul(size.mass, hn::Set(d, belly.muscle.kernel.volume_m3));
  hn::Store(work, d, block.report.strain_energy_j.lane + belly.first_lane);
  hn::Store(reaction, d, block.report.reaction_n.lane + belly.first_lane);
  hn::Store(mean_elongation(belly), d, block.report.elongation_m.lane + belly.first_lane);
  hn::Store(hn::Div(volume, rest_volume), d, block.report.volume_ratio.lane + belly.first_lane);
  report_kinetic_energy(block, size, belly.first_lane);
}

void tick_of_lanes(const BellyBlock& block, const FarFaceDrive& end, const Lanes<float>* activation,
                   std::uint32_t substeps, float tick_s, float* scratch, std::size_t first_lane) {
  const MuscleOptions& options = block.muscle.options;
  const float dt = tick_s / static_cast<float>(substeps);
  const V one = hn::Set(d, 1.0F);
  const V half_damping = hn::Mul(damping_of(block.muscle, activation, first_lane), hn::Set(d, 0.5F * dt));
  const float circular = 2 * std::numbers::pi_v<float> * static_cast<float>(options.foundation_hz);
  FiniteBellies belly{.muscle = block.muscle,
                      .cells = block.muscle.mesh.cells,
                      .way = end.way,
                      .law = law_of(block.muscle, factors(block.scale, first_lane)),
                      .keep = hn::Div(hn::Sub(one, half_damping), hn::Add(one, half_damping)),
                      .push = hn::Div(hn::Set(d, dt), hn::Add(one, half_damping)),
                      .push_over_mass = hn::Zero(d),
                      .step = hn::Set(d, dt),
                      .foundation = hn::Set(d, circular * circular),
                      .pushed = block.frame != nullptr || circular > 0,
                      .u = block.displacement + first_lane,
                      .v = block.velocity + first_lane,
                      .mean = scratch + first_lane,
                      .low = {},
                      .high = {},
                      .first_lane = first_lane};
  belly.push_over_mass = hn::Div(belly.push, belly.law.size.mass);
  const Vector from = read_ends(end.from, first_lane), to = read_ends(end.to, first_lane);
  const Vector change{hn::Sub(to.x, from.x), hn::Sub(to.y, from.y), hn::Sub(to.z, from.z)};
  const auto part_of_tick = [&](std::uint32_t s)
                                HWY_ATTR { return hn::Set(d, static_cast<float>(s) / static_cast<float>(substeps)); };
  FiniteSubstep now{};
  const V none = hn::Zero(d);
  now.field = {{none, none, none}, {none, none, none}, {none, none, none}, {none, none, none}};
  now.speed = hn::Div(change.z, hn::Set(d, tick_s));
  const bool held = end.way == FarEnd::held;
  if (end.way != FarEnd::free) hold_plane(belly, held, from.z, now.speed);
  belly.low.force = belly.mean + 2 * lane_count * (belly.cells[2] + 1);
  belly.high.force = belly.low.force + node_stride * plane_nodes(belly.cells);
  for (std::uint32_t k = 0; k <= belly.cells[2]; ++k) find_mean(belly, k);
  set_activity(belly, held ? to.z : mean_elongation(belly), activation);
  for (std::uint32_t s = 0; s < substeps; ++s) {
    const std::uint32_t moment = s + (held ? 1 : 0);
    const V part = part_of_tick(moment);
    now.end = moment == substeps ? to
                                 : Vector{mul_add(change.x, part, from.x), mul_add(change.y, part, from.y),
                                          mul_add(change.z, part, from.z)};
    if (block.frame != nullptr) now.field = frame_field(*block.frame, block.scale, part_of_tick(s), first_lane);
    substep(belly, now);
  }
  if (block.reported) report(belly, block);
}

void finite_tick(const BellyBlock& block, const FarFaceDrive& end, const Lanes<float>* activation,
                 std::uint32_t substeps, float tick_s, float* scratch) {
  for (std::size_t lane = 0; lane < lane_count; lane += vector_lanes)
    tick_of_lanes(block, end, activation, substeps, tick_s, scratch, lane);
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(finite_tick);
}  // namespace

void deform_finite(const BellyBlock& block, const FarFaceDrive& end, const Lanes<float>* activation,
                   std::uint32_t substeps, float tick_s, float* scratch) {
  HWY_DYNAMIC_DISPATCH(finite_tick)(block, end, activation, substeps, tick_s, scratch);
}

}  // namespace mobil::inline v0_3
#endif
