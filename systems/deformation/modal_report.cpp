#include "systems/deformation/modal.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "engine/fused-inl.h"
#include "engine/wide-inl.h"
#include "systems/deformation/modal-inl.h"
#include "systems/deformation/report-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

/// Returns the elongation at a far face that is not held.
HWY_INLINE V mean_of_far_face(const MuscleTemplate& control, const float* u) {
  const std::size_t far = first_insertion_node(control.mesh.cells);
  const std::vector<float>& share = control.kernel.far_share;
  V sum = hn::Zero(d);
  for (std::size_t n = 0; n < share.size(); ++n) {
    sum = mul_add(hn::Set(d, share[n]), hn::Load(d, u + node_stride * (far + n) + 2 * lane_count), sum);
  }
  return sum;
}

/// Writes the report of one register of lanes. X, W and s are the equations' (times P with one input), as half sums
/// over S²·l. Kinetic energy is ½·Σ W² + ½·m·ẇ². Strain energy is ½·Σ (X + ω·s)², s without the input of a lift, plus
/// half the static reaction to w, times w. By the lift's virtual work, the reaction is that at rest − S²·l·Σ ω·P·X,
/// plus drag.
void report_of_lanes(const ModalBlock& block, const MuscleTemplate& control, const ControlPoints& points,
                     const FarFaceDrive& end, float tick_s, BellyReport<Lanes<float>>& report, float lift_mass,
                     std::size_t lane) {
  const ModalInputs inputs = modal_inputs(end, block.frame);
  const std::size_t modes = block.basis.modes;
  const ModalTail tail = modal_tail(points.shape, modes, inputs.count);
  const bool held = end.way == FarEnd::held, moving = block.state != nullptr, one = inputs.count == 1;
  const std::size_t full = full_inputs(inputs.count);
  const auto at = [lane](const float* p, std::size_t i) HWY_ATTR { return hn::Load(d, p + i * lane_count + lane); };
  const auto input = [&](std::size_t i) HWY_ATTR { return hn::Load(d, inputs.to[i]->lane + lane); };
  const V none = hn::Zero(d), end_z = hn::Load(d, end.to[2]->lane + lane);
  const V across = hn::Load(d, block.scale.across.lane + lane), along = hn::Load(d, block.scale.along.lane + lane);
  const V mass = hn::Mul(hn::Mul(across, across), along);

  V kinetic = none, strain = none, pull = none;
  const float* motion = block.motion;
  for (std::size_t j = 0; j < modes; ++j) {
    const V omega = at(tail.omega, j), first = at(tail.participation, j);
    const V unit = one ? first : hn::Set(d, 1.0F);
    const V x = moving ? hn::Mul(unit, at(block.state, 2 * j)) : none;
    const V w = moving ? hn::Mul(unit, at(block.state, 2 * j + 1)) : none;
    V s = none;
    if (one) {
      if (!held) s = hn::Mul(first, input(0));
    } else {
      const float* participation = motion + 3 * lane_count;
      for (std::size_t i = 0; i < full; ++i, participation += lane_count) {
        if (i > 0 || !held) s = mul_add(at(participation, 0), input(i), s);
      }
      for (std::size_t i = full; i < inputs.count; i += 2, participation += lane_count) {
        const auto word = hn::BitCast(WordTag{}, at(participation, 0));
        s = mul_add(hn::BitCast(d, hn::ShiftLeft<16>(word)), input(i), s);
        s = mul_add(hn::BitCast(d, hn::And(word, hn::Set(WordTag{}, 0xFFFF0000U))), input(i + 1), s);
      }
      motion = participation;
    }
    const V strained = mul_add(omega, s, x);
    kinetic = mul_add(w, w, kinetic);
    strain = mul_add(strained, strained, strain);
    pull = mul_add(hn::Mul(omega, first), x, pull);
  }
  kinetic = hn::Mul(kinetic, mass);
  strain = hn::Mul(strain, mass);

  V elongation = end_z, reaction = end_z;
  if (held) {
    strain = mul_add(hn::Mul(at(tail.reaction, 0), end_z), end_z, strain);
    reaction = none;
    for (std::size_t i = 0; i < inputs.count; ++i) reaction = mul_add(at(tail.reaction, i), input(i), reaction);
    reaction = neg_mul_add(mass, pull, reaction);
    if (moving) {
      const V speed = hn::Div(hn::Sub(end_z, hn::Load(d, end.from[2]->lane + lane)), hn::Set(d, tick_s));
      reaction = mul_add(at(tail.drag, 0), speed, reaction);
      kinetic = mul_add(hn::Mul(hn::Mul(mass, hn::Set(d, lift_mass)), speed), speed, kinetic);
    }
  } else {
    elongation = mean_of_far_face(control, points.displacement + lane);
  }
  const V half = hn::Set(d, 0.5F);
  hn::Store(elongation, d, report.elongation_m.lane + lane);
  hn::Store(reaction, d, report.reaction_n.lane + lane);
  if (points.displacement != nullptr) {
    const V volume = enclosed_volume(control.kernel, across, along, points.displacement + lane);
    const V rest = hn::Mul(mass, hn::Set(d, control.kernel.volume_m3));
    hn::Store(hn::Div(volume, rest), d, report.volume_ratio.lane + lane);
  }
  hn::Store(hn::Mul(half, kinetic), d, report.kinetic_energy_j.lane + lane);
  hn::Store(hn::Mul(half, strain), d, report.strain_energy_j.lane + lane);
}

void report_block(const ModalBlock& block, const MuscleTemplate& control, const ControlPoints& points,
                  const FarFaceDrive& end, float tick_s, BellyReport<Lanes<float>>& report, float lift_mass) {
  for (std::size_t lane = 0; lane < lane_count; lane += vector_lanes) {
    report_of_lanes(block, control, points, end, tick_s, report, lift_mass, lane);
  }
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(report_block);
}  // namespace

void report_modal(const ModalBlock& block, const MuscleTemplate& control, const ControlPoints& points,
                  const FarFaceDrive& end, float tick_s, BellyReport<Lanes<float>>& report) {
  // Mass of the lift outside all modes, in the template's size.
  double lift_mass = block.basis.lift_kinetic;
  for (const double along : block.basis.lift_mass) lift_mass -= along * along;
  HWY_DYNAMIC_DISPATCH(report_block)
  (block, control, points, end, tick_s, report, static_cast<float>(lift_mass));
}

}  // namespace mobil::inline v0_3
#endif
