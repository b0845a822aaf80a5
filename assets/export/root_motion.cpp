#include <mobil/assets/export/root_motion.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

/// Motion from the frame of one root to that of another.
struct RootStep {
  RecordedRoot from, to;
  Quat<float> turn;

  RootStep(const RecordedRoot& before, const RecordedRoot& after) : from(before), to(after) {
    const double half = 0.5 * (static_cast<double>(after.heading_rad) - static_cast<double>(before.heading_rad));
    turn = {0, static_cast<float>(std::sin(half)), 0, static_cast<float>(std::cos(half))};
  }
  Vec3<float> operator()(const Vec3<float>& p) const {
    const Vec3<float> relative{static_cast<float>(static_cast<double>(p.x) - from.x_m), p.y,
                               static_cast<float>(static_cast<double>(p.z) - from.z_m)};
    const Vec3<float> turned = rotated(turn, relative);
    return {static_cast<float>(static_cast<double>(turned.x) + to.x_m), turned.y,
            static_cast<float>(static_cast<double>(turned.z) + to.z_m)};
  }
};

void move_pose(const RootStep& step, Pose<float>& pose) {
  for (std::size_t s = 0; s < segment_count; ++s) {
    pose.position_m[s] = step(pose.position_m[s]);
    pose.rotation[s] = product(step.turn, pose.rotation[s]);
  }
}

void move_points(const RootStep& step, std::vector<Vec3<float>>& points) {
  for (Vec3<float>& p : points) p = step(p);
}

/// Moves the forces of feet on the ground. A foot in the air keeps its zeros.
void move_ground(const RootStep& step, GroundReaction<float>& ground) {
  for (const std::size_t side : {0U, 1U}) {
    if (ground.force_n[side].y == 0) continue;
    ground.force_n[side] = rotated(step.turn, ground.force_n[side]);
    ground.centre_m[side] = step(ground.centre_m[side]);
  }
}

/// Moves frame `f` of a recorded walk.
void move_frame(const RootStep& step, std::size_t f, WalkRecording& recording) {
  move_pose(step, recording.frames[f]);
  if (!recording.around.empty())
    for (Pose<float>& pose : recording.around[f]) move_pose(step, pose);
  if (!recording.ground.empty()) move_ground(step, recording.ground[f]);
  for (RecordedMuscle& muscle : recording.muscles) move_points(step, muscle.position_m[f]);
  for (SkinnedSurface& surface : recording.skin)
    if (!surface.drawn_m.empty()) move_points(step, surface.drawn_m[f]);
}

double length_m(const Vec3<float>& v) {
  return std::sqrt(static_cast<double>(v.x * v.x + v.y * v.y + v.z * v.z));
}

double largest_gap_m(const std::vector<Vec3<float>>& a, const std::vector<Vec3<float>>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, length_m(a[i] - b[i]));
  return largest;
}

}  // namespace

void put_in_place(WalkRecording& recording) {
  for (std::size_t f = 0; f < recording.frames.size(); ++f) move_frame({recording.root[f], {}}, f, recording);
  recording.root.clear();
}

void put_in_place(CrowdRecording& recording) {
  for (RecordedPerson& person : recording.people) {
    const RecordedRoot first = person.root.front();
    for (std::size_t f = 0; f < person.frames.size(); ++f) {
      const RootStep step(person.root[f], first);
      move_pose(step, person.frames[f]);
      for (RecordedMuscle& muscle : person.muscles) move_points(step, muscle.position_m[f]);
      person.root[f] = first;
    }
  }
}

CycleGap close_cycle(WalkRecording& recording) {
  const RecordedRoot first = recording.root.front();
  for (std::size_t f = 0; f < recording.frames.size(); ++f) {
    RecordedRoot& root = recording.root[f];
    const RecordedRoot moved{root.x_m - first.x_m, root.z_m - first.z_m, root.heading_rad};
    move_frame({root, moved}, f, recording);
    root = moved;
  }
  const std::size_t last = recording.frames.size() - 1;
  const RootStep step(recording.root.front(), recording.root.back());
  recording.loops = true;
  CycleGap gap;
  Pose<float> closed = recording.frames.front();
  move_pose(step, closed);
  for (std::size_t s = 0; s < segment_count; ++s)
    gap.joints_m = std::max(gap.joints_m, length_m(closed.position_m[s] - recording.frames[last].position_m[s]));
  recording.frames[last] = closed;
  if (!recording.around.empty()) {
    recording.around[last] = recording.around.front();
    for (Pose<float>& pose : recording.around[last]) move_pose(step, pose);
  }
  if (!recording.ground.empty()) {
    recording.ground[last] = recording.ground.front();
    move_ground(step, recording.ground[last]);
  }
  const auto close = [&](std::vector<std::vector<Vec3<float>>>& frames) {
    std::vector<Vec3<float>> again = frames.front();
    move_points(step, again);
    const double gap_m = largest_gap_m(again, frames[last]);
    frames[last] = std::move(again);
    return gap_m;
  };
  for (RecordedMuscle& muscle : recording.muscles) gap.muscles_m = std::max(gap.muscles_m, close(muscle.position_m));
  for (SkinnedSurface& surface : recording.skin)
    if (!surface.drawn_m.empty()) close(surface.drawn_m);
  return gap;
}

}  // namespace mobil::inline v0_3
