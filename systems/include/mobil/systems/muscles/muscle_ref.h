#pragma once
// One of a person's muscles, with its two entities.

#include <array>

#include <mobil/components/muscle.h>
#include <mobil/engine/entity.h>

namespace mobil::inline v0_3 {

/// A muscle's entities by side (right, left). A side that does not exist has a stale handle.
struct MuscleRef {
  Muscle muscle{};
  std::array<Entity, 2> entity{};
};

}  // namespace mobil::inline v0_3
