#include "demo/walk/recorded_scene.h"

#include <cmath>

#include <mobil/engine/geometry.h>

namespace mobil {
namespace {

using namespace geometry;

/// sRGB as the renderer takes it, from the recording's linear colour.
Colour display_colour(const Vec3<float>& linear) {
  const auto encode = [](float x) { return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F; };
  return {encode(linear.x), encode(linear.y), encode(linear.z)};
}

}  // namespace

void add_bones(const WalkRecording& recording, std::size_t frame, const Vec3<float>& shift, std::uint64_t first_key,
               RecordedScene& scene) {
  const Pose<float>& pose = recording.frames[frame];
  for (std::size_t i = 0; i < recording.bones.size(); ++i) {
    const BoneSurface& bone = recording.bones[i];
    const std::size_t s = index(bone.segment);
    scene.placement.push_back({.position = pose.position_m[s] + shift, .rotation = pose.rotation[s]});
    scene.meshes.push_back({.position = bone.mesh.position,
                            .triangle = bone.mesh.triangle,
                            .colour = bone_ivory,
                            .placement = {&scene.placement.back(), 1},
                            .key = first_key == 0 ? 0 : first_key + i});
  }
}

LegVertices muscles_of(const WalkRecording& recording, std::size_t frame) {
  LegVertices muscles;
  for (const RecordedMuscle& muscle : recording.muscles) {
    auto& own = muscles[muscle.name.ends_with("_left") ? Side::left : Side::right];
    own.insert(own.end(), muscle.position_m[frame].begin(), muscle.position_m[frame].end());
  }
  return muscles;
}

void add_muscles(const WalkRecording& recording, std::size_t frame, const Vec3<float>& shift, RecordedScene& scene) {
  for (const RecordedMuscle& muscle : recording.muscles) {
    scene.placement.push_back({.position = shift});
    scene.meshes.push_back({.position = muscle.position_m[frame],
                            .triangle = muscle.triangle,
                            .colour = display_colour(muscle.colour),
                            .wetness = 0.5F,
                            .placement = {&scene.placement.back(), 1}});
  }
}

}  // namespace mobil
