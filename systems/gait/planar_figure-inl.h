// A walker in the plane of the walk: rods for the legs and a trunk, which give the centre of pressure of a step. See
// engine/wide-inl.h for how to include it.

#if defined(MOBIL_SYSTEMS_GAIT_PLANAR_FIGURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_PLANAR_FIGURE_INL_H_
#undef MOBIL_SYSTEMS_GAIT_PLANAR_FIGURE_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_PLANAR_FIGURE_INL_H_
#endif

#include "assets/gait/leg_model.h"
#include "assets/gait/step_feet-inl.h"
#include "systems/gait/leg_size-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// The body above the hips, in its own scale: height of its centre of mass above the hips and distance ahead; its
/// forward motion per radian of trunk lean, pelvic tilt and swing of both arms together; and the square of its radius
/// of gyration as it leans. They follow from the bodies of demo/lab/gait_fit/upper_body.h, times the ratio between that
/// and least-squares fits to the 48 segments of a man in walks of 0.5 to 2 m/s.
struct UpperBodyMotion {
  float above, ahead, per_lean, per_tilt, per_swing, gyration2;
};
constexpr UpperBodyMotion man_above_hips = {0.1833F, -0.0207F, 0.0689F, 0.1103F, 0.0219F, 0.0111F},
                          woman_above_hips = {0.1731F, -0.0196F, 0.0638F, 0.1040F, 0.0194F, 0.0116F},
                          child_above_hips = {0.2037F, -0.0167F, 0.0750F, 0.1010F, 0.0130F, 0.0122F};

/// Returns the value of persons between man, woman and child.
HWY_INLINE Wide above_hips(const LegSize& size, float UpperBodyMotion::*value) {
  const float man = man_above_hips.*value;
  const Wide adult = fma(size.woman, wide(woman_above_hips.*value - man), wide(man));
  return fma(size.child, child_above_hips.*value - adult, adult);
}

/// Point masses in the plane: per leg two of the thigh, two of the shank and one of the foot; and one of the body
/// above.
constexpr std::size_t planar_points = 11;

HWY_INLINE Wide planar_mass(const LegSize& size, std::size_t point) {
  if (point + 1 == planar_points) return 1.0F - 2.0F * (size.thigh_mass + size.shank_mass + size.foot_mass);
  const std::size_t part = point % 5;
  return part < 2 ? 0.5F * size.thigh_mass : part < 4 ? 0.5F * size.shank_mass : size.foot_mass;
}

struct PlanarFigure {
  Wide forward[planar_points], up[planar_points];
  Wide lean;   // of the body above the hips
  Wide aside;  // of the hips
  Wide stance_pitch;
};

/// Position of a knee that bends forward, from the hip, multiplied by the distance of the ankle; and the reciprocal of
/// that distance.
struct BentKnee {
  Wide forward, up, unit;
};

/// `dz` and `dy` lead from hip to ankle. `longest` is the maximum length of the leg, `thigh2` the square of the thigh's
/// length, and `difference2` that minus the square of the shank's.
HWY_INLINE BentKnee bent_knee(const Wide& dz, const Wide& dy, const Wide& longest, const Wide& thigh2,
                              const Wide& difference2) {
  const Wide far = sqrt(fma(dz, dz, dy * dy)), length = min(far, longest);
  const Wide near = fma(length, length, difference2) / (2.0F * length);
  const Wide bulge = sqrt(max(fnma(near, near, thigh2), 0.0F));
  return {fnma(dy, bulge, dz * near), fma(dz, bulge, dy * near), 1.0F / far};
}

HWY_NOINLINE inline void planar_leg(const Wide& height, const Wide& hip_forward, const Wide& hip_up,
                                    const Wide& ankle_forward, const Wide& ankle_up, std::size_t first,
                                    PlanarFigure& out) {
  constexpr float a = static_cast<float>(fraction::thigh), b = static_cast<float>(fraction::shank);
  const BentKnee knee = bent_knee(ankle_forward - hip_forward, ankle_up - hip_up, (a + b) * 0.9999F * height,
                                  a * a * height * height, (a * a - b * b) * height * height);
  const Wide knee_forward = fma(knee.forward, knee.unit, hip_forward), knee_up = fma(knee.up, knee.unit, hip_up);
  auto rod = [&](const forces::Rod& of, const Wide& z0, const Wide& y0, const Wide& z1, const Wide& y1,
                 std::size_t point) {
    for (const float part : {of.centre - of.gyration, of.centre + of.gyration}) {
      out.forward[point] = fma(z1 - z0, wide(part), z0);
      out.up[point++] = fma(y1 - y0, wide(part), y0);
    }
  };
  rod(forces::thigh, hip_forward, hip_up, knee_forward, knee_up, first);
  rod(forces::shank, knee_forward, knee_up, ankle_forward, ankle_up, first + 2);
  constexpr auto foot = static_cast<float>(forces::foot_centre.z);
  out.forward[first + 4] = fma(wide(foot), height, ankle_forward);
  out.up[first + 4] = ankle_up;
}

/// The hips in side view: their middle, position of the stance side ahead of and above it, and their lateral
/// displacement.
struct HipsSeen {
  Wide forward, up, before, above, aside;
};

