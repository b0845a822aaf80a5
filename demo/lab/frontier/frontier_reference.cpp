// The converged answer that `mobil frontier` holds all others against, and how far it still moves.

#include <map>
#include <memory>
#include <utility>

#include "assets/reduction/reduced_basis.h"
#include "demo/lab/effects/accuracy_measure.h"
#include "demo/lab/frontier/frontier.h"
#include "demo/program/must.h"
#include "systems/muscles/belly_library.h"

namespace mobil {
namespace {

constexpr std::uint32_t fewer_vectors = 24, vectors_of_a_coarse_mesh = 16;

Cells half(const Cells& cells) {
  return {cells[0] / 2, cells[1] / 2, cells[2] / 2};
}

/// Sixteen individuals, each with vectors of its own size alone, of a mesh and one of half its cells extrapolated.
std::vector<FrontierIndividual> own_vectors(const FrontierDrive& drive, const Cells& cells, std::uint32_t vectors,
                                            bool loads) {
  LegMuscles choice;
  choice.inertia = loads;
  std::vector<FrontierIndividual> all(lane_count);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    for (std::size_t before = 0; before < lane && all[lane].basis == nullptr; ++before) {
      const bool same = drive.scale.across[before] == drive.scale.across[lane] &&
                        drive.scale.along[before] == drive.scale.along[lane];
      if (same) all[lane] = all[before];
    }
    if (all[lane].basis != nullptr) continue;
    all[lane].basis = reference_basis(drive.plan[lane], choice, cells, vectors);
  }
  return all;
}

FrontierAnswer answer_with(const FrontierDrive& drive, std::vector<FrontierIndividual> individuals,
                           std::uint32_t vectors, bool loads) {
  FrontierMethod method;
  method.choice.method = Method::reduced;
  std::map<const ReducedBasis*, std::shared_ptr<const ReducedBasis>> cut;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    FrontierIndividual& own = individuals[lane];
    auto& basis = cut[own.basis.get()];
    if (basis == nullptr) basis = std::make_shared<const ReducedBasis>(truncated(*own.basis, vectors));
    const auto belly = must(make_reduced_belly(*basis, static_cast<double>(drive.scale.across[lane]),
                                               static_cast<double>(drive.scale.along[lane])));
    set_vectors(own, basis, belly, method.choice.damping_per_s);
  }
  return answer_of(drive, method, individuals, loads);
}

}  // namespace

FrontierReference make_reference(const FrontierDrive& drive, const Cells& cells, bool loads) {
  const std::uint32_t coarse_vectors = cells[0] < 8 ? vectors_of_a_coarse_mesh : most_vectors;
  const auto fine = own_vectors(drive, cells, most_vectors, loads);
  const auto coarse = own_vectors(drive, half(cells), coarse_vectors, loads);
  auto truth = answer_with(drive, fine, most_vectors, loads);
  const auto fewer = answer_with(drive, fine, fewer_vectors, loads);
  const auto coarser = answer_with(drive, coarse, coarse_vectors, loads);
  FrontierReference reference{std::move(truth), {}, {}};
  reference.mesh.add(coarser, reference.truth, drive.walks);
  reference.vectors.add(fewer, reference.truth, drive.walks);
  return reference;
}

}  // namespace mobil
