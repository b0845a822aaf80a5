#include "assets/import/mesh_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr float reach_limit_m = 1.5F, smallest_extent_m = 0.002F;
// A real leg's muscles (14 + 26) are 67 to 581 mm long, and its bones are 8 to 440 mm long.
constexpr float smallest_muscle_m = 0.03F, largest_part_m = 1.0F;
// The boxes of that leg's muscles come within 33 mm of the lines from hip to knee to ankle, that of its kneecap within
// 29 mm, and those of its muscles touch their bones'.
constexpr float line_limit_m = 0.06F, bone_limit_m = 0.05F;
// Reach of pelvis and foot beyond hip and ankle, for which there are only these landmarks.
constexpr float pelvis_reach_m = 0.15F, foot_reach_m = 0.25F;

float component_gap(float least, float most, float other_least, float other_most) {
  return std::max({0.0F, other_least - most, least - other_most});
}

float gap(const MeshBox& a, const MeshBox& b) {
  return std::hypot(component_gap(a.least.x, a.most.x, b.least.x, b.most.x),
                    component_gap(a.least.y, a.most.y, b.least.y, b.most.y),
                    component_gap(a.least.z, a.most.z, b.least.z, b.most.z));
}

/// Returns the place along the leg, from the hip down.
int place_of(Segment segment) {
  if (segment < Segment::thigh_right) return 0;  // psoas comes from a vertebra
  switch (segment) {
    case Segment::thigh_right:
      return 1;
    case Segment::patella_right:
    case Segment::shank_right:
      return 2;
    default:
      return 3;
  }
}

float gap_to_line(const MeshBox& box, const Vec3<float>& from, const Vec3<float>& to) {
  constexpr int steps = 16;
  float least = std::numeric_limits<float>::infinity();
  for (int i = 0; i <= steps; ++i) {
    const Vec3<float> p = from + (static_cast<float>(i) / steps) * (to - from);
    least = std::min(least, gap(box, {p, p}));
  }
  return least;
}

/// Returns the distance to the nearest of the lines between joints, from the part's origin to its insertion.
float gap_to_leg(const MeshBox& box, bool fleshy, int first, int last, const AnatomyLandmarks& at) {
  float least = std::numeric_limits<float>::infinity();
  if (fleshy) {  // muscles of only pelvis or foot also come near thigh and shank
    const bool passes_line = first <= 2 && last >= 1;
    first = passes_line ? std::max(first, 1) : 1;
    last = passes_line ? std::min(last, 2) : 2;
  }
  for (int place = first; place <= last; ++place) {
    if (place == 0) least = std::min(least, gap(box, {at.hip, at.hip}) - pelvis_reach_m);
    if (place == 1) least = std::min(least, gap_to_line(box, at.hip, at.knee));
    if (place == 2) least = std::min(least, gap_to_line(box, at.knee, at.ankle));
    if (place == 3) least = std::min(least, gap(box, {at.ankle, at.ankle}) - foot_reach_m);
  }
  return std::max(0.0F, least);
}

}  // namespace

MeshBox box_of(const SurfaceMesh& mesh) {
  MeshBox box{mesh.position.front(), mesh.position.front()};
  for (const auto& p : mesh.position) {
    box.least = {std::min(box.least.x, p.x), std::min(box.least.y, p.y), std::min(box.least.z, p.z)};
    box.most = {std::max(box.most.x, p.x), std::max(box.most.y, p.y), std::max(box.most.z, p.z)};
  }
  return box;
}

MeshBox to_mobil(const MeshBox& box, const MeshFrame& frame) {
  const auto point = [&](const Vec3<float>& p) {
    return to_mobil(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z), frame);
  };
  const Vec3<float> a = point(box.least), b = point(box.most);
  return {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
          {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
}

std::optional<std::string> misplaced(const MeshBox& box, const AnatomyPart& part, const AnatomyLandmarks& landmarks,
                                     const std::vector<PlacedBone>& bones) {
  const Vec3<float> size = box.most - box.least;
  const float extent = std::max({size.x, size.y, size.z});
  const bool fleshy = is_fleshy(part.kind);
  const float smallest = fleshy ? smallest_muscle_m : smallest_extent_m;
  const float largest = part.kind == AnatomyKind::skin ? 2 * reach_limit_m : largest_part_m;
  const auto &h = landmarks.hip, &l = box.least, &m = box.most;
  const float reach =
      std::hypot(std::max(h.x - l.x, m.x - h.x), std::max(h.y - l.y, m.y - h.y), std::max(h.z - l.z, m.z - h.z));
  if (!(reach <= reach_limit_m) || !(extent >= smallest && extent <= largest)) {
    return fmt::format("reaches {:.4g} m from the hip and is {:.4g} m large; valid: at most {} m, and {} to {} m",
                       reach, extent, reach_limit_m, smallest, largest);
  }
  if (part.kind == AnatomyKind::skin) return std::nullopt;
  const auto [first, last] = std::minmax({place_of(part.origin), place_of(part.insertion)});
  const float off = gap_to_leg(box, fleshy, first, last, landmarks);
  if (off > line_limit_m) {
    return fmt::format("lies {:.0f} mm off the line between the joints of its segments; valid: at most {:.0f} mm",
                       1000 * off, 1000 * line_limit_m);
  }
  float nearest = std::numeric_limits<float>::infinity();
  std::array<bool, 4> there{};
  for (const PlacedBone& bone : bones) {
    const int place = place_of(bone.segment);
    there[static_cast<std::size_t>(place)] = true;
    if (place >= first && place <= last) nearest = std::min(nearest, gap(box, bone.box));
  }
  if (fleshy && nearest > bone_limit_m &&
      std::find(&there[0] + first, &there[0] + last + 1, false) == &there[0] + last + 1) {
    return fmt::format("lies {:.0f} mm away from the bones of its segments; valid: at most {:.0f} mm", 1000 * nearest,
                       1000 * bone_limit_m);
  }
  return std::nullopt;
}

std::string frames_that_fit(const MeshBox& raw, const AnatomyPart& part, const AnatomyLandmarks& landmarks,
                            const std::vector<PlacedBone>& bones) {
  std::string fitting;
  for (const auto& [unit, metres] : mesh_units) {
    for (const bool y_up : {false, true}) {
      const MeshFrame frame{metres, y_up};
      if (misplaced(to_mobil(raw, frame), part, landmarks, bones)) continue;
      fitting += fmt::format("{}{}", fitting.empty() ? "" : ", or ", frame_name(frame));
    }
  }
  if (fitting.empty()) return ": write the mesh in the units and frame of landmarks.csv";
  return fmt::format(": in other units or axes it would fit, write into its row: {}", fitting);
}

}  // namespace mobil::inline v0_3
