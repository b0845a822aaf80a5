#include <mobil/systems/surfaces/vertex_rings.h>

#include <algorithm>
#include <string>

namespace mobil::inline v0_3 {
namespace {

constexpr std::uint16_t twice(std::uint16_t place) {
  return static_cast<std::uint16_t>(2 * place);
}

struct Link {
  std::uint32_t from, to;  // of a triangle (vertex, from, to)
};

/// Removes links that join end to end. Returns the polygon around their triangles; an open one contains the vertex.
std::vector<std::uint32_t> take_polygon(std::uint32_t vertex, std::vector<Link>& links) {
  const auto begins = [&](const Link& l) {
    return std::ranges::none_of(links, [&](const Link& other) { return other.to == l.from; });
  };
  auto next = std::ranges::find_if(links, begins);
  if (next == links.end()) next = links.begin();
  std::vector<std::uint32_t> polygon{next->from};
  while (next != links.end()) {
    polygon.push_back(next->to);
    links.erase(next);
    next = std::ranges::find(links, polygon.back(), &Link::from);
  }
  if (polygon.front() == polygon.back()) {
    polygon.pop_back();
  } else {
    polygon.push_back(vertex);
  }
  return polygon;
}

/// Appends a polygon as rings that all begin at its first corner. An incomplete last ring repeats that corner.
void append_rings(const std::vector<std::uint32_t>& polygon, std::span<const std::uint16_t> place,
                  std::vector<VertexRing>& rings) {
  for (std::size_t i = 1; i + 1 < polygon.size(); i += 4) {
    const std::size_t corners = std::min<std::size_t>(6, polygon.size() - i + 1);
    VertexRing ring;
    ring.fill(twice(place[polygon[0]]));  // a: (e − a)×(f − d) is 0 for e = a, and the triangle (a, d, e) for f = a
    for (std::size_t k = 1; k < corners; ++k) ring[k] = twice(place[polygon[i + k - 1]]);
    rings.push_back(ring);
  }
}

}  // namespace

Result<VertexRings> vertex_rings(std::span<const std::uint32_t> triangle, std::span<const std::uint16_t> place) {
  std::vector<std::vector<Link>> links(place.size());
  if (triangle.size() % 3 != 0) return fail("triangles take three indices each");
  for (std::size_t t = 0; t < triangle.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (triangle[t + k] >= place.size())
        return fail("a triangle has vertex " + std::to_string(triangle[t + k]) + " of " + std::to_string(place.size()));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      links[triangle[t + k]].push_back({triangle[t + (k + 1) % 3], triangle[t + (k + 2) % 3]});
    }
  }
  VertexRings all;
  std::vector<VertexRing> rings;
  for (std::uint32_t v = 0; v < place.size(); ++v) {
    rings.clear();
    while (!links[v].empty()) append_rings(take_polygon(v, links[v]), place, rings);
    VertexRing none;
    none.fill(twice(place[v]));
    all.vertex.push_back({twice(place[v]), rings.empty() ? none : rings[0], 0});
    for (std::size_t i = 1; i < rings.size(); ++i) all.more.push_back({v, rings[i]});
  }
  return all;
}

}  // namespace mobil::inline v0_3