/// Computes the hips at a part of the step's time, its phase and its waves. `along` is the cosine of the line's slant,
/// which projects steps of standing people along a slanted line into the side view.
HWY_NOINLINE inline HipsSeen hips_seen(const StepPlan<Lanes<float>>& plan, const MixedShape& of, const LegSize& size,
                                       const Wide& u, const Wide& phase, const StepWaves& waves, const Wide& along) {
  const HipsPlace hips = hips_place(plan, of, u, phase, waves);
  const Wide eased = smooth(u), half = static_cast<float>(fraction::hip_half_spacing) * size.hips;
  return {fma(hips.forward, along, hips.ahead), hips_height(plan, of, size.leg, u, waves),
          half * pelvis_rotation(plan, waves, eased), half * pelvis_list(plan, waves, eased), hips.aside};
}

/// The swing leg, relative to the stance foothold.
struct OtherLeg {
  Wide hip_forward, hip_up, ankle_forward, ankle_up;
  Wide part;  // of the swing
};

HWY_NOINLINE inline OtherLeg other_leg(const StepPlan<Lanes<float>>& plan, const MixedShape& of, const Wide& height,
                                       const Wide& phase, const HipsSeen& hips, const Wide& along) {
  const OtherAnkle other = other_ankle(plan, of, height, phase);
  const PlantedAnkle leaves = planted_ankle(height, other.standing_pitch);
  Wide s, c;
  sin_cos(load(plan.trailing_toe_out), s, c);
  const Wide other_along = select(other.swings, other.forward, leaves.along.value * c);
  return {hips.forward - hips.before, hips.up - hips.above, (other_along - load(plan.length_before_m)) * along,
          select(other.swings, other.up, leaves.up.value), other.part};
}

/// Computes the figure at a part of the step's time and its phase. `along` is that of hips_seen.
HWY_NOINLINE inline void planar_figure(const StepPlan<Lanes<float>>& plan, const LegSize& size, const Wide& u,
                                       const Wide& phase, const StepWaves& waves, const Wide& along,
                                       PlanarFigure& out) {
  const Wide& height = size.leg;
  const MixedShape of{plan.from.shape, plan.to.shape, mixed_part(plan, phase)};
  const HipsSeen hips = hips_seen(plan, of, size, u, phase, waves, along);
  const OtherLeg other = other_leg(plan, of, height, phase, hips, along);
  out.stance_pitch = stance_pitch(plan, of, phase);
  const PlantedAnkle stands = planted_ankle(height, out.stance_pitch);
  const OneShape landed{plan.from.shape};
  const Wide yielding = phase * (0.5F / pad_part), eased = smooth(u);
  const Wide stance_forward = stands.along.value + falling(landed, step_shape::pad_forward, yielding);
  const Wide stance_up = stands.up.value + falling(landed, step_shape::pad_up, yielding);
  planar_leg(height, hips.forward + hips.before, hips.up + hips.above, stance_forward, stance_up, 0, out);
  planar_leg(height, other.hip_forward, other.hip_up, other.ankle_forward, other.ankle_up, 5, out);
  out.aside = hips.aside;
  using U = UpperBodyMotion;
  const Wide per_lean = above_hips(size, &U::per_lean), per_tilt = above_hips(size, &U::per_tilt);
  const Wide bent_forward =
      fma(harmonics(of, step_shape::trunk, 3, waves), per_lean, per_tilt * pelvis_tilt(plan, waves, eased));
  out.lean = bent_forward / (per_lean + per_tilt);
  // Arms follow the opposite legs.
  const PostureParameters<Lanes<float>>&from = plan.from.posture, &to = plan.to.posture;
  const Wide back = posture(from.leg_back, to.leg_back, eased),
             range = posture(from.leg_forward, to.leg_forward, eased) - back;
  const Wide legs = (stance_forward + other.ankle_forward - 2.0F * hips.forward) / hips.up;
  const Wide swing =
      (legs - 2.0F * back) / max(range, 1e-3F) *
          (posture(from.arm_forward, to.arm_forward, eased) + posture(from.arm_back, to.arm_back, eased)) -
      2.0F * posture(from.arm_back, to.arm_back, eased);
  const Wide ahead = fma(above_hips(size, &U::per_swing), swing, bent_forward + above_hips(size, &U::ahead));
  out.forward[planar_points - 1] = fma(ahead, size.upper, hips.forward);
  out.up[planar_points - 1] = fma(above_hips(size, &U::above), size.upper, hips.up);
}

/// Mean rates between two figures `apart` seconds from each other, per kg: of the total angular momentum (z ẏ − y ż,
/// including the trunk's rotation) and of the height of the centre of mass.
struct PlanarMotion {
  Wide turning, rising;
};

HWY_NOINLINE inline PlanarMotion planar_motion(const PlanarFigure& a, const PlanarFigure& b, const LegSize& size,
                                               const Wide& per_apart) {
  PlanarMotion m = {wide(0.0F), wide(0.0F)};
  for (std::size_t i = 0; i < planar_points; ++i) {
    const Wide mass = planar_mass(size, i);
    m.turning = fma(mass, fnma(b.forward[i], a.up[i], a.forward[i] * b.up[i]), m.turning);
    m.rising = fma(mass, b.up[i] - a.up[i], m.rising);
  }
  const Wide spin = above_hips(size, &UpperBodyMotion::gyration2) * planar_mass(size, planar_points - 1);
  m.turning = fnma(spin * size.upper * size.upper, b.lean - a.lean, m.turning) * per_apart;
  m.rising = m.rising * per_apart;
  return m;
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
