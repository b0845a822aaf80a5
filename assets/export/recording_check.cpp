#include "assets/export/recording_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mobil {
namespace {

bool finite(const Vec3<float>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool all_finite(const std::vector<Vec3<float>>& positions) {
  return std::all_of(positions.begin(), positions.end(), finite);
}

Result<void> check_poses(const WalkRecording& recording) {
  for (std::size_t f = 0; f < recording.frames.size(); ++f) {
    for (std::size_t s = 0; s < segment_count; ++s) {
      const auto& q = recording.frames[f].rotation[s];
      const float length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
      if (!finite(recording.frames[f].position_m[s]) || !std::isfinite(length) || std::fabs(length - 1.0F) > 0.01F) {
        return fail(
            fmt::format("frame {} of the recording: {} has no finite position and unit rotation", f, segment_name[s]));
      }
    }
  }
  return {};
}

Result<void> check_triangles(const std::string& name, Segment segment, const std::vector<std::uint32_t>& triangle,
                             std::size_t vertex_count) {
  if (index(segment) >= segment_count) {
    return fail(fmt::format("surface '{}': segment {} does not exist; there are 0–{}", name, index(segment),
                            segment_count - 1));
  }
  if (triangle.empty() || triangle.size() % 3 != 0) {
    return fail(fmt::format("surface '{}': {} indices; give three for each of its triangles", name, triangle.size()));
  }
  const auto highest = *std::max_element(triangle.begin(), triangle.end());
  if (highest >= vertex_count) {
    return fail(fmt::format("surface '{}': a triangle uses vertex {} of {}", name, highest, vertex_count));
  }
  return {};
}

Result<void> check_muscle(const RecordedMuscle& muscle, std::size_t frame_count) {
  if (muscle.position_m.size() != frame_count) {
    return fail(fmt::format("muscle '{}': {} frames, the recording has {}; record each muscle in every frame",
                            muscle.name, muscle.position_m.size(), frame_count));
  }
  for (const float c : {muscle.colour.x, muscle.colour.y, muscle.colour.z}) {
    if (!(c >= 0.0F && c <= 1.0F)) {
      return fail(fmt::format("muscle '{}': colour {} is outside 0–1", muscle.name, c));
    }
  }
  const std::size_t vertex_count = muscle.position_m.front().size();
  for (std::size_t f = 0; f < frame_count; ++f) {
    if (muscle.position_m[f].size() != vertex_count) {
      return fail(fmt::format("muscle '{}': {} vertices in frame {}, {} in the first; they must not change",
                              muscle.name, muscle.position_m[f].size(), f, vertex_count));
    }
    if (!all_finite(muscle.position_m[f])) {
      return fail(fmt::format("muscle '{}', frame {}: a vertex is not finite", muscle.name, f));
    }
  }
  return check_triangles(muscle.name, muscle.segment, muscle.triangle, vertex_count);
}

}  // namespace

Result<void> check_recording(const WalkRecording& recording) {
  if (recording.frames.empty()) return fail("the recording has no frames; record at least one");
  if (!(recording.frame_s >= 0.001F && recording.frame_s <= 10.0F)) {
    return fail(fmt::format("frames {} s apart cannot be written; the range is 0.001–10 s", recording.frame_s));
  }
  if (auto ok = check_poses(recording); !ok) return ok;
  for (const auto& bone : recording.bones) {
    if (!all_finite(bone.mesh.position)) {
      return fail(fmt::format("bone '{}': a vertex is not finite", bone.mesh.name));
    }
    if (auto ok = check_triangles(bone.mesh.name, bone.segment, bone.mesh.triangle, bone.mesh.position.size()); !ok) {
      return ok;
    }
  }
  for (const auto& muscle : recording.muscles) {
    if (auto ok = check_muscle(muscle, recording.frames.size()); !ok) return ok;
  }
  return {};
}

}  // namespace mobil
