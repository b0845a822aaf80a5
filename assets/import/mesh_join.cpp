#include "assets/import/mesh_join.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <compare>

namespace mobil::inline v0_3 {
namespace {

constexpr std::uint32_t no_vertex = ~0U;

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

}  // namespace

Result<MeshFile> join_mesh(const RawMesh& raw, std::string_view path) {
  MeshFile file;
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
