// A host with its own engine/world.h, which uses Eigen itself and is built for AVX2 without inlining. Its Eigen aligns
// memory differently from the library's.
#include <Eigen/Dense>
#include <cstdio>

#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/version.h>
#include "engine/world.h"

int main() {
  const game::World mine;
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(64, 64);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a + a.transpose());
  mobil::Simulation simulation;
  const auto person = simulation.spawn({.height_m = 1.8F, .mass_kg = 80});
  mobil::LegMuscles muscles;
  muscles.method = mobil::Method::modal;
  const auto added = simulation.set_muscles(person.value(), muscles);
  for (int i = 0; i < 10; ++i) simulation.tick();
  std::printf("mobil %s: %s; the host's least eigenvalue is %.3f\n", MOBIL_VERSION,
              added ? "muscles" : added.error().message.c_str(), solver.eigenvalues()[0]);
  return added && solver.info() == Eigen::Success && mine.cells == 7 ? 0 : 1;
}
