// A game's own animation, here squats, on a skeleton of 14 bones (centimetres, z up, left-handed, x forward) drives a
// person with muscles.

#include <array>
#include <cmath>
#include <cstdio>

#include <mobil/forces.h>
#include <mobil/retarget.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>

namespace {

enum Bone {
  hips,
  belly,
  chest,
  head,
  upper_arm_r,
  forearm_r,
  upper_arm_l,
  forearm_l,
  thigh_r,
  calf_r,
  foot_r,
  thigh_l,
  calf_l,
  foot_l,
  bone_count
};
using Bones = std::array<mobil::BonePlace, bone_count>;

/// Returns a rotation about y, the axis to the right. A positive angle moves points below the axis back.
mobil::Quat<float> pitched(float angle_rad) {
  return {0, std::sin(angle_rad / 2), 0, std::cos(angle_rad / 2)};
}

/// Returns a pose of the game's animation with these angles of hips, knees and chest, rad. The feet stay level.
Bones squat(float hip, float knee, float lean) {
  constexpr float thigh_cm = 44, calf_cm = 44, ankle_cm = 7;
  const float shank = knee - hip;  // tilt from upright
  Bones bones;
  const float ahead = calf_cm * std::sin(shank), up = ankle_cm + calf_cm * std::cos(shank);
  const float hip_x = ahead - thigh_cm * std::sin(hip), hip_z = up + thigh_cm * std::cos(hip);
  for (const auto& [thigh, y] : {std::pair{thigh_r, 8.0F}, std::pair{thigh_l, -8.0F}}) {
    bones[thigh] = {{hip_x, y, hip_z}, pitched(-hip)};
    bones[thigh + 1] = {{ahead, y, up}, pitched(shank)};
    bones[thigh + 2] = {{0, y, ankle_cm}, pitched(0)};
  }
  bones[hips] = {{hip_x, 0, hip_z}, pitched(0)};
  bones[belly] = {{hip_x, 0, hip_z + 12}, pitched(lean / 2)};
  bones[chest] = {{hip_x, 0, hip_z + 30}, pitched(lean)};
  bones[head] = {{hip_x, 0, hip_z + 62}, pitched(0)};
  for (const auto& [arm, y] : {std::pair{upper_arm_r, 20.0F}, std::pair{upper_arm_l, -20.0F}}) {
    bones[arm] = {{hip_x, y, hip_z + 50}, pitched(lean)};
    bones[arm + 1] = {{hip_x, y * 2.4F, hip_z + 50}, pitched(lean)};
  }
  return bones;
}

int failed(const mobil::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 2;
}

}  // namespace

int main() {
  mobil::Simulation simulation;
  mobil::SkeletonBones bones;
  bones.pelvis = hips;
  bones.spine = {belly, chest};
  bones.head = head;
  bones.limbs[mobil::Side::right] = {
      .thigh = thigh_r, .shank = calf_r, .foot = foot_r, .upper_arm = upper_arm_r, .forearm = forearm_r};
  bones.limbs[mobil::Side::left] = {
      .thigh = thigh_l, .shank = calf_l, .foot = foot_l, .upper_arm = upper_arm_l, .forearm = forearm_l};
  const mobil::BoneUnits unreal{mobil::PoseAxes::z_up_left_handed, 100};
  const Bones rest = squat(0, 0, 0);
  const auto limbs = mobil::limb_lengths(bones, rest, unreal);
  if (!limbs) return failed(limbs.error());
  const auto person = simulation.spawn_posed({.height_m = 1.8F, .mass_kg = 80, .limbs = *limbs});
  if (!person) return failed(person.error());
  const auto map = mobil::Retarget::make(simulation.person(*person)->body, bones, rest, unreal);
  if (!map) return failed(map.error());
  if (const auto done = simulation.set_muscles(*person); !done) return failed(done.error());
  if (const auto done = simulation.enable(*person, mobil::Feature::forces); !done) return failed(done.error());
  const mobil::Entity quadriceps = simulation.muscle(*person, mobil::Muscle::quadriceps, mobil::Side::right);
  float longest_m = 0, deepest_rad = 0, max_n = 0;
  for (int tick = 0; tick <= 240; ++tick) {
    const float part = 0.5F - 0.5F * std::cos(static_cast<float>(tick) * 0.0262F);
    const auto pose = map->pose(squat(0.9F * part, 1.6F * part, 0.4F * part));
    if (!pose) return failed(pose.error());
    if (const auto done = simulation.set_pose(*person, *pose); !done) return failed(done.error());
    simulation.tick();
    const auto line = *simulation.get<mobil::LineOfAction>(quadriceps);
    const float knee = simulation.get<mobil::JointAngles>(*person)->knee_flexion[mobil::Side::right];
    longest_m = std::max(longest_m, line.length_m - line.rest_length_m);
    deepest_rad = std::max(deepest_rad, knee);
    const auto ground = *simulation.get<mobil::GroundReaction>(*person);
    const float up_n = ground.force_n[mobil::Side::right].y + ground.force_n[mobil::Side::left].y;
    max_n = std::max(max_n, up_n);
    if (tick % 60 == 0)
      std::printf("%.0f s: knee %3.0f deg, quadriceps %+3.0f mm, %3.0f N on the ground\n", tick / 60.0,
                  57.3 * static_cast<double>(knee), 1e3 * static_cast<double>(line.length_m - line.rest_length_m),
                  static_cast<double>(up_n));
  }
  // Knees bend, knee extensors lengthen, and standing up takes more force than the weight.
  return deepest_rad > 1.5F && longest_m > 0.02F && max_n > 80 * 9.81F ? 0 : 1;
}
