#pragma once
// What makes an individual: what was asked for, and the sizes that follow.

#include <array>
#include <cstdint>

#include "components/lanes.h"
#include "components/segments.h"

namespace mobil {

enum class Constitution : std::uint8_t { thin, average, athletic, heavy };

/// Heath–Carter somatotype, each part from 1 (little) to about 7 (much).
struct Biotype {
  float endo = 3, meso = 4, ecto = 3;
};

/// What a caller asks of a body. Ranges: height 1.2–2.2 m, mass 30–200 kg, each part of the biotype 0.1–12.
struct BodyRequest {
  float height_m = 1.75F;
  float mass_kg = 75.0F;
  Biotype biotype{};
  Constitution constitution = Constitution::average;
};

/// One individual's skeleton, host side: made once at spawn by `make_body` (assets/anthropometry.h).
/// Frames: every segment's origin is its proximal joint (thigh: hip centre, shank: knee, foot: ankle, toes: ball of
/// the foot, pelvis: midpoint of the hip centres, patella: its centre); in the anatomical position all rotations are
/// identity, +Y up, +Z forward, +X left.
struct Body {
  BodyRequest request;
  /// Origin of each segment in its parent's frame, m; the pelvis: its height over the ground when standing.
  std::array<Vec3<float>, segment_count> joint_offset_m;
  /// Centre of mass of each segment in its own frame, m.
  std::array<Vec3<float>, segment_count> centre_of_mass_m;
  /// Farthest point of each segment along its own axis (its distal joint, or its tip), in its own frame, m.
  std::array<Vec3<float>, segment_count> tip_m;
  std::array<float, segment_count> mass_kg;
  /// Lowest points of the foot in the foot's frame, right side, m: under the heel, and under the ball.
  Vec3<float> heel_m, ball_m;
  float thigh_length_m, shank_length_m;
  /// Hip centre over the ground when standing upright with straight knees, m.
  float hip_height_m;
};

/// The few sizes that per-tick kernels read; all other lengths are these times a constant.
template <class F>
struct BodySize {
  F height_m;
  F mass_kg;
};

}  // namespace mobil
