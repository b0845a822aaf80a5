#pragma once
// Motion of control points between ticks for any method, and static solutions, with which methods start and hand over.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <mobil/components/muscle.h>
#include <mobil/engine/world.h>
#include "assets/reduction/modal_basis.h"
#include "assets/reduction/modal_belly.h"
#include "systems/deformation/belly.h"

namespace mobil::inline v0_3 {

/// Motion of control points, three numbers each, in the muscle's frame: m and m/s.
struct BellyMotion {
  std::vector<float> displacement, velocity;
};

/// Drive and loads of a belly over the last tick.
struct BellyLoad {
  FarEnd far_end = FarEnd::held;
  float from = 0, to = 0;  // EndDrive's
  std::optional<FrameLoad<float>> frame{};
  float tick_s = 0;
  float activation = 0;  // of a belly that begins: sets the rest state of a tuned one
};
/// Returns the load of a muscle with or without a belly.
BellyLoad load_of(const World& world, Entity muscle, float tick_s);

/// Modal belly of the last request, which is the same for both legs.
struct LastReducedBelly {
  const ModalBasis* basis = nullptr;
  BellyScale<float> scale{};
  ModalBelly belly{};
};

/// Returns all floats of an entity's field, empty without such a field.
template <class Tag>
std::vector<float> field_of(const World& world, Entity entity) {
  std::vector<float> values(world.get<Tag>(entity).value_or(0));
  world.get_field<Tag>(entity, values);
  return values;
}

/// Returns the mean over the `nodes` nodes of a plane of cells, by axis.
std::array<float, 3> plane_mean(std::span<const float> three_a_node, std::size_t plane, std::size_t nodes);

/// Numbers of successive static solutions, each of which removes most of the remaining error: from nothing, from nearby
/// under a frame's load, and once where a scaled shape is nearly right.
namespace static_solutions {
inline constexpr int from_nothing = 4, from_nearby = 2, once = 1;
}

struct StaticBelly {
  const MuscleTemplate& shape;
  const BellySolver& solver;
  const BellyScale<float>& scale;
};

/// Moves `displacement` toward the static solution for the load at the tick's end.
void solve_static(const StaticBelly& belly, const BellyLoad& load, int solutions, std::vector<float>& displacement);
/// Returns the velocity of a static solution over the tick.
std::vector<float> static_velocity(const StaticBelly& belly, const BellyLoad& load,
                                   const std::vector<float>& displacement);
/// Returns the static solution without frame loads: the template's shape, stretched.
BellyMotion stretched(const Belly& belly, const LineOfAction<float>& line, const BellyLoad& load);
/// Moves `motion` to the static solution under all loads and, with `moves`, sets its velocity.
void settle_belly(const Belly& belly, const BellySolver& solver, const BellyLoad& load, int solutions,
                  BellyMotion& motion, bool moves);

/// Adds to `motion` the remainder of a fading earlier motion (mobil/components/fade.h).
void add_fade(const World& world, Entity muscle, float tick_s, BellyMotion& motion);
/// Returns the difference between the shown motion and the new method's: displacement, then velocity. Empty if it is
/// less than 0.01 mm or not finite.
std::vector<float> fade_between(const BellyMotion& before, const BellyMotion& after);

}  // namespace mobil::inline v0_3
