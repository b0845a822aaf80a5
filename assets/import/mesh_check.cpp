#include "assets/import/mesh_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <mobil/assets/import/mesh_edges.h>
#include <mobil/engine/geometry.h>
#include "assets/import/mend_mesh.h"
#include "assets/import/simplify_surface.h"
#include "assets/import/triangle_cuts.h"
#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

// Bounds. In the worst of the 40 muscles of a real leg made for display, 0.35 % of the triangles cut others and 2.8 %
// are specks. No piece cuts another, volume / area^1.5 is at least 0.011, and twice volume / area at least 1.5 mm. Its
// skin extends 26 mm over the middle plane, bones and muscles do not.
constexpr double max_cut_share = 0.02, max_speck_share = 0.1;
constexpr std::size_t max_cuts_between_pieces = 8;
constexpr double min_fullness = 0.003, min_thickness_m = 0.0003;
constexpr float max_over_middle_m = 0.05F;
/// Maximum share of the surface of one closed hole, and of all of them together.
constexpr double hole_share = 0.01, all_holes_share = 0.03;
/// Share of the volume from which on a piece inside another counts as a copy; smaller ones are accepted.
constexpr double copy_share = 0.1;

double area_of(const SurfaceMesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t + 2 < mesh.triangle.size(); t += 3) {
    const auto at = [&](std::size_t k) { return to_double(mesh.position[mesh.triangle[t + k]]); };
    area += length(cross(at(1) - at(0), at(2) - at(0))) / 2;
  }
  return area;
}

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

Result<void> take_specks_away(SurfaceMesh& mesh, double share, bool fleshy, SurfaceReport& report) {
  const std::size_t before = mesh.triangle.size() / 3;
  const std::size_t specks = remove_specks(mesh, share);
  const std::size_t gone = before - mesh.triangle.size() / 3;
  if (specks > 0) {
    report.said.push_back(
        fmt::format("{} of {} taken away", counted(specks, "speck", "specks"), counted(gone, "triangle", "triangles")));
  }
  const double lost = static_cast<double>(gone) / static_cast<double>(before);
  if (fleshy && lost > max_speck_share) {
    return fail(
        fmt::format("{:.0f} % of its triangles are specks; valid: at most {:.0f} %: take them away in a mesh "
                    "editor, or join the triangles at their vertices",
                    100 * lost, 100 * max_speck_share));
  }
  return {};
}

Result<void> mend_topology(SurfaceMesh& mesh, bool fleshy, SurfaceReport& report) {
  const auto turned = wind_alike(mesh);
  if (!turned) {
    return fail(
        "cannot be wound one way, for the surface has one side only; make it the hull of a body in a mesh editor");
  }
  if (*turned > 0)
    report.said.push_back(
        fmt::format("{} turned, as their neighbours are wound", counted(*turned, "triangle", "triangles")));
  if (const std::size_t pinched = split_pinches(mesh); pinched > 0) {
    report.said.push_back(
        fmt::format("{} split, where two surfaces touch", counted(pinched, "pinched vertex", "pinched vertices")));
  }
  if (!fleshy) return {};
  const ClosedHoles holes = close_holes(mesh, hole_share, all_holes_share);
  if (holes.closed > 0) {
    report.said.push_back(
        fmt::format("{} closed, {:.2g} % of the surface", counted(holes.closed, "hole", "holes"), 100 * holes.share));
  }
  if (holes.left == 0) return {};
  return fail(fmt::format(
      "is open: {} open edges, {} too large to close; valid: closed, or holes of at most {:.0f} % of "
      "the surface each and {:.0f} % in all: close them in a mesh editor",
      count_edges(mesh).border, counted(holes.left, "hole is", "holes are"), 100 * hole_share, 100 * all_holes_share));
}

/// Fails if a piece of a closed surface is inside another as a copy of it.
Result<void> check_nested(const SurfaceMesh& mesh, const Pieces& pieces) {
  const std::vector<double> volume = piece_volumes(mesh, pieces);
  const double largest = *std::max_element(volume.begin(), volume.end());
  for (std::uint32_t p = 0; p < pieces.count; ++p) {
    if (volume[p] < copy_share * largest || times_inside_others(mesh, pieces, p) < 0.5) continue;
    return fail(
        fmt::format("one piece of {:.3g} cm3 lies inside another, so that its volume counts twice; keep one of "
                    "the two, or cut the inner one out in a mesh editor",
                    1e6 * volume[p]));
  }
  return {};
}

