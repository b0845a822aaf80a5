#include <mobil/systems/surfaces/surface_contacts.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <mobil/engine/geometry.h>
#include <mobil/engine/interrupt.h>
#include "assets/surfaces/space_cells.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr float near_m = 0.015F;  // at rest
constexpr int rounds = 3, shifts = 2, sweeps = 2, max_restored = 4, bands_each = 12;

void link_neighbours(const BodySurfaces& surfaces, std::span<const Vec3<float>> position, SurfaceContacts& contacts) {
  std::vector<std::vector<std::uint32_t>> beside(surfaces.vertices);
  for (std::size_t t = 0; t < surfaces.index.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      auto& of = beside[surfaces.index[t + k]];
      for (const std::size_t next : {(k + 1) % 3, (k + 2) % 3}) of.push_back(surfaces.index[t + next]);
    }
  }
  contacts.first_neighbour.push_back(0);
  for (std::size_t v = 0; v < beside.size(); ++v) {
    auto& of = beside[v];
    float longest = 0;
    for (const std::uint32_t other : of) longest = std::max(longest, length(position[other] - position[v]));
    contacts.edge_m.push_back(longest);
    std::ranges::sort(of);
    contacts.neighbour.insert(contacts.neighbour.end(), of.begin(), std::unique(of.begin(), of.end()));
    contacts.first_neighbour.push_back(static_cast<std::uint32_t>(contacts.neighbour.size()));
  }
}

/// Cuts each muscle's length into bands, along the line between its highest and its lowest vertex at rest.
void cut_into_bands(const BodySurfaces& surfaces, std::span<const Vec3<float>> position, SurfaceContacts& contacts) {
  contacts.band.assign(surfaces.vertices, SurfaceContacts::no_band);
  contacts.within.assign(surfaces.vertices, 0);
  for (const SurfacePart& part : surfaces.part) {
    if (!part.driver || part.vertices == 0) continue;
    const auto of = position.subspan(part.first_vertex, part.vertices);
    const auto [low, high] = std::ranges::minmax_element(of, {}, &Vec3<float>::y);
    const Vec3<float> along = *high - *low;
    const float square = std::max(dot(along, along), 1e-12F);
    for (std::uint32_t v = 0; v < part.vertices; ++v) {
      const float t = std::clamp(dot(of[v] - *low, along) / square, 0.0F, 0.9999F);
      const auto band = static_cast<std::uint16_t>(t * bands_each);
      contacts.band[part.first_vertex + v] = static_cast<std::uint16_t>(contacts.bands + band);
      contacts.within[part.first_vertex + v] = t * bands_each - static_cast<float>(band);
    }
    contacts.bands = static_cast<std::uint16_t>(contacts.bands + bands_each);
    contacts.triangle.insert(contacts.triangle.end(), surfaces.index.begin() + part.first_index,
                             surfaces.index.begin() + part.first_index + part.indices);
  }
}

}  // namespace

SurfaceContacts find_contacts(const BodySurfaces& surfaces, std::span<const Vec3<float>> position,
                              std::span<const Vec3<float>> normal) {
  SurfaceContacts contacts;
  link_neighbours(surfaces, position, contacts);
  cut_into_bands(surfaces, position, contacts);
  SpaceCells cells(double{near_m});
  std::vector<std::uint32_t> part_of(surfaces.vertices);
  for (std::uint32_t p = 0; p < surfaces.part.size(); ++p) {
    const SurfacePart& part = surfaces.part[p];
    for (std::uint32_t v = part.first_vertex; v < part.first_vertex + part.vertices; ++v) {
      part_of[v] = p;
      cells.add(v, to_double(position[v]));
    }
  }
  struct Nearest {
    std::uint32_t vertex;
    float square;
  };
  std::map<std::uint32_t, Nearest> nearest;  // by part
  for (std::uint32_t v = 0; v < surfaces.vertices; ++v) {
    check_interrupt();
    const SurfacePart& own = surfaces.part[part_of[v]];
    if (!own.driver) continue;
    nearest.clear();
    cells.near(to_double(position[v]), 0, 1, [&](std::uint32_t other) {
      const SurfacePart& theirs = surfaces.part[part_of[other]];
      if (part_of[other] == part_of[v] || (theirs.driver == own.driver)) return;
      const Vec3<float> off = position[v] - position[other];
      const float square = dot(off, off);
      if (square > near_m * near_m) return;
      const auto [at, is_new] = nearest.try_emplace(part_of[other], Nearest{other, square});
      if (!is_new && square < at->second.square) at->second = {other, square};
    });
    for (const auto& [part, one] : nearest) {
      const float out = dot(normal[one.vertex], position[v] - position[one.vertex]);
      contacts.pair.push_back({v, one.vertex, std::min(out, 0.0F)});
    }
  }
  return contacts;
}

