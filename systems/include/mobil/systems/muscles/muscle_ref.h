#pragma once
// One of a person's muscles: both its entities.

#include <array>

#include <mobil/components/muscle.h>
#include <mobil/engine/entity.h>

namespace mobil::inline v0_3 {

/// By side (right, left); a side that is gone has a stale handle.
struct MuscleRef {
  Muscle muscle{};
  std::array<Entity, 2> entity{};
};

}  // namespace mobil::inline v0_3
