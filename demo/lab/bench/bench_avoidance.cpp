// Crowds that avoid each other: speed in a corridor, across each other and through a door, distances, and the cost of
// choosing steps.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include <mobil/avoidance.h>
#include <mobil/components/avoidance.h>
#include <mobil/simulation.h>
#include <mobil/systems/poses/roots.h>
#include "demo/lab/bench/bench.h"
#include "demo/measure/phase_time.h"
#include "engine/row_hash.h"

namespace mobil {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float wide_m = 5, round_m = 100, ring_m = round_m / (2 * pi), square_m = 22, door_m = 1.2F, post_m = 0.2F;
constexpr float radius_m = 0.22F;  // of shoulders with their arms

enum class Flow : std::uint8_t { one_way, both_ways, crossing, door };

float drawn(std::uint64_t number, std::uint64_t what) {
  return static_cast<float>(mix64(mix64(number + 78) ^ what) >> 40) * 0x1p-24F;
}

/// People who walk around a ring, so that their number is constant; or across a square or through a door. There they
/// enter again at the other end as soon as there is room.
class FlowScene {
 public:
  FlowScene(Flow flow, float people_a_m2, const AvoidanceOptions& options = {}) : flow_(flow) {
    avoidance_.set_options(options);
    across_m_ = flow == Flow::crossing ? square_m : wide_m;
    along_m_ = flow == Flow::crossing ? square_m : flow == Flow::door ? 30 : round_m;
    const auto count = static_cast<int>(people_a_m2 * along_m_ * across_m_);
    const float room_m = flow == Flow::crossing ? across_m_ : across_m_ - 2 * radius_m;
    const int rows =
        std::max(1, static_cast<int>(std::lround(room_m / std::sqrt(along_m_ * room_m / static_cast<float>(count)))));
    const int columns = (count + rows - 1) / rows;
    for (int i = 0; i < columns * rows && static_cast<int>(people_.size()) < count; ++i) {
      const auto number = static_cast<std::uint64_t>(i);
      Person one;
      one.back = flow != Flow::one_way && drawn(number, 3) < 0.5F;
      one.speed_m_s = 1.34F + 0.35F * (drawn(number, 4) + drawn(number, 5) - 1);
      const float height = 1.72F + 0.15F * (drawn(number, 6) + drawn(number, 7) - 1);
      const auto spread = [&](float cell, std::uint64_t what) {
        return (2 * drawn(number, what) - 1) * std::max(0.0F, 0.5F * (cell - 0.46F));
      };
      const float along = along_m_ / static_cast<float>(columns), across = room_m / static_cast<float>(rows);
      one.x_m = (static_cast<float>(i / rows) + 0.5F) * along - 0.5F * along_m_ + spread(along, 1);
      one.z_m = (static_cast<float>(i % rows) + 0.5F) * across - 0.5F * room_m + spread(across, 2);
      if (round()) {
        const float angle = one.x_m / ring_m, radius = ring_m + one.z_m;
        one.x_m = radius * std::cos(angle);
        one.z_m = radius * std::sin(angle);
      }
      if (flow == Flow::door && std::fabs(one.x_m) < 0.7F) continue;
      one.entity =
          simulation_.spawn({.height_m = height, .mass_kg = 24 * height * height}, {.speed_m_s = 0.0F}).value();
      simulation_.place(one.entity, one.x_m, one.z_m, heading(one));
      avoidance_.manage(one.entity);
      people_.push_back(one);
    }
    put_walls();
    for (const Person& one : people_) entities_.push_back(one.entity);
    roots_.resize(people_.size());
    wishes_.resize(people_.size());
  }

  std::size_t people() const { return people_.size(); }
  double choosing_s = 0, way_m = 0, person_s = 0, stood_s = 0, near = 0, looks = 0;
  double trunks_m = 0, shoulders_m = 0;  // largest overlap of two people
  double in_middle = 0;                  // of the square: people, summed over ticks
  std::size_t passed = 0;

