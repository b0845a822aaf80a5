#include "assets/surfaces/tissue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <mobil/assets/muscles/leg_sections.h>
#include <mobil/engine/geometry.h>
#include <mobil/muscle_table.h>
#include "assets/muscles/muscle_architecture.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr std::size_t tissue_stations = 24;
constexpr double end_station = tissue_stations - 1;

/// A surface summed up at even places of `along`.
struct TissueLine {
  std::array<Vec, tissue_stations> centre{};
  std::array<double, tissue_stations> radius{}, tendon{};  // m, mean distance from the centre; mean share
  double length_m = 0;                                     // over which `along` grows from 0 to 1, on average
};

/// Replaces values of tissue_stations without vertices by their neighbours'.
template <class T>
void fill_gaps(std::array<T, tissue_stations>& value, const std::array<double, tissue_stations>& count) {
  for (std::size_t i = 0; i < tissue_stations; ++i) {
    if (count[i] > 0) continue;
    std::size_t low = i, high = i;
    while (low > 0 && count[low] == 0) --low;
    while (high + 1 < tissue_stations && count[high] == 0) ++high;
    if (count[low] == 0) low = high;
    if (count[high] == 0) high = low;
    const double w = high == low ? 0 : static_cast<double>(i - low) / static_cast<double>(high - low);
    value[i] = (1 - w) * value[low] + w * value[high];
  }
}

std::size_t station_at(double along) {
  return static_cast<std::size_t>(std::lround(end_station * std::clamp(along, 0.0, 1.0)));
}

TissueLine tissue_line(std::span<const Vec3<float>> position, std::span<const TexturePlace> place,
                       std::span<const float> tendon) {
  TissueLine line;
  std::array<double, tissue_stations> count{};
  const auto station = [&](std::size_t v) { return station_at(static_cast<double>(place[v].along)); };
  for (std::size_t v = 0; v < position.size(); ++v) {
    const std::size_t i = station(v);
    count[i] += 1;
    line.centre[i] = line.centre[i] + to_double(position[v]);
    if (!tendon.empty()) line.tendon[i] += static_cast<double>(tendon[v]);
  }
  for (std::size_t i = 0; i < tissue_stations; ++i) {
    const double share = 1 / std::max(count[i], 1.0);
    line.centre[i] = share * line.centre[i];
    line.tendon[i] *= share;
  }
  fill_gaps(line.centre, count);
  for (std::size_t v = 0; v < position.size(); ++v) {
    const std::size_t i = station(v);
    line.radius[i] += length(to_double(position[v]) - line.centre[i]) / count[i];
  }
  fill_gaps(line.radius, count);
  fill_gaps(line.tendon, count);
  if (!tendon.empty()) return line;
  const double thickest = *std::ranges::max_element(line.radius);
  for (std::size_t i = 0; i < tissue_stations; ++i) {
    const double relative = line.radius[i] / std::max(thickest, 1e-9);
    line.tendon[i] = tendon_share(relative * relative);
  }
  return line;
}

template <class T>
T at_station(const std::array<T, tissue_stations>& value, double along) {
  const double at = end_station * along;
  const auto i = std::min(static_cast<std::size_t>(at), tissue_stations - 2);
  const double w = at - static_cast<double>(i);
  return (1 - w) * value[i] + w * value[i + 1];
}

/// Places along the line where the free tendons end; 0 and 1 without them.
struct FreeTendons {
  double from = 0, to = 1;
  bool all = false;  // the surface has no belly
};
FreeTendons free_tendons(const TissueLine& line) {
  constexpr int places = 200;
  const auto is_belly = [&](int i) { return at_station(line.tendon, static_cast<double>(i) / places) < 0.5; };
  int from = 0, to = places;
  while (from <= places && !is_belly(from)) ++from;
  while (to > from && !is_belly(to)) --to;
  return {static_cast<double>(from) / places, static_cast<double>(to) / places, from > places};
}

bool has_parallel_fibres(Muscle muscle) {
  using enum Muscle;
  constexpr std::array parallel = {sartorius,       gracilis, tensor_fasciae_latae, adductor_longus, adductor_brevis,
                                   adductor_magnus, pectineus};
  return std::ranges::find(parallel, muscle) != parallel.end();
}

/// Returns the unit direction from the line to the leg's bone at each station, across the line; shorter where the bone
/// is near.
std::array<Vec, tissue_stations> ways_to_bone(const Body& body, const TissueLine& line) {
  const LegFrame leg = leg_frame(body);
  constexpr double near_m = 0.01;
  std::array<Vec, tissue_stations> ways{};
  for (std::size_t i = 0; i < tissue_stations; ++i) {
    const Vec& at = line.centre[i];
    const Vec bone = leg_point(leg, std::clamp(leg_level(leg, at.y), 0.0, 2.0), 0, 0);
    const Vec along = line.centre[std::min(i + 1, tissue_stations - 1)] - line.centre[i == 0 ? 0 : i - 1];
    Vec way = bone - at;
    if (const double whole = dot(along, along); whole > 0) way = way - (dot(way, along) / whole) * along;
    ways[i] = (1 / std::max(length(way), near_m)) * way;
  }
  return ways;
}

