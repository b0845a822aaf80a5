#include "systems/lines/frame_motion.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "engine/wide_geometry-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

HWY_INLINE WideQuat conjugate(const WideQuat& q) {
  return {-q.x, -q.y, -q.z, q.w};
}

HWY_INLINE WideVec scale(const Wide& s, const WideVec& a) {
  return {s * a.x, s * a.y, s * a.z};
}

/// Returns the rotation vector of a quaternion, rad, for the rotation by at most π.
HWY_INLINE WideVec rotation_vector(const WideQuat& q) {
  const WideVec axis{q.x, q.y, q.z};
  const Wide sine = max(length(axis), 1e-18F);
  const Wide angle = wide(2.0F) * atan2(sine, abs(q.w));
  return scale(copy_sign(angle / sine, q.w), axis);
}

HWY_INLINE void store(const WideVec& x, const WideVec& y, const WideVec& z, Mat3<Lanes<float>>& to) {
  mobil::HWY_NAMESPACE::store(x, to.x);
  mobil::HWY_NAMESPACE::store(y, to.y);
  mobil::HWY_NAMESPACE::store(z, to.z);
}

}  // namespace

void feel_frame(const LineOfAction<Lanes<float>>& line, FrameHistory<Lanes<float>>& history,
                FrameLoad<Lanes<float>>& load_of, float tick_s) {
  const WideVec start = load(line.start_m);
  const WideQuat rotation = load(line.rotation);
  const WideMask first = equal(history.known, 0), second = equal(history.known, 1);
  WideQuat before = load(history.rotation);
  before = {select(first, rotation.x, before.x), select(first, rotation.y, before.y),
            select(first, rotation.z, before.z), select(first, rotation.w, before.w)};
  const WideVec step = start - select(first, start, load(history.start_m));
  const WideVec turn = rotation_vector(rotation * conjugate(before));
  const WideMask even = first | second;
  const WideVec step_before = select(even, step, load(history.step_m));
  const WideVec turn_before = select(even, turn, load(history.turn_rad));

  // Load during the last tick, in the frame at that time.
  const Wide rate = wide(1.0F / tick_s), rate2 = wide(1.0F / (tick_s * tick_s));
  const WideQuat inward = conjugate(before);
  WideVec felt = scale(-rate2, step - step_before);
  felt.y = felt.y - wide(gravity_m_s2);
  const WideVec constant = rotate(inward, felt);
  const WideVec w = rotate(inward, scale(wide(0.5F) * rate, turn + turn_before));
  const WideVec a = rotate(inward, scale(rate2, turn - turn_before));

  // −α×x − ω×(ω×x) = −α×x + ω²x − ω(ω·x)
  const Wide xx = w.x * w.x, yy = w.y * w.y, zz = w.z * w.z;
  const Wide xy = w.x * w.y, xz = w.x * w.z, yz = w.y * w.z;
  const WideVec row_x{yy + zz, a.z - xy, -a.y - xz};
  const WideVec row_y{-a.z - xy, xx + zz, a.x - yz};
  const WideVec row_z{a.y - xz, -a.x - yz, xx + yy};

  const auto last = [&](const Vec3<Lanes<float>>& to, const WideVec& now)
                        HWY_ATTR { return select(first, now, load(to)); };
  store(last(load_of.constant_to, constant), load_of.constant_from);
  store(last(load_of.gradient_to.x, row_x), last(load_of.gradient_to.y, row_y), last(load_of.gradient_to.z, row_z),
        load_of.gradient_from);
  store(constant, load_of.constant_to);
  store(row_x, row_y, row_z, load_of.gradient_to);
  store(start, history.start_m);
  store(step, history.step_m);
  store(rotation, history.rotation);
  store(turn, history.turn_rad);
  for (std::uint32_t& known : history.known.lane) known = known == 0 ? 1 : 2;
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(feel_frame);
}  // namespace

void frame_motion(const LineOfAction<Lanes<float>>& line, FrameHistory<Lanes<float>>& history,
                  FrameLoad<Lanes<float>>& load, float tick_s) {
  HWY_DYNAMIC_DISPATCH(feel_frame)(line, history, load, tick_s);
}

}  // namespace mobil::inline v0_3
#endif
