#pragma once
// The scene of `mobil view`, without graphics: one person chosen by the user, and a crowd on both sides.

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

/// All settings of the user.
struct ViewChoice {
  BodyRequest body{};
  GaitRequest gait{};
  std::array<Method, view_groups> method{Method::modal, Method::modal, Method::modal, Method::modal};
  std::uint32_t modes = 12;
  ExcitationSource activation = ExcitationSource::none;
  bool inertia = false, forces = true;
  std::size_t people = 60;
  bool choose = false;  // true: methods of all people are chosen for the camera
  float tolerance_px = 1;
  double budget_s = 0;  // 0: none
};

bool same_choice(const ViewChoice& a, const ViewChoice& b);

/// The last seconds of the person's right leg, oldest first.
struct ViewTrace {
  static constexpr std::size_t ticks = 144;
  std::array<float, ticks> hip_deg{}, knee_deg{}, ankle_deg{}, right_load{}, left_load{};  // loads: fractions of weight
  std::array<std::array<float, ticks>, view_groups> elongation_mm{};
};

/// Method of a muscle group, with the error and cost predicted from measurements.
struct ViewMethod {
  MuscleMethod method;
  float error_m = 0, cost_us = 0;  // 0 if that method was not measured
};

class ViewScene {
 public:
  /// Creates the scene. Errors: an invalid choice.
  static Result<ViewScene> make(const ViewChoice& choice);

  /// Applies a choice. Errors, in one line: an invalid choice, which leaves the scene unchanged.
  Result<void> set(const ViewChoice& choice);
  const ViewChoice& choice() const { return choice_; }

  /// Runs one tick. Methods are chosen for pictures of that size, pixels, by `camera`.
  void tick(const Camera& camera, int width, int height);
  /// Returns all people, the person first; valid until the next call of `set`.
  std::span<const CrowdCamera::Drawn> drawn() const { return drawn_; }
  /// Returns once the number of a person whose surfaces are no longer needed.
  std::optional<std::uint64_t> gone() { return std::exchange(gone_, std::nullopt); }
  /// Returns the place of the person's pelvis, m.
  Vec3<float> place() const;
  ViewMethod method(std::size_t group) const;
  const ViewTrace& trace() const { return trace_; }
  const Simulation& simulation() const { return *simulation_; }
  /// Returns the report of level of detail for the last tick; nullopt while methods are not chosen.
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
  std::vector<float> lane_m_;  // of each person in the crowd
  std::vector<CrowdCamera::Drawn> drawn_;
  std::optional<std::uint64_t> gone_;
  std::optional<LodReport> chosen_;
  ViewTrace trace_;
};

}  // namespace mobil
