#pragma once
// The methods of deformation.h for one belly, in double precision with sparse matrices and factors, written to be read
// line by line beside the equations. It checks the kernels; a step of its one belly costs some twice as much as theirs
// of sixteen.

#include <memory>
#include <span>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "assets/fem/critical_step.h"
#include "assets/fem/stiffness_terms.h"

namespace mobil {

/// One belly and how it is stepped: C = α·M + β·K, foundation K_f = ω_f²·M in x and y alone.
struct ReferenceOptions {
  Method method = Method::explicit_central;
  Mass mass = Mass::lumped;  // of ECD lumped, of ICD consistent, whatever is asked
  FarEnd end = FarEnd::free;
  double dt_s = 0;                 // of static unused
  double damping_per_s = 0;        // α
  double stiffness_damping_s = 0;  // β
  double foundation_1_s = 0;       // ω_f
  double across = 1, along = 1;    // S and l
};

/// What acts at one moment. `end`: total of a uniform traction on the far face, N (of a sliding one z alone); of a held
/// one the displacement along z, m. Frame: acceleration `constant` + `gradient`·x of a mass at rest position x, as in
/// FrameLoad.
struct ReferenceLoad {
  Vec3<double> end{};
  Vec3<double> constant{};
  Mat3<double> gradient{};
};

/// As BellyReport, volume left out.
struct ReferenceReport {
  double elongation_m, reaction_n, kinetic_energy_j, strain_energy_j;
};

/// One belly at rest at t = 0. Displacement (m) and velocity (m/s; of ECD and ICD half a step back) are three a node, x
/// fastest, the first plane's zero, and may be written.
///
/// The far face of a held belly moves at an even speed within each step, so that its own acceleration (which a
/// consistent mass would pass to its neighbours) is none.
class ReferenceBelly {
 public:
  /// Fails on scales or a step that are not positive, on negative damping or foundation, or where the far face is not
  /// free to move and the mesh has no other node.
  static Result<ReferenceBelly> make(const HexahedralMesh& mesh, const StiffnessTerms& terms,
                                     const ReferenceOptions& options);
  ReferenceBelly(ReferenceBelly&&) noexcept;
  ReferenceBelly& operator=(ReferenceBelly&&) noexcept;
  ~ReferenceBelly();

  /// The velocity that goes with rest at t = 0 under `load`: of ECD and ICD v₋½ = −½Δt·M⁻¹·f(0). Of static, the
  /// displacement under it.
  void start(const ReferenceLoad& load);

  /// One step, from the load at its start to that at its end. ECD and ICD feel the former's force and the latter's held
  /// displacement, CAA both, static the latter alone.
  void step(const ReferenceLoad& now, const ReferenceLoad& next);

  std::span<double> displacement();
  std::span<double> velocity();

  /// Energies as in BellyReport: of ECD and ICD ½·v½ᵀ·M·v½ and ½·uₙᵀ·K·uₙ₊₁, of CAA ½·vᵀ·M·v and ½·uᵀ·K·u. Their sum
  /// is constant where nothing is loaded, driven or damped.
  ReferenceReport report() const;

  /// Whether every displacement is a number.
  bool finite() const;

 private:
  struct State;
  explicit ReferenceBelly(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace mobil