namespace {

/// Contact of a vertex.
constexpr std::uint8_t touches_muscle = 1, touches_bone = 2;

class Apart {
 public:
  Apart(const SurfaceContacts& contacts, std::span<Vec3<float>> position, std::span<Vec3<float>> normal,
        ContactWork& work)
      : contacts_(contacts), position_(position), normal_(normal), work_(work) {
    work_.touches.assign(position.size(), 0);
    work_.taken.assign(contacts.bands, 0);
    work_.other.clear();
    for (const ContactPair& pair : contacts.pair) work_.other.push_back(pair.other);
    find_areas();
    find_volumes(work_.volume);
    work_.moved_out.assign(work_.volume.size(), 0);
  }

  /// Moves sections of a belly aside as a whole by their mean push, less towards the belly's ends.
  void shift() {
    find_pushes();
    auto& shift = work_.shift;
    shift.assign(contacts_.bands, {0, 0, 0});
    work_.pushed_area.assign(contacts_.bands, 0);
    for (std::size_t v = 0; v < position_.size(); ++v) {
      const Vec3<float>& by = work_.push[v];
      if (by.x == 0 && by.y == 0 && by.z == 0) continue;
      shift[contacts_.band[v]] = shift[contacts_.band[v]] + work_.area[v] * by;
      work_.pushed_area[contacts_.band[v]] += work_.area[v];
    }
    for (std::size_t b = 0; b < contacts_.bands; ++b) {
      const float part = (static_cast<float>(b % bands_each) + 0.5F) / bands_each, free = 4 * part * (1 - part);
      shift[b] = free / std::max(work_.pushed_area[b], 1e-9F) * shift[b];
    }
    for (std::size_t v = 0; v < position_.size(); ++v)
      if (contacts_.band[v] != SurfaceContacts::no_band) position_[v] = position_[v] + shift_of(v);
  }

  void sweep() {
    find_pushes();
    smooth();
    for (std::size_t v = 0; v < position_.size(); ++v) {
      const Vec3<float>& by = work_.push[v];
      if (contacts_.band[v] == SurfaceContacts::no_band || (by.x == 0 && by.y == 0 && by.z == 0)) continue;
      work_.taken[contacts_.band[v]] += work_.area[v] * dot(normal_[v], by);
      position_[v] = position_[v] + by;
    }
  }

  /// Returns to each section the volume that was taken from it, outwards, where it touches no bone: neighbours make
  /// room in the next round. In the `last` round only vertices without contact move.
  void give_back(bool last) {
    constexpr float max_m = 0.004F;
    const auto takes = [&](std::size_t v) {
      return contacts_.band[v] != SurfaceContacts::no_band && work_.touches[v] < (last ? touches_muscle : touches_bone);
    };
    work_.free_area.assign(contacts_.bands, 0);
    for (std::size_t v = 0; v < position_.size(); ++v)
      if (takes(v)) work_.free_area[contacts_.band[v]] += work_.area[v];
    for (std::size_t v = 0; v < position_.size(); ++v) {
      if (!takes(v)) continue;
      const std::uint16_t band = contacts_.band[v];
      const float out = std::clamp(-work_.taken[band] / std::max(work_.free_area[band], 1e-9F), -max_m, max_m);
      position_[v] = position_[v] + out * normal_[v];
    }
    for (std::size_t b = 0; b < contacts_.bands; ++b) {
      const float room = max_m * work_.free_area[b];
      work_.taken[b] -= std::clamp(work_.taken[b], -room, room);
    }
  }

  /// Distributes the remaining error of each muscle's volume over vertices that touch less than `min_touch`, evenly
  /// except on tendons. Returns true if a muscle was off by more than a thousandth and had room.
  bool restore_volumes(std::uint8_t min_touch) {
    constexpr float max_m = 0.008F;  // over all rounds
    find_volumes(work_.now_volume);
    const std::size_t muscles = work_.volume.size();
    const auto lacking = [&](std::size_t m) {
      const double volume = work_.volume[m] - work_.now_volume[m];
      return std::abs(volume) > 1e-3 * std::abs(work_.volume[m]) ? static_cast<float>(volume) : 0.0F;
    };
    bool off = false;
    for (std::size_t m = 0; m < muscles; ++m) off = off || lacking(m) != 0;
    if (!off) return false;
    find_pushes();  // present contacts
    find_areas();
    find_weights(min_touch);
    work_.free_area.assign(muscles, 0);
    for (std::size_t v = 0; v < position_.size(); ++v)
      if (const std::uint16_t band = contacts_.band[v]; band != SurfaceContacts::no_band)
        work_.free_area[band / bands_each] += work_.weight[v] * work_.area[v];
    work_.out.assign(muscles, 0);
    bool moves = false;
    for (std::size_t m = 0; m < muscles; ++m) {
      if (!(work_.free_area[m] > 0)) continue;
      work_.out[m] =
          std::clamp(lacking(m) / work_.free_area[m], -max_m - work_.moved_out[m], max_m - work_.moved_out[m]);
      work_.moved_out[m] += work_.out[m];
      moves = moves || work_.out[m] != 0;
    }
    if (!moves) return false;
    for (std::size_t v = 0; v < position_.size(); ++v)
      if (const std::uint16_t band = contacts_.band[v]; band != SurfaceContacts::no_band)
        position_[v] = position_[v] + work_.weight[v] * work_.out[band / bands_each] * normal_[v];
    return true;
  }

