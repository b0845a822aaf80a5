// Positions of pelvis and feet in a step. See engine/wide-inl.h for how to include it.

#if defined(MOBIL_SYSTEMS_KINEMATICS_STEP_NOW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_KINEMATICS_STEP_NOW_INL_H_
#undef MOBIL_SYSTEMS_KINEMATICS_STEP_NOW_INL_H_
#else
#define MOBIL_SYSTEMS_KINEMATICS_STEP_NOW_INL_H_
#endif

#include "assets/body/column.h"
#include "assets/gait/on_line-inl.h"
#include "assets/gait/uneven-inl.h"
#include "systems/gait/kinematics_wide-inl.h"
#include "systems/gait/leg_size-inl.h"
#include "systems/gait/unit_skeleton.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Present motion of the pelvis, seen from the right, and the hips relative to their middle, in its heading. `tilt` is
/// that of gait laboratories, `turn` is from the anatomical position.
struct PelvisMotion {
  Wide rotation, list, tilt;
  WideQuat turn;
  WideVec hip[2];
};

HWY_NOINLINE inline PelvisMotion pelvis_motion(const StepPlan<Lanes<float>>& plan, const StepWaves& w,
                                               const Wide& eased, const Wide& sign, const Wide& hips) {
  PelvisMotion m;
  m.rotation = sign * pelvis_rotation(plan, w, eased);
  m.list = sign * pelvis_list(plan, w, eased);
  m.tilt = pelvis_tilt(plan, w, eased);
  m.turn = turn_yzx(m.rotation, -m.list, m.tilt - static_cast<float>(neutral_tilt));
  for (std::size_t side = 0; side < 2; ++side)
    m.hip[side] = rotate(m.turn, scaled(unit_skeleton.joint_offset[index(on_side(Segment::thigh_right, side))], hips));
  return m;
}

/// Position and heading of the pelvis in the frame of the stance foothold, with sine and cosine of the heading.
struct PelvisPlace {
  WideVec position;
  Wide heading, sine, cosine;
};

/// Returns the lower of two values, rounded where they are within `width` of each other: C², never above either.
HWY_INLINE Wide lower_of(const Wide& a, const Wide& b, const Wide& width) {
  const Wide d = clamp((b - a) / width, -1.0F, 1.0F);
  // The positive part of d with (1 − d²) 3/4 as its second derivative.
  const Wide rounded = fma(d, fma(d, 0.375F - 0.0625F * d * d, wide(0.5F)), wide(0.1875F));
  return min(a, b) - width * (rounded - max(d, 0.0F));
}

/// Draws a foot in the air that its leg cannot reach toward the hip. This is smooth: it starts `rounding` of the leg's
/// length before the limit, and is weaker near the ground at toe-off and landing.
HWY_NOINLINE inline void draw_in(FootMotion& foot, Foothold& at, const PelvisPlace& root, const PelvisMotion& motion,
                                 std::size_t side, const Wide& height, float rounding) {
  const WideVec& hip = motion.hip[side];
  const Wide hip_left = root.position.x + fma(hip.x, root.cosine, hip.z * root.sine);
  const Wide hip_ahead = root.position.z + fnma(hip.x, root.sine, hip.z * root.cosine);
  const Wide dx = at.ankle.left - hip_left, dz = at.ankle.forward - hip_ahead;
  const Wide dy = foot.ankle_up - root.position.y - hip.y;
  const Wide distance = sqrt(fma(dx, dx, fma(dy, dy, dz * dz)));
  constexpr float full = static_cast<float>(fraction::thigh + fraction::shank);
  const Wide most = 0.9995F * full * height;
  const Wide within = fma(rounding * full * height, foot.in_the_air, wide(1e-5F));
  const Wide near = max(1.0F - abs(distance - most) / within, 0.0F);
  const Wide reached = min(distance, most) - within * (1.0F / 6.0F) * near * near * near;
  const Wide part = mix(wide(1.0F), reached / distance, smooth(4.0F * foot.in_the_air));
  at.ankle = {fma(part, dx, hip_left), fma(part, dz, hip_ahead)};
  foot.ankle_up = fma(part, dy, root.position.y + hip.y);
}

/// Returns the height of the middle of the hips at which a leg is as straight as a knee becomes.
HWY_NOINLINE inline Wide highest_hips(const FootMotion& foot, const Foothold& at, const PelvisPlace& root,
                                      const PelvisMotion& motion, std::size_t side, const Wide& height) {
  const WideVec& hip = motion.hip[side];
  const Wide dx = at.ankle.left - root.position.x, dz = at.ankle.forward - root.position.z;
  const Wide x = fnma(dz, root.sine, dx * root.cosine) - hip.x, z = fma(dx, root.sine, dz * root.cosine) - hip.z;
  constexpr float straightest = static_cast<float>(fraction::thigh + fraction::shank) * 0.9999F;  // 1.6 degrees
  const Wide reach = straightest * height;
  return foot.ankle_up - hip.y + sqrt(max(reach * reach - fma(x, x, z * z), 0.0F));
}

