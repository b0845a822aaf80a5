#include <mobil/assets/surfaces/skin_binding.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include <mobil/anthropometry.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;
using enum Segment;

/// Shares of a point that the arm and each leg carry.
struct Share {
  double arm;    // 0 trunk, 1 arm
  double left;   // of the legs' part: 0 the right leg's, 1 the left leg's
  double thigh;  // 0 pelvis, 1 thigh
};

Share share_of(const form::BodyForm& form, const Vec& p) {
  const double size = form.size();
  const Vec q{-std::abs(p.x), p.y, p.z};
  const form::BodyForm::Parts part = form.parts(p);
  const Vec in_arm = form.in_arm(q);
  const double down = form.arm().shoulder().y - in_arm.y;
  Share share{};
  if (q.x < -0.10 * size) {
    share.arm = 1 / (1 + std::exp((part.arm - std::min(part.trunk, part.leg)) / 0.012));
    share.arm *= smoothstep(-0.06 * size, 0.07 * size, down);
    if (share.arm < 1e-3) share.arm = 0;
  }
  share.left = smoothstep(-0.03 * size, 0.03 * size, p.x);
  share.thigh = smoothstep(-hip_bend.above_m * size, hip_bend.below_m * size, form.leg().hip().y - form.in_leg(q).y);
  return share;
}

Vec at_rest(const form::BodyForm& form, const Vec& p, const Share& share) {
  const double side = p.x > 0 ? -1 : 1;
  const Vec right{side * p.x, p.y, p.z};  // mirrored to the right
  if (share.arm > 0) {
    const Vec r = form.in_arm(right, share.arm);
    return {side * r.x, r.y, r.z};
  }
  // The leg of the other side carries a part of points near the middle.
  const Vec own = form.in_leg(right, share.thigh);
  const Vec other = form.in_leg({-right.x, right.y, right.z}, share.thigh);
  const double far = side > 0 ? share.left : 1 - share.left;
  return {side * ((1 - far) * own.x - far * other.x), (1 - far) * own.y + far * other.y, own.z};
}

class Binder {
 public:
  Binder(const form::BodyForm& form, const Body& body, int turns)
      : form_(form), rest_(standing_pose(body)), turns_(turns) {}

  SkinBinding bind(const std::vector<Vec>& place) {
    for (const Vec& p : place) bind(p);
    sort_frames();
    return std::move(binding_);
  }

 private:
  Vec origin(Segment s) const { return to_double(rest_.position_m[index(s)]); }

  void add(double weight, std::size_t from, std::size_t to, double turn) {
    if (weight < 1e-4) return;
    turn = std::round(turns_ * turn) / turns_;
    // A vertex that turns fully with one segment is rigid.
    if (turn == 0) to = from;
    if (turn == 1) from = to;
    if (from == to) turn = 0;
    const auto key = std::tuple(from, to, turn);
    const auto [found, is_new] = known_.try_emplace(key, static_cast<std::uint16_t>(binding_.frame.size()));
    if (is_new)
      binding_.frame.push_back(
          {static_cast<std::uint8_t>(from), static_cast<std::uint8_t>(to), static_cast<float>(turn)});
    taken_.push_back({weight, found->second});
  }
  /// Returns a joint's turn `at` a distance beyond it; the joint bends between −before and +after.
  double bent(double at, double before, double after) const {
    return smoothstep(-before * form_.size(), after * form_.size(), at);
  }

  void bind(const Vec& p) {
    taken_.clear();
    const Share share = share_of(form_, p);
    const Vec r = at_rest(form_, p, share);
    const std::size_t side = p.x > 0 ? 1 : 0;
    // Skin on the shoulder alone, and skin that also follows the trunk.
    const double arm = smoothstep(0, 0.2, share.arm);
    if (arm > 0) add_arm(arm, share.arm, r, side);
    const double above = r.y - form_.leg().hip().y;
    const double trunk = smoothstep(0.14 * form_.size(), 0.24 * form_.size(), above);
    add_trunk((1 - arm) * trunk, r);
    add_leg((1 - arm) * (1 - trunk) * (1 - share.left), share.thigh, r, 0);
    add_leg((1 - arm) * (1 - trunk) * share.left, share.thigh, r, 1);
    finish(r);
  }

  void add_arm(double weight, double turn, const Vec& r, std::size_t side) {
    const std::size_t upper = index(on_side(upper_arm_right, side)), fore = index(on_side(forearm_right, side)),
                      hand = index(on_side(hand_right, side)), fingers = index(on_side(fingers_right, side)),
                      untwisted = untwisted_forearm(side);
    const double size = form_.size(), elbow = origin(forearm_right).y - r.y, wrist = origin(hand_right).y - r.y;
    const double out = side == 0 ? -1 : 1;
    const Vec knuckles = origin(on_side(fingers_right, side)), thumb = origin(on_side(thumb_right, side));
    if (elbow < -0.05 * size) return add(weight, index(on_side(clavicle_right, side)), upper, turn);
    const double bend = bent(elbow, 0.05, 0.05);
    if (bend < 1) return add(weight, upper, untwisted, bend);
    const double twist = smoothstep(0.05 * size, 0.22 * size, elbow), flat = bent(wrist, 0.03, 0.03);
    if (flat <= 0) return add(weight, untwisted, fore, twist);
    if (flat < 1) return add(weight, fore, hand, flat);
    // The thumb is farther out than the palm, below its root.
    const double off_palm = out * (r.x - knuckles.x) - (0.036 + 0.10 * std::max(0.0, knuckles.y - r.y)) * size;
    const bool is_thumb = off_palm > 0 && r.y < thumb.y;
    const double of_thumb = is_thumb ? smoothstep(0, 0.012 * size, off_palm) * bent(thumb.y - r.y, -0.010, 0.040) : 0;
    if (of_thumb > 0) return add(weight, hand, index(on_side(thumb_right, side)), of_thumb);
    add(weight, hand, fingers, bent(knuckles.y - r.y, 0.012, 0.012));
  }