  void make_normals() {
    const auto is_muscle = [&](std::size_t v) { return contacts_.band[v] != SurfaceContacts::no_band; };
    for (std::size_t v = 0; v < position_.size(); ++v)
      if (is_muscle(v)) normal_[v] = {0, 0, 0};
    each_triangle([&](const std::uint32_t* corner, const Vec3<float>& twice) {
      for (std::size_t k = 0; k < 3; ++k) normal_[corner[k]] = normal_[corner[k]] + twice;
    });
    for (std::size_t v = 0; v < position_.size(); ++v) {
      if (!is_muscle(v)) continue;
      const float square = dot(normal_[v], normal_[v]);
      normal_[v] = square > 0 ? 1 / std::sqrt(square) * normal_[v] : Vec3<float>{0, 1, 0};
    }
  }

 private:
  /// Calls `f(corners, twice the area along the normal)` for each triangle.
  template <class F>
  void each_triangle(const F& f) const {
    for (std::size_t t = 0; t < contacts_.triangle.size(); t += 3) {
      const std::uint32_t* const corner = &contacts_.triangle[t];
      const Vec3<float>& a = position_[corner[0]];
      f(corner, cross(position_[corner[1]] - a, position_[corner[2]] - a));
    }
  }
  void find_areas() {
    work_.area.assign(position_.size(), 0);
    each_triangle([&](const std::uint32_t* corner, const Vec3<float>& twice) {
      const float third = std::sqrt(dot(twice, twice)) / 6;
      for (std::size_t k = 0; k < 3; ++k) work_.area[corner[k]] += third;
    });
  }
  /// Finds the volume of each muscle's closed surface, about its own first corner.
  void find_volumes(std::vector<double>& volume) const {
    volume.assign(contacts_.bands / bands_each, 0);
    std::size_t muscle = volume.size();
    Vec origin{};
    for (std::size_t t = 0; t < contacts_.triangle.size(); t += 3) {
      const std::uint32_t* const corner = &contacts_.triangle[t];
      const auto at = [&](std::size_t k) { return to_double(position_[corner[k]]); };
      if (const std::size_t own = contacts_.band[corner[0]] / bands_each; own != muscle) {
        muscle = own;
        origin = at(0);
      }
      volume[muscle] += dot(at(0) - origin, cross(at(1) - origin, at(2) - origin)) / 6;
    }
  }
  /// Finds weights: 1 on a belly where it is widest and touches less, smaller next to contacts, little on tendons.
  void find_weights(std::uint8_t min_touch) {
    work_.wide.assign(contacts_.bands, 0);
    for (std::size_t v = 0; v < position_.size(); ++v)
      if (contacts_.band[v] != SurfaceContacts::no_band) work_.wide[contacts_.band[v]] += work_.area[v];
    for (std::size_t first = 0; first < contacts_.bands; first += bands_each) {
      const auto own = std::span(work_.wide).subspan(first, bands_each);
      const float widest = std::max(*std::ranges::max_element(own), 1e-12F);
      for (float& wide : own) wide = (wide / widest) * (wide / widest);
    }
    const auto is_free = [&](std::size_t v) {
      return contacts_.band[v] != SurfaceContacts::no_band && work_.touches[v] < min_touch;
    };
    work_.weight.assign(position_.size(), 0);
    for (std::uint32_t v = 0; v < position_.size(); ++v) {
      const std::uint32_t first = contacts_.first_neighbour[v], last = contacts_.first_neighbour[v + 1];
      if (!is_free(v) || first == last) continue;
      std::uint32_t free = 0;
      for (std::uint32_t i = first; i < last; ++i) free += is_free(contacts_.neighbour[i]) ? 1 : 0;
      work_.weight[v] = work_.wide[contacts_.band[v]] * static_cast<float>(free) / static_cast<float>(last - first);
    }
  }
  void find_pushes() {
    work_.push.assign(position_.size(), {0, 0, 0});
    for (std::size_t p = 0; p < contacts_.pair.size(); ++p) {
      work_.other[p] = nearest(contacts_.pair[p].vertex, work_.other[p]);
      push(contacts_.pair[p], work_.other[p]);
    }
  }
  /// Returns a vertex' shift, interpolated between the middles of its band and of the next one.
  Vec3<float> shift_of(std::size_t v) const {
    const std::size_t band = contacts_.band[v], first = band - band % bands_each, last = first + bands_each - 1;
    const float from_middle = contacts_.within[v] - 0.5F;
    const std::size_t next = from_middle < 0 ? std::max(band, first + 1) - 1 : std::min(band + 1, last);
    const float part = std::abs(from_middle);
    return (1 - part) * work_.shift[band] + part * work_.shift[next];
  }

