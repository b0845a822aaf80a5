#pragma once
// One person in a world: a row with BodySize, Physique and Pose; a walker also with Gait and what follows from it. What
// can be asked of one.

#include <optional>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

class World;

/// Places beyond are refused, m.
inline constexpr float farthest_m = 1e6F;
/// Whether a quaternion's length is 1 within 1 %; not of NaN.
bool is_rotation(const Quat<float>& q);

/// Awake or asleep; false for a stale handle.
bool is_person(const World& world, Entity entity);
/// A person whose host animates the skeleton; false for a stale handle.
bool is_posed(const World& world, Entity entity);
/// What was asked of a person's body.
BodyRequest body_request(const World& world, Entity person);
/// The same as components.
BodySize<float> body_size(const BodyRequest& request);
BodySize<float> body_size(const Body& body);
BodySize<float> body_size(const World& world, Entity person);
Physique<float> physique(const BodyRequest& request);

/// What is asked of a walker, awake or asleep; nothing for a stale handle and for posed people.
std::optional<Gait<float>> gait_of(const World& world, Entity person);
/// A walker's body, and what is asked of it.
struct AskedBody {
  BodySize<float> size;
  Gait<float> gait;
};
/// Of a walker, awake or asleep; nothing for a stale handle and for posed people.
std::optional<AskedBody> asked_body(const World& world, Entity person);
/// What one of many walkers is asked to do otherwise.
struct WalkChange {
  Entity person;
  std::optional<GaitChange> gait{};
  std::optional<float> heading_rad{};
};
/// What a walker is to do from the next step on, as these would have it. Errors: a stale handle, a posed person, a gait
/// out of range.
Result<Gait<float>> changed_gait(const World& world, Entity person, const GaitChange& change);
Result<Gait<float>> changed_gait(const AskedBody& now, const GaitChange& change);
/// What is asked of a walker who is slowed down on a slope (Footing) is asked of the walk on level ground: the same
/// change, with its speed and step where it names none.
GaitChange change_on_level(const World& world, Entity person, const GaitChange& change);
Result<Gait<float>> new_gait(const World& world, Entity person, const GaitRequest& gait);
/// What a walker is to do; nothing for a stale handle and for posed people.
std::optional<GaitRequest> gait_request(const World& world, Entity person);
/// The same who is to turn to a heading (rad, about +Y, 0 toward +Z, positive to the left). Errors: a stale handle, a
/// posed person, a heading that is not within ±10000.
Result<Gait<float>> turned_gait(const World& world, Entity person, float heading_rad);
/// Asks somebody who stands to step aside: to `left_m` to the left and `ahead_m` ahead of where they stand, negative to
/// the right and back, at most 0.25 m aside and 0.20 m ahead or back for a leg of 0.85 m (a body of 1.73 m), in
/// proportion to the leg. It begins within a quarter of a second, or once the feet are side by side, and takes two
/// steps of 0.3 to 0.5 s. Errors: a stale handle, a posed person, somebody who is to walk, a way out of range.
Result<void> step_aside(World& world, Entity person, float left_m, float ahead_m);
/// Where somebody is to be: the point of the walking line beside the foot that bears, m, and the line's heading there
/// (rad, about +Y).
struct PlaceRequest {
  Entity person;
  float x_m = 0, z_m = 0, heading_rad = 0;
};
/// A way through the world: from one place and heading to others.
struct Placing {
  float from_x_m, from_z_m, from_heading_rad, to_x_m, to_z_m, to_heading_rad;

  float turn_rad() const { return to_heading_rad - from_heading_rad; }
  /// A heading that goes along; what went straight ahead does so to the bit.
  float turned(float rad) const { return rad == from_heading_rad ? to_heading_rad : rad + turn_rad(); }
};
/// Errors: a stale handle, a posed person, a place not within 1000 km or a heading not within ±10000.
Result<void> check_place(const World& world, const PlaceRequest& to);
/// Puts a walker who is awake elsewhere at once, and tells the way; muscles' places are their own. What the walker is
/// about to do goes on, turned likewise. Takes no memory.
Placing place_walker(World& world, const PlaceRequest& to);
/// Everybody's places, less (x, 0, z); muscles' are their own (systems/muscles/leg_muscles.h).
void shift_people(World& world, float x_m, float z_m);
/// Where a posed person's skeleton is at the end of the next tick; joint angles and points of the soles follow at once,
/// the centre of mass with the tick. Errors: a stale handle, a walker, a place not within 1000 km, a quaternion whose
/// length is not 1 within 1 %; the pose then stays.
Result<void> set_pose(World& world, Entity person, const Pose<float>& pose);
/// Whether it may be set.
Result<void> check_pose(const World& world, Entity person, const Pose<float>& pose);

}  // namespace mobil::inline v0_3
