#include "systems/deformation/method.h"

#include <array>

#include "systems/deformation/method_finite.h"
#include "systems/deformation/method_modal.h"
#include "systems/deformation/method_static.h"
#include "systems/deformation/method_stepped.h"

namespace mobil::inline v0_3 {

std::span<const DeformationMethod> deformation_methods() {
  static const std::array all = {explicit_method, implicit_method, newmark_method,
                                 static_method,   modal_method,    finite_method};
  return all;
}

const DeformationMethod* deformation_method(Method method) {
  for (const DeformationMethod& one : deformation_methods()) {
    if (one.method == method) return &one;
  }
  return nullptr;
}

std::optional<BellyMotion> nodal_motion(const World& world, Entity muscle, float, LastReducedBelly&) {
  return BellyMotion{field_of<NodalDisplacement>(world, muscle), field_of<NodalVelocity>(world, muscle)};
}

Beginning go_on_as_nodes(const NextBelly&, const PastBelly& past, bool) {
  Beginning from{past.motion().displacement, past.motion().velocity, {}, {}};
  if (past.apart && past.seen) from.fade = fade_between(past.shown, past.computed);
  return from;
}

BellyMotion stretched_at_rest(const NextBelly& next) {
  BellyMotion motion = stretched(next.belly, next.line, next.load);
  if (next.belly.finite == nullptr) return motion;
  const auto& [across, along] = next.belly.plan.scale;
  const float speed = (next.load.to - next.load.from) / next.load.tick_s;
  for (std::size_t i = 0; i < motion.displacement.size(); ++i) {
    const float share = next.belly.finite->stretch[i] * (i % 3 == 2 ? 1 : across / along);
    motion.displacement[i] = next.load.to * share;
    motion.velocity[i] = speed * share;
  }
  return motion;
}

}  // namespace mobil::inline v0_3
