#include <mobil/assets/muscles/muscle_path.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr double degree = std::numbers::pi / 180;

Vec scaled(const PathPoint& p, const LegScale<double>& scale) {
  const double along = p.bone == LegBone::thigh ? scale.thigh : p.bone == LegBone::shank ? scale.shank : scale.across;
  return {scale.across * p.at_m.x, along * p.at_m.y, scale.across * p.at_m.z};
}

/// Returns the direction of an edge of that bone.
Vec edge_axis(LegBone bone, const LegFrames<double>& leg) {
  return rotated(bone == LegBone::pelvis ? leg.pelvis : bone == LegBone::thigh ? leg.thigh : leg.shank, {1, 0, 0});
}

/// Returns the point at which the shortest path from a to b over the edge through p touches it, relative to p. Returns
/// nothing if the straight line clears the edge.
std::optional<Vec> touch(const Vec& a, const Vec& b, const Vec& axis, const PathPoint& edge) {
  const double turn = dot(cross(a, b), axis);
  if (edge.hold == PathHold::front ? turn >= 0 : turn <= 0) return std::nullopt;
  // Round the pelvis' edge it never bends by more than a right angle; in deep flexion it is clear of it.
  if (edge.bone == LegBone::pelvis && dot(a, b) >= dot(a, axis) * dot(b, axis)) return std::nullopt;
  // Unfolded into one plane the path is straight.
  const double from = dot(a, axis), to = dot(b, axis);
  const double near = length(a - from * axis), far = length(b - to * axis);
  return ((from * far + to * near) / (near + far)) * axis;
}

}  // namespace

KneeSpline<double> knee_spline(const KneeTrack& track) {
  constexpr std::size_t n = knee_knots;
  // Second derivatives m: m₀ = mₙ₋₁ = 0, mᵢ₋₁ + 4mᵢ + mᵢ₊₁ = 6 (tᵢ₋₁ − 2tᵢ + tᵢ₊₁), by elimination.
  std::array<Vec, n> m{}, right{};
  std::array<double, n> diagonal{};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    right[i] = 6.0 * (track[i - 1] - 2.0 * track[i] + track[i + 1]);
    diagonal[i] = 4;
    if (i == 1) continue;
    diagonal[i] -= 1 / diagonal[i - 1];
    right[i] = right[i] - (1 / diagonal[i - 1]) * right[i - 1];
  }
  for (std::size_t i = n - 2; i > 0; --i) m[i] = (1 / diagonal[i]) * (right[i] - m[i + 1]);
  KneeSpline<double> s{track[0], track[1] - track[0] - (1.0 / 6) * m[1], {}};
  // The third derivative of piece k is mₖ₊₁ − mₖ; its jumps are the cubics' coefficients.
  Vec before{};
  for (std::size_t k = 0; k < n; ++k) {
    const Vec third = k + 1 < n ? m[k + 1] - m[k] : Vec{};
    s.cubic[k] = (1.0 / 6) * (third - before);
    before = third;
  }
  return s;
}

Vec track_at(const KneeTrack& track, double flexion_deg) {
  if (flexion_deg == 0) return track[0];  // the result of everything below at 0°
  const KneeSpline<double> s = knee_spline(track);
  const double u = flexion_deg / knee_knot_deg;
  Vec at = s.at_zero + u * s.slope;
  for (std::size_t k = 0; k < knee_knots; ++k) {
    const double d = std::max(u - static_cast<double>(k), 0.0);
    at = at + d * d * d * s.cubic[k];
  }
  return at;
}

LegScale<double> leg_scale(double thigh_m, double shank_m) {
  return {thigh_m / published_leg::thigh_m, shank_m / published_leg::shank_m,
          (thigh_m + shank_m) / published_leg::leg_m};
}

LegScale<double> leg_scale(const Body& body) {
  auto scale = leg_scale(static_cast<double>(body.thigh_length_m), static_cast<double>(body.shank_length_m));
  // With custom limb lengths, bones keep the thickness that follows from the usual leg, and pelvis and feet their size.
  if (has_own_limbs(body.request)) {
    const double usual_m = (fraction::thigh + fraction::shank) * static_cast<double>(body.size.leg_scale_m);
    scale.across = usual_m / published_leg::leg_m;
  }
  return scale;
}

Vec bone_origin(LegBone bone, const LegFrames<double>& leg) {
  return bone == LegBone::shank ? leg.knee_m : bone == LegBone::foot ? leg.ankle_m : leg.hip_m;
}

Vec path_point(const PathPoint& p, const LegScale<double>& scale, const LegFrames<double>& leg) {
  const std::array<Quat<double>, 4> turned = {leg.pelvis, leg.thigh, leg.shank, leg.foot};
  return bone_origin(p.bone, leg) + rotated(turned[static_cast<std::size_t>(p.bone)], scaled(p, scale));
}

