// A thigh and a shank with its foot that hang on a moving hip (paper, section 4.1), in body heights and per kg. See
// engine/wide-inl.h for how to include it.

#if defined(MOBIL_SYSTEMS_GAIT_SWING_LEG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_SWING_LEG_INL_H_
#undef MOBIL_SYSTEMS_GAIT_SWING_LEG_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_SWING_LEG_INL_H_
#endif

#include "assets/body/segment_masses.h"
#include "systems/gait/planar_figure-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Angles of thigh and shank from the downward vertical, forward positive (the paper's θ₃, θ₄), and their rates.
struct SwingState {
  Wide thigh, shank, thigh_rate, shank_rate;
};

/// Torques about hip and knee that move the distal parts forward (flex the hip, extend the knee), per kg of the body
/// and height².
struct Torques {
  Wide hip, knee;
};

/// Acceleration of the hip relative to free fall, heights per s².
struct Pull {
  Wide forward, up;
};

/// Inertias about hip and knee, their coupling, first moments, and the lengths.
struct SwingLeg {
  float thigh_inertia, shank_inertia, coupling, thigh_moment, shank_moment, thigh, shank;

  /// Returns the angles of a leg between its hip and its ankle, with rates 0.
  HWY_NOINLINE SwingState hanging(const OtherLeg& at) const {
    const Wide dz = at.ankle_forward - at.hip_forward, dy = at.ankle_up - at.hip_up;
    const BentKnee knee =
        bent_knee(dz, dy, wide((thigh + shank) * 0.9999F), wide(thigh * thigh), wide(thigh * thigh - shank * shank));
    const Wide knee_forward = knee.forward * knee.unit, knee_up = knee.up * knee.unit;
    return {atan2(knee_forward, -knee_up), atan2(dz - knee_forward, knee_up - dy), wide(0.0F), wide(0.0F)};
  }

  /// Returns the torques that cause these accelerations.
  HWY_NOINLINE Torques torques(const SwingState& y, const Wide& thigh_bend, const Wide& shank_bend,
                               const Pull& pull) const {
    Wide s3, c3, s4, c4;
    sin_cos(y.thigh, s3, c3);
    sin_cos(y.shank, s4, c4);
    const Wide c = coupling * fma(c3, c4, s3 * s4), s = coupling * fnma(c3, s4, s3 * c4);
    const Wide on_thigh = fma(wide(thigh_inertia), thigh_bend, c * shank_bend) + s * y.shank_rate * y.shank_rate +
                          thigh_moment * fma(pull.forward, c3, pull.up * s3);
    const Wide on_shank = fma(wide(shank_inertia), shank_bend, c * thigh_bend) - s * y.thigh_rate * y.thigh_rate +
                          shank_moment * fma(pull.forward, c4, pull.up * s4);
    return {on_thigh + on_shank, on_shank};
  }
};

constexpr SwingLeg unit_swing_leg = [] {
  constexpr auto a = static_cast<float>(fraction::thigh), b = static_cast<float>(fraction::shank);
  using namespace forces;
  // The foot's mass is at the ankle.
  constexpr auto mass = [](MassGroup g) { return static_cast<float>(de_leva_men[static_cast<std::size_t>(g)]); };
  constexpr float thigh_mass = mass(MassGroup::thigh), shank_mass = mass(MassGroup::shank),
                  foot_mass = mass(MassGroup::foot);
  constexpr float below = shank_mass + foot_mass, moment = (shank_mass * shank.centre + foot_mass) * b;
  constexpr float inertia =
      (shank_mass * (shank.centre * shank.centre + shank.gyration * shank.gyration) + foot_mass) * b * b;
  return SwingLeg{thigh_mass * (thigh.centre * thigh.centre + thigh.gyration * thigh.gyration) * a * a + below * a * a,
                  inertia,
                  moment * a,
                  thigh_mass * thigh.centre * a + below * a,
                  moment,
                  a,
                  b};
}();

/// Second derivatives of the angles under torques, and their derivatives.
struct SwingBends {
  Wide thigh, shank;

  HWY_INLINE SwingBends(const SwingLeg& of, const SwingState& y, const Pull& pull, const Torques& torque)
      : leg_(of), thigh_rate_(y.thigh_rate), shank_rate_(y.shank_rate) {
    Wide s3, c3, s4, c4;
    sin_cos(y.thigh, s3, c3);
    sin_cos(y.shank, s4, c4);
    c_ = of.coupling * fma(c3, c4, s3 * s4);
    s_ = of.coupling * fnma(c3, s4, s3 * c4);
    per_ = 1.0F / fnma(c_, c_, wide(of.thigh_inertia * of.shank_inertia));
    thigh_turns_ = of.thigh_moment * (pull.forward * s3 - pull.up * c3);
    shank_turns_ = of.shank_moment * (pull.forward * s4 - pull.up * c4);
    const Wide f3 = torque.hip - torque.knee - s_ * y.shank_rate * y.shank_rate -
                    of.thigh_moment * fma(pull.forward, c3, pull.up * s3);
    const Wide f4 =
        torque.knee + s_ * y.thigh_rate * y.thigh_rate - of.shank_moment * fma(pull.forward, c4, pull.up * s4);
    solve(f3, f4, thigh, shank);
  }

  /// Returns the rate of change of a derivative of the state whose torques change by `by`.
  HWY_INLINE SwingState derivative(const SwingState& d, const Torques& by) const {
    const Wide apart = d.thigh - d.shank;
    const Wide f3 = by.hip - by.knee + thigh_turns_ * d.thigh + s_ * apart * shank -
                    fma(c_ * apart, shank_rate_ * shank_rate_, 2.0F * s_ * shank_rate_ * d.shank_rate);
    const Wide f4 = by.knee + shank_turns_ * d.shank + s_ * apart * thigh +
                    fma(c_ * apart, thigh_rate_ * thigh_rate_, 2.0F * s_ * thigh_rate_ * d.thigh_rate);
    SwingState rate{d.thigh_rate, d.shank_rate, {}, {}};
    solve(f3, f4, rate.thigh_rate, rate.shank_rate);
    return rate;
  }

 private:
  HWY_INLINE void solve(const Wide& f3, const Wide& f4, Wide& x3, Wide& x4) const {
    x3 = fnma(c_, f4, leg_.shank_inertia * f3) * per_;
    x4 = fnma(c_, f3, leg_.thigh_inertia * f4) * per_;
  }
  const SwingLeg& leg_;
  Wide thigh_rate_, shank_rate_, c_, s_, per_, thigh_turns_, shank_turns_;
};

/// Position of the ankle relative to the hip.
struct AnkleBelow {
  Wide forward, up;
  HWY_INLINE AnkleBelow(const SwingLeg& leg, const SwingState& y) {
    sin_cos(y.thigh, s3_, c3_);
    sin_cos(y.shank, s4_, c4_);
    s3_ = leg.thigh * s3_;
    s4_ = leg.shank * s4_;
    forward = s3_ + s4_;
    up = -fma(wide(leg.thigh), c3_, leg.shank * c4_);
  }
  HWY_INLINE Wide up_by(const SwingState& d) const { return fma(s3_, d.thigh, s4_ * d.shank); }

 private:
  Wide s3_, c3_, s4_, c4_;
};

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