struct PatternSize {
  double length_m = 0, girth_m = 0;  // over which `along` grows by 1 and `around` by 2
};
/// Returns the inverses of the coordinates' mean gradients over the surface.
PatternSize pattern_size(const SurfaceMesh& mesh, std::span<const TexturePlace> place) {
  double area = 0, along = 0, around = 0;
  for (std::size_t t = 0; t + 2 < mesh.triangle.size(); t += 3) {
    const std::uint32_t* vertex_of = &mesh.triangle[t];
    const auto edge = [&](int k) {
      return to_double(mesh.position[vertex_of[k]]) - to_double(mesh.position[vertex_of[0]]);
    };
    const auto grown = [&](int k) {
      const TexturePlace &to = place[vertex_of[k]], &from = place[vertex_of[0]];
      return std::pair{static_cast<double>(to.along - from.along),
                       std::remainder(static_cast<double>(to.around - from.around), 2.0)};
    };
    const Vec p = edge(1), q = edge(2);
    const double twice_area = length(cross(p, q));
    if (twice_area <= 0) continue;
    // twice the area times the gradient of a linear function that grows by a along p and by b along q
    const auto gradient = [&](double a, double b) { return length(a * q - b * p); };
    const auto [p_along, p_around] = grown(1);
    const auto [q_along, q_around] = grown(2);
    area += twice_area;
    along += gradient(p_along, q_along);
    around += gradient(p_around, q_around);
  }
  return {area / std::max(along, 1e-9), 2 * area / std::max(around, 1e-9)};
}

std::uint8_t byte(double share) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

}  // namespace

double tendon_share(double relative_area) {
  return 1 - smoothstep(0.10, 0.32, relative_area);
}

MuscleTissue muscle_tissue(const Body& body, Muscle muscle, const SurfaceMesh& mesh,
                           std::span<const TexturePlace> place, std::span<const float> tendon) {
  MuscleTissue made;
  const std::vector<Vec3<float>>& position = mesh.position;
  if (position.empty()) return made;
  TissueLine line = tissue_line(position, place, tendon);
  const MuscleParameters own = muscle_parameters(body, muscle);
  const PatternSize size = pattern_size(mesh, place);
  line.length_m = size.length_m;
  made.fibres = {static_cast<float>(size.length_m), static_cast<float>(size.girth_m),
                 static_cast<float>(own.pennation_deg * std::numbers::pi / 180)};
  const FreeTendons free = free_tendons(line);
  const double free_m = (free.from + 1 - free.to) * line.length_m;
  const double inside_m =
      free.all || has_parallel_fibres(muscle) ? 0 : std::min(own.tendon_m - free_m, line.length_m - free_m);
  const bool covers_another = !members_of(muscle).front().lies_on.empty();
  const auto ways = ways_to_bone(body, line);
  // An end without a free tendon grows from the bone as flesh.
  const auto tendinous = [](double free_share) { return smoothstep(0.01, 0.05, free_share); };
  const double first = tendinous(free.from), last = tendinous(1 - free.to);
  for (std::size_t v = 0; v < position.size(); ++v) {
    const double along = static_cast<double>(place[v].along);
    double sheet = 0;
    if (inside_m > 0) {
      const Vec out = to_double(position[v]) - at_station(line.centre, along);
      const double to_bone = dot(out, at_station(ways, along)) / std::max(length(out), 1e-9);
      const double insertion_side = covers_another ? to_bone : -to_bone;
      // A tongue: it narrows and thins out from the tendon to its tip.
      const auto covered = [&](double from_tendon, double side) {
        const double way = std::clamp(from_tendon * line.length_m / inside_m, 0.0, 1.0), edge = way - 0.3;
        return smoothstep(edge, edge + 0.8, side) * std::pow(1 - way, 1.5);
      };
      sheet = std::max(first * covered(along - free.from, -insertion_side),
                       last * covered(free.to - along, insertion_side));
    }
    const double sinew = tendon.empty() ? at_station(line.tendon, along) : static_cast<double>(tendon[v]);
    const TexturePlace at = folded(place[v]);
    made.vertex.push_back({byte(along), byte(static_cast<double>(at.around)), byte(sinew), byte(sheet)});
  }
  return made;
}

}  // namespace mobil::inline v0_3
