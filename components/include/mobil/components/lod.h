#pragma once
// Level of detail of one person: request and decision. Both are stored on the person's row.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>

namespace mobil::inline v0_3 {

/// Request for one person. `own`: bits of OwnNeed for the values that the person overrides; the scene sets all others.
/// `muscles`: one bit a muscle, muscle m in word m / 32. `tolerance_m`: tolerated error of control points.
template <class F>
struct LodRequest {
  static constexpr std::uint64_t stable_id = 0xac0dbd2fe7aa7417;
  UInt32<F> own, looked_at, muscles[max_muscles / 32];
  F tolerance_m;
};
enum OwnNeed : std::uint32_t { own_muscles = 1, own_tolerance = 2, own_look = 4 };

/// Visibility of a person: within sight; near but out of sight; out of sight; out of reach.
enum class View : std::uint8_t { seen, near, out_of_sight, out_of_reach };
inline constexpr std::array<std::string_view, 4> view_name = {"seen", "near", "out of sight", "out of reach"};

/// Decision for one person. `level` and `goal`: the current and the scheduled level of each muscle, four bits a muscle,
/// muscle m in word m / 8; they differ while a switch waits. `points` and `goal_points`: one bit a muscle, set if its
/// control points are placed. `effects`: bits of LodFlags. `tolerance_m`: tolerance at the last decision.
/// `relative_size`: factor from the table's errors to this person's (size and margin). `speed_step`: the table's speed
/// class.
template <class F>
struct LodState {
  static constexpr std::uint64_t stable_id = 0xba57c91d4f94a3f7;
  UInt32<F> level[max_muscles / 8], goal[max_muscles / 8];
  UInt32<F> points[max_muscles / 32], goal_points[max_muscles / 32], muscles[max_muscles / 32];
  UInt32<F> view, speed_step, effects;
  F tolerance_m, relative_size;
};
/// Levels of the table that apply to a person: those with inertia; those of active muscles, unless
/// LegMuscles::finite_shape is switched off. `lod_bare`: the person woke without muscles, and gets them when one of
/// them must be simulated.
enum LodFlags : std::uint32_t { lod_inertia = 1, lod_active = 2, lod_bare = 4 };

}  // namespace mobil::inline v0_3
