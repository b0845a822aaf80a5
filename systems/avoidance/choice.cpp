#include "systems/avoidance/choice.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <mobil/components/avoidance.h>
#include <mobil/components/footing.h>
#include <mobil/each.h>
#include <mobil/rows.h>
#include "assets/gait/slope_pace.h"
#include "systems/avoidance/lane.h"
#include "systems/avoidance/preference.h"
#include "systems/gait/gait.h"

namespace mobil::inline v0_3 {
namespace {

/// Maximum number of foreseen people, nearest first, and the radius of the search, m. The smaller radius is searched
/// first, which is enough among many people.
constexpr std::size_t max_passers = 12;
constexpr float sees_m = 6, sees_first_m = 2.5F;
/// Amount by which gaps can be narrower for a standing walker to start into, m.
constexpr float squeezes_m = 0.06F;
/// Additional distance from people and discs, which make no room, m.
constexpr float all_of_the_way_m = 0.15F;
/// Waiting time at which a walker uses the full overlap, and after which staying costs more, s.
constexpr float patience_s = 2;
/// Cost of turning; bonus for passing on the right of oncoming people.
constexpr float of_turning = 0.15F, keeps_right = 0.05F;
/// Distance by which arms yield at a wall, m: a walker who starts next to one sways. A walker who is already too
/// near comes no nearer, within rounding.
constexpr float brushes_m = 0.03F, rounding_m = 2e-4F;
/// Margin of a way around the rectangle between its ends, m: ways bend.
constexpr float off_straight_m = 0.1F;

float square(float x) {
  return x * x;
}
struct Near {
  float distance2;
  std::uint32_t index, reservation;
  bool operator<(const Near& other) const {
    return distance2 != other.distance2 ? distance2 < other.distance2 : index < other.index;
  }
};

/// One choice: the walker's trials and the cost of each.
class WayChoice {
 public:
  WayChoice(const Surroundings& around, const Striker& striker, const HeelStrikePlace<float>& from,
            const AvoidanceState<float>& course)
      : around_(around),
        mine_(around.book.reservation(striker.reservation)),
        me_(striker.reservation),
        from_(from),
        course_(course),
        wish_(direction(course.heading_rad)),
        trials_(make_trials(from, course)),
        overlap_m_(around.overlap_m * std::min(course.waits_s * (1 / patience_s), 1.0F)) {
    tried_ways(broadcast(from), trials_.trial, around.book.instants(), ways_, end_);
    const std::size_t now = mine_.at(around.book.instant());
    for (std::size_t s = 0; s < way_samples; ++s) {  // the same bits that others keep clear of
      ways_.x_m[s][reserved] = mine_.x_m[now + s];
      ways_.z_m[s][reserved] = mine_.z_m[now + s];
    }
    at_ = {mine_.x_m[now], mine_.z_m[now]};
    for (float& open : open_.lane) open = 1;
  }

  std::size_t best() {
    look_at_people();
    look_at_walls();
    look_at_discs();
    from_.speed_m_s > 0 ? prefer_walking() : prefer_standing();
    std::size_t best = reserved;
    for (std::size_t l = 1; l < lane_count; ++l)
      if (open_[l] > 0 && cost_[l] < cost_[best]) best = l;
    return best;
  }

  /// Returns the gait request of a trial.
  Gait<float> gait(std::size_t l, const GaitStyle& style) const {
    const Trial<Lanes<float>>& trial = trials_.trial;
    Gait<float> gait = complete_gait(from_.height_m, trials_.kind[l] == TrialKind::go ? trial.speed_m_s[l] : 0,
                                     end_.step_length_m[l], style);
    gait.heading_rad =
        trial.turn_rad[l] == trials_.wish_rad ? course_.heading_rad : from_.heading_rad + trial.turn_rad[l];
    if (trials_.kind[l] == TrialKind::aside) {
      const GroundPoint slant = direction(trial.slant_rad[l]);
      gait.left_m = trial.aside_m[l] * slant.x_m;
      gait.ahead_m = trial.aside_m[l] * slant.z_m;
    }
    return gait;
  }

  void tell(std::size_t l, Chosen& out) const {
    out.trial = l;
    out.kind = trials_.kind[l];
    out.duration_s = end_.duration_s[l];
    for (std::size_t s = 0; s < way_samples; ++s) {
      out.x_m[s] = ways_.x_m[s][l];
      out.z_m[s] = ways_.z_m[s][l];
    }
    out.box = box_of(at_, {out.x_m.back(), out.z_m.back()}, off_straight_m);
  }

