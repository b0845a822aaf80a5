#pragma once
// Everybody's reservation, and who is near whom.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/engine/entity.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>
#include "engine/row_hash.h"
#include "systems/avoidance/ways.h"

namespace mobil::inline v0_3 {

/// A rectangle of the ground, m.
struct GroundBox {
  float low_x_m, high_x_m, low_z_m, high_z_m;

  bool meets(const GroundBox& other, float within_m) const {
    return low_x_m <= other.high_x_m + within_m && other.low_x_m <= high_x_m + within_m &&
           low_z_m <= other.high_z_m + within_m && other.low_z_m <= high_z_m + within_m;
  }
};

/// The rectangle between two points, and so much more on every side.
inline GroundBox box_of(GroundPoint a, GroundPoint b, float more_m) {
  return {std::min(a.x_m, b.x_m) - more_m, std::max(a.x_m, b.x_m) + more_m, std::min(a.z_m, b.z_m) - more_m,
          std::max(a.z_m, b.z_m) + more_m};
}

/// A wall and what is round it, by which most are passed over.
struct BoxedWall {
  Wall wall;
  GroundBox box;
};

/// Where somebody is at the instants from `first` on, and then stays; which way they face and how fast they go as their
/// step ends.
struct Reservation {
  /// Of reservations that were made up to that many instants ago a whole row of way_samples is still there.
  static constexpr std::size_t kept = 2 * way_samples;
  /// What it was made from.
  struct Source {
    std::uint32_t generation, steps;
    float line_x_m, line_z_m, heading_rad, duration_s, speed_m_s, bend_next_per_m;
    bool operator==(const Source&) const = default;
  };

  Entity who;
  std::uint32_t first;
  Source source;
  GroundBox box;
  float faces_x, faces_z, x_m_s, z_m_s, radius_m, shoulders_m;
  float ground_m, steepness;  // height of the ground under the stance foot; how steep it is there, m per m
  bool yields;                // avoids others too
  std::array<float, kept> x_m, z_m;

  std::size_t at(std::uint32_t instant) const {
    const std::uint32_t since = instant - first;
    return since < way_samples ? since : way_samples;
  }
};

/// What is looked at first of who is near: of a reservation, where they are at the book's instant and which way they
/// face. Fifty-six bytes, in the order of the ground, where a reservation has half a kilobyte.
struct Nearby {
  std::int32_t cell_x, cell_z;
  std::uint32_t reservation, who;  // who: the entity's index
  GroundBox box;
  float x_m, z_m, faces_x, faces_z, ground_m, steepness;
};

/// A walker whose next step begins in the tick to come.
struct Striker {
  Table* table;
  std::uint32_t block, lane, reservation;
};

/// A block of walkers: where their reservations' numbers begin in the book; lanes that begin a step in the tick to
/// come.
struct BlockOfReservations {
  Table* table;
  std::uint32_t block, first, striking;
};

/// The reservations of all walkers.
class ReservationBook {
 public:
  /// Goes over all walkers: makes reservations anew where steps have begun since or anything else has changed.
  void refresh(World& world, const Jobs& jobs, std::uint32_t tick, float tick_s, float shoulders_h);

  /// The next instant of reservations, all after the tick to come.
  std::uint32_t instant() const { return instant_; }
  WayInstants instants() const {
    return {static_cast<float>(first_tick_) * tick_s_, static_cast<float>(every_ticks_) * tick_s_};
  }
  /// Those who avoid others and are about to begin a step, in the order of their rows.
  const std::vector<Striker>& strikers() const { return strikers_; }
  std::size_t people() const { return seen_.size(); }
  std::size_t reservations() const { return reservations_.size(); }
  /// The greatest half breadth of anybody, shoulders counted, m.
  float broadest_m() const { return broadest_m_; }
  const Reservation& reservation(std::uint32_t number) const { return reservations_[number]; }
  /// All walkers' blocks; the reservation of somebody in one.
  std::span<const BlockOfReservations> blocks() const { return blocks_; }
  std::uint32_t reservation_in(const BlockOfReservations& at, std::size_t lane) const { return seen_[at.first + lane]; }

  /// `f(const Nearby&)` for all whose reservations come within `reach_m` of a place, and some more, but for those on
  /// other floors than `whose`: on a bridge, below it. On another floor is who is another_floor_m higher or lower than
  /// the slope of either leads to. From any thread.
  template <class F>
  void near(float x_m, float z_m, const Reservation& whose, float reach_m, const F& of_all) const {
    if (seen_.empty()) return;
    const std::size_t now = whose.at(instant_);
    const auto f = [&](const Nearby& one) {
      const float apart_m = std::fabs(one.ground_m - whose.ground_m);
      if (apart_m > another_floor_m) {
        const float away_m = std::hypot(one.x_m - whose.x_m[now], one.z_m - whose.z_m[now]);
        if (apart_m > another_floor_m + 1.25F * std::max(one.steepness, whose.steepness) * away_m) return;
      }
      of_all(one);
    };
    const float reach = reach_m + longest_m_;
    const std::int32_t low_x = cell(x_m - reach), high_x = cell(x_m + reach);
    const std::int32_t low_z = cell(z_m - reach), high_z = cell(z_m + reach);
    constexpr double max_cells = 4096;  // more of them take longer than everybody one after the other
    const double wide = 1.0 + high_x - low_x, deep = 1.0 + high_z - low_z;
    if (wide * deep > max_cells) {
      for (const Nearby& one : sorted_) f(one);
      return;
    }
    for (std::int32_t x = low_x; x <= high_x; ++x) {
      for (std::int32_t z = low_z; z <= high_z; ++z) {
        const std::size_t b = bucket(x, z);
        for (std::uint32_t i = starts_[b]; i < starts_[b + 1]; ++i)
          if (sorted_[i].cell_x == x && sorted_[i].cell_z == z) f(sorted_[i]);
      }
    }
  }

 private:
  static constexpr float cell_m = 1.5F, another_floor_m = 1.5F;
  static constexpr std::uint32_t none = 0xFFFFFFFFU;

  /// Of any number, also of NaN: a snapshot may have put anybody anywhere.
  static std::int32_t cell(float m) {
    constexpr float most = 1e8F;
    return static_cast<std::int32_t>(std::floor(std::fmin(std::fmax(m * (1 / cell_m), -most), most)));
  }
  std::size_t bucket(std::int32_t x, std::int32_t z) const {
    const std::uint64_t both = std::uint64_t{static_cast<std::uint32_t>(x)} << 32U | static_cast<std::uint32_t>(z);
    return mix64(both) & (buckets_ - 1);
  }
  void list(World& world);
  void remake(BlockOfReservations& at, float shoulders_h);
  void sort();

  std::uint32_t instant_ = 0, first_tick_ = 0, every_ticks_ = 1;  // first_tick_: how many ahead the instant is
  float tick_s_ = 0;
  std::vector<Reservation> reservations_;
  std::vector<std::uint32_t> reservation_of_;  // by entity index
  std::vector<std::uint32_t> seen_;            // reservations of all rows, block by block
  std::vector<BlockOfReservations> blocks_;
  std::vector<Striker> strikers_;
  float longest_m_ = 0;  // half of the longest side of any box
  float broadest_m_ = 0;
  std::size_t buckets_ = 1;
  std::vector<std::uint32_t> starts_;
  std::vector<Nearby> sorted_, unsorted_;
};

}  // namespace mobil::inline v0_3
