// Drawn muscles have the table's sections; and those cover the outlines of the real muscles from which they were
// measured, if the meshes are available.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/import/anatomy_folder.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/assets/surfaces/muscle_surfaces.h>
#include <mobil/engine/geometry.h>
#include "assets/surfaces/leg_station.h"
#include "assets/surfaces/surface_mesh.h"
#include "tests/files/reference_data.h"

namespace mobil::section_overlap_test {
namespace {

using namespace geometry;

/// A point of a section along the planes' anterior and lateral, and a closed outline as its edges, m.
struct Flat {
  double u, v;
};
using Outline = std::vector<std::pair<Flat, Flat>>;

Outline cut(const SurfaceMesh& mesh, const SectionPlanes& planes, const Vec& origin) {
  Outline edges;
  const auto height = [&](std::uint32_t i) { return dot(to_double(mesh.position[i]) - origin, planes.normal); };
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    std::vector<Flat> ends;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangle[t + k], b = mesh.triangle[t + (k + 1) % 3];
      const double from = height(a), to = height(b);
      if ((from < 0) == (to < 0)) continue;
      const Vec p = to_double(mesh.position[a]), q = to_double(mesh.position[b]),
                at = p + (from / (from - to)) * (q - p) - origin;
      ends.push_back({dot(at, planes.anterior), dot(at, planes.lateral)});
    }
    if (ends.size() == 2) edges.emplace_back(ends[0], ends[1]);
  }
  return edges;
}

bool is_inside(const Outline& outline, const Flat& p) {
  bool inside = false;
  for (const auto& [a, b] : outline) {
    if ((a.v > p.v) == (b.v > p.v)) continue;
    if (p.u < a.u + (p.v - a.v) / (b.v - a.v) * (b.u - a.u)) inside = !inside;
  }
  return inside;
}

/// Area of one outline, and of the common part over the joint one; m² and 1.
struct Overlap {
  double area = 0, share = 0;
};
Overlap overlap(const Outline& one, const Outline& other) {
  Flat low{1e9, 1e9}, high{-1e9, -1e9};
  for (const Outline* outline : {&one, &other}) {
    for (const auto& [a, b] : *outline) {
      low = {std::min({low.u, a.u, b.u}), std::min({low.v, a.v, b.v})};
      high = {std::max({high.u, a.u, b.u}), std::max({high.v, a.v, b.v})};
    }
  }
  constexpr int cells = 70;
  const double du = (high.u - low.u) / cells, dv = (high.v - low.v) / cells;
  int in_one = 0, both = 0, any = 0;
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const Flat p{low.u + (i + 0.5) * du, low.v + (j + 0.5) * dv};
      const bool a = is_inside(one, p), b = is_inside(other, p);
      in_one += a ? 1 : 0, both += a && b ? 1 : 0, any += a || b ? 1 : 0;
    }
  }
  return {in_one * du * dv, any > 0 ? static_cast<double>(both) / any : 0};
}

/// Returns a section's outline as the table has it, its centre at the origin and its size times `size`.
Outline outline_of(const LegSection& s, double unit) {
  const double turn = static_cast<double>(s.angle_deg) * std::numbers::pi / 180;
  constexpr int corners = 48;
  const auto corner = [&](int i) {
    const double phase = 2 * std::numbers::pi * i / corners, xi = std::cos(phase),
                 first = static_cast<double>(s.semi_1) * xi,
                 second =
                     static_cast<double>(s.semi_2) * std::sin(phase) + static_cast<double>(s.bow) * (1 - 2 * xi * xi);
    return Flat{unit * (first * std::cos(turn) - second * std::sin(turn)),
                unit * (first * std::sin(turn) + second * std::cos(turn))};
  };
  Outline edges;
  for (int i = 0; i < corners; ++i) edges.emplace_back(corner(i), corner(i + 1));
  return edges;
}

/// Area and centroid of an outline, whose edges can have any sense.
struct Moments {
  double area = 0;
  Flat centre{0, 0};
};
Moments moments(const Outline& outline) {
  Flat low{1e9, 1e9}, high{-1e9, -1e9};
  for (const auto& [a, b] : outline) {
    low = {std::min({low.u, a.u, b.u}), std::min({low.v, a.v, b.v})};
    high = {std::max({high.u, a.u, b.u}), std::max({high.v, a.v, b.v})};
  }
  constexpr int cells = 70;
  const double du = (high.u - low.u) / cells, dv = (high.v - low.v) / cells;
  Moments of;
  int count = 0;
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const Flat p{low.u + (i + 0.5) * du, low.v + (j + 0.5) * dv};
      if (!is_inside(outline, p)) continue;
      ++count;
      of.centre = {of.centre.u + p.u, of.centre.v + p.v};
    }
  }
  of.area = count * du * dv;
  of.centre = {of.centre.u / std::max(count, 1), of.centre.v / std::max(count, 1)};
  return of;
}

Outline placed(const Outline& outline, const Moments& from, const Moments& to) {
  const double size = std::sqrt(to.area / from.area);
  const auto put = [&](const Flat& p) {
    return Flat{to.centre.u + size * (p.u - from.centre.u), to.centre.v + size * (p.v - from.centre.v)};
  };
  Outline out;
  for (const auto& [a, b] : outline) out.emplace_back(put(a), put(b));
  return out;
}