 private:
  /// Closes trials that come nearer than `apart_m`, or nearer than the reservation where that is less.
  void keep_clear(const Lanes<float>& min_m2, float apart_m) {
    const float least = square(std::min(apart_m, std::max(std::sqrt(min_m2[reserved]) - rounding_m, 0.0F)));
    for (std::size_t l = 1; l < lane_count; ++l) open_[l] = min_m2[l] >= least ? open_[l] : 0;
  }

  GroundBox reached() const {
    GroundBox box = box_of(at_, at_, 0);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const float x = ways_.x_m[way_samples - 1][l], z = ways_.z_m[way_samples - 1][l];
      box = {std::min(box.low_x_m, x), std::max(box.high_x_m, x), std::min(box.low_z_m, z), std::max(box.high_z_m, z)};
    }
    return box_of({box.low_x_m, box.low_z_m}, {box.high_x_m, box.high_z_m}, off_straight_m);
  }

  /// Returns the distance to keep. Unmanaged people turn no shoulders, and managed people do not turn for them.
  float apart_from(const Reservation& reservation) const {
    return (reservation.yields ? mine_.radius_m : mine_.shoulders_m) + reservation.radius_m;
  }
  void keep_clear_of(const Reservation& reservation, std::uint32_t instant) {
    const float apart = apart_from(reservation) - overlap_m_;
    if (!reservation.box.meets(box_, apart)) return;
    const std::size_t now = reservation.at(instant);
    nearest_approach(ways_, &reservation.x_m[now], &reservation.z_m[now], min_m2_);
    keep_clear(min_m2_, apart);
  }

  /// Closes trials that meet people within reach, and stores the nearest people.
  void look_at_people() {
    box_ = reached();
    const float reach =
        std::max({at_.x_m - box_.low_x_m, box_.high_x_m - at_.x_m, at_.z_m - box_.low_z_m, box_.high_z_m - at_.z_m});
    const std::uint32_t instant = around_.book.instant();
    std::array<Near, max_passers> near;
    const auto remember = [&](const Nearby& other) {
      const Near one = {square(other.x_m - at_.x_m) + square(other.z_m - at_.z_m), other.who, other.reservation};
      if (one.distance2 > square(sees_m) || (passing_ == max_passers && !(one < near[passing_ - 1]))) return;
      if (passing_ < max_passers) ++passing_;
      std::size_t i = passing_ - 1;
      for (; i > 0 && one < near[i - 1]; --i) near[i] = near[i - 1];
      near[i] = one;
    };
    const float apart_at_most = mine_.shoulders_m + around_.book.broadest_m();
    const float at_first_m = std::max(reach + apart_at_most, sees_first_m);
    around_.book.near(at_.x_m, at_.z_m, mine_, at_first_m, [&](const Nearby& other) {
      if (other.reservation == me_) return;
      if (other.box.meets(box_, apart_at_most)) keep_clear_of(around_.book.reservation(other.reservation), instant);
      remember(other);
    });
    if (at_first_m < sees_m && (passing_ < max_passers || near.back().distance2 > square(at_first_m))) {
      passing_ = 0;
      around_.book.near(at_.x_m, at_.z_m, mine_, sees_m, [&](const Nearby& other) {
        if (other.reservation != me_) remember(other);
      });
    }
    for (std::size_t i = 0; i < passing_; ++i) {
      const Reservation& reservation = around_.book.reservation(near[i].reservation);
      const std::size_t now = reservation.at(instant);
      const bool stands = now >= way_samples;
      passer_[i] = {reservation.x_m[now], reservation.z_m[now], stands ? 0 : reservation.x_m_s,
                    stands ? 0 : reservation.z_m_s,
                    apart_from(reservation) + (reservation.yields ? 0 : all_of_the_way_m)};
    }
  }

  void look_at_walls() {
    for (const auto& [wall, box] : around_.walls) {
      if (!box.meets(box_, mine_.shoulders_m) || !mine_.meets(wall.height)) continue;
      nearest_to_wall(ways_, wall.from.x_m, wall.from.z_m, wall.to.x_m, wall.to.z_m, min_m2_);
      keep_clear(min_m2_, mine_.shoulders_m - brushes_m);
    }
  }

  void look_at_discs() {
    const WayInstants instants = around_.book.instants();
    std::array<float, way_samples> x, z;
    for (const Disc& disc : around_.discs) {
      if (!mine_.meets(disc.height)) continue;
      for (std::size_t s = 0; s < way_samples; ++s) {
        const float then = instants.first_s + static_cast<float>(s) * instants.every_s;
        x[s] = disc.at.x_m + then * disc.x_m_s;
        z[s] = disc.at.z_m + then * disc.z_m_s;
      }
      const float apart = disc.radius_m + mine_.shoulders_m;
      if (box_of({x.front(), z.front()}, {x.back(), z.back()}, 0).meets(box_, apart)) {
        nearest_approach(ways_, x.data(), z.data(), min_m2_);
        keep_clear(min_m2_, apart);
      }
    }
  }

