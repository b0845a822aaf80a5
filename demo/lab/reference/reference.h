#pragma once
// The methods of deformation.h for one belly, in double precision with sparse matrices and factors, written to be
// compared line by line with the equations. It checks the kernels. A step of its one belly costs about twice as much as
// theirs of sixteen.

#include <memory>
#include <span>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "assets/fem/critical_step.h"
#include "assets/fem/stiffness_terms.h"

namespace mobil {

/// One belly and its method: C = α·M + β·K, foundation K_f = ω_f²·M in x and y only.
struct ReferenceOptions {
  Method method = Method::explicit_central;
  Mass mass = Mass::lumped;  // always lumped for ECD, consistent for ICD
  FarEnd end = FarEnd::free;
  double dt_s = 0;                 // unused by static
  double damping_per_s = 0;        // α
  double stiffness_damping_s = 0;  // β
  double foundation_1_s = 0;       // ω_f
  double across = 1, along = 1;    // S and l
};

/// Load at one moment. `end`: total of a uniform traction on the far face, N (for a sliding one z only); for a held one
/// the displacement along z, m. The frame's acceleration is `constant` + `gradient`·x for a mass at rest position x, as
/// in FrameLoad.
struct ReferenceLoad {
  Vec3<double> end{};
  Vec3<double> constant{};
  Mat3<double> gradient{};
};

/// Report like BellyReport, without volume.
struct ReferenceReport {
  double elongation_m, reaction_n, kinetic_energy_j, strain_energy_j;
};

/// One belly at rest at t = 0. Displacement (m) and velocity (m/s; half a step back for ECD and ICD) have three numbers
/// a node, x fastest, with zeros in the first plane. Both can be written.
///
/// The far face of a held belly moves at constant speed within each step. Its own acceleration, which a consistent mass
/// would pass to its neighbours, is therefore 0.
class ReferenceBelly {
 public:
  /// Makes a belly. Fails on scales or a step that are not positive, on negative damping or foundation, or if the far
  /// face is not free to move and the mesh has no other node.
  static Result<ReferenceBelly> make(const HexahedralMesh& mesh, const StiffnessTerms& terms,
                                     const ReferenceOptions& options);
  ReferenceBelly(ReferenceBelly&&) noexcept;
  ReferenceBelly& operator=(ReferenceBelly&&) noexcept;
  ~ReferenceBelly();

  /// Sets the velocity of rest at t = 0 under `load`: v₋½ = −½Δt·M⁻¹·f(0) for ECD and ICD. Static sets the displacement
  /// under the load.
  void start(const ReferenceLoad& load);

  /// Advances by one step, from the load at its start to that at its end. ECD and ICD use the former's force and the
  /// latter's held displacement, CAA both, static only the latter.
  void step(const ReferenceLoad& now, const ReferenceLoad& next);

  std::span<double> displacement();
  std::span<double> velocity();

  /// Returns energies as in BellyReport: ½·v½ᵀ·M·v½ and ½·uₙᵀ·K·uₙ₊₁ for ECD and ICD, ½·vᵀ·M·v and ½·uᵀ·K·u for CAA.
  /// Their sum is constant without load, drive or damping.
  ReferenceReport report() const;

  /// Returns true if every displacement is finite.
  bool finite() const;

 private:
  struct State;
  explicit ReferenceBelly(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace mobil
