#include "systems/deformation/method_finite.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <mobil/components/activation.h>
#include <mobil/rows.h>
#include "systems/deformation/deformation.h"
#include "systems/deformation/finite.h"
#include "systems/deformation/finite_shape.h"
#include "systems/deformation/restart.h"

namespace mobil::inline v0_3 {
namespace {
namespace of_finite {

void deform(Shared<MuscleTemplate> shape, TagValue<FiniteSteps> steps, float tick_s, Scratch<ScratchFloats> scratch,
            const BellyScale<Lanes<float>>& scale, const EndDrive<Lanes<float>>& end, Maybe<Activation> activation,
            Maybe<FrameLoad> frame, Field<NodalDisplacement> displacement, Field<NodalVelocity> velocity,
            BellyReport<Lanes<float>>& report, const Rows& rows, Tally<RestartedBellies> restarted) {
  deform_finite({*shape, scale, displacement.data, velocity.data, report, Stiffness::individual, frame.block},
                {shape->options.far_end, end}, activation.block == nullptr ? nullptr : &activation.block->activation,
                static_cast<std::uint32_t>(steps.value), tick_s, scratch.data);
  // A belly deformed this far can come to rest inside out.
  constexpr float min_volume = 0.5F, max_volume = 2.0F;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    float& volume = report.volume_ratio[lane];
    if (!(volume > min_volume && volume < max_volume)) volume = std::numeric_limits<float>::quiet_NaN();
  }
  restarted.add(restart_bellies(*shape, rows, end, tick_s, report, displacement.data, velocity.data));
}

Module module() {
  return {.name = "deformation, finite strain",
          .parts = {component_id(TagValue<FiniteSteps>{})},
          .systems = [](ScheduleBuilder& systems) {
            systems.add("deformation, finite strain", &deform).one_of("bellies");
          }};
}

void parts(const MuscleKind& kind, std::vector<ComponentId>& to) {
  to.push_back(component_id(TagValue<ScratchFloats>{scratch_floats(*kind.shape, Method::finite)}));
  to.push_back(
      component_id(FieldWidth<NodalVelocity>{static_cast<std::uint32_t>(nodal_width(kind.shape->mesh.cells))}));
  to.push_back(component_id(TagValue<FiniteSteps>{kind.steps}));
}

bool recognise(const Archetype& key, MuscleKind& kind) {
  const ComponentId* const steps = find_component(key, type_id<FiniteSteps>());
  if (steps == nullptr || kind.shape.resource == nullptr || kind.shape->options.strain != Strain::finite) return false;
  kind.method.method = Method::finite;
  kind.steps = static_cast<std::uint32_t>(steps->value);
  return kind.steps == steps->value;
}

/// Returns a linear displacement in which sections between the ends have the width that their axial stretch leaves.
std::vector<float> keep_volume(const MuscleTemplate& shape, const BellyScale<float>& scale, std::vector<float> linear) {
  const std::size_t nodes = plane_nodes(shape.mesh.cells), last = shape.mesh.cells[2];
  const std::span<const float> rest = shape.kernel.rest_m;
  for (std::size_t k = 1; k < last; ++k) {
    const auto low = plane_mean(rest, k - 1, nodes), high = plane_mean(rest, k + 1, nodes);
    // The axial means are unchanged, because only x and y are modified.
    const float drawn = plane_mean(linear, k + 1, nodes)[2] - plane_mean(linear, k - 1, nodes)[2];
    const float stretch = std::clamp(1 + drawn / (scale.along * (high[2] - low[2])), 0.3F, 3.0F);
    const float width = scale.across * (1 / std::sqrt(stretch) - 1);
    const auto centre = plane_mean(rest, k, nodes), moved = plane_mean(linear, k, nodes);
    for (std::size_t i = 3 * k * nodes; i < 3 * (k + 1) * nodes; ++i) {
      if (i % 3 != 2) linear[i] = moved[i % 3] + width * (rest[i] - centre[i % 3]);
    }
  }
  return linear;
}

void add(const BellyMotion& more, BellyMotion& to) {
  for (std::size_t i = 0; i < to.displacement.size(); ++i) {
    to.displacement[i] += more.displacement[i];
    to.velocity[i] += more.velocity[i];
  }
}

/// Returns the rest displacement with the end at `end_m`, whose linear solution is `linear`.
std::vector<float> rest_at(const NextBelly& next, float end_m, const std::vector<float>& linear) {
  const BellyScale<float>& scale = next.belly.plan.scale;
  if (next.belly.finite == nullptr) return keep_volume(*next.belly.shape->shape, scale, linear);
  const auto scales = broadcast(scale);
  Lanes<float> end, pulls;
  std::ranges::fill(end.lane, end_m);
  std::ranges::fill(pulls.lane, next.load.activation);
  std::vector<Lanes<float>> at(linear.size());
  const ShapeBlock block{*next.belly.finite, scales, end, &pulls};
  const ShapeBlend blend = blend_of(block);
  add_shape(block, blend, false, at[0].lane, at[0].lane);
  std::vector<float> rest(linear.size());
  // Beyond the table the belly is stretched in proportion to the linear solution.
  const float beyond = end_m == 0 ? 0 : blend.beyond_m[0] / end_m;
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = at[i][0] + beyond * linear[i];
  return rest;
}

BellyMotion at_rest(const NextBelly& next) {
  BellyMotion motion = stretched(next.belly, next.line, next.load);
  add(finite_less_linear(next), motion);
  return motion;
}

Beginning begin(const NextBelly& next, bool moves) {
  BellyMotion motion = stretched(next.belly, next.line, next.load);
  if (next.choice.inertia) {
    settle_belly(next.belly, *next.belly.resting, next.load,
                 moves ? static_solutions::from_nearby : static_solutions::from_nothing, motion, moves);
  }
  add(finite_less_linear(next), motion);
  if (!moves) std::ranges::fill(motion.velocity, 0.0F);
  return {std::move(motion.displacement), std::move(motion.velocity), {}, {}};
}

}  // namespace of_finite
}  // namespace

BellyMotion finite_less_linear(const NextBelly& next) {
  const BellyMotion linear = stretched(next.belly, next.line, next.load);
  const std::size_t width = linear.displacement.size();
  std::vector<float> before(width);
  for (std::size_t i = 0; i < width; ++i) before[i] = linear.displacement[i] - next.load.tick_s * linear.velocity[i];
  const std::vector<float> now = of_finite::rest_at(next, next.load.to, linear.displacement),
                           then = of_finite::rest_at(next, next.load.from, before);
  BellyMotion more{std::vector<float>(width), std::vector<float>(width)};
  for (std::size_t i = 0; i < width; ++i) {
    more.displacement[i] = now[i] - linear.displacement[i];
    more.velocity[i] = (now[i] - then[i]) / next.load.tick_s - linear.velocity[i];
  }
  return more;
}

constinit const DeformationMethod finite_method = {Method::finite,        &of_finite::module, &of_finite::parts,
                                                   &of_finite::recognise, &nodal_motion,      &of_finite::begin,
                                                   &of_finite::at_rest,   &go_on_as_nodes};

}  // namespace mobil::inline v0_3
