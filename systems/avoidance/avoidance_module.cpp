#include "systems/avoidance/avoidance_module.h"

#include "components/avoidance.h"

namespace mobil {

Module avoidance_module() {
  return {.name = "avoidance", .parts = {component_part<Course>()}};
}

}  // namespace mobil
