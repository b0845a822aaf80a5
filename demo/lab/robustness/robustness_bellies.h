#pragma once
// Sixteen bellies of one template by any method, as the rows of `mobil robustness` shake, load and poison them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/muscle.h>
#include "assets/fem/belly_solver.h"
#include "assets/fem/muscle_template.h"
#include "assets/fem/stiffness_terms.h"
#include "demo/lab/reference/reference.h"
#include "demo/lab/robustness/robustness.h"
#include "systems/deformation/deformation.h"

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
LimitProbe probe_limit(const HexahedralMesh& mesh, const StiffnessTerms& terms, ReferenceOptions options,
                       std::uint32_t steps);

/// The worst of several probes; a limit that is NaN counts as the worst.
struct WorstProbe {
  double drift_below = 0, growth_above = 1e300;
  std::size_t tried = 0;

  void take(const LimitProbe& probe);
};

/// Two rows: what the worst did just below its limit, and just above.
void add_rows(RobustnessRun& run, const std::string& tried, const WorstProbe& worst);

inline constexpr double robustness_tick_s = 1.0 / 60;
inline constexpr std::array<Element, 3> all_elements = {Element::full, Element::bbar, Element::one_point};

struct Bellies {
  MuscleTemplate muscle;
  std::optional<BellySolver> solver{};  // none: ECD
  Stiffness stiffness = Stiffness::individual;
  BellyScale<Lanes<float>> scale{};
  std::vector<Lanes<float>> displacement, velocity, scratch;
  BellyReport<Lanes<float>> report{};
  std::optional<FrameLoad<Lanes<float>>> frame{};

  /// At rest, all of the template's own size.
  explicit Bellies(MuscleTemplate shape);

  /// Fails as make_belly_solver does, for bodies of the template's own size.
  void solve_by(Method method, Mass mass, double dt_s);

  /// One tick in `substeps` equal steps.
  void tick(const FarFaceDrive& end, std::uint32_t substeps, float tick_s);

  /// Kinetic and strain energy of a lane after the last tick, J.
  double energy_j(std::size_t lane) const;
  /// Whether all of a lane's displacements and velocities are numbers.
  bool finite(std::size_t lane) const;
  /// Largest displacement of a lane, m.
  double reach_m(std::size_t lane) const;
};

/// Across 0.8–1.25, along 0.85–1.15: sixteen different ones.
void make_sixteen_sizes(Bellies& bellies);

/// Random displacements up to `size_m` of what moves, the same in every lane.
void shake(Bellies& bellies, float size_m, std::uint32_t seed = 1);
void shake(ReferenceBelly& belly, const Cells& cells, FarEnd end, double size_m, std::uint32_t seed = 1);

/// Substeps that keep every lane within its critical step. Errors: critical_step's.
std::uint32_t substeps_of(const Bellies& bellies, double tick_s);

/// Words that differ between two blocks of one template in displacement and velocity, but for `but_lane`.
std::size_t different_words(const Bellies& a, const Bellies& b, std::size_t but_lane = lane_count);

/// The same of two lanes of numbers.
std::size_t different_lanes(const Lanes<float>& a, const Lanes<float>& b, std::size_t but_lane);

/// A spindle of a length of 0.12 m, bent a little to one side. The mesh of most rows.
HexahedralMesh spindle(const Cells& cells);

/// Uniform between `low` and `high`, the same on every machine.
double uniform(std::mt19937& random, double low, double high);

}  // namespace mobil