  void tick(bool counts) {
    const std::uint32_t now = simulation_.ticks();
    if (now % 6 == 0) {
      for (std::size_t i = 0; i < people_.size(); ++i)
        wishes_[i] = {people_[i].entity, people_[i].speed_m_s, heading(people_[i])};
      avoidance_.set_desired_velocity(wishes_);
    }
    simulation_.tick();
    simulation_.roots(entities_, roots_);
    for (std::size_t i = 0; i < people_.size(); ++i) move(people_[i], roots_[i], counts);
    come_in_again();
    if (!counts) return;
    if (flow_ == Flow::crossing) in_middle += static_cast<double>(count_in_middle());
    choosing_s += phase_s(simulation_, "avoidance");
    person_s += simulation_.tick_s() * static_cast<double>(people_.size());
    if (now % 6 == 0) look_who_is_near();
  }

 private:
  struct Person {
    Entity entity{};
    float x_m = 0, z_m = 0, speed_m_s = 0;
    bool back = false;
    double stands_s = 0;
    std::uint32_t came_in = 0;
    bool clear = true;  // of all people, some time after entering
    AvoidanceState<float> course{};
    double faces_rad = 0;
  };

  bool round() const { return flow_ == Flow::one_way || flow_ == Flow::both_ways; }

  float heading(const Person& one) const {
    if (round()) {
      // Steps follow a heading late. With this look-ahead a lone walker drifts neither out nor in.
      constexpr float looks_ahead_m = 1.7F;
      const float way = one.back ? -1 : 1;
      const float at = std::atan2(one.z_m, one.x_m) + way * looks_ahead_m / std::hypot(one.x_m, one.z_m);
      return std::atan2(-way * std::sin(at), way * std::cos(at));
    }
    if (flow_ == Flow::crossing) return one.back ? 0 : 0.5F * pi;
    if (flow_ != Flow::door || one.x_m > 0.3F) return 0.5F * pi;
    const float free_m = 0.5F * door_m - radius_m - 0.03F, ahead = one.x_m < -post_m ? 0.0F : 1.0F;
    return std::atan2(ahead - one.x_m, std::clamp(one.z_m, -free_m, free_m) - one.z_m);
  }

  void put_walls() {
    if (flow_ == Flow::crossing) return;
    if (round()) {
      constexpr int sides = 48;
      std::vector<Wall> walls;
      for (const float radius : {ring_m - 0.5F * wide_m, ring_m + 0.5F * wide_m}) {
        const auto corner = [&](int i) {
          const float angle = 2 * pi * static_cast<float>(i) / sides;
          return GroundPoint{radius * std::cos(angle), radius * std::sin(angle)};
        };
        for (int i = 0; i < sides; ++i) walls.push_back({corner(i), corner(i + 1)});
      }
      avoidance_.set_walls(walls);
      return;
    }
    constexpr float beyond = 30, half = 0.5F * wide_m, gap = 0.5F * door_m;
    const float end = 0.5F * along_m_ + beyond;
    std::vector<Wall> walls = {{{-end, -half}, {end, -half}}, {{-end, half}, {end, half}}};
    for (const float side : {-1.0F, 1.0F}) {
      for (const float x : {-post_m, post_m}) walls.push_back({{x, side * half}, {x, side * gap}});
      walls.push_back({{-post_m, side * gap}, {post_m, side * gap}});
    }
    avoidance_.set_walls(walls);
  }

  void move(Person& one, const Root& root, bool counts) {
    const auto x = static_cast<float>(root.x_m), z = static_cast<float>(root.z_m);
    const bool sideways = flow_ == Flow::crossing && one.back;
    const float turned = (z - one.z_m) * x - (x - one.x_m) * z;
    const float on = round() ? (one.back ? -turned : turned) / std::hypot(x, z) : sideways ? z - one.z_m : x - one.x_m;
    if (counts) {
      way_m += static_cast<double>(on);
      passed += flow_ == Flow::door && one.x_m < 0 && x >= 0;
      constexpr double long_s = 5;
      one.stands_s = on > 1e-4F ? 0 : one.stands_s + simulation_.tick_s();
      if (one.stands_s > long_s) stood_s += simulation_.tick_s();
    }
    one.x_m = x;
    one.z_m = z;
  }