  void add_trunk(double weight, const Vec& r) {
    const std::size_t last = index(head);
    const double size = form_.size(), lowest = origin(L5).y - 0.04 * size;
    const double up = smoothstep(1.535 * size, 1.600 * size, r.y + 0.6 * (r.z + 0.02 * size));
    add(weight * up, last, last, 0);
    weight *= 1 - up;
    if (r.y <= lowest) return add(weight, index(pelvis), index(pelvis), 0);
    // Vertebrae turn into each other from the middle of one to the middle of the next.
    const auto joint = [&](std::size_t k) { return rest_.position_m[k].y; };
    std::size_t k = 0;  // between the joints of k and of the one above
    while (k + 1 < last && static_cast<double>(joint(k + 1)) < r.y) ++k;
    const double low = k == 0 ? lowest : static_cast<double>(joint(k)), high = static_cast<double>(joint(k + 1));
    const double t = std::clamp((r.y - low) / (high - low), 0.0, 1.0);
    if (k == 0) return add(weight, k, k + 1, 0.5 * t);
    if (t < 0.5) return add(weight, k - 1, k, 0.5 + t);
    add(weight, k, k + 1, t - 0.5);
  }

  void add_leg(double weight, double thigh, const Vec& r, std::size_t side) {
    const std::size_t upper = index(on_side(thigh_right, side)), lower = index(on_side(shank_right, side)),
                      foot = index(on_side(foot_right, side)), toes = index(on_side(toes_right, side));
    // Behind the ankle skin bends lower than in front: it covers the tendon, which stays straight as the heel rises.
    const double behind = smoothstep(0, 0.035 * form_.size(), origin(foot_right).z - r.z);
    const double knee = bent(origin(shank_right).y - r.y, knee_bend.above_m, knee_bend.below_m),
                 ankle = bent(origin(foot_right).y - r.y, ankle_bend.above_m - 0.06 * behind,
                              ankle_bend.below_m - 0.01 * behind);
    if (thigh < 1) return add(weight, index(pelvis), upper, thigh);
    if (knee < 1) return add(weight, upper, lower, knee);
    if (ankle < 1) return add(weight, lower, foot, ankle);
    add(weight, foot, toes, bent(r.z - origin(toes_right).z, 0.022, 0.022));
  }

  void finish(const Vec& r) {
    std::ranges::sort(taken_, std::greater{}, &Taken::weight);
    if (taken_.size() > SkinVertex::max_frames) taken_.resize(SkinVertex::max_frames);
    double sum = 0;
    for (const Taken& taken : taken_) sum += taken.weight;
    SkinVertex vertex;
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      vertex.frame[i] = taken_[i].frame;
      vertex.weight[i] = static_cast<float>(taken_[i].weight / sum);
    }
    binding_.vertex.push_back(vertex);
    binding_.rest.push_back(r);
  }

  void sort_frames() {
    const std::vector<SkinFrame> unsorted = binding_.frame;
    std::vector<std::uint16_t> order(unsorted.size()), place(unsorted.size());
    std::iota(order.begin(), order.end(), std::uint16_t{0});
    std::ranges::sort(order, {},
                      [&](std::uint16_t i) { return std::tuple(unsorted[i].from, unsorted[i].to, unsorted[i].turn); });
    for (std::size_t i = 0; i < order.size(); ++i) {
      binding_.frame[i] = unsorted[order[i]];
      place[order[i]] = static_cast<std::uint16_t>(i);
    }
    for (SkinVertex& vertex : binding_.vertex) {
      for (std::size_t k = 0; k < SkinVertex::max_frames; ++k)
        if (vertex.weight[k] != 0) vertex.frame[k] = place[vertex.frame[k]];
    }
  }

  struct Taken {
    double weight;
    std::uint16_t frame;
  };
  const form::BodyForm& form_;
  Pose<float> rest_;
  double turns_;
  SkinBinding binding_;
  std::vector<Taken> taken_;
  std::map<std::tuple<std::size_t, std::size_t, double>, std::uint16_t> known_;
};

}  // namespace

SkinBinding bind_skin(const form::BodyForm& form, const Body& body, const std::vector<Vec>& place, int turns) {
  return Binder(form, body, turns).bind(place);
}

std::vector<Vec> skin_at_rest(const form::BodyForm& form, const std::vector<Vec>& place) {
  std::vector<Vec> rest;
  rest.reserve(place.size());
  for (const Vec& p : place) rest.push_back(at_rest(form, p, share_of(form, p)));
  return rest;
}

}  // namespace mobil::inline v0_3
