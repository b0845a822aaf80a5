#include "assets/surfaces/tube.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr std::size_t channel_count = 8;  // centre, matrix, angle, bow
using Channels = std::array<double, channel_count>;

Channels channels(const TubeStation& s) {
  const double c = std::cos(s.angle), n = std::sin(s.angle);
  return {s.centre.x,
          s.centre.y,
          s.centre.z,
          s.semi_u * c * c + s.semi_v * n * n,
          (s.semi_u - s.semi_v) * c * n,
          s.semi_u * n * n + s.semi_v * c * c,
          s.angle,
          s.bow};
}

/// Returns the slope at the middle of three values (Fritsch and Butland's harmonic mean if `monotone`).
double slope(double before, double after, double h_before, double h_after, bool monotone) {
  if (!monotone) return (before * h_after + after * h_before) / (h_before + h_after);
  if (before * after <= 0) return 0;
  const double w1 = 2 * h_after + h_before, w2 = h_after + 2 * h_before;
  return (w1 + w2) / (w1 / before + w2 / after);
}

struct Frame {
  Vec u, v, normal;
};

void add_ring(SurfaceMesh& mesh, const TubeSection& s, const Frame& f, const Vec& shift, double size, int segments) {
  for (int j = 0; j < segments; ++j) {
    const double a = 2 * std::numbers::pi * j / segments, c = size * std::cos(a), n = size * std::sin(a);
    double p = s.uu * c + s.uv * n, q = s.uv * c + s.vv * n;
    if (s.bow != 0) {
      const double ca = std::cos(s.angle), sa = std::sin(s.angle);
      const double along = (c * ca + n * sa), bent = s.bow * (1 - 2 * along * along);
      p -= sa * bent;
      q += ca * bent;
    }
    mesh.position.push_back(to_float(s.centre + shift + p * f.u + q * f.v));
  }
}

/// Adds triangles between consecutive rings of `segments` vertices, and fans to the poles: vertex 0 and the last one.
void connect(SurfaceMesh& mesh, int rings, int segments) {
  const auto n = static_cast<std::uint32_t>(segments);
  const auto vertex = [&](int ring, int j) {
    return 1 + static_cast<std::uint32_t>(ring) * n + static_cast<std::uint32_t>(j % segments);
  };
  const std::uint32_t last = 1 + static_cast<std::uint32_t>(rings) * n;
  for (int j = 0; j < segments; ++j) {
    mesh.triangle.insert(mesh.triangle.end(), {0U, vertex(0, j + 1), vertex(0, j)});
    for (int r = 0; r + 1 < rings; ++r) {
      const auto a = vertex(r, j), b = vertex(r, j + 1), c = vertex(r + 1, j + 1), d = vertex(r + 1, j);
      mesh.triangle.insert(mesh.triangle.end(), {a, b, c, a, c, d});
    }
    mesh.triangle.insert(mesh.triangle.end(), {vertex(rings - 1, j), vertex(rings - 1, j + 1), last});
  }
}

double smaller_semi_axis(const TubeSection& s) {
  const double mean = 0.5 * (s.uu + s.vv), half = 0.5 * (s.uu - s.vv);
  return mean - std::sqrt(half * half + s.uv * s.uv);
}

}  // namespace