  /// Walks along the other surface's edges from the nearest vertex at rest or of the last pass to the present one.
  std::uint32_t nearest(std::uint32_t vertex, std::uint32_t other) const {
    constexpr int max_steps = 12;
    const Vec3<float>& at = position_[vertex];
    const auto square = [&](std::uint32_t v) {
      const Vec3<float> off = at - position_[v];
      return dot(off, off);
    };
    std::uint32_t best = other;
    float least = square(best);
    for (int step = 0; step < max_steps; ++step) {
      const std::uint32_t from = best;
      for (std::uint32_t i = contacts_.first_neighbour[from]; i < contacts_.first_neighbour[from + 1]; ++i) {
        const std::uint32_t next = contacts_.neighbour[i];
        if (const float s = square(next); s < least) {
          least = s;
          best = next;
        }
      }
      if (best == from) break;
    }
    return best;
  }

  void push(const ContactPair& pair, std::uint32_t other) {
    constexpr float near_by_m = 0.004F, deepest_m = 0.045F;
    const Vec3<float> off = position_[pair.vertex] - position_[other], &out = normal_[other];
    const float gap = dot(off, out), beside = dot(off, off) - gap * gap, depth = pair.rest_m - gap;
    const float max_beside = contacts_.edge_m[other];  // farther away the vertex is past the other's edge
    if (beside > max_beside * max_beside || gap < -deepest_m) return;
    const bool bone = contacts_.band[other] == SurfaceContacts::no_band;
    if (depth > -near_by_m) {
      for (const std::uint32_t v : {pair.vertex, other})
        work_.touches[v] = std::max(work_.touches[v], bone ? touches_bone : touches_muscle);
    }
    if (depth <= 0) return;
    raise(pair.vertex, (bone ? depth : 0.5F * depth) * out);
    if (!bone) raise(other, -0.5F * depth * out);
  }
  /// Keeps the larger of a vertex' push and another push.
  void raise(std::uint32_t v, const Vec3<float>& by) {
    Vec3<float>& now = work_.push[v];
    if (dot(by, by) > dot(now, now)) now = by;
  }

  /// Smooths pushes, so that single vertices make no dents: neighbours move by half.
  void smooth() {
    constexpr int passes = 2;
    work_.smooth.resize(position_.size());
    for (int pass = 0; pass < passes; ++pass) {
      for (std::uint32_t v = 0; v < position_.size(); ++v) {
        const std::uint32_t first = contacts_.first_neighbour[v], last = contacts_.first_neighbour[v + 1];
        if (contacts_.band[v] == SurfaceContacts::no_band || first == last) {
          work_.smooth[v] = {0, 0, 0};
          continue;
        }
        Vec3<float> sum{0, 0, 0};
        for (std::uint32_t i = first; i < last; ++i) sum = sum + work_.push[contacts_.neighbour[i]];
        work_.smooth[v] = 0.6F * work_.push[v] + 0.4F / static_cast<float>(last - first) * sum;
      }
      std::swap(work_.push, work_.smooth);
    }
  }

  const SurfaceContacts& contacts_;
  std::span<Vec3<float>> position_, normal_;
  ContactWork& work_;
};

}  // namespace

void keep_apart(const SurfaceContacts& contacts, std::span<Vec3<float>> position, std::span<Vec3<float>> normal,
                ContactWork& work) {
  Apart apart(contacts, position, normal, work);
  for (int round = 0; round < rounds; ++round) {
    check_interrupt();
    for (int i = 0; i < shifts; ++i) apart.shift();
    for (int i = 0; i < sweeps; ++i) apart.sweep();
    apart.give_back(round + 1 == rounds);
    apart.make_normals();
    if (round + 1 < rounds && apart.restore_volumes(touches_bone)) apart.make_normals();
  }
  for (int i = 0; i < max_restored && apart.restore_volumes(touches_muscle); ++i) apart.make_normals();
}

}  // namespace mobil::inline v0_3
