#pragma once
// Sixteen bellies of one template with any method, which the rows of `mobil robustness` shake, load and poison.

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

/// Fractions of the critical step that are tried. The computed one is at most 0.1 % below the exact one (0.2 % if
/// stiffness damping dominates), so the upper fraction is above both.
inline constexpr double just_below = 0.999, just_above = 1.004;

/// Energy of a free belly: kinetic and strain. Their sum is constant below the limit; above it they grow with opposite
/// signs.
struct LimitProbe {
  double limit_s;
  double drift_below;   // largest change of the energy, relative to the first
  double growth_above;  // kinetic energy, last over first
};

/// Runs `steps` below, 600 above. Uses method, mass, end, damping and scales of `options`. Errors: ReferenceBelly's.
LimitProbe probe_limit(const HexahedralMesh& mesh, const StiffnessTerms& terms, ReferenceOptions options,
                       std::uint32_t steps);

/// Worst of several probes; a limit that is NaN counts as the worst.
struct WorstProbe {
  double drift_below = 0, growth_above = 1e300;
  std::size_t tried = 0;

  void take(const LimitProbe& probe);
};

/// Adds two rows: the worst results just below the limit, and just above.
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

  /// Creates bellies at rest, all of the template's own size.
  explicit Bellies(MuscleTemplate shape);

  /// Sets a method with a solver. Fails as make_belly_solver does, for bodies of the template's own size.
  void solve_by(Method method, Mass mass, double dt_s);

  /// Advances by a tick in `substeps` equal steps.
  void tick(const FarFaceDrive& end, std::uint32_t substeps, float tick_s);

  /// Returns kinetic and strain energy of a lane after the last tick, J.
  double energy_j(std::size_t lane) const;
  /// Returns true if all of a lane's displacements and velocities are finite.
  bool finite(std::size_t lane) const;
  /// Returns the largest displacement of a lane, m.
  double reach_m(std::size_t lane) const;
};

/// Sets sixteen different sizes: across 0.8–1.25, along 0.85–1.15.
void make_sixteen_sizes(Bellies& bellies);

/// Sets random displacements up to `size_m` of moving components, the same in every lane.
void shake(Bellies& bellies, float size_m, std::uint32_t seed = 1);
void shake(ReferenceBelly& belly, const Cells& cells, FarEnd end, double size_m, std::uint32_t seed = 1);

/// Returns substeps that keep every lane within its critical step. Errors: critical_step's.
std::uint32_t substeps_of(const Bellies& bellies, double tick_s);

/// Counts the words that differ between two blocks of one template in displacement and velocity, except in `but_lane`.
std::size_t different_words(const Bellies& a, const Bellies& b, std::size_t but_lane = lane_count);

/// Counts the differences between two lanes of numbers, except in `but_lane`.
std::size_t different_lanes(const Lanes<float>& a, const Lanes<float>& b, std::size_t but_lane);

/// Returns a spindle 0.12 m long, bent slightly to one side: the mesh of most rows.
HexahedralMesh spindle(const Cells& cells);

/// Returns a uniform number between `low` and `high`, the same on every machine.
double uniform(std::mt19937& random, double low, double high);

}  // namespace mobil
