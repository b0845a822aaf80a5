#include "demo/lab/frontier/frontier_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include <mobil/muscle_table.h>
#include "assets/surfaces/muscle_cage.h"

namespace mobil {

Result<HexahedralMesh> frontier_mesh(Muscle muscle, const Cells& cells) {
  return bend_block(cells, muscle_cage(muscle), reference_belly_m(muscle), belly_grading);
}

void set_vectors(FrontierIndividual& own, std::shared_ptr<const ReducedBasis> basis, const ReducedBelly& belly,
                 double damping_per_s) {
  own.motion.resize(reduced_motion_width(basis->vectors, basis->inputs));
  own.points.resize(reduced_shape_width(basis->vectors, basis->inputs));
  write_motion(belly, damping_per_s, frontier_tick_s, own.motion);
  write_shape(belly, damping_per_s, own.points);
  own.basis = std::move(basis);
}

Result<std::vector<FrontierIndividual>> frontier_individuals(const FrontierDrive& drive, const FrontierMethod& method,
                                                             bool loads, BellyLibrary& library) {
  LegMuscles choice = method.choice;
  choice.muscles.reset();
  choice.muscles.set(static_cast<std::size_t>(drive.muscle));
  choice.inertia = loads;
  std::vector<FrontierIndividual> all(lane_count);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    auto belly = library.belly(drive.plan[lane], choice, frontier_tick_s);
    if (!belly) return fail(fmt::format("{}: {}", muscle_name(drive.muscle), belly.error().message));
    FrontierIndividual& own = all[lane];
    own.shape = belly->shape->shape;
    own.steps = belly->steps;
    own.solver = std::move(belly->solver);
    if (belly->basis != nullptr) set_vectors(own, belly->basis, *belly->motions, choice.damping_per_s);
  }
  if (method.even_steps) {
    const auto most = std::ranges::max(all, {}, &FrontierIndividual::steps).steps;
    for (FrontierIndividual& individual : all) individual.steps = most;
  }
  return all;
}

}  // namespace mobil
