#include "assets/import/mesh_join.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <compare>

#include "assets/import/polygon_cut.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::uint32_t no_vertex = ~0U;
constexpr std::size_t max_corner_comparisons = 400'000'000;  // a second

struct PlacedVertex {
  float x, y, z;
  std::uint32_t index;
  friend auto operator<=>(const PlacedVertex&, const PlacedVertex&) = default;  // NOLINT(modernize-use-nullptr)
};

/// Returns the first equal position of each. Sorted, not hashed, so that no file can make it slow.
std::vector<std::uint32_t> first_equal(const std::vector<Vec3<float>>& position) {
  std::vector<PlacedVertex> sorted(position.size());
  for (std::uint32_t v = 0; v < position.size(); ++v) {
    const auto& p = position[v];
    sorted[v] = {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F, v};  // −0 becomes +0
  }
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a < b; });
  std::vector<std::uint32_t> first(position.size());
  for (std::size_t i = 0, group = 0; i < sorted.size(); ++i) {
    const auto &a = sorted[group], &b = sorted[i];
    if (a.x != b.x || a.y != b.y || a.z != b.z) group = i;
    first[b.index] = sorted[group].index;
  }
  return first;
}

/// Replaces the fans of polygons by their cut.
Result<void> cut_polygons(RawMesh& raw, std::string_view path, std::string_view faces, std::vector<std::string>& said) {
  std::size_t work = max_corner_comparisons, crossed = 0, first_crossed = 0;
  std::vector<std::uint32_t> corner;
  for (const RawPolygon& polygon : raw.polygon) {
    std::uint32_t* const fan = &raw.triangle[3 * polygon.triangle];
    corner.assign(fan, fan + 3);
    for (std::size_t t = 1; t < polygon.triangles; ++t) corner.push_back(fan[3 * t + 2]);
    const PolygonCut cut = cut_polygon(raw.position, corner, fan, work);
    if (cut == PolygonCut::endless) {
      return fail(fmt::format("{}: {} {} is a face of {} corners, too many to cut into triangles; export triangles",
                              path, faces, polygon.place, corner.size()));
    }
    if (cut == PolygonCut::crossed && crossed++ == 0) first_crossed = polygon.place;
  }
  if (crossed > 0) {
    const std::string more = crossed == 1 ? "" : fmt::format(", and {} more do", crossed - 1);
    said.push_back(
        fmt::format("the face of {} {} crosses itself{}; cut from its first corner", faces, first_crossed, more));
  }
  return {};
}

}  // namespace

void add_face(RawMesh& raw, std::span<const std::uint32_t> corner, std::size_t place) {
  if (corner.size() > 3) raw.polygon.push_back({raw.triangle.size() / 3, corner.size() - 2, place});
  for (std::size_t c = 2; c < corner.size(); ++c) {
    raw.triangle.insert(raw.triangle.end(), {corner[0], corner[c - 1], corner[c]});
  }
}

void add_strip(RawMesh& raw, std::span<const std::uint32_t> corner) {
  for (std::size_t c = 2; c < corner.size(); ++c) {
    const std::size_t turned = c % 2;
    raw.triangle.insert(raw.triangle.end(), {corner[c - 2], corner[c - 1 + turned], corner[c - turned]});
  }
}

bool has_room(const RawMesh& raw, std::size_t triangles) {
  return triangles <= max_mesh_triangles && raw.triangle.size() / 3 <= max_mesh_triangles - triangles;
}

Result<MeshFile> join_mesh(RawMesh raw, std::string_view path, std::string_view faces) {
  MeshFile file;
  if (auto done = cut_polygons(raw, path, faces, file.said); !done) return tl::unexpected(done.error());
  file.triangles_in_file = raw.triangle.size() / 3;
  const auto first = first_equal(raw.position);
  std::vector<std::uint32_t> number(raw.position.size(), no_vertex);
  file.mesh.triangle.reserve(raw.triangle.size());
  for (std::size_t t = 0; t + 2 < raw.triangle.size(); t += 3) {
    std::array<std::uint32_t, 3> corner{};
    for (std::size_t c = 0; c < 3; ++c) corner[c] = first[raw.triangle[t + c]];
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    for (const auto vertex : corner) {
      if (number[vertex] == no_vertex) {
        number[vertex] = static_cast<std::uint32_t>(file.mesh.position.size());
        const auto& p = raw.position[vertex];
        file.mesh.position.push_back({p.x + 0.0F, p.y + 0.0F, p.z + 0.0F});
      }
      file.mesh.triangle.push_back(number[vertex]);
    }
  }
  if (file.mesh.triangle.empty()) {
    return fail(fmt::format(
        "{}: no triangle with three different corners; a surface needs at least one: export the mesh again", path));
  }
  return file;
}

tl::unexpected<Error> fault_in_line(std::string_view path, std::size_t line, std::string_view what) {
  return fail(fmt::format("{} line {}: {}", path, line, what));
}

tl::unexpected<Error> too_many_triangles(std::string_view path) {
  return fail(fmt::format("{}: more than {} triangles; valid: at most so many: make the mesh coarser in a mesh editor",
                          path, max_mesh_triangles));
}

}  // namespace mobil::inline v0_3
