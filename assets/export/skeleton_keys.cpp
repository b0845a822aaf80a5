#include "assets/export/skeleton_keys.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mobil::inline v0_3 {
namespace {

constexpr double still_m = 5e-6, still_rad = 2e-6;

Eigen::Quaterniond widened(const Quat<float>& q) {
  return Eigen::Quaterniond(static_cast<double>(q.w), static_cast<double>(q.x), static_cast<double>(q.y),
                            static_cast<double>(q.z))
      .normalized();
}
Vec3<float> rounded(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}
Quat<float> rounded(const Eigen::Quaterniond& q) {
  return {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()), static_cast<float>(q.w())};
}

/// Turns each quaternion to the side of the one before it, then keeps one if all are the same rotation.
std::vector<Quat<float>> rotation_keys(std::vector<Eigen::Quaterniond> local) {
  if (local.front().w() < 0) local.front().coeffs() *= -1;
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (std::size_t f = 0; f < local.size(); ++f) {
    if (f > 0 && local[f].dot(local[f - 1]) < 0) local[f].coeffs() *= -1;
    sum += local[f].coeffs();
  }
  if (sum.norm() > 0) {
    const Eigen::Quaterniond mean(Eigen::Vector4d(sum.normalized()));
    const bool still =
        std::all_of(local.begin(), local.end(), [&](const auto& q) { return q.angularDistance(mean) < still_rad; });
    if (still) return {rounded(mean)};
  }
  std::vector<Quat<float>> keys;
  keys.reserve(local.size());
  for (const auto& q : local) keys.push_back(rounded(q));
  return keys;
}

std::vector<Vec3<float>> translation_keys(const std::vector<Eigen::Vector3d>& local, const Vec3<float>& rest_m,
                                          double tolerance_m) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& t : local) mean += t;
  mean /= static_cast<double>(local.size());
  const auto stays_at = [&](const Eigen::Vector3d& place) {
    return std::all_of(local.begin(), local.end(), [&](const auto& t) { return (t - place).norm() < tolerance_m; });
  };
  if (stays_at(widened(rest_m))) return {rest_m};
  if (stays_at(mean)) return {rounded(mean)};
  std::vector<Vec3<float>> keys;
  keys.reserve(local.size());
  for (const auto& t : local) keys.push_back(rounded(t));
  return keys;
}

/// Adds the keys of roots, without changing rounded numbers of equal ones.
SegmentKeys root_keys(std::span<const RecordedRoot> root) {
  SegmentKeys keys;
  if (root.empty()) return {{{0, 0, 0}}, {{0, 0, 0, 1}}};
  for (const RecordedRoot& at : root) {
    const RigidTransform place = root_transform(at);
    keys.translation_m.push_back(rounded(place.position_m));
    keys.rotation.push_back(rounded(place.rotation));
  }
  const auto turns_not = [&](const RecordedRoot& at) { return at.heading_rad == root.front().heading_rad; };
  const auto moves_not = [&](const RecordedRoot& at) {
    return at.x_m == root.front().x_m && at.z_m == root.front().z_m;
  };
  if (std::ranges::all_of(root, turns_not)) keys.rotation.resize(1);
  if (std::ranges::all_of(root, moves_not)) keys.translation_m.resize(1);
  return keys;
}

}  // namespace

RigidTransform root_transform(const RecordedRoot& root) {
  const double half = 0.5 * static_cast<double>(root.heading_rad);
  return {{root.x_m, 0, root.z_m}, Eigen::Quaterniond(std::cos(half), 0, std::sin(half), 0)};
}

SkeletonKeys skeleton_keys(const std::vector<Pose<float>>& frames, const StandingPlaces& rest,
                           std::span<const RecordedRoot> root) {
  const std::size_t frame_count = frames.size();
  double farthest_m = 0;
  for (const auto& pose : frames) {
    for (const auto& p : pose.position_m) farthest_m = std::max(farthest_m, widened(p).cwiseAbs().maxCoeff());
  }
  const double tolerance_m = still_m + 4.0 * farthest_m * static_cast<double>(std::numeric_limits<float>::epsilon());

  SkeletonKeys keys;
  keys.segment.resize(segment_count);
  keys.root = root_keys(root);
  keys.world.assign(frame_count, std::vector<RigidTransform>(segment_count));
  std::vector<Eigen::Vector3d> translation(frame_count);
  std::vector<Eigen::Quaterniond> rotation(frame_count);
  for (std::size_t s = 0; s < segment_count; ++s) {
    const bool is_root = segment_parent[s] == static_cast<Segment>(s);
    const auto parent = [&](std::size_t f) {
      if (!is_root) return keys.world[f][index(segment_parent[s])];
      return root_transform(root.empty() ? RecordedRoot{} : root[f]);
    };
    for (std::size_t f = 0; f < frame_count; ++f) {
      const RigidTransform from = parent(f);
      translation[f] = from.rotation.conjugate() * (widened(frames[f].position_m[s]) - from.position_m);
      rotation[f] = (from.rotation.conjugate() * widened(frames[f].rotation[s])).normalized();
    }
    SegmentKeys& segment = keys.segment[s];
    segment.translation_m = translation_keys(translation, rest_offset(rest, s), tolerance_m);
    segment.rotation = rotation_keys(rotation);
    for (std::size_t f = 0; f < frame_count; ++f) {
      const RigidTransform from = parent(f);
      const auto& t = segment.translation_m[std::min(f, segment.translation_m.size() - 1)];
      const auto& r = segment.rotation[std::min(f, segment.rotation.size() - 1)];
      keys.world[f][s] = {from.position_m + from.rotation * widened(t), (from.rotation * widened(r)).normalized()};
    }
  }
  return keys;
}

Vec3<float> rest_offset(const StandingPlaces& rest, std::size_t segment) {
  const std::size_t parent = index(segment_parent[segment]);
  return rounded(parent == segment ? rest[segment] : Eigen::Vector3d(rest[segment] - rest[parent]));
}

bool leaves_rest(const SegmentKeys& keys, const Vec3<float>& rest_offset_m) {
  const Vec3<float>& t = keys.translation_m.front();
  return keys.translation_m.size() > 1 || t.x != rest_offset_m.x || t.y != rest_offset_m.y || t.z != rest_offset_m.z;
}

bool turns(const SegmentKeys& keys) {
  return keys.rotation.size() > 1 ||
         widened(keys.rotation.front()).angularDistance(Eigen::Quaterniond::Identity()) > still_rad;
}

StandingPlaces standing_places(const std::vector<Pose<float>>& frames, std::span<const BoneSurface> surfaces) {
  StandingPlaces place;
  place[0].setZero();
  for (std::size_t s = 1; s < segment_count; ++s) {
    const std::size_t parent = index(segment_parent[s]);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& pose : frames)
      mean +=
          widened(pose.rotation[parent]).conjugate() * (widened(pose.position_m[s]) - widened(pose.position_m[parent]));
    place[s] = place[parent] + mean / static_cast<double>(frames.size());
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (const BoneSurface& surface : surfaces) {
    for (const auto& p : surface.mesh.position) {
      lowest = std::min(lowest, place[index(surface.segment)].y() + static_cast<double>(p.y));
    }
  }
  if (surfaces.empty()) {
    for (const auto& p : place) lowest = std::min(lowest, p.y());
  }
  for (auto& p : place) p.y() -= lowest;
  return place;
}

}  // namespace mobil::inline v0_3
