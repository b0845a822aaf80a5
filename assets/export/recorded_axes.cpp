#include <mobil/assets/export/recorded_axes.h>

#include <vector>

namespace mobil::inline v0_3 {
namespace {

void turn(Vec3<float>& v) {
  v = {-v.x, v.y, -v.z};
}

void turn(std::vector<Vec3<float>>& values) {
  for (Vec3<float>& v : values) turn(v);
}

void turn(Pose<float>& pose) {
  for (Vec3<float>& p : pose.position_m) turn(p);
  for (Quat<float>& q : pose.rotation) q = {-q.x, q.y, -q.z, q.w};
}

void turn(GroundReaction<float>& ground) {
  for (Vec3<float>& force : ground.force_n) turn(force);
  for (Vec3<float>& centre : ground.centre_m) turn(centre);
}

void turn(RecordedMuscle& muscle) {
  for (auto& frame : muscle.position_m) turn(frame);
}

void turn(SkinnedSurface& surface) {
  turn(surface.position);
  turn(surface.normal);
  for (auto& t : surface.tangent) t = {-t[0], t[1], -t[2], t[3]};
  for (auto& frame : surface.drawn_m) turn(frame);
}

template <class Values>
void turn_each(Values& values) {
  for (auto& value : values) turn(value);
}

void turn_bones(std::vector<BoneSurface>& bones) {
  for (BoneSurface& bone : bones) turn(bone.mesh.position);
}

void turn_roots(std::vector<RecordedRoot>& roots) {
  for (RecordedRoot& root : roots) root = {-root.x_m, -root.z_m, root.heading_rad};
}

}  // namespace

void put_z_back(WalkRecording& recording) {
  recording.z_back = !recording.z_back;
  turn_each(recording.frames);
  for (auto& around : recording.around) turn_each(around);
  turn_bones(recording.bones);
  turn_each(recording.muscles);
  turn_each(recording.ground);
  turn_each(recording.skin);
  turn_each(recording.standing_m);
  turn(recording.tip_m);
  turn_roots(recording.root);
}

void put_z_back(CrowdRecording& recording) {
  recording.z_back = !recording.z_back;
  for (RecordedFigure& figure : recording.figures) {
    turn_bones(figure.surfaces);
    turn_each(figure.skin);
    turn_each(figure.standing_m);
  }
  for (RecordedPerson& person : recording.people) {
    turn_each(person.frames);
    turn_each(person.muscles);
    turn_roots(person.root);
  }
}

}  // namespace mobil::inline v0_3
