#include "systems/avoidance/reservations.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <mobil/components/avoidance.h>
#include <mobil/components/footing.h>
#include <mobil/each.h>
#include <mobil/engine/access.h>
#include "systems/gait/gait.h"

namespace mobil::inline v0_3 {
namespace {

/// Continues the way of a person who avoids no others in the direction of the step under way.
void go_on(const WayInstants& at, Reservation& reservation) {
  const float x = reservation.x_m[0], z = reservation.z_m[0];
  for (std::size_t s = 1; s < way_samples; ++s) {
    reservation.x_m[s] = x + static_cast<float>(s) * at.every_s * reservation.x_m_s;
    reservation.z_m[s] = z + static_cast<float>(s) * at.every_s * reservation.z_m_s;
  }
}

/// Returns the steepness between footholds, or of the ground under the stance foot. Stairs have the first, slopes both.
float steepness_of(const Footing<Lanes<float>>& footing, std::size_t lane) {
  constexpr std::size_t stance = index(FootholdOf::stance), landing = index(FootholdOf::landing);
  constexpr float shortest_m = 0.2F;
  const float way_m = std::max(std::hypot(footing.landing_x_m[lane] - footing.stance_x_m[lane],
                                          footing.landing_z_m[lane] - footing.stance_z_m[lane]),
                               shortest_m);
  const float along = std::fabs(footing.height_m[landing][lane] - footing.height_m[stance][lane]) / way_m;
  return std::max(along, std::hypot(footing.rise_x[stance][lane], footing.rise_z[stance][lane]));
}

void finish(Reservation& reservation) {
  std::fill(reservation.x_m.begin() + way_samples, reservation.x_m.end(), reservation.x_m[way_samples - 1]);
  std::fill(reservation.z_m.begin() + way_samples, reservation.z_m.end(), reservation.z_m[way_samples - 1]);
  const auto [low_x, high_x] = std::minmax_element(reservation.x_m.begin(), reservation.x_m.begin() + way_samples);
  const auto [low_z, high_z] = std::minmax_element(reservation.z_m.begin(), reservation.z_m.begin() + way_samples);
  reservation.box = {*low_x, *high_x, *low_z, *high_z};
}

}  // namespace

void ReservationBook::refresh(World& world, const Jobs& jobs, std::uint32_t tick, float tick_s, float shoulders_h) {
  every_ticks_ = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(std::lround(0.1F / tick_s)));
  instant_ = (tick + every_ticks_) / every_ticks_;  // the first after the coming tick
  first_tick_ = instant_ * every_ticks_ - tick;
  tick_s_ = tick_s;
  list(world);
  in_parallel(jobs, blocks_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) remake(blocks_[b], shoulders_h);
  });
  strikers_.clear();
  for (const BlockOfReservations& at : blocks_) {
    for (std::uint32_t lanes = at.striking; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      strikers_.push_back({at.table, at.block, lane, seen_[at.first + lane]});
    }
  }
  sort();
}

/// Lists the rows of all walkers, each with its own reservation.
void ReservationBook::list(World& world) {
  if (reservations_.size() > 2 * seen_.size() + 4096) {  // most belong to removed people
    reservations_.clear();
    std::ranges::fill(reservation_of_, none);
  }
  blocks_.clear();
  seen_.clear();
  for (Table& table : world.tables()) {
    if (!TableColumn<GaitState>(table) || !TableColumn<StepPlan>(table) || !TableColumn<BodySize>(table)) continue;
    for (std::size_t b = 0; b < table.block_count(); ++b) {
      blocks_.push_back({&table, static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(seen_.size()), 0});
      const Entity* const entities = table.entities(b);
      for (std::size_t lane = 0; lane < table.live(b); ++lane) {
        const Entity who = entities[lane];
        if (who.index >= reservation_of_.size()) reservation_of_.resize(std::max<std::size_t>(who.index + 1, 64), none);
        std::uint32_t& number = reservation_of_[who.index];
        if (number == none) {
          reservations_.push_back({});
          number = static_cast<std::uint32_t>(reservations_.size() - 1);
        }
        seen_.push_back(number);
      }
    }
  }
}

