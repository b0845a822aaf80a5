#include "assets/export/joint_angles.h"

#include <cmath>
#include <numbers>

namespace mobil::inline v0_3 {
namespace {

constexpr double half_turn = std::numbers::pi, whole_turn = 2 * std::numbers::pi;

/// Returns the same direction, as near to `before` as whole turns bring it.
double unwound(double angle, double before) {
  return angle - whole_turn * std::round((angle - before) / whole_turn);
}

JointTurn unwound(const JointTurn& turn, const JointTurn& before) {
  return {unwound(turn.x, before.x), unwound(turn.z, before.z), unwound(turn.y, before.y)};
}

double distance(const JointTurn& a, const JointTurn& b) {
  return std::abs(a.x - b.x) + std::abs(a.z - b.z) + std::abs(a.y - b.y);
}

}  // namespace

std::vector<JointTurn> joint_turns(const std::vector<Eigen::Quaterniond>& rotation) {
  std::vector<JointTurn> turns;
  turns.reserve(rotation.size());
  for (const auto& q : rotation) {
    const Eigen::Matrix3d r = q.toRotationMatrix();
    const double cosine = std::hypot(r(1, 1), r(2, 1));
    JointTurn turn{std::atan2(r(2, 1), r(1, 1)), std::atan2(-r(0, 1), cosine), std::atan2(r(0, 2), r(0, 0))};
    if (cosine < 1e-6) {  // x and y turn about the same axis: x takes the whole turn
      turn.x = std::atan2(-r(1, 2), r(2, 2));
      turn.y = 0;
    }
    if (!turns.empty()) {
      const JointTurn& before = turns.back();
      const JointTurn one = unwound(turn, before);
      const JointTurn other = unwound({turn.x + half_turn, half_turn - turn.z, turn.y + half_turn}, before);
      turn = distance(other, before) < distance(one, before) ? other : one;
    }
    turns.push_back(turn);
  }
  return turns;
}

std::vector<Eigen::Quaterniond> turned_against(const SkeletonKeys& skeleton, Segment parent, Segment child) {
  std::vector<Eigen::Quaterniond> turned;
  turned.reserve(skeleton.world.size());
  for (const auto& frame : skeleton.world) {
    turned.push_back(frame[index(parent)].rotation.conjugate() * frame[index(child)].rotation);
  }
  return turned;
}

}  // namespace mobil::inline v0_3
