#pragma once
// How a belly's control points move between ticks, by whatever method: what a change of method starts from, and what
// the method that comes can take over of it. Part of the front door.

#include <optional>
#include <vector>

#include "assets/reduction/reduced_belly.h"
#include "engine/world.h"
#include "systems/muscles/simulation_muscles.h"

namespace mobil {

/// Three numbers a control point, in the muscle's frame: m and m/s.
struct BellyMotion {
  std::vector<float> displacement, velocity;
};

/// What has moved and loaded a belly over the last tick.
struct BellyLoad {
  Drive drive = Drive::displacement;
  float from = 0, to = 0;  // EndDisplacement's or EndForce's
  std::optional<FrameLoad<float>> frame;
  float tick_s = 0;
};
/// Of a muscle with or without a belly.
BellyLoad load_of(const World& world, Entity muscle, float tick_s);

/// The motions of the belly asked for last, as both legs have the same one.
struct LastReducedBelly {
  const ReducedBasis* basis = nullptr;
  BellyScale<float> scale{};
  ReducedBelly belly{};
};

/// What a muscle computes, and what it shows: that and what fades. Nothing where there is no belly. Velocities of ECD
/// and ICD are taken as they are, half a step back; static answers move as their loads over the last tick did.
std::optional<BellyMotion> computed_motion(const World& world, Entity muscle, float tick_s, LastReducedBelly& last);
void add_fade(const World& world, Entity muscle, float tick_s, BellyMotion& motion);

/// The belly that a muscle is about to become. `load` is the last tick's.
struct NextBelly {
  const Belly& belly;
  const LegMuscles& choice;
  const LineOfAction<float>& line;
  const BellyLoad& load;
};

/// What a belly begins with: displacement and velocity of its control points, the state of a reduced one, and what
/// fades (components/fade.h). Empty where there is no such thing, or where it stays as it is.
struct Beginning {
  std::vector<float> displacement, velocity, state, fade;
};

/// Under its line's length and what loads it, so that it does not ring: at rest, or, where it `moves`, at the speed
/// that its loads have.
Beginning begin(const NextBelly& next, bool moves);

/// What a muscle was: what its method computed, what it showed, and whether anybody saw that.
struct PastBelly {
  BellyMotion computed, shown;
  bool seen = false;
};
/// Going on from there; `keeps`: the state of the reduced belly stays as it is.
Beginning go_on(const NextBelly& next, const PastBelly& past, bool keeps);

}  // namespace mobil
