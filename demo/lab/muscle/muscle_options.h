#pragma once
// The command line of `mobil muscle`, read and checked.

#include <cstddef>
#include <optional>
#include <string>

#include "assets/fem/belly_solver.h"
#include "assets/fem/muscle_template.h"
#include "assets/reduction/modal_basis.h"
#include "demo/lab/muscle/force_history.h"
#include "demo/program/options.h"

namespace mobil {

/// As typed; empty means left out.
struct MuscleText {
  std::string cells = "2x2x8", cell_size = "0.015", grading = "1,1", element = "full", young = "10666.7",
              poisson = "0.3333", density = "1000";
  std::string method = "explicit-central", mass, dt, seconds = "1", precision = "single", damping = "0",
              stiffness_damping = "0", foundation = "0", modes = "16";
  std::string load, gravity = "0,0,0", out = "disp.csv", glb;
  std::string activation, of = "gastrocnemius_medial";  // activation: of a real muscle instead of a block
};

struct MuscleRequest {
  MuscleTemplate muscle;  // free far face; its options hold element, mass and damping
  Method method;
  bool in_double;
  std::optional<BellySolver> solver;      // of ICD, CAA and static in single precision
  std::optional<ModalBasis> basis;        // of the modal method
  std::optional<double> critical_step_s;  // of ECD and ICD
  double dt_s;
  std::size_t steps;
  ForceHistory load;
  Vec3<double> gravity_m_s2;
  std::filesystem::path out;
  std::filesystem::path glb;  // of the modal method, or empty
  std::string warning;        // one line, or empty
};

std::vector<Option> muscle_options(MuscleText& text);

/// Fails, naming the option, the valid range and the remedy: on values out of range, a mass that the method does not
/// support, a step above the critical one, or too many steps.
Result<MuscleRequest> read_muscle_request(const MuscleText& text);

/// Returns, for example, "explicit-central: explicit central differences, lumped mass".
std::string describe_method(const MuscleRequest& request);

}  // namespace mobil
