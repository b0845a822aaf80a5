#pragma once
// How a belly's control points move between ticks, by whatever method, and static answers of one belly: what methods
// begin with and what they hand over to each other.

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

/// Three numbers a control point, in the muscle's frame: m and m/s.
struct BellyMotion {
  std::vector<float> displacement, velocity;
};

/// What has moved and loaded a belly over the last tick.
struct BellyLoad {
  FarEnd far_end = FarEnd::held;
  float from = 0, to = 0;  // EndDrive's
  std::optional<FrameLoad<float>> frame{};
  float tick_s = 0;
  float activation = 0;  // of who begins: what tension makes of a tuned belly's rest
};
/// Of a muscle with or without a belly.
BellyLoad load_of(const World& world, Entity muscle, float tick_s);

/// The motions of the belly asked for last, as both legs have the same one.
struct LastReducedBelly {
  const ModalBasis* basis = nullptr;
  BellyScale<float> scale{};
  ModalBelly belly{};
};

/// All of an entity's floats of a field; empty where it has none.
template <class Tag>
std::vector<float> field_of(const World& world, Entity entity) {
  std::vector<float> values(world.get<Tag>(entity).value_or(0));
  world.get_field<Tag>(entity, values);
  return values;
}

/// Mean over the `nodes` nodes of a plane of cells, by axis.
std::array<float, 3> plane_mean(std::span<const float> three_a_node, std::size_t plane, std::size_t nodes);

/// Static solutions, each of which takes away most of what the last left: from nothing, from nearby under a frame's
/// load, and where a shape in proportion is all but right.
namespace static_solutions {
inline constexpr int from_nothing = 4, from_nearby = 2, once = 1;
}

struct StaticBelly {
  const MuscleTemplate& shape;
  const BellySolver& solver;
  const BellyScale<float>& scale;
};

/// Goes from `displacement` toward the static answer to the load at the tick's end.
void solve_static(const StaticBelly& belly, const BellyLoad& load, int solutions, std::vector<float>& displacement);
/// How a static answer moved over the tick.
std::vector<float> static_velocity(const StaticBelly& belly, const BellyLoad& load,
                                   const std::vector<float>& displacement);
/// The static answer without the loads of the frame: the template's shape, drawn out.
BellyMotion stretched(const Belly& belly, const LineOfAction<float>& line, const BellyLoad& load);
/// What `motion` becomes under all loads: the static answer, and, where it `moves`, how that moves.
void settle_belly(const Belly& belly, const BellySolver& solver, const BellyLoad& load, int solutions,
                  BellyMotion& motion, bool moves);

/// Adds to `motion` what still fades of a muscle's earlier one (mobil/components/fade.h).
void add_fade(const World& world, Entity muscle, float tick_s, BellyMotion& motion);
/// What the new method leaves of what was shown: displacement, then velocity. Empty where it is less than 0.01 mm.
std::vector<float> fade_between(const BellyMotion& before, const BellyMotion& after);

}  // namespace mobil::inline v0_3
