#include "systems/avoidance/narrow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <mobil/components/avoidance.h>
#include <mobil/each.h>
#include "engine/exact_math.h"
#include "systems/gait/shoulders.h"

namespace mobil::inline v0_3 {
namespace {

/// Ticks from one evaluation of a person to the next.
constexpr std::uint32_t every_ticks = 8;
/// Instants ahead at which neighbours are sought. A turn takes half a second and is finished by then.
constexpr std::array<std::size_t, 3> looked_at = {0, 2, 4};
/// The depth of shoulders with the arms, as a part of their breadth.
constexpr float depth_part = 0.58F;
/// Costs of a missing metre, of a turn, and of a turn to the other side, because the shoulders are at their broadest on
/// the way there.
constexpr float of_lacking_per_m = 100, of_turning_per_rad = 1, of_the_other_way = 3;

/// Candidate turns, smaller ones first.
struct Turn {
  float rad, sine, cosine;
};
const std::array<Turn, 9>& turns() {
  static const auto all = [] {
    std::array<Turn, 9> made{};
    for (std::size_t i = 0; i < made.size(); ++i) {
      const float size = max_shoulder_turn * static_cast<float>((i + 1) / 2) / static_cast<float>(made.size() / 2);
      const float turn = i % 2 == 1 ? size : 0 - size;
      made[i] = {turn, static_cast<float>(exact::sin(double{turn})), static_cast<float>(exact::cos(double{turn}))};
    }
    return made;
  }();
  return all;
}

/// A person nearby: the direction to them, and the walker's part of the gap.
struct Neighbour {
  float toward_x, toward_z, room_m;
  std::uint32_t who;

  bool operator<(const Neighbour& other) const {
    return room_m != other.room_m ? room_m < other.room_m : who < other.who;
  }
};
/// Returns how far shoulders of that half-breadth, facing (x, z), reach toward a person, m. They are an ellipse.
float reach_of(float shoulders_m, float faces_x, float faces_z, const Neighbour& one) {
  const float ahead = one.toward_x * faces_x + one.toward_z * faces_z;
  const float aside = one.toward_x * faces_z - one.toward_z * faces_x;
  return shoulders_m * std::sqrt(aside * aside + depth_part * depth_part * ahead * ahead);
}
/// Returns true if the person can come nearer than the shoulders are broad, and then turns them.
bool narrows(const Reservation& reservation) {
  return reservation.shoulders_m > reservation.radius_m;
}

class Narrowing {
 public:
  Narrowing(const ReservationBook& book, std::uint32_t me, float turned_rad)
      : mine_(book.reservation(me)), turned_rad_(turned_rad) {
    const std::uint32_t instant = book.instant();
    const std::size_t now = mine_.at(instant), then = now + looked_at.back();
    const GroundBox box = box_of({mine_.x_m[now], mine_.z_m[now]}, {mine_.x_m[then], mine_.z_m[then]}, 0);
    const float both_at_most = mine_.shoulders_m + book.broadest_m();
    const float long_m = std::max(box.high_x_m - box.low_x_m, box.high_z_m - box.low_z_m);
    book.near(0.5F * (box.low_x_m + box.high_x_m), 0.5F * (box.low_z_m + box.high_z_m), mine_,
              both_at_most + 0.5F * long_m, [&](const Nearby& other) {
                if (other.reservation != me && other.box.meets(box, both_at_most))
                  look_at(book.reservation(other.reservation), now, instant);
              });
  }

  float best() const {
    if (count_ == 0) return 0;
    const Turn* best = nullptr;
    float least = 0;
    for (const Turn& turn : turns()) {
      const float costs = cost(turn);
      if (best != nullptr && costs >= least) continue;
      least = costs;
      best = &turn;
    }
    return best->rad;
  }

 private:
  void look_at(const Reservation& reservation, std::size_t now, std::uint32_t instant) {
    const std::size_t then = reservation.at(instant);
    const float both = mine_.shoulders_m + reservation.shoulders_m;
    float nearest2 = both * both, x = 0, z = 0;
    for (const std::size_t ahead : looked_at) {
      const float dx = reservation.x_m[then + ahead] - mine_.x_m[now + ahead];
      const float dz = reservation.z_m[then + ahead] - mine_.z_m[now + ahead], squared = dx * dx + dz * dz;
      if (!(squared < nearest2)) continue;
      nearest2 = squared;
      x = dx;
      z = dz;
    }
    const float nearest = std::sqrt(nearest2);
    if (nearest >= both || nearest <= 0) return;
    // If both turn, each gets a part of the gap; otherwise the one who turns gets the rest.
    const float room = narrows(reservation) ? nearest * mine_.shoulders_m / both : nearest - reservation.shoulders_m;
    const Neighbour one = {x / nearest, z / nearest, room, reservation.who.index};
    if (count_ < near_.size()) {
      near_[count_++] = one;
      return;
    }
    const auto furthest = std::max_element(near_.begin(), near_.end());
    if (one < *furthest) *furthest = one;
  }

  float cost(const Turn& turn) const {
    const float faces_x = mine_.faces_x * turn.cosine + mine_.faces_z * turn.sine;
    const float faces_z = mine_.faces_z * turn.cosine - mine_.faces_x * turn.sine;
    float lacking = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Neighbour& one = near_[i];
      lacking = std::max(lacking, reach_of(mine_.shoulders_m, faces_x, faces_z, one) - one.room_m);
    }
    const bool other_way = turn.rad * turned_rad_ < 0;
    return of_lacking_per_m * lacking + of_turning_per_rad * std::fabs(turn.rad) + (other_way ? of_the_other_way : 0);
  }

  const Reservation& mine_;
  float turned_rad_;
  std::array<Neighbour, 8> near_;
  std::size_t count_ = 0;
};

}  // namespace

void narrow_shoulders(const ReservationBook& book, const Jobs& jobs, std::uint32_t tick) {
  const std::span<const BlockOfReservations> blocks = book.blocks();
  in_parallel(jobs, blocks.size(), [&](std::size_t begin, std::size_t end) {
    for (const BlockOfReservations& at : blocks.subspan(begin, end - begin)) {
      const TableColumn<AvoidanceState> courses(*at.table);
      if (!courses) continue;
      auto& course = courses.at(*at.table, at.block);
      const Entity* const entities = at.table->entities(at.block);
      for (std::size_t l = 0; l < at.table->live(at.block); ++l) {
        if ((entities[l].index + tick) % every_ticks != 0) continue;
        const std::uint32_t me = book.reservation_in(at, l);
        course.turn_to_rad[l] = narrows(book.reservation(me)) ? Narrowing(book, me, course.turn_rad[l]).best() : 0;
      }
    }
  });
}

}  // namespace mobil::inline v0_3
