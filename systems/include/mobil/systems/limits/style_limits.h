#pragma once
// Corrects gait styles. Numbers that are each in range can together put a foot under the ground, bend a joint beyond
// its limit or shake the pelvis. Such a style is moved toward the usual one by the smallest sufficient amount.

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <string>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/scratch.h>
#include <mobil/systems/gait/step_bounds.h>
#include <mobil/systems/limits/walk_limits.h>

namespace mobil::inline v0_3 {

/// A change to one number of a style: the requested value would bring `bound` to `would_be` (m, rad or m/s²).
struct StyleChange {
  std::size_t parameter;  // index into gait_parameters; one past the last: step length, m
  float asked, walked;
  WalkBound bound;
  float would_be, speed_m_s;
  WalkPart part;  // of a walk at that speed
};
/// Returns a description, for example "time_asymmetry 0.3 was lowered to 0.11: the pelvis would be shaken with 78 m/s2
/// at 2.1 m/s" or "... in stopping from 2.1 m/s".
std::string described(const StyleChange& change);

/// Scratch memory of `keep_walk_limits`, reused between calls.
struct StyleLimitWork {
  std::vector<std::size_t> near, far, farther;  // checked walkers; far: stops also; farther: changes also
  std::vector<std::uint8_t> breaks;
  ScratchPool searches{std::pmr::new_delete_resource()};  // each is too large for small stacks
};

/// Corrects step lengths and styles of resolved gaits (resolve_gait) so that the steady walk at that speed keeps all
/// limits (mobil/systems/limits/walk_limits.h), and so do stops from it, turns and changes of speed. A gait that goes
/// no further than the usual walk of that speed is accepted as well. The step length is corrected first, if the usual
/// style with it violates a limit. Then the minimum of numbers of the style is moved, by one common fraction of their
/// distance to the usual ones, to 1/256. Checks depend on the style:
///   the usual style with steps of 0.76 to 1.12 of the usual length is not checked;
///   styles near the usual one with little knee flexion are checked in steady walking;
///   styles near it with more knee flexion are checked in stops also;
///   all others are checked in turns and changes of speed also. They must keep 7° from the limits of ankles and 3° from
///   those of hips in walking and stopping, but can always go 3° further than the usual walk.
/// Two turns and one change of speed are checked (`Looking`). Others can violate a limit and are counted
/// (mobil/systems/limits/limit_monitor.h). Bits do not depend on neighbours or threads. `moved` receives the changes of
/// each gait; it is as long as `gaits`, or empty. Allocates in `work`, which keeps the memory, and for `moved`.
void keep_walk_limits(const Jobs& jobs, std::span<const BodySize<float>> sizes, std::span<Gait<float>> gaits,
                      StyleLimitWork& work, std::span<std::vector<StyleChange>> moved = {});
/// Corrects one gait and returns the changes.
std::vector<StyleChange> keep_walk_limits(const BodySize<float>& size, Gait<float>& gait);

}  // namespace mobil::inline v0_3
