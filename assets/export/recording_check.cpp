#include "assets/export/recording_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace mobil::inline v0_3 {
namespace {

constexpr std::size_t max_cloths = 256;

bool finite(const Vec3<float>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool all_finite(std::span<const Vec3<float>> positions) {
  return std::all_of(positions.begin(), positions.end(), finite);
}

Result<void> check_poses(const std::string& name, const std::vector<Pose<float>>& frames) {
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (std::size_t s = 0; s < segment_count; ++s) {
      const auto& q = frames[f].rotation[s];
      const float length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
      if (!finite(frames[f].position_m[s]) || !std::isfinite(length) || std::fabs(length - 1.0F) > 0.01F) {
        return fail(
            fmt::format("frame {} of {}: {} has no finite position and unit rotation", f, name, segment_name[s]));
      }
    }
  }
  return {};
}

Result<void> check_colour(const std::string& whose, const Vec3<float>& colour) {
  for (const float c : {colour.x, colour.y, colour.z}) {
    if (!(c >= 0.0F && c <= 1.0F)) return fail(fmt::format("{}: colour {} is outside 0–1", whose, c));
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
  if (auto ok = check_colour(fmt::format("muscle '{}'", muscle.name), muscle.colour); !ok) return ok;
  const std::size_t vertex_count = muscle.position_m.front().size();
  if (!muscle.tissue.empty() && muscle.tissue.size() != vertex_count) {
    return fail(fmt::format("muscle '{}': tissue of {} vertices, and {} vertices; give one for each, or none",
                            muscle.name, muscle.tissue.size(), vertex_count));
  }
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

Result<void> check_drawn(const SkinnedSurface& surface, std::size_t frames) {
  if (surface.drawn_m.empty()) return {};
  if (surface.drawn_m.size() != frames)
    return fail(fmt::format("skin '{}': {} frames of drawn places; give {} of a walk, and none of a crowd",
                            surface.name, surface.drawn_m.size(), frames));
  for (std::size_t f = 0; f < frames; ++f) {
    if (surface.drawn_m[f].size() != surface.position.size() || !all_finite(surface.drawn_m[f]))
      return fail(fmt::format("skin '{}': frame {} has not a finite drawn place for each of {} vertices", surface.name,
                              f, surface.position.size()));
  }
  return {};
}

Result<void> check_skin(const SkinnedSurface& surface) {
  const std::size_t vertices = surface.position.size();
  if (!all_finite(surface.position) || !all_finite(surface.normal))
    return fail(fmt::format("skin '{}': a vertex or a normal is not finite", surface.name));
  const auto is_unit = [](const Vec3<float>& n) { return std::fabs(n.x * n.x + n.y * n.y + n.z * n.z - 1) < 1e-3F; };
  if (!std::ranges::all_of(surface.normal, is_unit))
    return fail(fmt::format("skin '{}': a normal has not length 1", surface.name));
  if (surface.normal.size() != vertices || surface.joint.size() != vertices || surface.weight.size() != vertices) {
    return fail(fmt::format("skin '{}': {} vertices, {} normals, {} joints, {} weights; give each vertex all of them",
                            surface.name, vertices, surface.normal.size(), surface.joint.size(),
                            surface.weight.size()));
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    float sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      sum += surface.weight[v][k];
      if (surface.joint[v][k] < segment_count && surface.weight[v][k] >= 0) continue;
      return fail(fmt::format("skin '{}': vertex {} follows segment {} by {}", surface.name, v, surface.joint[v][k],
                              surface.weight[v][k]));
    }
    if (!(std::fabs(sum - 1) < 1e-3F))
      return fail(fmt::format("skin '{}': the weights of vertex {} add up to {}", surface.name, v, sum));
  }
  if (surface.texture.size() != surface.tangent.size() ||
      (!surface.texture.empty() && surface.texture.size() != vertices))
    return fail(fmt::format("skin '{}': {} vertices, {} texture places, {} tangents; give each vertex both, or none",
                            surface.name, vertices, surface.texture.size(), surface.tangent.size()));
  for (std::size_t v = 0; v < surface.texture.size(); ++v) {
    const auto& [right, down] = surface.texture[v];
    const auto& [x, y, z, up] = surface.tangent[v];
    constexpr float rounding = 1e-3F;
    if (!(right >= 0 && right <= 1 && down >= 0 && down <= 1))
      return fail(fmt::format("skin '{}': vertex {} lies at ({}, {}) of its texture; the range is 0–1", surface.name, v,
                              right, down));
    if (!(std::fabs(x * x + y * y + z * z - 1) < rounding && std::fabs(up) == 1))
      return fail(
          fmt::format("skin '{}': the tangent of vertex {} is ({}, {}, {}), {}; it must have length 1 and end in "
                      "1 or -1",
                      surface.name, v, x, y, z, up));
  }
  if (surface.cloth >= max_cloths) {
    return fail(fmt::format("skin '{}': cloth {}; the range is 0–{}", surface.name, surface.cloth, max_cloths - 1));
  }
  return check_triangles(surface.name, Segment::pelvis, surface.triangle, vertices);
}

Result<void> check_figure(const SeenFigure& figure, std::size_t frames) {
  if (!figure.cloth.empty() && figure.cloth.size() != figure.surfaces.size()) {
    return fail(fmt::format("a figure has {} surfaces and {} cloths; give each surface one, or none at all",
                            figure.surfaces.size(), figure.cloth.size()));
  }
  for (std::size_t i = 0; i < figure.surfaces.size(); ++i) {
    const auto& [segment, mesh] = figure.surfaces[i];
    if (!all_finite(mesh.position)) return fail(fmt::format("bone '{}': a vertex is not finite", mesh.name));
    if (auto ok = check_triangles(mesh.name, segment, mesh.triangle, mesh.position.size()); !ok) return ok;
    if (figure.cloth_of(i) >= max_cloths) {
      return fail(fmt::format("bone '{}': cloth {}; the range is 0–{}", mesh.name, figure.cloth[i], max_cloths - 1));
    }
  }
  if (!all_finite(figure.standing_m) || (!figure.skin.empty() && !figure.has_standing()))
    return fail("a figure is drawn about segments at places that are not finite, or not given (standing_m)");
  for (const SkinnedSurface& surface : figure.skin) {
    if (auto ok = check_skin(surface); !ok) return ok;
    if (auto ok = check_drawn(surface, frames); !ok) return ok;
    if (surface.drawn_m.empty() != figure.skin.front().drawn_m.empty())
      return fail(
          fmt::format("skin '{}': drawn places of some of a figure's surfaces; give all or none", surface.name));
  }
  return {};
}

Result<void> check_person(const RecordedPeople& recorded, const SeenPerson& person) {
  const auto& frames = *person.frames;
  if (frames.empty()) return fail(fmt::format("the recording of {} has no frames; record at least one", person.name));
  const std::size_t expected = recorded.people.front().frames->size();
  if (frames.size() != expected) {
    return fail(fmt::format("{} has {} frames, {} has {}; record all over the same time", person.name, frames.size(),
                            recorded.people.front().name, expected));
  }
  if (!person.root.empty() && person.root.size() != frames.size())
    return fail(fmt::format("{} has {} frames and {} roots; give each frame one, or none", person.name, frames.size(),
                            person.root.size()));
  for (const RecordedRoot& root : person.root) {
    if (!std::isfinite(root.x_m) || !std::isfinite(root.z_m) || !std::isfinite(root.heading_rad))
      return fail(fmt::format("{}: a root is not finite", person.name));
  }
  if (person.figure >= recorded.figures.size()) {
    return fail(fmt::format("{} looks like figure {} of {}", person.name, person.figure, recorded.figures.size()));
  }
  for (const float s : {person.scale.x, person.scale.y, person.scale.z}) {
    if (!(s >= 0.01F && s <= 100.0F)) {
      return fail(fmt::format("{}: surfaces scaled by {}; the range is 0.01–100", person.name, s));
    }
  }
  for (const auto& colour : person.colours) {
    if (auto ok = check_colour(person.name, colour); !ok) return ok;
  }
  if (auto ok = check_poses(person.name, frames); !ok) return ok;
  for (const auto& muscle : person.muscles) {
    if (auto ok = check_muscle(muscle, frames.size()); !ok) return ok;
  }
  return {};
}

}  // namespace

Result<void> check_recording(const RecordedPeople& recorded) {
  if (recorded.people.empty()) return fail("the recording has nobody in it; record at least one person");
  if (!(recorded.frame_s >= 0.001 && recorded.frame_s <= 10)) {
    return fail(fmt::format("frames {} s apart cannot be written; the range is 0.001–10 s", recorded.frame_s));
  }
  std::set<std::string> names;
  for (const SeenPerson& person : recorded.people) {
    if (!names.insert(person.name).second) {
      return fail(fmt::format("two people are called '{}'; give each a name of their own", person.name));
    }
    if (auto ok = check_person(recorded, person); !ok) return ok;
  }
  for (const SeenFigure& figure : recorded.figures) {
    if (auto ok = check_figure(figure, recorded.is_walk ? recorded.people.front().frames->size() : 0); !ok) return ok;
  }
  return {};
}

}  // namespace mobil::inline v0_3
