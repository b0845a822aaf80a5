// The converged answer that `mobil frontier` holds all others against, and how far it still moves.

#include <map>
#include <memory>
#include <utility>

#include "assets/reduction/reduced_basis.h"
#include "demo/lab/effects/accuracy_measure.h"
#include "demo/lab/frontier/frontier.h"
#include "systems/muscles/belly_library.h"

namespace mobil {
namespace {

constexpr std::uint32_t fewer_vectors = 24, vectors_of_a_coarse_mesh = 16;

Cells half(const Cells& cells) {
  return {cells[0] / 2, cells[1] / 2, cells[2] / 2};
}

/// Sixteen individuals, each with vectors of its own size alone, of a mesh and one of half its cells extrapolated.
Result<std::vector<FrontierIndividual>> own_vectors(const FrontierDrive& drive, const Cells& cells,
                                                    std::uint32_t vectors, bool loads) {
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
    auto basis = reference_basis(drive.plan[lane], choice, cells, vectors);
    if (!basis) return tl::unexpected(basis.error());
    all[lane].basis = std::move(*basis);
  }
  return all;
}

Result<FrontierAnswer> answer_with(const FrontierDrive& drive, std::vector<FrontierIndividual> individuals,
                                   std::uint32_t vectors, bool loads) {
  FrontierMethod method;
  method.choice.method = Method::reduced;
  std::map<const ReducedBasis*, std::shared_ptr<const ReducedBasis>> cut;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    FrontierIndividual& own = individuals[lane];
    auto& basis = cut[own.basis.get()];
    if (basis == nullptr) basis = std::make_shared<const ReducedBasis>(truncated(*own.basis, vectors));
    const auto belly = make_reduced_belly(*basis, static_cast<double>(drive.scale.across[lane]),
                                          static_cast<double>(drive.scale.along[lane]));
    if (!belly) return tl::unexpected(belly.error());
    set_vectors(own, basis, *belly, method.choice.damping_per_s);
  }
  return answer_of(drive, method, individuals, loads);
}

Result<FrontierAnswer> explicit_answer(const FrontierDrive& drive, const Cells& cells, bool loads) {
  FrontierMethod method;
  method.choice.cells = cells;
  method.even_steps = true;
  BellyLibrary library;
  const auto individuals = frontier_individuals(drive, method, loads, library);
  if (!individuals) return tl::unexpected(individuals.error());
  return answer_of(drive, method, *individuals, loads);
}

}  // namespace

Result<FrontierReference> make_reference(const FrontierDrive& drive, const Cells& cells, std::span<const Cells> checks,
                                         bool loads) {
  const std::uint32_t coarse_vectors = cells[0] < 8 ? vectors_of_a_coarse_mesh : most_vectors;
  const auto fine = own_vectors(drive, cells, most_vectors, loads);
  if (!fine) return tl::unexpected(fine.error());
  const auto coarse = own_vectors(drive, half(cells), coarse_vectors, loads);
  if (!coarse) return tl::unexpected(coarse.error());
  auto truth = answer_with(drive, *fine, most_vectors, loads);
  if (!truth) return tl::unexpected(truth.error());
  const auto fewer = answer_with(drive, *fine, fewer_vectors, loads);
  if (!fewer) return tl::unexpected(fewer.error());
  const auto coarser = answer_with(drive, *coarse, coarse_vectors, loads);
  if (!coarser) return tl::unexpected(coarser.error());
  FrontierReference reference{std::move(*truth), {}, {}};
  reference.mesh.add(*coarser, reference.truth, drive.walks);
  reference.vectors.add(*fewer, reference.truth, drive.walks);
  if (checks.size() == 2) {
    const auto a = explicit_answer(drive, checks[0], loads);
    if (!a) return tl::unexpected(a.error());
    const auto b = explicit_answer(drive, checks[1], loads);
    if (!b) return tl::unexpected(b.error());
    reference.elements.emplace().add(extrapolated(*b, *a), reference.truth, drive.walks);
  }
  return reference;
}

}  // namespace mobil