  /// Adds the cost of meeting people, discs and walls on ways from here.
  void foresee(const Onward<Lanes<float>>& ways, float narrower_m, bool walls, Lanes<float>& cost) const {
    for (std::size_t i = 0; i < passing_; ++i) {
      Passer one = passer_[i];
      one.apart_m -= narrower_m;
      add_foresight(ways, one, cost);
    }
    for (const Disc& disc : around_.discs)
      if (mine_.meets(disc.height) &&
          square(disc.at.x_m - at_.x_m) + square(disc.at.z_m - at_.z_m) < square(sees_m + disc.radius_m))
        add_foresight(ways,
                      {disc.at.x_m, disc.at.z_m, disc.x_m_s, disc.z_m_s,
                       disc.radius_m + mine_.shoulders_m + all_of_the_way_m - narrower_m},
                      cost);
    constexpr float wall_within_m = 2;
    for (std::size_t i = 0; walls && i < around_.walls.size(); ++i) {
      const auto& [wall, box] = around_.walls[i];
      if (!box.meets({at_.x_m, at_.x_m, at_.z_m, at_.z_m}, wall_within_m) || !mine_.meets(wall.height)) continue;
      const GroundPoint at = nearest_of(wall, at_);
      if (square(at.x_m - at_.x_m) + square(at.z_m - at_.z_m) < square(wall_within_m))
        add_foresight(ways, {at.x_m, at.z_m, 0, 0, mine_.shoulders_m - narrower_m}, cost);
    }
  }

  /// Returns true if a person ahead in the desired direction comes toward the walker.
  bool meets_anybody() const {
    const float x = wish_.x_m, z = wish_.z_m;
    constexpr float comes_m_s = 0.3F;
    return std::any_of(
        passer_.begin(), passer_.begin() + static_cast<std::ptrdiff_t>(passing_), [&](const Passer& one) {
          return one.x_m_s * x + one.z_m_s * z < -comes_m_s && (one.x_m - at_.x_m) * x + (one.z_m - at_.z_m) * z > 0;
        });
  }

  void prefer_walking() {
    const Onward<Lanes<float>> ways = {end_.duration_s, end_.x_m, end_.z_m, end_.speed_m_s, end_.heading_rad};
    cost_of_ways(ways, course_.speed_m_s, wish_, cost_);
    foresee(ways, 0, false, cost_);
    const bool meets = meets_anybody();
    for (std::size_t l = 0; l < lane_count; ++l) {
      cost_[l] += of_turning * std::fabs(end_.bend_rad[l]);
      if (meets && trials_.trial.turn_rad[l] < trials_.wish_rad) cost_[l] -= keeps_right;
    }
  }

  /// Returns the best of sixteen headings in which a standing walker starts at that pace; none if staying costs less.
  std::optional<float> wished_start(float pace_m_s) {
    Onward<Lanes<float>> ways;
    constexpr float apart = 2 * std::numbers::pi_v<float> / lane_count;
    for (std::size_t l = 0; l < lane_count; ++l) {
      ways.x_m[l] = at_.x_m;
      ways.z_m[l] = at_.z_m;
      ways.duration_s[l] = 0;
      ways.speed_m_s[l] = pace_m_s;
      ways.heading_rad[l] = course_.heading_rad + static_cast<float>(l) * apart;
    }
    cost_of_ways(ways, course_.speed_m_s, wish_, cost_);
    foresee(ways, squeezes_m, true, cost_);
    const bool meets = meets_anybody();
    constexpr float max_patience = 2, impatience = 0.5F;  // a walker who has waited accepts any heading
    float least = square(course_.speed_m_s) + std::min(max_patience, impatience * course_.waits_s);
    std::size_t best = lane_count;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const float cost = cost_[l] - (meets && l > lane_count / 2 ? keeps_right : 0);
      if (cost >= least) continue;
      least = cost;
      best = l;
    }
    if (best == lane_count) return {};
    return ways.heading_rad[best];
  }

