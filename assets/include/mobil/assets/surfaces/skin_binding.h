#pragma once
// Binding of a body's skin to its segments. Every joint turns its skin about the one point that both segments share. A
// vertex that turns by a part of the joint's angle keeps its distance from the joint, unlike a mean of two positions.

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
/// Returns the forearm of either side as the elbow alone would turn it. The skin takes up the pronation about its
/// length evenly from elbow to wrist.
constexpr std::uint8_t untwisted_forearm(std::size_t side) {
  return static_cast<std::uint8_t>(segment_count + side);
}
inline constexpr std::size_t skin_segments = segment_count + 2;
/// Returns a frame's segment; for an untwisted forearm, the forearm.
constexpr std::size_t segment_of(std::uint8_t s) {
  return s < segment_count ? s : index(on_side(Segment::forearm_right, s - segment_count));
}
/// Extent of bending skin above and below a joint of the leg, m for a body of 1.75 m; at the ankle, in front.
struct SkinBend {
  double above_m, below_m;
};
inline constexpr SkinBend hip_bend{0.12, 0.20}, knee_bend{0.10, 0.10}, ankle_bend{0.09, 0.02};

/// Frames of a vertex. Weights add up to 1; unused frames have weight 0.
struct SkinVertex {
  static constexpr std::size_t max_frames = 4;
  std::array<std::uint16_t, max_frames> frame{};
  std::array<float, max_frames> weight{};
};

struct SkinBinding {
  std::vector<SkinFrame> frame;  // those between the same two segments are adjacent
  std::vector<SkinVertex> vertex;
  std::vector<Vec3<double>> rest;  // in the anatomical position, m
};

/// Binds points of the meshing pose (body_form.h) and moves them to the anatomical position. `turns` is the number of
/// steps of a joint's angle for which vertices share a frame.
SkinBinding bind_skin(const form::BodyForm& form, const Body& body, const std::vector<Vec3<double>>& place, int turns);

/// Moves points of another body's surface, which are bound already, to the anatomical position.
std::vector<Vec3<double>> skin_at_rest(const form::BodyForm& form, const std::vector<Vec3<double>>& place);

}  // namespace mobil::inline v0_3