Result<void> check_cuts(const SurfaceMesh& mesh, const Pieces& pieces, bool fleshy, SurfaceReport& report) {
  const CutCount cuts = count_cuts(mesh, pieces.of);
  report.self_intersections = cuts.pairs;
  const double share = static_cast<double>(cuts.pairs) / static_cast<double>(mesh.triangle.size() / 3);
  const std::string more = cuts.complete ? "" : "at least ";
  if (cuts.pairs > 0) {
    report.said.push_back(fmt::format("{}{} of triangles cut each other", more, counted(cuts.pairs, "pair", "pairs")));
  }
  if (!fleshy) return {};
  if (cuts.between_pieces > max_cuts_between_pieces) {
    return fail(
        fmt::format("two pieces overlap, {}{} pairs of their triangles cut each other; valid: at most {}: keep "
                    "one of them, or unite them in a mesh editor",
                    more, cuts.between_pieces, max_cuts_between_pieces));
  }
  if (!cuts.complete || share > max_cut_share) {
    return fail(
        fmt::format("cuts itself, {}{} pairs of triangles, {:.3g} % of all; valid: at most {:.0f} %: mend it in "
                    "a mesh editor",
                    more, cuts.pairs, 100 * share, 100 * max_cut_share));
  }
  return {};
}

Result<void> check_fullness(double volume, double area) {
  const double thickness = 2 * volume / area;
  if (volume / std::pow(area, 1.5) >= min_fullness && thickness >= min_thickness_m) return {};
  return fail(
      fmt::format("is flat: {:.3g} cm3 within {:.3g} cm2, {:.2g} mm thick; valid: volume / area^1.5 from {} and "
                  "from {} mm: give it the muscle's thickness in a mesh editor",
                  1e6 * volume, 1e4 * area, 1000 * thickness, min_fullness, 1000 * min_thickness_m));
}

}  // namespace

Result<void> check_edges(SurfaceMesh& mesh, SurfaceReport& report) {
  EdgeCount edges = count_edges(mesh);
  report.open_edges = edges.border;
  report.overused_edges = edges.overused;
  if (edges.overused == 0) return {};
  if (const std::size_t doubled = drop_doubled(mesh); doubled > 0) {
    report.said.push_back(fmt::format("{} taken away", counted(doubled, "doubled triangle", "doubled triangles")));
    edges = count_edges(mesh);
  }
  if (edges.overused == 0) return {};
  return fail(
      fmt::format("{} edges are used by more than two triangles, valid: 0; take the extra faces away or split the "
                  "edges in a mesh editor",
                  edges.overused));
}

Result<void> keep_right_side(SurfaceMesh& mesh, float middle_x, SurfaceReport& report) {
  constexpr float far = std::numeric_limits<float>::infinity();
  const Pieces pieces = label_pieces(mesh);
  std::vector<float> least(pieces.count, far), most(pieces.count, -far);
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const float x = mesh.position[mesh.triangle[t]].x - middle_x;
    least[pieces.of[t / 3]] = std::min(least[pieces.of[t / 3]], x);
    most[pieces.of[t / 3]] = std::max(most[pieces.of[t / 3]], x);
  }
  const auto left = [&](std::uint32_t p) { return least[p] > 0; };
  std::size_t gone = 0;
  float over = 0;
  for (std::uint32_t p = 0; p < pieces.count; ++p) {
    gone += left(p) ? 1 : 0;
    if (!left(p)) over = std::max(over, most[p]);
  }
  if (gone == pieces.count) {
    return fail("lies wholly on the left of the middle plane, its row says right; write left, or mirror the mesh");
  }
  if (over > max_over_middle_m) {
    return fail(
        fmt::format("reaches {:.0f} mm to the left of the middle plane, its row says right; valid: at most {:.0f} "
                    "mm: cut it there, or write mid for what spans both sides",
                    1000 * over, 1000 * max_over_middle_m));
  }
  if (gone == 0) return {};
  report.said.push_back(fmt::format("{} on the left side taken away", counted(gone, "piece", "pieces")));
  keep_pieces(mesh, pieces, [&](std::uint32_t p) { return !left(p); });
  return {};
}

Result<void> mend_and_check(SurfaceMesh& mesh, AnatomyKind kind, double speck_share, SurfaceReport& report) {
  const bool fleshy = is_fleshy(kind);
  if (kind != AnatomyKind::bone) {
    if (auto done = take_specks_away(mesh, speck_share, fleshy, report); !done) return done;
  }
  if (auto done = mend_topology(mesh, fleshy, report); !done) return done;
  const Pieces pieces = label_pieces(mesh);
  const std::size_t open = count_edges(mesh).border;
  report.pieces = pieces.count;
  const double area = area_of(mesh);
  report.area_cm2 = 1e4 * area;
  if (open > 0) {
    report.said.push_back(fmt::format("open: {}", counted(open, "open edge", "open edges")));
  } else if (const std::size_t turned = turn_outwards(mesh, pieces); turned > 0) {
    report.said.push_back(pieces.count == 1 ? std::string("turned, it was inside out")
                                            : fmt::format("{} turned, inside out", counted(turned, "piece", "pieces")));
  }
  const double volume = enclosed_volume(mesh);
  report.volume_cm3 = 1e6 * volume;
  if (fleshy) {
    if (auto done = check_fullness(volume, area); !done) return done;
  }
  if (auto done = check_cuts(mesh, pieces, fleshy, report); !done) return done;
  return fleshy && pieces.count > 1 ? check_nested(mesh, pieces) : Result<void>();
}

}  // namespace mobil::inline v0_3
