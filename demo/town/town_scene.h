#pragma once
// The people of a small town: each party has a destination, and everyone a path to it and a desired velocity along it.
// Avoidance keeps them apart, Terrain places their feet on kerbs, stairs and ramp.

#include <cstddef>
#include <cstdint>

#include <mobil/avoidance.h>
#include <mobil/simulation.h>
#include <mobil/systems/poses/roots.h>
#include "demo/town/town_map.h"

namespace mobil {

struct TownOptions {
  std::size_t people = 40;
  std::uint64_t seed = 1;
  int threads = 0;
};

/// Statistics of the run so far.
struct TownReport {
  std::size_t arrivals = 0, paths = 0, places_asked = 0;
  double nearest_m = 1e9;     // minimum distance of two walking lines minus both radii
  double longest_wait_s = 0;  // of a person who stands but has a desired speed
  double walked_m = 0;        // sum over all people
  double paths_s = 0, avoidance_s = 0, terrain_s = 0, tick_s = 0;  // wall time
  std::size_t ticks = 0;
};

class TownScene {
 public:
  /// Creates the scene. Errors: those of TownPaths::make and of the simulation.
  static Result<TownScene> make(const TownOptions& options);
  TownScene(TownScene&&) noexcept;
  TownScene& operator=(TownScene&&) = delete;
  ~TownScene();

  void tick();

  const Simulation& simulation() const { return *simulation_; }
  /// Returns the people; the first takes the tour (town_places).
  const std::vector<Entity>& people() const { return people_; }
  const TownReport& report() const { return report_; }
  bool tour_over() const { return pedestrians_.front().toured >= tour_stops; }
  /// Returns place and heading of the first person's walking line.
  Root guide() const { return roots_.front(); }

 private:
  struct Pedestrian {
    std::uint64_t leader;  // number of the person whose places it goes to: its own, or that of its party
    float speed_m_s, radius_m;
    std::size_t place;  // destination
    std::size_t toured = 0;
    std::vector<GroundPoint> corners;
    std::size_t next = 0;
    std::uint32_t drawn = 0;
    DesiredVelocity wish{};
    bool asked = false;
  };

  TownScene(TownPaths paths, const TownOptions& options);
  Result<void> people_come(const TownOptions& options);
  void choose_place(std::size_t number);
  void find_way(std::size_t number);
  void follow_way(std::size_t number);
  void measure();

  TownPaths paths_;
  std::unique_ptr<Simulation> simulation_;
  std::uint64_t seed_;
  std::vector<Entity> people_;
  std::vector<Pedestrian> pedestrians_;
  std::vector<Root> roots_;
  std::vector<DesiredVelocity> wishes_;
  TownReport report_;
};

}  // namespace mobil
