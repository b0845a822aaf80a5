#include "demo/lab/effects/accuracy_reference.h"

#include <algorithm>
#include <cmath>

#include <mobil/rows.h>
#include "assets/surfaces/muscle_cage.h"
#include "systems/deformation/reduced.h"
#include "systems/muscles/belly_library.h"

namespace mobil {

Result<std::shared_ptr<const ReducedBasis>> reference_basis(const MusclePlan& plan, const LegMuscles& choice,
                                                            const Cells& cells, std::uint32_t vectors) {
  const auto mesh = bend_block(cells, muscle_cage(plan.muscle), reference_belly_m(plan.muscle), belly_grading);
  if (!mesh) return tl::unexpected(mesh.error());
  const auto across = static_cast<double>(plan.scale.across), along = static_cast<double>(plan.scale.along);
  ReducedOptions options;
  options.vectors = vectors;
  options.frame_loads = choice.inertia;
  options.foundation_hz = foundation_of(choice, plan.muscle);
  options.damping_per_s = choice.damping_per_s;
  options.middle_ratio = across / along;
  options.ratio_width = 1;
  options.middle_product = across * along;
  auto basis = make_reduced_basis(*mesh, choice.material, choice.element, options);
  if (!basis) return tl::unexpected(basis.error());
  return std::make_shared<const ReducedBasis>(std::move(*basis));
}

Result<ReferenceMuscle> ReferenceMuscle::make(std::shared_ptr<const ReducedBasis> basis, const HumanMuscle& muscle,
                                              const LegMuscles& choice, double tick_s) {
  const BellyScale<float>& scale = muscle.plan.scale;
  const auto belly = make_reduced_belly(*basis, static_cast<double>(scale.across), static_cast<double>(scale.along));
  if (!belly) return tl::unexpected(belly.error());
  ReferenceMuscle made;
  const auto spread = [](const std::vector<float>& row) {
    std::vector<Line> lines(row.size());
    for (std::size_t i = 0; i < row.size(); ++i) std::fill_n(lines[i].lane, lane_count, row[i]);
    return lines;
  };
  std::vector<float> motion(reduced_motion_width(basis->vectors, basis->inputs));
  std::vector<float> shape(reduced_shape_width(basis->vectors, basis->inputs));
  write_motion(*belly, choice.damping_per_s, tick_s, motion);
  write_shape(*belly, choice.damping_per_s, shape);
  made.motion_ = spread(motion);
  made.shape_ = spread(shape);
  made.state_ = spread(std::vector<float>(reduced_state_width(basis->vectors)));
  made.displacement_ = spread(std::vector<float>(3 * std::size_t{node_count(basis->options.control_cells)}));
  made.scale_ = broadcast(scale);
  made.tick_s_ = static_cast<float>(tick_s);
  made.basis_ = std::move(basis);
  return made;
}

Result<void> ReferenceMuscle::follow(const Simulation& simulation, Entity muscle) {
  const auto end = simulation.get<EndDrive>(muscle);
  if (!end || simulation.world().get<FarEnd>(muscle) != static_cast<std::uint64_t>(FarEnd::held))
    return fail("a muscle is gone, or not driven by displacement");
  const auto drive = broadcast(*end);
  const FarFaceDrive ends(FarEnd::held, drive);
  const auto load = simulation.get<FrameLoad>(muscle);
  if (!load && basis_->options.frame_loads) return fail("a muscle lost its inertia");
  const auto loads = load ? broadcast(*load) : FrameLoad<Lanes<float>>{};
  const ReducedBlock block{*basis_, scale_, state_.data()->lane, motion_.data()->lane,
                           basis_->options.frame_loads ? &loads : nullptr};
  deform_reduced(block, ends, tick_s_);
  place_control_points(block, {shape_.data()->lane, displacement_.data()->lane}, ends);
  return {};
}

float ReferenceMuscle::largest_error_m(const NodalView& nodes) const {
  float largest = 0;
  for (std::size_t n = 0; n < displacement_.size() / 3; ++n) {
    float square = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const float there = nodes.first != nullptr ? nodes.first[(3 * n + c) * lane_count] : 0.0F;
      const float apart = there - displacement_[3 * n + c].lane[0];
      square += apart * apart;
    }
    const float error = std::sqrt(square);
    if (!(error <= largest)) largest = error;
  }
  return largest;
}

}  // namespace mobil
