#pragma once
// How a body's skin hangs on its segments. Every joint turns its skin about the one point that both segments share:
// where a vertex turns with a part of the joint's angle it keeps its distance from the joint, which a mean of two
// places would not.

#include <array>
#include <cstdint>
#include <vector>

#include <mobil/assets/surfaces/body_form.h>
#include <mobil/components/segments.h>

namespace mobil::inline v0_3 {

/// A frame between two segments: `turn` of the way from `from`'s rotation to `to`'s, about the origin of `to`.
struct SkinFrame {
  std::uint8_t from, to;  // Segment, or untwisted_forearm
  float turn;
  bool operator==(const SkinFrame&) const = default;
};
/// The forearm of either side as the elbow alone would turn it, without the pronation about its own length, which the
/// skin takes up evenly from elbow to wrist.
constexpr std::uint8_t untwisted_forearm(std::size_t side) {
  return static_cast<std::uint8_t>(segment_count + side);
}
inline constexpr std::size_t skin_segments = segment_count + 2;
/// A frame's segment: the forearm of an untwisted one.
constexpr std::size_t segment_of(std::uint8_t s) {
  return s < segment_count ? s : index(on_side(Segment::forearm_right, s - segment_count));
}
/// How far above and below a joint of the leg its skin bends, m of a body of 1.75 m; at the ankle, in front.
struct SkinBend {
  double above_m, below_m;
};
inline constexpr SkinBend hip_bend{0.12, 0.20}, knee_bend{0.10, 0.10}, ankle_bend{0.09, 0.02};

/// Weights add up to 1; frames that are not used weigh 0.
struct SkinVertex {
  static constexpr std::size_t max_frames = 4;
  std::array<std::uint16_t, max_frames> frame{};
  std::array<float, max_frames> weight{};
};

struct SkinBinding {
  std::vector<SkinFrame> frame;  // those between the same two segments one after the other
  std::vector<SkinVertex> vertex;
  std::vector<Vec3<double>> rest;  // in the anatomical position, m
};

/// Binds places in the pose that is meshed (body_form.h) and brings them into the anatomical position. `turns`: steps
/// of a joint's angle that vertices share a frame for.
SkinBinding bind_skin(const form::BodyForm& form, const Body& body, const std::vector<Vec3<double>>& place, int turns);

/// Brings places that are bound already, of another body's surface, into the anatomical position.
std::vector<Vec3<double>> skin_at_rest(const form::BodyForm& form, const std::vector<Vec3<double>>& place);

}  // namespace mobil::inline v0_3