  /// Lets people who have left enter again at the other end as soon as there is room, next to where they left. The
  /// number of people on the stretch is thus constant.
  void come_in_again() {
    if (round()) return;
    const float end = 0.5F * along_m_;
    for (std::size_t i = 0; i < people_.size(); ++i) {
      Person& one = people_[i];
      const float x = one.x_m > end ? -1 : one.x_m < -end ? 1 : 0;
      const float z = flow_ != Flow::crossing ? 0 : one.z_m > end ? -1 : one.z_m < -end ? 1 : 0;
      if (x == 0 && z == 0) continue;
      const auto state = *simulation_.get<GaitState>(one.entity);
      constexpr int tries = 16;
      for (int k = 0; k < tries; ++k) {
        constexpr float within_m = 8, beside_m = 0.3F;
        const std::uint64_t draw = mix64(simulation_.ticks() * tries + static_cast<std::uint64_t>(k)) ^ i;
        const float deep = end - within_m * drawn(draw, 1), most = 0.5F * across_m_ - radius_m - 0.1F;
        const float side = std::clamp((x != 0 ? one.z_m : one.x_m) + beside_m * (2 * drawn(draw, 2) - 1), -most, most);
        const float to_x = x != 0 ? x * deep : side, to_z = x != 0 ? side : z * deep;
        if (!is_free(one, to_x, to_z, state.heading_rad)) continue;
        simulation_.place(one.entity, to_x, to_z, state.heading_rad);
        one.x_m = to_x;
        one.z_m = to_z;
        one.came_in = simulation_.ticks();
        one.clear = false;
        break;
      }
    }
  }

  bool is_free(const Person& one, float x_m, float z_m, float heading_rad) const {
    constexpr float room_m = 2.2F, middle_m = 0.7F;
    const float at_x = x_m + middle_m * std::sin(heading_rad), at_z = z_m + middle_m * std::cos(heading_rad);
    return std::none_of(people_.begin(), people_.end(), [&](const Person& other) {
      return &other != &one && std::hypot(other.x_m - at_x, other.z_m - at_z) < 0.5F * room_m;
    });
  }

  std::ptrdiff_t count_in_middle() const {
    return std::count_if(people_.begin(), people_.end(), [&](const Person& one) {
      return std::max(std::fabs(one.x_m), std::fabs(one.z_m)) < 0.25F * square_m;
    });
  }

  /// Returns half the breadth of a person's shoulders toward (x, z): an ellipse as deep as 0.58 of its breadth.
  static double shoulders_toward(const Person& one, double x, double z) {
    const double faces = one.faces_rad + double{one.course.turn_rad};
    const double ahead = x * std::sin(faces) + z * std::cos(faces), aside = x * std::cos(faces) - z * std::sin(faces);
    return double{one.course.shoulders_m} * std::hypot(aside, 0.58 * ahead);
  }

  /// A person who enters can be placed where another was about to be. People count once they are clear of all others,
  /// some seconds later.
  void look_who_is_near() {
    constexpr std::uint32_t settled = 300;
    constexpr double counts_m = 0.05;
    for (std::size_t i = 0; i < people_.size(); ++i) {
      people_[i].course = *simulation_.get<AvoidanceState>(people_[i].entity);
      people_[i].faces_rad = double{roots_[i].heading_rad};
    }
    for (Person& one : people_) {
      double trunks = 0, shoulders = 0, of_all = 0;
      for (const Person& other : people_) {
        if (&other == &one) continue;
        const double x = double{other.x_m} - double{one.x_m}, z = double{other.z_m} - double{one.z_m};
        const double apart = std::hypot(x, z);
        if (apart > 2 * double{radius_m} + 0.1) continue;
        const double to_x = x / std::max(apart, 1e-6), to_z = z / std::max(apart, 1e-6);
        const double together = double{one.course.radius_m} + double{other.course.radius_m} - apart;
        of_all = std::max(of_all, together);
        if (!one.clear || !other.clear) continue;
        trunks = std::max(trunks, together);
        shoulders =
            std::max(shoulders, shoulders_toward(one, to_x, to_z) + shoulders_toward(other, to_x, to_z) - apart);
      }
      one.clear = one.clear || (of_all <= 0 && one.came_in + settled < simulation_.ticks());
      trunks_m = std::max(trunks_m, trunks);
      shoulders_m = std::max(shoulders_m, shoulders);
      near += std::max(trunks, shoulders) > counts_m ? 1 : 0;
      ++looks;
    }
  }

