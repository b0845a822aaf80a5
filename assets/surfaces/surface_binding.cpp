#include <mobil/assets/surfaces/surface_binding.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

double plane_height(const HexahedralMesh& lattice, std::uint32_t k) {
  const std::uint32_t n = plane_nodes(lattice.cells);
  double sum = 0;
  for (std::uint32_t i = 0; i < n; ++i) sum += lattice.node[k * n + i].z;
  return sum / n;
}

struct Position {
  std::uint32_t element;
  std::array<double, 3> local;  // 0–1 in the element
};

/// Returns the element of the parameters (each 0 to the number of cells), and their place in it.
Position split(const Cells& cells, const std::array<double, 3>& parameter) {
  std::array<std::uint32_t, 3> cell{};
  Position p{};
  for (std::size_t d = 0; d < 3; ++d) {
    cell[d] = std::min(static_cast<std::uint32_t>(parameter[d]), cells[d] - 1);
    p.local[d] = parameter[d] - cell[d];
  }
  p.element = (cell[2] * cells[1] + cell[1]) * cells[0] + cell[0];
  return p;
}

/// Corner order of element_nodes: round the lower face, then round the upper.
constexpr std::array<std::array<int, 3>, 8> corner = {
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

std::array<double, 8> weights(const std::array<double, 3>& t) {
  std::array<double, 8> w{};
  for (std::size_t c = 0; c < 8; ++c) {
    w[c] = 1;
    for (std::size_t d = 0; d < 3; ++d) w[c] *= corner[c][d] == 1 ? t[d] : 1 - t[d];
  }
  return w;
}

/// Returns the map at a position and its three derivatives with respect to the parameters.
std::array<Vec, 4> map(const HexahedralMesh& lattice, const Position& p) {
  const Hexahedron nodes = element_nodes(lattice.cells, p.element);
  const auto w = weights(p.local);
  std::array<Vec, 4> r{};
  for (std::size_t c = 0; c < 8; ++c) {
    const Vec& node = lattice.node[nodes[c]];
    r[0] = r[0] + w[c] * node;
    for (std::size_t d = 0; d < 3; ++d) {
      double slope = corner[c][d] == 1 ? 1 : -1;
      for (std::size_t e = 0; e < 3; ++e) {
        if (e != d) slope *= corner[c][e] == 1 ? p.local[e] : 1 - p.local[e];
      }
      r[d + 1] = r[d + 1] + slope * node;
    }
  }
  return r;
}

/// Finds points in one lattice, with precomputed heights of its planes.
struct LatticeSearch {
  const HexahedralMesh& lattice;
  std::vector<double> height;

  explicit LatticeSearch(const HexahedralMesh& mesh) : lattice(mesh) {
    for (std::uint32_t k = 0; k <= mesh.cells[2]; ++k) height.push_back(plane_height(mesh, k));
  }
  LatticePlace place(const Vec& point) const;
};

LatticePlace LatticeSearch::place(const Vec& point) const {
  const Cells& cells = lattice.cells;
  std::array<double, 3> parameter = {0.5 * cells[0], 0.5 * cells[1], 0};
  for (std::uint32_t k = 0; k < cells[2]; ++k) {
    const double low = height[k], high = height[k + 1];
    if (point.z > low) parameter[2] = k + std::min(1.0, (point.z - low) / (high - low));
  }
  double stride = 1;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const auto r = map(lattice, split(cells, parameter));
    const Vec off = point - r[0];
    const double det = dot(r[1], cross(r[2], r[3]));
    if (std::abs(det) < 1e-30) break;
    const std::array<double, 3> step = {dot(off, cross(r[2], r[3])) / det, dot(r[1], cross(off, r[3])) / det,
                                        dot(r[1], cross(r[2], off)) / det};
    double moved = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      // at most one cell at a time, because the neighbour has another map
      const double next = std::clamp(parameter[d] + stride * std::clamp(step[d], -1.0, 1.0), 0.0, 1.0 * cells[d]);
      moved = std::max(moved, std::abs(next - parameter[d]));
      parameter[d] = next;
    }
    if (moved < 1e-12) break;
    if (iteration > 20) stride = 0.5;  // breaks a cycle between two cells
  }
  const Position p = split(cells, parameter);
  return {element_nodes(cells, p.element), weights(p.local)};
}

/// Returns half the thickness of a surface between two heights: the largest distance of its points from the middle of
/// their slice.
double radius(const std::vector<Vec>& place, double from, double to) {
  constexpr int slices = 8;
  struct Slice {
    double x = 0, y = 0, count = 0;
  };
  std::array<Slice, slices> all{};
  const auto slice = [&](const Vec& p) -> Slice* {
    const double at = slices * (p.z - from) / (to - from);
    return at < 0 || at >= slices ? nullptr : &all[static_cast<std::size_t>(at)];
  };
  for (const Vec& p : place) {
    if (Slice* s = slice(p)) s->x += p.x, s->y += p.y, ++s->count;
  }
  double farthest = 0;
  for (const Vec& p : place) {
    if (const Slice* s = slice(p))
      farthest = std::max(farthest, std::hypot(p.x - s->x / s->count, p.y - s->y / s->count));
  }
  return farthest;
}

Vec in_frame(const RestFrame& frame, const Vec3<float>& position) {
  return rotated(conjugate(to_double(frame.rotation)), to_double(position) - to_double(frame.start_m));
}