PathPoint path_end(const MemberMuscle& muscle, double flexion_deg) {
  if (!muscle.kneecap) return muscle.path.back();
  return {LegBone::shank, track_at(*muscle.kneecap, flexion_deg)};
}

LegFrames<double> anatomical_leg(const Body& body) {
  const Vec hip = to_double(body.joint_offset_m[index(Segment::pelvis)]) +
                  to_double(body.joint_offset_m[index(Segment::thigh_right)]);
  const Vec knee = hip + to_double(body.joint_offset_m[index(Segment::shank_right)]);
  const Vec ankle = knee + to_double(body.joint_offset_m[index(Segment::foot_right)]);
  const Quat<double> identity{0, 0, 0, 1};
  return {hip, knee, ankle, identity, identity, identity, identity};
}

double knee_flexion(const LegFrames<double>& leg) {
  const Quat<double> q = product(conjugate(leg.thigh), leg.shank);
  return 2 * exact::atan2(q.w < 0 ? -q.x : q.x, std::abs(q.w));
}

LegFrames<double> rolled(const LegScale<double>& scale, const LegFrames<double>& leg) {
  const Vec by = rotated(leg.shank, scale.across * track_at(knee_rolling(), knee_flexion(leg) / degree));
  LegFrames<double> there = leg;
  there.knee_m = leg.knee_m + by;
  there.ankle_m = leg.ankle_m + by;
  return there;
}

namespace {

/// A leg with the values that all its members' paths need.
struct BentLeg {
  const LegScale<double>& scale;
  const LegFrames<double>& leg;
  LegFrames<double> there = rolled(scale, leg);
  double flexion_deg = knee_flexion(leg) / degree;
};

/// Visits the corners of a member's path in order.
template <class Visit>
void follow_path(const MemberMuscle& muscle, const BentLeg& bent, Visit visit) {
  const PathPoint end = path_end(muscle, bent.flexion_deg);
  const std::size_t own = muscle.path.size(), all = own + (muscle.kneecap ? 1 : 0);
  const auto point = [&](std::size_t i) -> const PathPoint& { return i < own ? muscle.path[i] : end; };
  Vec before{};
  for (std::size_t i = 0; i < all; ++i) {
    const PathPoint& p = point(i);
    Vec at = path_point(p, bent.scale, bent.there);
    if (p.hold != PathHold::fixed) {
      std::size_t next = i;
      while (point(next).hold != PathHold::fixed) ++next;
      const Vec straight_to = path_point(point(next), bent.scale, bent.there);
      const auto touched = touch(before - at, straight_to - at, edge_axis(p.bone, bent.leg), p);
      if (!touched) continue;
      at = at + *touched;
    }
    visit(PathCorner{at, p.bone});
    before = at;
  }
}

double path_length(const MemberMuscle& muscle, const BentLeg& bent) {
  double sum = 0;
  std::optional<Vec> before;
  follow_path(muscle, bent, [&](const PathCorner& corner) {
    if (before) sum += length(corner.at - *before);
    before = corner.at;
  });
  return sum;
}

double reference_volume_cm3(const MemberMuscle& muscle) {
  return handsfield_volume_cm3(muscle, reference_body_height_m, reference_body_mass_kg);
}

}  // namespace

std::vector<PathCorner> member_path(const MemberMuscle& muscle, const LegScale<double>& scale,
                                    const LegFrames<double>& leg) {
  std::vector<PathCorner> corners;
  follow_path(muscle, {scale, leg}, [&](const PathCorner& corner) { corners.push_back(corner); });
  return corners;
}

double member_length(const MemberMuscle& muscle, const LegScale<double>& scale, const LegFrames<double>& leg) {
  return path_length(muscle, {scale, leg});
}

double member_weight(std::span<const MemberMuscle> members, const MemberMuscle& muscle) {
  double all = 0;
  for (const auto& m : members) all += reference_volume_cm3(m);
  return reference_volume_cm3(muscle) / all;
}

std::vector<double> member_lengths(Muscle muscle, const LegScale<double>& scale, const LegFrames<double>& leg) {
  const BentLeg bent{scale, leg};
  std::vector<double> lengths;
  for (const auto& member : members_of(muscle)) lengths.push_back(path_length(member, bent));
  return lengths;
}

double muscle_length(Muscle muscle, std::span<const double> member_m) {
  const auto members = members_of(muscle);
  double sum = 0;
  for (std::size_t i = 0; i < members.size(); ++i) sum += member_weight(members, members[i]) * member_m[i];
  return sum;
}

double muscle_length(Muscle muscle, const LegScale<double>& scale, const LegFrames<double>& leg) {
  return muscle_length(muscle, member_lengths(muscle, scale, leg));
}

}  // namespace mobil::inline v0_3