  Flow flow_;
  float across_m_, along_m_;
  Simulation simulation_;
  Avoidance avoidance_ = simulation_.avoidance();
  std::vector<Person> people_;
  std::vector<Entity> entities_;
  std::vector<Root> roots_;
  std::vector<DesiredVelocity> wishes_;
};

void time_flow(BenchRun& run, const std::string& name, Flow flow, float people_a_m2, int full_s = 90,
               const AvoidanceOptions& options = {}) {
  const int seconds = run.quick ? 6 : full_s;
  FlowScene scene(flow, people_a_m2, options);
  for (int tick = 0; tick < seconds * 60; ++tick) scene.tick(tick >= seconds * 20);
  std::string of = fmt::format("{} people, {} s", scene.people(), seconds);
  if (flow == Flow::crossing) {
    constexpr double middle_m2 = 0.25 * square_m * square_m;
    of += fmt::format("; {:.2f} a m² in the middle", scene.in_middle / (seconds * 40 * middle_m2));
  }
  if (flow == Flow::door) {
    run.add_figure(name + ".people_per_s", static_cast<double>(scene.passed) / (seconds * 2 / 3.0), "/s", of);
  } else {
    run.add_figure(
        name + ".m_per_s", scene.way_m / scene.person_s, "m/s",
        of + fmt::format("; {:.1f} % of the time somebody stands for over 5 s", 100 * scene.stood_s / scene.person_s));
  }
  run.add_figure(name + ".overlap_cm", 100 * scene.trunks_m, "cm",
                 fmt::format("of trunks, the most; {:.2f} % of people overlap by more than 5 cm, shoulders counted",
                             100 * scene.near / std::max(scene.looks, 1.0)));
  run.add_figure(name + ".shoulders_cm", 100 * scene.shoulders_m, "cm", "of shoulders as they are turned, the most");
  run.add_figure(name + ".us_per_person_tick", 1e6 * scene.choosing_s / (60 * scene.person_s), "us", "choosing steps");
}

}  // namespace

void bench_avoidance(BenchRun& run) {
  time_flow(run, "avoidance.one_way_0.5", Flow::one_way, 0.5F);
  time_flow(run, "avoidance.one_way_1", Flow::one_way, 1);
  time_flow(run, "avoidance.one_way_2", Flow::one_way, 2);
  const AvoidanceOptions unturned = {.radius_h = AvoidanceOptions{}.shoulders_h};
  time_flow(run, "avoidance.one_way_2_unturned", Flow::one_way, 2, 90, unturned);
  time_flow(run, "avoidance.both_ways_0.2", Flow::both_ways, 0.2F);
  time_flow(run, "avoidance.both_ways_0.5", Flow::both_ways, 0.5F);
  time_flow(run, "avoidance.both_ways_1", Flow::both_ways, 1);
  time_flow(run, "avoidance.both_ways_1_long", Flow::both_ways, 1, 600);
  time_flow(run, "avoidance.crossing_0.5", Flow::crossing, 0.5F);
  time_flow(run, "avoidance.crossing_1", Flow::crossing, 1);
  time_flow(run, "avoidance.door", Flow::door, 0.7F);
}

}  // namespace mobil