HWY_INLINE Foothold foothold_of(const WideMask& stands, const Foothold& stance, const Foothold& other) {
  return {
      {select(stands, stance.ankle.left, other.ankle.left), select(stands, stance.ankle.forward, other.ankle.forward)},
      select(stands, stance.heading, other.heading)};
}

HWY_INLINE FootMotion foot_of(const WideMask& stands, const FootMotion& stance, const FootMotion& other) {
  return {select(stands, stance.pitch, other.pitch),
          select(stands, stance.toes, other.toes),
          select(stands, stance.toe_out, other.toe_out),
          select(stands, stance.ankle_up, other.ankle_up),
          select(stands, stance.ankle_out, other.ankle_out),
          select(stands, stance.ankle_forward, other.ankle_forward),
          other.part,
          other.swung,
          select(stands, wide(0.0F), other.in_the_air)};
}

/// Part of the ankles' sideways displacement in a turn by which the hips yield, to keep the centre of mass on the line.
constexpr float give_way = 0.03F;

/// Returns the lateral position of a foot, to the left of the line, minus that of a straight walk.
HWY_INLINE Wide beside(const OnLine& on, const PelvisPlace& root, const Foothold& at, const Wide& straight) {
  return fma(at.ankle.left - on.place.left, root.cosine, (on.place.forward - at.ankle.forward) * root.sine) - straight;
}

/// Pelvis and feet in the frame of the stance foothold, from which a pose is built.
struct StepNow {
  Wide part, eased;  // elapsed part of the step's time
  StepWaves waves;
  MixedShape shape;
  PelvisMotion motion;
  PelvisPlace pelvis;
  WideMask stands[2];
  FootMotion foot[2];
  Foothold at[2];
  Slope under[2];  // only with footing, as is:
  Wide lean;       // added to that on level ground
};

constexpr std::size_t step_now_fetches = 7;

/// Computes the state of a step. `footing` is null on level ground. `fetch` is called step_now_fetches times, evenly
/// over the work, for prefetching.
template <class Fetch>
HWY_INLINE StepNow step_now(const LegSize& size, const StepPlan<Lanes<float>>& plan,
                            const GaitState<Lanes<float>>& state, const Footing<Lanes<float>>* footing,
                            const Fetch& fetch) {
  const Wide &height = size.leg, one = wide(1.0F), zero = wide(0.0F);
  const Wide time = load(state.time_s);
  const WideMask right_stands = equal(state.stance_side, Side::right),
                 left_stands = equal(state.stance_side, Side::left);
  const Wide u = time / load(plan.duration_s), eased = smooth(u), phase = step_phase(plan, u);
  const StepWaves waves = step_waves(phase);
  const MixedShape of{plan.from.shape, plan.to.shape, mixed_part(plan, phase)};
  fetch();
  const PelvisMotion motion = pelvis_motion(plan, waves, eased, select(right_stands, one, -one), size.hips);
  const Line line = line_of(plan, state);
  fetch();

  StepNow now{u, eased, waves, of, motion, {}, {right_stands, left_stands}, {}, {}, {}, zero};
  PelvisPlace& pelvis = now.pelvis;
  HipsPlace hips = hips_place(plan, of, u, phase, waves);
  const Wide aside = select(right_stands, hips.aside, -hips.aside);
  const OnLine on = on_line(line, hips.forward, phase, eased);
  fetch();
  const Wide up =
      hips_height(plan, of, height, u, waves) -
      mix(select(stands(plan.from), zero,
                 longer_leg(line.from.length_m, line.turned_before, line.shift_before, line.shift, height)),
          select(stands(plan.to), zero, longer_leg(line.to.length_m, line.turn, line.shift, line.shift_next, height)),
          eased);
  pelvis.heading = on.heading;
  sin_cos(pelvis.heading, pelvis.sine, pelvis.cosine);

  fetch();
  FootMotion stance = stance_foot(plan, of, height, phase);
  fetch();
  FootMotion other = other_foot(plan, of, height, phase);
  fetch();
  Uneven uneven;
  HipsOver over;
  if (footing != nullptr) {
    uneven = uneven_of(plan, *footing, load(state.heading_rad), line.turn, height);
    over = hips_over(plan, uneven, height, phase);
    hips.ahead = hips.ahead + over.ahead;
    now.lean = over.lean;
    step_otherwise(plan, *footing, of, uneven, height, phase, stance, other);
  }
  const Wide out = select(left_stands, one, -one);  // the stance foot's side
  Foothold standing_at = stance_foothold(line, stance, out), other_at = other_foothold(line, other, -out);
  const Wide rest = shift_at_rest(plan, line, eased);
  const Wide way_aside = aside + rest -
                         give_way * (beside(on, pelvis, standing_at, rest + out * stance.ankle_out) +
                                     beside(on, pelvis, other_at, rest - out * other.ankle_out));
  const Ground way = turned(way_aside, hips.ahead, pelvis.sine, pelvis.cosine);
  pelvis.position = {on.place.left + way.left, up, on.place.forward + way.forward};
  if (footing != nullptr) {
    const Slopes& slopes = uneven.slopes;
    const Slope other_slope = part_way(slopes.leaving, slopes.landing, other.swung);
    put_on(slopes.stance, {fma(out, load(plan.from.half_width_m), line.shift), zero}, stance, standing_at);
    put_on(other_slope, flat_other(plan, line, other.swung, -out), other, other_at);
    const Ground moved = hips_moved(slopes, select(load(plan.landing) > 0.0F, eased, zero));
    pelvis.position = {pelvis.position.x + moved.left, up + over.up, pelvis.position.z + moved.forward};
    for (std::size_t side = 0; side < 2; ++side) {
      const auto of_foot = [&](Wide Slope::*word)
                               HWY_ATTR { return select(now.stands[side], slopes.stance.*word, other_slope.*word); };
      now.under[side] = {of_foot(&Slope::height), of_foot(&Slope::left), of_foot(&Slope::along),
                         of_foot(&Slope::moved_left), of_foot(&Slope::moved_along)};
    }
  }
  for (std::size_t side = 0; side < 2; ++side) {
    now.foot[side] = foot_of(now.stands[side], stance, other);
    now.at[side] = foothold_of(now.stands[side], standing_at, other_at);
    draw_in(now.foot[side], now.at[side], pelvis, motion, side, height, footing != nullptr ? 0.06F : 0.01F);
  }
  fetch();
  // The pelvis sinks where a leg would be too short: in a turn, at a very slow walk or on uneven ground.
  Wide rounding = 0.0002F * height;
  if (footing != nullptr) rounding = rounding + gentler(uneven, eased, height);
  const auto limit = [&](std::size_t side) HWY_ATTR {
    const Wide highest = highest_hips(now.foot[side], now.at[side], pelvis, motion, side, height);
    if (footing == nullptr) return highest;
    // A rising foot has already been drawn in and does not hold the hips back, but a foot about to land does.
    const FootMotion& foot = now.foot[side];
    const Wide free = smooth(4.0F * foot.in_the_air) * (1.0F - smooth((foot.part - 0.35F) * (1.0F / 0.3F)));
    return fma(0.05F * height, free, highest);
  };
  pelvis.position.y = lower_of(pelvis.position.y, lower_of(limit(Side::right), limit(Side::left), rounding), rounding);
  return now;
}

