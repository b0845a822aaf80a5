#pragma once
// One of a person's muscles: both its entities.

#include <array>

#include "components/muscle.h"
#include "engine/entity.h"

namespace mobil {

/// By side (right, left); a side that is gone has a stale handle.
struct OwnMuscle {
  Muscle muscle{};
  std::array<Entity, 2> entity{};
};

}  // namespace mobil
