#pragma once
// The room of a drawn muscle: inside the skin, outside bones and the muscle beneath. Rings of vertices are cut back to
// it.

#include <span>
#include <vector>

#include <mobil/assets/body/leg_profile.h>
#include <mobil/assets/muscles/leg_sections.h>
#include <mobil/components/body.h>
#include "assets/surfaces/distance_field.h"
#include "assets/surfaces/leg_bones.h"

namespace mobil::inline v0_3 {

/// Returns the mean of a ring's vertices.
Vec3<double> ring_middle(std::span<const Vec3<float>> ring);

/// Skin of a right leg and hip without the arm, the body standing at x = z = 0.
class SkinRoom {
 public:
  SkinRoom(const Body& body, const LegFrame& leg);
  const LegProfile& profile() const { return profile_; }
  /// Widens the skin about the leg's line by a factor of at least 1.
  void widen(double factor) { wider_ = factor; }
  /// Returns the distance from the skin, negative inside, m: the profile's at the leg, the body form's at the hip.
  double distance(const Vec3<double>& at) const;

 private:
  LegFrame leg_;
  LegProfile profile_;
  DistanceField hip_;
  double wider_ = 1;
};

/// Cuts a ring back to `cover_m` inside the skin, each vertex along its ray from the ring's middle. The ring is moved
/// in first if its middle is too near the skin.
void keep_in(const SkinRoom& skin, double cover_m, std::span<Vec3<float>> ring);

/// Cuts a ring back to `gap_m` outside the drawn bones, each vertex along its ray from the ring's middle. The ring is
/// moved out first if its middle is within.
void keep_out(const LegBones& bones, double gap_m, std::span<Vec3<float>> ring);

/// Cuts a horizontal ring back to the outside of a bone or muscle whose horizontal sections are given, in the same way.
void keep_off(const LegFrame& leg, std::span<const LegSection> beneath, std::span<Vec3<float>> ring);

/// Cuts a horizontal ring back to `gap_m` outside the drawn muscle beneath, whose horizontal rings are given from
/// above, in the same way.
void keep_off(std::span<const std::vector<Vec3<float>>> beneath, double gap_m, std::span<Vec3<float>> ring);

}  // namespace mobil::inline v0_3