/// Replaces a part of a vertex' shares by those that its bones hold.
void hold(const MuscleSurface& surface, std::size_t v, VertexBinding& b) {
  const auto share = [&](const std::vector<float>& held) { return v < held.size() ? held[v] : 0.0F; };
  b.origin_held = share(surface.origin_held);
  b.insertion_held = share(surface.insertion_held);
  const float rest = 1 - b.origin_held - b.insertion_held;
  if (rest == 1) return;
  (b.origin_held > 0 ? b.origin : b.insertion) += b.lattice;
  b.lattice = 0;
  b.origin *= rest;
  b.insertion *= rest;
}

}  // namespace

LatticePlace place_in_lattice(const HexahedralMesh& lattice, const Vec3<double>& point) {
  return LatticeSearch(lattice).place(point);
}

void bind_surface(MuscleSurface& surface, const HexahedralMesh& lattice, const RestFrame& frame,
                  const Passages& passages) {
  const LatticeSearch search(lattice);
  surface.binding.clear();
  surface.rest_in_lattice.clear();
  surface.rest_rotation = frame.rotation;
  surface.origin_turn = surface.insertion_turn = 0;
  for (const auto& position : surface.mesh.position) {
    const Vec q = in_frame(frame, position);
    const LatticePlace place = search.place(q);
    VertexBinding b{};
    for (std::size_t c = 0; c < 8; ++c) {
      b.node[c] = static_cast<std::uint16_t>(place.node[c]);
      b.node_weight[c] = static_cast<float>(place.weight[c]);
    }
    b.origin = static_cast<float>(1 - smoothstep(passages.origin_to, passages.origin_from, q.z));
    b.insertion = static_cast<float>(smoothstep(passages.insertion_from, passages.insertion_to, q.z));
    b.lattice = 1 - b.origin - b.insertion;
    hold(surface, surface.binding.size(), b);
    surface.binding.push_back(b);
    surface.rest_in_lattice.push_back(to_float(q));
  }
}

void bind_surface(MuscleSurface& surface, const HexahedralMesh& lattice, const RestFrame& frame, double blend_m) {
  const double low = plane_height(lattice, 0), high = plane_height(lattice, lattice.cells[2]);
  bind_surface(surface, lattice, frame, Passages{low - blend_m, low, high, high + blend_m});
}

Passages bind_muscle(MuscleSurface& surface, const HexahedralMesh& lattice, const RestFrame& frame,
                     const Attachments& attachments, double min_m) {
  constexpr double attached = 0.95, lengths_of_thickness = 4.5;
  constexpr float origin_turn = 0.8F, insertion_turn = 0.4F;
  const double low = plane_height(lattice, 0), high = plane_height(lattice, lattice.cells[2]);
  std::vector<Vec> place;
  double first = in_frame(frame, attachments.origin_m).z, last = in_frame(frame, attachments.insertion_m).z;
  for (const auto& position : surface.mesh.position) {
    place.push_back(in_frame(frame, position));
    first = std::min(first, place.back().z);
    last = std::max(last, place.back().z);
  }
  const auto least = [&](double from, double to) {
    return std::max(min_m, lengths_of_thickness * radius(place, from, to));
  };
  Passages p{};
  p.origin_to = low - attached * std::max(0.0, low - first);
  p.origin_from = std::max(low, p.origin_to + least(p.origin_to - min_m, p.origin_to + min_m));
  p.insertion_to = high + attached * std::max(0.0, last - high);
  p.insertion_from = std::min(high, p.insertion_to - least(p.insertion_to - min_m, p.insertion_to + min_m));
  if (p.origin_from > p.insertion_from) p.origin_from = p.insertion_from = 0.5 * (p.origin_from + p.insertion_from);
  bind_surface(surface, lattice, frame, p);
  surface.origin_m = attachments.origin_m;
  surface.insertion_m = attachments.insertion_m;
  surface.origin_turn = origin_turn;
  surface.insertion_turn = insertion_turn;
  return p;
}

void bind_beyond(MuscleSurface& beyond, const MuscleSurface& surface, const HexahedralMesh& lattice,
                 const RestFrame& frame, const Passages& passages, const Attachments& ligament) {
  bind_surface(beyond, lattice, frame, passages);
  beyond.origin = surface.insertion;
  beyond.origin_m = surface.insertion_m;
  beyond.origin_turn = surface.insertion_turn;
  beyond.insertion_m = ligament.insertion_m;
  const Vec from = to_double(ligament.origin_m), along = to_double(ligament.insertion_m) - from;
  for (std::size_t v = 0; v < beyond.binding.size(); ++v) {
    VertexBinding& b = beyond.binding[v];
    const float past = 1 - b.lattice;
    const double t = dot(to_double(beyond.mesh.position[v]) - from, along) / dot(along, along);
    b.insertion = past * static_cast<float>(smoothstep(0, 1, t));
    b.origin = past - b.insertion;
  }
}

void bind_ligament(MuscleSurface& surface, const Vec3<float>& origin_m, const Vec3<float>& insertion_m) {
  const Vec from = to_double(origin_m), along = to_double(insertion_m) - from;
  surface.binding.clear();
  surface.rest_in_lattice.assign(surface.mesh.position.size(), {0, 0, 0});
  surface.origin_turn = surface.insertion_turn = 0;
  for (const auto& position : surface.mesh.position) {
    const double t = dot(to_double(position) - from, along) / dot(along, along);
    VertexBinding b{};
    b.node_weight[0] = 1;
    b.insertion = static_cast<float>(smoothstep(0, 1, t));
    b.origin = 1 - b.insertion;
    surface.binding.push_back(b);
  }
}

}  // namespace mobil::inline v0_3
