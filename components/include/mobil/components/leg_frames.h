#pragma once
// Positions and rotations of one leg's bones, as its lines of action need them.

#include <cstdint>

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// World positions (m) of a leg's joint centres and world rotations of its bones. A left leg is stored as its mirror
/// image (position x → −x, quaternion (x, y, z, w) → (x, −y, −z, w)), so that every leg here is a right one.
template <class F>
struct LegFrames {
  Vec3<F> hip_m, knee_m, ankle_m;
  Quat<F> pelvis, thigh, shank, foot;
};

/// A leg's bones in the frame of its own knee: origin at the knee joint, axes of the thigh, m. `pelvis` and `foot` are
/// the axes x, y and z of these bones in that frame. The shank is turned about x by the flexion, whose sine and cosine
/// are stored. A left leg is mirrored, as in LegFrames.
template <class F>
struct KneeFrame {
  Vec3<F> hip_m, ankle_m;
  Vec3<F> pelvis[3], foot[3];
  F flexion_rad, sine, cosine;
};

/// Progress of a leg in the walk: elapsed fraction of the gait cycle since its own heel strike, 0 to 1; and the walk's
/// speed over √(g · leg), 0 for standing and posed people.
template <class F>
struct LegClock {
  F cycle, speed;
};

/// Both legs of a person, right first, published for the lookups of their muscles.
struct PublishedLeg {
  static constexpr std::uint64_t stable_id = 0x70b491471d4294ea;
  struct alignas(64) Leg {
    LegFrames<float> frames;
    LegClock<float> clock;
  };
  Leg leg[2];
};

/// Sizes of a leg relative to the leg of the published paths: thigh length, shank length, and their sum for muscles
/// that span both.
template <class F>
struct LegScale {
  F thigh, shank, across;
};

}  // namespace mobil::inline v0_3