  /// Lets a standing walker do what is nearest to the desired start.
  void prefer_standing() {
    const Trial<Lanes<float>>& trial = trials_.trial;
    const float pace = trial.speed_m_s[1];
    const std::optional<float> there_rad = wished_start(pace);
    const bool goes = there_rad.has_value();  // otherwise faces the desired heading, and waits
    const GroundPoint to = direction(there_rad.value_or(0)), go = {goes ? pace * to.x_m : 0, goes ? pace * to.z_m : 0};
    const float off = goes ? wrapped(*there_rad - from_.heading_rad) : trials_.wish_rad;
    const bool as_wished = go.x_m * wish_.x_m + go.z_m * wish_.z_m > 0.85F * pace;
    constexpr float of_turning_there = 0.05F, of_turning_little = 0.15F, of_turning_away = 0.2F;
    constexpr float of_turning_on_spot = 0.1F, of_slower = 0.3F;
    constexpr float of_sidling = 0.3F;                    // if the way is open, because turning and walking is faster
    constexpr float turns_from = 0.5F, min_off = 0.1F;    // rad; between them, only if no open step leads there
    constexpr float of_waiting_per_s = 0.3F, max_of_waiting = 1;
    const float of_staying = std::clamp(of_waiting_per_s * (course_.waits_s - patience_s), 0.0F, max_of_waiting);
    Lanes<float> speed, heading = end_.heading_rad, more{};
    for (std::size_t l = 0; l < lane_count; ++l) {
      const TrialKind kind = trials_.kind[l];
      speed[l] = kind == TrialKind::stay ? 0 : pace;
      if (kind == TrialKind::aside) {
        heading[l] = from_.heading_rad + trial.slant_rad[l];
        if (as_wished && std::fabs(off) > turns_from) more[l] = of_sidling;
      }
      if (kind == TrialKind::stay) more[l] = of_staying;
      if (kind == TrialKind::go) more[l] = of_slower * square(trial.speed_m_s[l] - pace);
      if (kind != TrialKind::turn) continue;
      const bool there = std::fabs(off) > min_off && off * trial.turn_rad[l] > 0;  // then walks there
      if (there) heading[l] = from_.heading_rad + off;
      if (there && !goes) {
        constexpr float of_facing_it = -0.01F;
        speed[l] = 0;
        more[l] = of_staying + of_facing_it;
        continue;
      }
      const bool much = std::fabs(off) > turns_from;
      more[l] = !there      ? of_turning_on_spot + of_staying
                : as_wished ? (much ? of_turning_there : of_turning_little)
                            : of_turning_away * std::fabs(off);
    }
    off_velocity(speed, heading, go.x_m, go.z_m, cost_);
    for (std::size_t l = 0; l < lane_count; ++l) cost_[l] += more[l];
  }

  const Surroundings& around_;
  const Reservation& mine_;
  std::uint32_t me_;
  const HeelStrikePlace<float>& from_;
  const AvoidanceState<float>& course_;
  GroundPoint wish_;  // desired direction, of length 1
  Trials trials_;
  WaySamples<Lanes<float>> ways_;
  StepEnd<Lanes<float>> end_;
  float overlap_m_;
  GroundPoint at_;  // at the book's next instant
  GroundBox box_;
  Lanes<float> open_, cost_, min_m2_;  // open: 1 if the trial can be taken
  std::array<Passer, max_passers> passer_;
  std::size_t passing_ = 0;
};

}  // namespace

bool meet(const Chosen& a, const Chosen& b, float apart_m) {
  if (!a.box.meets(b.box, apart_m)) return false;
  for (std::size_t s = 0; s < way_samples; ++s)
    if (square(a.x_m[s] - b.x_m[s]) + square(a.z_m[s] - b.z_m[s]) < square(apart_m)) return true;
  return false;
}

void choose_step(const Surroundings& around, const Striker& striker, Chosen& out) {
  const Table& table = *striker.table;
  const auto block_of = [&](const auto& column) -> const auto& {
    return column.at(table, striker.block);
  };
  HeelStrikePlace<Lanes<float>> footing;
  next_footing(block_of(TableColumn<BodySize>(table)), block_of(TableColumn<StepPlan>(table)),
               block_of(TableColumn<GaitState>(table)), footing);
  AvoidanceState<float> course = row_of(block_of(TableColumn<AvoidanceState>(table)), striker.lane);
  if (const TableColumn<Footing> ground(table); ground)
    course.speed_m_s = slope_speed(course.speed_m_s, ground.at(table, striker.block).slows_for[striker.lane]);
  const Gait<float> before = row_of(block_of(TableColumn<Gait>(table)), striker.lane);
  HeelStrikePlace<float> from = row_of(footing, striker.lane);
  from.usual = course.usual;
  out = {};
  out.gait = out.as_reserved = before;
  out.under_way = from.speed_m_s <= 0 && from.length_before_m > 0;
  if (out.under_way) return;
  if (from.speed_m_s <= 0 && course.speed_m_s <= 0) {  // stays and turns
    out.gait = complete_gait(from.height_m, 0, 0, before.style);
    out.gait.heading_rad = course.heading_rad;
    return;
  }
  course.heading_rad = lane_heading(around.book, around.walls, striker.reservation, course);
  WayChoice choice(around, striker, from, course);
  const std::size_t best = choice.best();
  choice.tell(best, out);
  out.gait = choice.gait(best, before.style);
  out.as_reserved = choice.gait(reserved, before.style);
}

}  // namespace mobil::inline v0_3
