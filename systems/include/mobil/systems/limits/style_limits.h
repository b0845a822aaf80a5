#pragma once
// Styles of which each number is in its range, and which together would put a foot under the ground, bend a joint
// further than it goes or shake the pelvis: they are drawn toward the usual style by as little as mends it.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/engine/jobs.h>
#include <mobil/systems/gait/step_bounds.h>
#include <mobil/systems/limits/walk_limits.h>

namespace mobil::inline v0_3 {

/// One number of a style that was moved, and why: as asked it would bring `bound` to `would_be` (m, rad or m/s²).
struct StyleChange {
  std::size_t parameter;  // of gait_parameters; behind the last: the step length, m
  float asked, walked;
  WalkBound bound;
  float would_be, speed_m_s;
  WalkPart part;  // of a walk at that speed
};
/// "time_asymmetry 0.3 was lowered to 0.11: the pelvis would be shaken with 78 m/s2 at 2.1 m/s"; "... in stopping from
/// 2.1 m/s".
std::string described(const StyleChange& change);

/// What looking at styles works in, kept from one time to the next.
struct StyleLimitWork {
  std::vector<std::size_t> near, far, farther;  // who is looked at; far: in stopping too; farther: and in changing
  std::vector<std::uint8_t> breaks;
};

/// Moves step lengths and styles of gaits (as resolve_gait has them) so that a steady walk of that speed keeps all
/// limits (mobil/systems/limits/walk_limits.h), and so do stops from it, turns and changes of speed, or all go no
/// further than the usual walk of that speed does: first the step length, if the usual style breaks one with it; then
/// as few numbers of the style as it takes, all by one part of their way to the usual ones, to a 256th. Not everything
/// is looked at:
///   the usual style with steps of 0.76 to 1.12 of the usual length: nothing;
///   styles near the usual one whose knees bend little: walking alone;
///   styles near it whose knees bend more: stops too;
///   all others: stops, turns and changes of speed too. They keep 7° clear of the ends of ankles and 3° of hips in
///   walking and stopping, but may always go 3° further than the usual walk.
/// Two turns and one change of speed are looked at (`Looking`). Other ones may go beyond a limit, and are counted
/// (mobil/systems/limits/limit_monitor.h). Bits depend on neither neighbours nor threads. `moved`: what was, gait by
/// gait, as long as `gaits`; or empty. Takes memory in `work` alone, which keeps it, and for what is moved.
void keep_walk_limits(const Jobs& jobs, std::span<const BodySize<float>> sizes, std::span<Gait<float>> gaits,
                      StyleLimitWork& work, std::span<std::vector<StyleChange>> moved = {});
/// The same of one.
std::vector<StyleChange> keep_walk_limits(const BodySize<float>& size, Gait<float>& gait);

}  // namespace mobil::inline v0_3
