#pragma once
// Reservations of all walkers, and search for neighbours.

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

/// Returns the rectangle between two points, extended by `more_m` on every side.
inline GroundBox box_of(GroundPoint a, GroundPoint b, float more_m) {
  return {std::min(a.x_m, b.x_m) - more_m, std::max(a.x_m, b.x_m) + more_m, std::min(a.z_m, b.z_m) - more_m,
          std::max(a.z_m, b.z_m) + more_m};
}

/// A wall and its bounding box, by which most walls are skipped.
struct BoxedWall {
  Wall wall;
  GroundBox box;
};

/// A person's place at each instant from `first` on, after which the person stays. Also the direction in which the
/// person faces and the velocity at the end of the step.
struct Reservation {
  /// Stored samples. From each of the first way_samples instants a full row of way_samples remains.
  static constexpr std::size_t kept = 2 * way_samples;
  /// Values from which the reservation was made.
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
  float ground_m, steepness;  // ground under the stance foot: height; steepness, m per m
  bool yields;                // avoids others
  std::array<float, kept> x_m, z_m;

  /// Returns true if an obstacle at these heights is on this person's floor: not below the ground, and not above a
  /// person's head.
  bool meets(const HeightRange& height) const {
    constexpr float head_m = 2;
    return height.high_m > ground_m && height.low_m < ground_m + head_m;
  }
  std::size_t at(std::uint32_t instant) const {
    const std::uint32_t since = instant - first;
    return since < way_samples ? since : way_samples;
  }
};

/// Data of a neighbour that is read first: place at the book's instant, and direction of facing. It has 56 bytes,
/// sorted by place, where a reservation has half a kilobyte.
struct Nearby {
  std::int32_t cell_x, cell_z;
  std::uint32_t reservation, who;  // who: the entity's index
  GroundBox box;
  float x_m, z_m, faces_x, faces_z, ground_m, steepness;
};

/// A walker whose next step begins in the coming tick.
struct Striker {
  Table* table;
  std::uint32_t block, lane, reservation;
};

/// A block of walkers: index of its first reservation number in the book, and lanes that begin a step in the coming
/// tick.
struct BlockOfReservations {
  Table* table;
  std::uint32_t block, first, striking;
};

/// The reservations of all walkers.
class ReservationBook {
 public:
  /// Remakes the reservations of walkers whose step is new or whose source has changed.
  void refresh(World& world, const Jobs& jobs, std::uint32_t tick, float tick_s, float shoulders_h);

  /// Returns the next instant of reservations, which is after the coming tick.
  std::uint32_t instant() const { return instant_; }
  WayInstants instants() const {
    return {static_cast<float>(first_tick_) * tick_s_, static_cast<float>(every_ticks_) * tick_s_};
  }
  /// Returns the walkers who avoid others and are about to begin a step, in the order of their rows.
  const std::vector<Striker>& strikers() const { return strikers_; }
  std::size_t people() const { return seen_.size(); }
  std::size_t reservations() const { return reservations_.size(); }
  /// Returns the greatest half-breadth of all people, shoulders included, m.
  float broadest_m() const { return broadest_m_; }
  const Reservation& reservation(std::uint32_t number) const { return reservations_[number]; }
  /// Return the blocks of all walkers, and the reservation number of a lane in one.
  std::span<const BlockOfReservations> blocks() const { return blocks_; }
  std::uint32_t reservation_in(const BlockOfReservations& at, std::size_t lane) const { return seen_[at.first + lane]; }

  /// Calls `f(const Nearby&)` for all people whose reservations come within `reach_m` of a place, and for some others.
  /// Skips people on other floors than `whose`, for example below a bridge: those who are another_floor_m higher or
  /// lower than either slope leads to. Callable from any thread.
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
    constexpr double max_cells = 4096;  // beyond this, a scan of all people is faster
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

  /// Accepts any number, also NaN, because a snapshot can contain any place.
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

  std::uint32_t instant_ = 0, first_tick_ = 0, every_ticks_ = 1;  // first_tick_: ticks until the instant
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
