#pragma once
// One steady gait cycle of one person with leg muscles, as `mobil paper` tells and shows it; people put on a
// stage, and pictures taken of it.

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

/// Length from origin to insertion over that in the anatomical position, as the paths of the gait2392 model have it on
/// measured joint angles; the deviation is that of the angles, carried over. Without one (`sd` zero) where none was
/// published.
struct PublishedLength {
  std::string muscle;  // hamstrings, rectus_femoris, gastrocnemius, soleus, tibialis_anterior
  MeasuredCurve curve;
};

/// All of one walk: opensim_normal_gait, schwartz_slow, schwartz_free or schwartz_fast; from the table that the program
/// carries. Error: the table is not as it should be.
std::vector<PublishedLength> read_published_lengths(std::string_view walk);

/// `shown_at`: where in the cycle (0–1, ascending) pictures are to be made.
struct CycleRequest {
  BodyRequest body{};
  GaitRequest gait{};
  std::optional<LegMuscles> muscles{};
  std::vector<double> shown_at{};
  std::optional<std::filesystem::path> anatomy{};
};

/// A muscle of the right leg. Thickness: the diameter of a round bar of the muscle's volume and belly length, which
/// grows and shrinks as the widest of its mesh's sections does.
struct MuscleCycle {
  MusclePlan plan;
  double rest_length_m = 0, rest_thickness_m = 0;
  /// Of the line of action; the pull on the belly's far end, positive when longer than at rest; and the belly's own.
  CycleCurve length_m{}, pull_n{}, elongation_m{}, volume_ratio{}, thickness_m{};
};

/// What pictures take: as many frames as places in the cycle were asked for.
struct ShownWalk {
  WalkRecording recording;                          // surfaces of the simulated muscles alone
  std::vector<std::vector<Vec3<float>>> mesh_edge;  // of the right leg by frame, two ends an edge, m, world
};

/// Over the right leg's cycle; heights over the ground, sideways positive to the left of the line walked along.
struct PaperCycle {
  Body body;
  Gait<float> gait{};
  double cycle_s = 0, stance_s = 0;
  CycleCurve com_height_m{}, com_sideways_m{}, pelvis_height_m{}, knee_flexion_deg{};
  CycleCurve ground_n{};  // vertical, under the right foot
  std::vector<MuscleCycle> muscles;
  ShownWalk shown;

  const MuscleCycle& muscle(Muscle muscle) const;  // must have been asked for
};

/// Walks until steady and then one cycle more, in ticks of 1/240 s. Errors: a body, gait or choice of muscles out of
/// range; an anatomy folder that cannot be read.
PaperCycle walk_cycle(const CycleRequest& request);

struct CycleRange {
  double low, high, low_percent, high_percent;
  double span() const { return high - low; }
};
CycleRange range_of(const CycleCurve& curve);
double mean_of(const CycleCurve& curve);

/// One moment of a walk. The point of the ground below the pelvis is put at `at`.
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

/// From the right of people who walk toward +z (which is to the right in the picture) and somewhat in front of them:
/// `turn_deg` from the side, `rise_deg` above. Holds about `tall_m` of height at the target, hardly any perspective.
Camera camera_at(const Vec3<float>& target, float tall_m, float turn_deg, float rise_deg);

/// The direction to the right in pictures of that camera, of unit length.
Vec3<float> across(const Camera& camera);

/// People `apart_m` from one another, each in their own first frame, from left to right before the camera.
std::vector<Actor> side_by_side(std::span<const PaperCycle> walks, const Camera& camera, float apart_m);

/// Errors: no graphics device or driver.
Image take_picture(const Stage& stage, std::span<const Actor> actors);

}  // namespace mobil
