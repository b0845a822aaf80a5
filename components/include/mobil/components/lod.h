#pragma once
// What a scene needs of a person's muscles, and what was decided of it: state like any other, on the person's row.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>

namespace mobil::inline v0_3 {

/// What is asked of one person. `own`: bits of OwnNeed, of what the person has a need of its own of; all else is the
/// scene's. `muscles`: a bit each; `tolerance_m`: of control points.
template <class F>
struct LodRequest {
  static constexpr std::uint64_t stable_id = 0xac0dbd2fe7aa7417;
  UInt32<F> own, muscles, looked_at;
  F tolerance_m;
};
enum OwnNeed : std::uint32_t { own_muscles = 1, own_tolerance = 2, own_look = 4 };

/// Where a person is for the viewer: within sight; near by but out of sight; out of sight; out of reach.
enum class View : std::uint8_t { seen, near, out_of_sight, out_of_reach };
inline constexpr std::array<std::string_view, 4> view_name = {"seen", "near", "out of sight", "out of reach"};

/// What was decided for one person. `level` and `goal`: four bits a muscle, muscle m in word m / 8, of what runs and of
/// what is to (they differ while a switch waits); `points` and `goal_points`: a bit a muscle, whether control points
/// are placed; `effects`: bits of LodFlags. `tolerance_m` is what was asked when it was last decided; `relative_size`
/// how much larger than the table's an error of this person's is (size and margin); `speed_step` of the table (accuracy
/// by speed).
template <class F>
struct LodState {
  static constexpr std::uint64_t stable_id = 0xba57c91d4f94a3f7;
  UInt32<F> level[max_muscles / 8], goal[max_muscles / 8];
  UInt32<F> points, goal_points;
  UInt32<F> view, muscles, speed_step, effects;
  F tolerance_m, relative_size;
};
/// Which of the table's levels and figures are a person's: of muscles with inertia; of muscles that pull, unless
/// LegMuscles::finite_shape has been switched off for them.
/// `lod_bare`: the person woke without muscles, and gets them when one of them is to be simulated.
enum LodFlags : std::uint32_t { lod_inertia = 1, lod_active = 2, lod_bare = 4 };

}  // namespace mobil::inline v0_3
