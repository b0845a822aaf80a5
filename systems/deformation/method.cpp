#include "systems/deformation/method.h"

#include <array>

#include "systems/deformation/method_reduced.h"
#include "systems/deformation/method_static.h"
#include "systems/deformation/method_stepped.h"

namespace mobil {

std::span<const DeformationMethod> deformation_methods() {
  static const std::array all = {explicit_method, implicit_method, newmark_method, static_method, reduced_method};
  return all;
}

const DeformationMethod* deformation_method(Method method) {
  for (const DeformationMethod& one : deformation_methods()) {
    if (one.method == method) return &one;
  }
  return nullptr;
}

BellyMotion stretched_at_rest(const NextBelly& next) {
  return stretched(next.belly, next.line, next.load);
}

}  // namespace mobil