const MemberMuscle* row_with_sections(Muscle muscle) {
  for (const MemberMuscle& line : members_of(muscle))
    if (!line.sections.empty()) return &line;
  return nullptr;
}

/// Girth and place change with the body, but not the shape of a section. Bones cut into those of the shank.
TEST(SectionOverlap, DrawnMusclesHaveTheTablesSections) {
  const Body body = make_body({1.80F, 80}).value();
  const LegFrame leg = leg_frame(body);
  for (const GroupSurface& drawn : make_muscle_surfaces(body, muscle_members(), MuscleRoom::alone)) {
    if (!muscle_members()[static_cast<std::size_t>(drawn.muscle)]) continue;
    const MemberMuscle& row = *row_with_sections(drawn.muscle);
    const SectionPlanes planes = section_planes(leg, row.across);
    double sum = 0, areas = 0;
    for (const LegSection& s : row.sections) {
      const Vec origin = section_centre(leg, planes, static_cast<double>(s.level), 0, 0);
      const Outline outline = cut(drawn.surface.mesh, planes, origin), own = outline_of(s, leg.unit);
      if (outline.empty()) continue;
      const Overlap found = overlap(outline, placed(own, moments(own), moments(outline)));
      sum += found.area * found.share;
      areas += found.area;
    }
    EXPECT_GT(sum / areas, drawn.surface.origin == Segment::shank_right ? 0.7 : 0.85) << row.name;
  }
}

TEST(SectionOverlap, DrawnMusclesHaveTheirVolumes) {
  const Body body = make_body({1.80F, 80}).value();
  for (const MuscleRoom room : {MuscleRoom::alone, MuscleRoom::together}) {
    for (const GroupSurface& drawn : make_muscle_surfaces(body, muscle_members(), room)) {
      if (!muscle_members()[static_cast<std::size_t>(drawn.muscle)]) continue;
      double wanted = 0;
      for (const MemberMuscle& line : members_of(drawn.muscle)) wanted += member_volume_m3(body, line);
      EXPECT_NEAR(enclosed_volume(drawn.surface.mesh) / wanted, 1, 0.02) << drawn.surface.mesh.name;
    }
  }
}

/// Returns a real mesh with its leg's lines hip–knee–ankle made straight and vertical, the hip at the origin.
SurfaceMesh straightened(SurfaceMesh mesh, const AnatomyLandmarks& at) {
  const Vec hip = to_double(at.hip), knee = to_double(at.knee), ankle = to_double(at.ankle);
  for (auto& p : mesh.position) {
    const Vec here = to_double(p);
    const Vec &from = here.y > knee.y ? hip : knee, &to = here.y > knee.y ? knee : ankle;
    const double t = (from.y - here.y) / (from.y - to.y);
    const Vec line = from + t * (to - from);
    p = to_float(Vec{here.x - line.x, here.y - hip.y, here.z - line.z});
  }
  return mesh;
}

/// Soleus and vasti are curved sheets, which plain ellipses cover by less; two meshes are threads and drawn thicker.
TEST(SectionOverlap, TableCoversTheMeasuredMuscles) {
  const auto folder = test::anatomy_folder();
  if (!folder) GTEST_SKIP() << test::no_anatomy;
  const auto anatomy = load_anatomy(folder->string(), {.muscle_cell_m = 0});
  ASSERT_TRUE(anatomy.has_value()) << anatomy.error().message;
  const AnatomyLandmarks& at = anatomy->landmarks;
  const double thigh = static_cast<double>(at.hip.y - at.knee.y), shank = static_cast<double>(at.knee.y - at.ankle.y);
  const LegFrame leg{{0, 0, 0}, thigh, shank, thigh, 1e-3};
  std::size_t compared = 0;
  double all_sum = 0, all_areas = 0;
  for (const AnatomyPart& part : anatomy->part) {
    if (part.kind != AnatomyKind::muscle || !part.muscle) continue;
    const MemberMuscle& row = *row_with_sections(*part.muscle);
    const SectionPlanes planes = section_planes(leg, row.across);
    std::vector<TubeStation> stations;
    for (const LegSection& s : row.sections) stations.push_back(leg_station(leg, planes, s));
    const SurfaceMesh tube = loft(stations, {.reference = planes.anterior,
                                             .normal = planes.normal,
                                             .rings = 60,
                                             .segments = 32,
                                             .cap = 0.5}),
                      real = straightened(part.mesh, at);
    constexpr int cuts = 24;
    const double first = static_cast<double>(row.sections.front().level),
                 last = static_cast<double>(row.sections.back().level);
    double sum = 0, areas = 0;
    for (int i = 0; i < cuts; ++i) {
      const double level = first + (last - first) * (i + 0.5) / cuts;
      const Vec origin = section_centre(leg, planes, level, 0, 0);
      const Overlap found = overlap(cut(real, planes, origin), cut(tube, planes, origin));
      sum += found.area * found.share;
      areas += found.area;
    }
    ++compared;
    all_sum += sum, all_areas += areas;
    const bool thread = *part.muscle == Muscle::extensor_hallucis_longus || *part.muscle == Muscle::peroneus_tertius;
    EXPECT_GT(sum / areas, thread ? 0.35 : 0.6) << row.name;
  }
  EXPECT_EQ(compared, 38U);
  EXPECT_GT(all_sum / all_areas, 0.78);
}

}  // namespace
}  // namespace mobil::section_overlap_test