TubeSection tube_section(std::span<const TubeStation> stations, double t) {
  std::vector<double> at(stations.size(), 0.0);
  for (std::size_t i = 1; i < stations.size(); ++i) {
    at[i] = at[i - 1] + length(stations[i].centre - stations[i - 1].centre);
  }
  const double s = std::clamp(t, 0.0, 1.0) * at.back();
  std::size_t i = 0;
  while (i + 2 < stations.size() && s > at[i + 1]) ++i;
  const double h = at[i + 1] - at[i], x = (s - at[i]) / h;

  const Channels here = channels(stations[i]), next = channels(stations[i + 1]);
  const Channels before = i > 0 ? channels(stations[i - 1]) : here;
  const Channels after = i + 2 < stations.size() ? channels(stations[i + 2]) : next;
  Channels value{}, rate{};
  for (std::size_t c = 0; c < channel_count; ++c) {
    const bool monotone = c >= 3;
    const double d = (next[c] - here[c]) / h;
    double from = d, to = d;
    if (i > 0) from = slope((here[c] - before[c]) / (at[i] - at[i - 1]), d, at[i] - at[i - 1], h, monotone);
    if (i + 2 < stations.size())
      to = slope(d, (after[c] - next[c]) / (at[i + 2] - at[i + 1]), h, at[i + 2] - at[i + 1], monotone);
    const double b = 3 * d - 2 * from - to, k = from + to - 2 * d;
    value[c] = here[c] + h * x * (from + x * (b + x * k));
    rate[c] = from + x * (2 * b + 3 * k * x);
  }
  TubeSection section{{value[0], value[1], value[2]},
                      normalised(Vec{rate[0], rate[1], rate[2]}),
                      value[3],
                      value[4],
                      value[5],
                      value[6],
                      value[7]};
  // A blend of entries with different slopes can leave the cone of ellipses, linear interpolation cannot.
  if (section.uu * section.vv <= 1.0001 * section.uv * section.uv || section.uu <= 0) {
    section.uu = here[3] + x * (next[3] - here[3]);
    section.uv = here[4] + x * (next[4] - here[4]);
    section.vv = here[5] + x * (next[5] - here[5]);
  }
  return section;
}

SurfaceMesh loft(std::span<const TubeStation> stations, const TubeShape& shape) {
  const int cap_rings = shape.segments < 12 ? 1 : 2;
  SurfaceMesh mesh;
  std::optional<Vec> fixed;
  if (shape.normal) {
    fixed = normalised(*shape.normal);
    if (dot(*fixed, stations.back().centre - stations.front().centre) < 0) fixed = -1.0 * *fixed;
  }
  const auto frame = [&](const TubeSection& s) {
    Frame f;
    f.normal = fixed ? *fixed : s.tangent;
    f.u = orthogonal(shape.reference, f.normal);
    f.v = cross(f.normal, f.u);
    return f;
  };
  int rings = 0;
  const auto cap = [&](const TubeSection& s, double outward) {
    const Frame f = frame(s);
    const Vec reach = (outward * shape.cap * smaller_semi_axis(s)) * f.normal;
    // a bowed end's pole is at the section's middle
    const Vec middle = s.bow * (std::cos(s.angle) * f.v - std::sin(s.angle) * f.u);
    const Vec pole = s.centre + reach + middle;
    if (outward < 0) mesh.position.push_back(to_float(pole));
    for (int i = 1; i <= cap_rings && shape.cap > 0; ++i, ++rings) {
      const int step = outward < 0 ? i : cap_rings + 1 - i;
      const double a = 0.5 * std::numbers::pi * step / (cap_rings + 1);
      add_ring(mesh, s, f, std::cos(a) * reach, std::sin(a), shape.segments);
    }
    if (outward > 0) mesh.position.push_back(to_float(pole));
  };
  cap(tube_section(stations, 0), -1);
  for (int r = 0; r < shape.rings; ++r, ++rings) {
    const TubeSection s = tube_section(stations, static_cast<double>(r) / (shape.rings - 1));
    add_ring(mesh, s, frame(s), {0, 0, 0}, 1, shape.segments);
  }
  cap(tube_section(stations, 1), 1);
  connect(mesh, rings, shape.segments);
  return mesh;
}

SurfaceMesh ellipsoid(const Vec3<double>& centre, const Vec3<double>& semi, int rings, int segments) {
  SurfaceMesh mesh;
  mesh.position.push_back(to_float(centre - Vec{0, semi.y, 0}));
  for (int r = 1; r <= rings; ++r) {
    const double a = std::numbers::pi * r / (rings + 1);
    for (int j = 0; j < segments; ++j) {
      const double b = 2 * std::numbers::pi * j / segments;
      mesh.position.push_back(to_float(
          centre + Vec{semi.x * std::sin(a) * std::sin(b), -semi.y * std::cos(a), semi.z * std::sin(a) * std::cos(b)}));
    }
  }
  mesh.position.push_back(to_float(centre + Vec{0, semi.y, 0}));
  connect(mesh, rings, segments);
  return mesh;
}

}  // namespace mobil::inline v0_3
