#pragma once
// One steady gait cycle of one person with leg muscles, as numbers and pictures of `mobil paper`; people on a stage,
// and pictures of it.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/engine/error.h>
#include <mobil/simulation.h>
#include <mobil/systems/render/camera.h>
#include <mobil/systems/render/image.h>
#include "demo/pictures/cycle_curve.h"

namespace mobil {

/// Length from origin to insertion relative to that in the anatomical position, from the paths of the gait2392 model at
/// measured joint angles. The deviation is that of the angles, propagated; `sd` is zero where none was published.
struct PublishedLength {
  std::string muscle;  // hamstrings, rectus_femoris, gastrocnemius, soleus, tibialis_anterior
  MeasuredCurve curve;
};

/// Returns the lengths of one walk: opensim_normal_gait, schwartz_slow, schwartz_free or schwartz_fast, from the table
/// in the program. Error: the table is damaged.
std::vector<PublishedLength> read_published_lengths(std::string_view walk);

/// `shown_at`: places in the cycle (0–1, ascending) of pictures.
struct CycleRequest {
  BodyRequest body{};
  GaitRequest gait{};
  std::optional<LegMuscles> muscles{};
  std::vector<double> shown_at{};
  std::optional<std::filesystem::path> anatomy{};
};

/// A muscle of the right leg. Thickness is the diameter of a round bar with the muscle's volume and belly length,
/// scaled with the widest section of its mesh.
struct MuscleCycle {
  MusclePlan plan;
  double rest_length_m = 0, rest_thickness_m = 0;
  /// Length of the line of action; pull on the belly's far end, positive when longer than at rest; values of the belly.
  CycleCurve length_m{}, pull_n{}, elongation_m{}, volume_ratio{}, thickness_m{};
};

/// Input of pictures: one frame for each requested place in the cycle.
struct ShownWalk {
  WalkRecording recording;                          // surfaces of the simulated muscles alone
  std::vector<std::vector<Vec3<float>>> mesh_edge;  // of the right leg by frame, two ends an edge, m, world
};

/// Curves over the right leg's cycle: heights above the ground, sideways positive to the left of the walking line.
struct PaperCycle {
  Body body;
  Gait<float> gait{};
  double cycle_s = 0, stance_s = 0;
  CycleCurve com_height_m{}, com_sideways_m{}, pelvis_height_m{}, knee_flexion_deg{};
  CycleCurve ground_n{};  // vertical, under the right foot
  std::vector<MuscleCycle> muscles;
  ShownWalk shown;

  const MuscleCycle& muscle(Muscle muscle) const;  // must have been requested
};

/// Walks until steady and then one more cycle, in ticks of 1/240 s. Errors: a body, gait or choice of muscles out of
/// range; an anatomy folder that cannot be read.
PaperCycle walk_cycle(const CycleRequest& request);

struct CycleRange {
  double low, high, low_percent, high_percent;
  double span() const { return high - low; }
};
CycleRange range_of(const CycleCurve& curve);
double mean_of(const CycleCurve& curve);

/// One moment of a walk. The point of the ground below the pelvis is placed at `at`.
struct Actor {
  const ShownWalk* walk = nullptr;
  std::size_t frame = 0;
  Vec3<float> at{0, 0, 0};
  enum class Bones : std::uint8_t { all, right_leg, none } bones = Bones::all;
  enum class Muscles : std::uint8_t { both, right, none } muscles = Muscles::both;
  bool mesh = false;  // the right leg's finite-element meshes, as lines
};

struct Stage {
  Camera camera;
  int width = 640, height = 480;
  bool ground = true;
};

/// Returns a camera at the right of people who walk toward +z (to the right in the picture) and somewhat in front of
/// them: `turn_deg` from the side, `rise_deg` above. It shows about `tall_m` of height at the target, with hardly any
/// perspective.
Camera camera_at(const Vec3<float>& target, float tall_m, float turn_deg, float rise_deg);

/// Returns the direction to the right in pictures of that camera, of unit length.
Vec3<float> across(const Camera& camera);

/// Returns people `apart_m` from one another, each in their own first frame, from left to right before the camera.
std::vector<Actor> side_by_side(std::span<const PaperCycle> walks, const Camera& camera, float apart_m);

/// Draws a picture. Errors: no graphics device or driver.
Image take_picture(const Stage& stage, std::span<const Actor> actors);

}  // namespace mobil
