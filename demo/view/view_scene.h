#pragma once
// What `mobil view` shows: one person of the user's choosing and a crowd to both sides of the way. No graphics.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/engine/error.h>
#include <mobil/lod.h>
#include <mobil/simulation.h>
#include <mobil/systems/render/camera.h>
#include "demo/crowd/crowd_picture.h"

namespace mobil {

inline constexpr std::size_t view_groups = 4;

/// All that the user sets.
struct ViewChoice {
  BodyRequest body{};
  GaitRequest gait{};
  std::array<Method, view_groups> method{Method::modal, Method::modal, Method::modal, Method::modal};
  std::uint32_t modes = 12;
  ExcitationSource activation = ExcitationSource::none;
  bool inertia = false, forces = true;
  std::size_t people = 60;
  bool choose = false;  // methods as the camera calls for, everybody's
  float tolerance_px = 1;
  double budget_s = 0;  // 0: none
};

bool same_choice(const ViewChoice& a, const ViewChoice& b);

/// The last seconds of the person's right leg, oldest first.
struct ViewTrace {
  static constexpr std::size_t ticks = 144;
  std::array<float, ticks> hip_deg{}, knee_deg{}, ankle_deg{}, right_load{}, left_load{};  // loads: parts of weight
  std::array<std::array<float, ticks>, view_groups> elongation_mm{};
};

/// Of one muscle group what it has, its predicted error and its cost, as measured.
struct ViewMethod {
  MuscleMethod method;
  float error_m = 0, cost_us = 0;  // 0 where that method was not measured
};

class ViewScene {
 public:
  /// Errors: a choice that cannot be.
  static Result<ViewScene> make(const ViewChoice& choice);

  /// Errors, in one line: what cannot be; the scene is unchanged.
  Result<void> set(const ViewChoice& choice);
  const ViewChoice& choice() const { return choice_; }

  /// One tick; `camera`, in pictures of that size, is what methods are chosen for.
  void tick(const Camera& camera, int width, int height);
  /// Everybody, the person first; good until the next call.
  std::span<const CrowdCamera::Drawn> drawn() const { return drawn_; }
  /// Whose surfaces are not needed any more; asked once.
  std::optional<std::uint64_t> gone() { return std::exchange(gone_, std::nullopt); }
  /// Where the person's pelvis is, m.
  Vec3<float> place() const;
  ViewMethod method(std::size_t group) const;
  const ViewTrace& trace() const { return trace_; }
  const Simulation& simulation() const { return *simulation_; }
  /// What the last update of choosing did; nothing while nothing is chosen.
  const std::optional<LodReport>& chosen() const { return chosen_; }

 private:
  ViewScene() : simulation_(std::make_unique<Simulation>(SimulationOptions{.threads = 0})) {}
  Result<Entity> spawned(const ViewChoice& choice) const;
  Result<void> set_methods(Entity person, const ViewChoice& choice) const;
  Result<void> set_crowd(std::size_t people);
  Result<void> set_choosing(const ViewChoice& choice);
  void stop_choosing();
  Result<void> look(const Camera& camera, int width, int height);
  void sample();
  void keep_near();

  std::unique_ptr<Simulation> simulation_;
  bool choosing_ = false;
  ViewChoice choice_;
  Entity person_{};
  std::uint64_t number_ = 0;  // of the person's figure
  std::vector<Entity> crowd_;
  std::vector<float> lane_m_;  // of each of the crowd
  std::vector<CrowdCamera::Drawn> drawn_;
  std::optional<std::uint64_t> gone_;
  std::optional<LodReport> chosen_;
  ViewTrace trace_;
};

}  // namespace mobil