/// A leg's thigh and shank in the plane of hip, knee and ankle. The frame faces along the pelvis' heading, with its
/// origin in the middle of the hips.
struct LegPlane {
  WideVec to_ankle;  // from the hip
  Wide across2;      // square of the part that is not ahead
  Wide distance;     // to the ankle, at most as long as the leg
  Wide near, bulge;  // of the knee: along the line from hip to ankle, and off it
};

HWY_INLINE LegPlane leg_plane(const StepNow& now, std::size_t side, const Wide& height) {
  const Wide upper = static_cast<float>(fraction::thigh) * height;
  const Wide lower = static_cast<float>(fraction::shank) * height;
  const PelvisPlace& root = now.pelvis;
  const Foothold& at = now.at[side];
  // The frame of the stance foothold, rotated to the pelvis' heading, has small numbers. The knee keeps its digits at
  // any distance from the origin.
  const WideVec& hip = now.motion.hip[side];
  const Wide dx = at.ankle.left - root.position.x, dz = at.ankle.forward - root.position.z;
  LegPlane leg;
  leg.to_ankle = {fnma(dz, root.sine, dx * root.cosine) - hip.x, now.foot[side].ankle_up - root.position.y - hip.y,
                  fma(dx, root.sine, dz * root.cosine) - hip.z};
  const WideVec& d = leg.to_ankle;
  leg.across2 = fma(d.x, d.x, d.y * d.y);
  const Wide longest = (upper + lower) * 0.999999F;
  leg.distance = min(sqrt(fma(d.z, d.z, leg.across2)), longest);
  // Foot of the knee's perpendicular on the line from hip to ankle.
  leg.near = fma(leg.distance, leg.distance, (upper - lower) * (upper + lower)) / (2.0F * leg.distance);
  leg.bulge = sqrt(max((upper - leg.near) * (upper + leg.near), 0.0F));
  return leg;
}

/// Returns the pitch of a foot in the air, smoothly reduced if the ankle would bend up too far. Ankles of usual walks
/// do not come near that. `shank` is the forward angle of the shank relative to the slope of the ground.
HWY_INLINE Wide held_pitch(const FootMotion& foot, const Wide& shank) {
  constexpr float most = 0.61F, width = 0.09F;  // 35 and 5 degrees
  const Wide ankle = foot.pitch - shank;
  return foot.pitch - smooth(4.0F * foot.in_the_air) * (ankle - lower_of(ankle, wide(most), wide(width)));
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
