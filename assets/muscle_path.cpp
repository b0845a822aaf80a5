#include "assets/muscle_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assets/anthropometry.h"
#include "engine/geometry.h"

namespace mobil {
namespace {

using namespace geometry;

constexpr double degree = std::numbers::pi / 180;

Vec scaled(const PathPoint& p, const LegScale<double>& scale) {
  const double along = p.bone == LegBone::thigh ? scale.thigh : p.bone == LegBone::shank ? scale.shank : scale.across;
  return {scale.across * p.at_m.x, along * p.at_m.y, scale.across * p.at_m.z};
}

/// 1 where the path bends round the point, 0 where it does not.
double share_of_bend(const PathPoint& p, double flexion_deg) {
  double share = 1;
  if (p.from_deg > -180) share *= smoothstep(p.from_deg - path_blend_deg, p.from_deg + path_blend_deg, flexion_deg);
  if (p.to_deg < 180) share *= 1 - smoothstep(p.to_deg - path_blend_deg, p.to_deg + path_blend_deg, flexion_deg);
  return share;
}

Vec kneecap_at(const KneecapTrack& track, double flexion_deg) {
  const KneecapSpline s = kneecap_spline(track);
  const double u = flexion_deg / kneecap_knot_deg;
  Vec at = s.at_zero + u * s.slope;
  for (std::size_t k = 0; k < kneecap_knots; ++k) {
    const double d = std::max(u - static_cast<double>(k), 0.0);
    at = at + d * d * d * s.cubic[k];
  }
  return at;
}

}  // namespace

KneecapSpline kneecap_spline(const KneecapTrack& track) {
  constexpr std::size_t n = kneecap_knots;
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
  KneecapSpline s{track[0], track[1] - track[0] - (1.0 / 6) * m[1], {}};
  // The third derivative of piece k is mₖ₊₁ − mₖ; its jumps are the cubics' coefficients.
  Vec before{};
  for (std::size_t k = 0; k < n; ++k) {
    const Vec third = k + 1 < n ? m[k + 1] - m[k] : Vec{};
    s.cubic[k] = (1.0 / 6) * (third - before);
    before = third;
  }
  return s;
}

LegScale<double> leg_scale(double thigh_m, double shank_m) {
  return {thigh_m / published_leg::thigh_m, shank_m / published_leg::shank_m,
          (thigh_m + shank_m) / published_leg::leg_m};
}

LegScale<double> leg_scale(const Body& body) {
  return leg_scale(static_cast<double>(body.thigh_length_m), static_cast<double>(body.shank_length_m));
}

Vec path_point(const PathPoint& p, const LegScale<double>& scale, const LegFrames<double>& leg) {
  const Vec at = scaled(p, scale);
  switch (p.bone) {
    case LegBone::pelvis:
      return leg.hip_m + rotated(leg.pelvis, at);
    case LegBone::thigh:
      return leg.hip_m + rotated(leg.thigh, at);
    case LegBone::shank:
      return leg.knee_m + rotated(leg.shank, at);
    case LegBone::foot:
      break;
  }
  return leg.ankle_m + rotated(leg.foot, at);
}

PathPoint path_end(const MemberMuscle& muscle, double flexion_deg) {
  if (muscle.kneecap == nullptr) return muscle.path.back();
  return {LegBone::shank, kneecap_at(*muscle.kneecap, flexion_deg)};
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
  return 2 * std::atan2(q.w < 0 ? -q.x : q.x, std::abs(q.w));
}

double member_length(const MemberMuscle& muscle, const LegScale<double>& scale, const LegFrames<double>& leg) {
  const double flexion_deg = knee_flexion(leg) / degree;
  const Vec end = path_point(path_end(muscle, flexion_deg), scale, leg);
  Vec at = path_point(muscle.path.front(), scale, leg);
  double sum = 0;
  for (std::size_t i = 1; i < muscle.path.size(); ++i) {
    Vec next = path_point(muscle.path[i], scale, leg);
    if (!bends_always(muscle.path[i])) {
      // The straight line from where the path has come to the next point that always bends it.
      std::size_t j = i + 1;
      while (j < muscle.path.size() && !bends_always(muscle.path[j])) ++j;
      const Vec line = (j < muscle.path.size() ? path_point(muscle.path[j], scale, leg) : end) - at;
      const double t = std::clamp(dot(next - at, line) / std::max(dot(line, line), 1e-12), 0.0, 1.0);
      const Vec straight = at + t * line;
      next = straight + share_of_bend(muscle.path[i], flexion_deg) * (next - straight);
    }
    sum += length(next - at);
    at = next;
  }
  return muscle.kneecap == nullptr ? sum : sum + length(end - at);
}

double member_weight(std::span<const MemberMuscle> members, const MemberMuscle& muscle) {
  double all = 0;
  for (const auto& m : members) all += handsfield_volume_cm3(m, reference_body_height_m, reference_body_mass_kg);
  return handsfield_volume_cm3(muscle, reference_body_height_m, reference_body_mass_kg) / all;
}

double muscle_length(Muscle muscle, const LegScale<double>& scale, const LegFrames<double>& leg) {
  const auto members = members_of(muscle);
  double sum = 0;
  for (const auto& m : members) sum += member_weight(members, m) * member_length(m, scale, leg);
  return sum;
}

}  // namespace mobil