void ReservationBook::remake(BlockOfReservations& at, float shoulders_h) {
  Table& table = *at.table;
  const auto& size = TableColumn<BodySize>(table).at(table, at.block);
  const auto& plan = TableColumn<StepPlan>(table).at(table, at.block);
  const auto& state = TableColumn<GaitState>(table).at(table, at.block);
  const TableColumn<AvoidanceState> courses(table);
  const TableColumn<Footing> ground(table);
  const ClockUnits units = clock_units(tick_s_);
  const Entity* const entities = table.entities(at.block);
  std::uint32_t changed = 0;
  at.striking = 0;
  for (std::uint32_t l = 0; l < table.live(at.block); ++l) {
    const Reservation::Source source = {entities[l].generation, state.steps[l],          state.line_x_m[l],
                                        state.line_z_m[l],      state.heading_rad[l],    plan.duration_s[l],
                                        plan.to.speed_m_s[l],   state.bend_next_per_m[l]};
    Reservation& reservation = reservations_[seen_[at.first + l]];
    reservation.shoulders_m = courses ? courses.at(table, at.block).shoulders_m[l] : shoulders_h * size.shoulders_scale_m[l];
    reservation.radius_m = courses ? courses.at(table, at.block).radius_m[l] : reservation.shoulders_m;
    reservation.yields = static_cast<bool>(courses);
    reservation.ground_m = ground ? ground.at(table, at.block).height_m[index(FootholdOf::stance)][l] : 0;
    reservation.steepness = ground ? steepness_of(ground.at(table, at.block), l) : 0;
    if (courses && units.of(state.time_s[l]) + units.per_tick >= units.step(plan.duration_s[l])) at.striking |= 1U << l;
    // The reservation of a person who avoids no others leads straight ahead from its first instant. It is remade at
    // each instant, so that it follows from the world and not from the time of reading.
    const bool lasts = courses || reservation.first == instant_;
    if (reservation.source == source && reservation.who == entities[l] && lasts) continue;
    reservation.source = source;
    reservation.who = entities[l];
    reservation.first = instant_;
    changed |= 1U << l;
  }
  if (changed == 0) return;
  WaySamples<Lanes<float>> ways;
  reservation_ways(size, plan, state, first_tick_, every_ticks_, tick_s_, ways);
  Lanes<float> heading, faces_x, faces_z;
  for (std::size_t l = 0; l < lane_count; ++l) heading[l] = state.heading_rad[l] + state.turn_rad[l];
  directions(heading, faces_x, faces_z);
  for (; changed != 0; changed &= changed - 1) {
    const auto l = static_cast<std::uint32_t>(std::countr_zero(changed));
    Reservation& reservation = reservations_[seen_[at.first + l]];
    for (std::size_t s = 0; s < way_samples; ++s) {
      reservation.x_m[s] = ways.x_m[s][l];
      reservation.z_m[s] = ways.z_m[s][l];
    }
    reservation.faces_x = faces_x[l];
    reservation.faces_z = faces_z[l];
    reservation.x_m_s = plan.to.speed_m_s[l] * reservation.faces_x;
    reservation.z_m_s = plan.to.speed_m_s[l] * reservation.faces_z;
    if (!courses) go_on(instants(), reservation);
    finish(reservation);
  }
}

/// Sorts neighbours by cells of the ground, with a counting sort.
void ReservationBook::sort() {
  buckets_ = std::bit_ceil(2 * seen_.size() + 1);
  starts_.assign(buckets_ + 2, 0);
  unsorted_.clear();
  longest_m_ = broadest_m_ = 0;
  for (const std::uint32_t number : seen_) {
    const Reservation& reservation = reservations_[number];
    const GroundBox& box = reservation.box;
    const std::size_t now = reservation.at(instant_);
    broadest_m_ = std::max({broadest_m_, reservation.radius_m, reservation.shoulders_m});
    longest_m_ = std::max({longest_m_, 0.5F * (box.high_x_m - box.low_x_m), 0.5F * (box.high_z_m - box.low_z_m)});
    unsorted_.push_back({cell(0.5F * (box.low_x_m + box.high_x_m)), cell(0.5F * (box.low_z_m + box.high_z_m)), number,
                         reservation.who.index, box, reservation.x_m[now], reservation.z_m[now], reservation.faces_x,
                         reservation.faces_z, reservation.ground_m, reservation.steepness});
    ++starts_[bucket(unsorted_.back().cell_x, unsorted_.back().cell_z) + 2];
  }
  for (std::size_t b = 2; b < starts_.size(); ++b) starts_[b] += starts_[b - 1];
  sorted_.resize(seen_.size());
  for (const Nearby& one : unsorted_) sorted_[starts_[bucket(one.cell_x, one.cell_z) + 1]++] = one;
}

}  // namespace mobil::inline v0_3
