#pragma once
// The critical step tried out: a shaken belly in double precision, stepped just below it and just above it.

#include <cstdint>
#include <string>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/engine/error.h>
#include "assets/fem/stiffness_terms.h"
#include "demo/lab/stress/stress.h"
#include "demo/lab/reference/reference.h"

namespace mobil {

/// Parts of the critical step at which it is tried: it is at most 0.1 % below the exact one (0.2 % where stiffness
/// damping dominates), so the upper of these is above both.
inline constexpr double just_below = 0.999, just_above = 1.004;

/// What became of a free belly's energy: kinetic and strain, which together are constant below the limit. Above it they
/// grow with opposite signs.
struct LimitProbe {
  double limit_s;
  double drift_below;   // largest change of the energy, in parts of the first
  double growth_above;  // kinetic energy, last over first
};

/// `steps` below, 600 above. Of `options`, method, mass, end, damping and scales count. Errors: ReferenceBelly's.
Result<LimitProbe> probe_limit(const HexahedralMesh& mesh, const StiffnessTerms& terms, ReferenceOptions options,
                               std::uint32_t steps);

/// The worst of several probes; a limit that is NaN counts as the worst.
struct WorstProbe {
  double drift_below = 0, growth_above = 1e300;
  std::size_t tried = 0;

  void take(const LimitProbe& probe);
};

/// Two rows: what the worst did just below its limit, and just above.
void add_rows(StressRun& run, const std::string& tried, const WorstProbe& worst);

}  // namespace mobil
