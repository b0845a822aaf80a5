#pragma once
// Requests to one person in a world. A person is a row with BodySize, Physique and Pose. A walker also has Gait and the
// components that follow from it.

#include <optional>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/error.h>
#include <mobil/systems/people/people.h>

namespace mobil::inline v0_3 {

class World;

/// Maximum coordinate of a position, m.
inline constexpr float farthest_m = 1e6F;
/// Returns true if a quaternion's length is 1 within 1 %; false for NaN.
bool is_rotation(const Quat<float>& q);

/// Returns true for a person, awake or asleep; false for a stale handle.
bool is_person(const World& world, Entity entity);
/// Returns true for a person whose skeleton the host animates; false for a stale handle.
bool is_posed(const World& world, Entity entity);
/// Returns a person's state; nothing for a stale handle and for entities that are not people.
std::optional<PersonState> person_state(const World& world, Entity person);
/// Returns the request that a person's body was made from.
BodyRequest body_request(const World& world, Entity person);
/// Return the components of a body.
BodySize<float> body_size(const BodyRequest& request);
BodySize<float> body_size(const World& world, Entity person);
Physique<float> physique(const BodyRequest& request);

/// Returns the requested gait of a walker, awake or asleep; nothing for a stale handle or a posed person.
std::optional<Gait<float>> gait_of(const World& world, Entity person);
/// A walker's body size, requested gait and age.
struct AskedBody {
  BodySize<float> size;
  Gait<float> gait;
  float age_y;
};
/// Returns them for a walker, awake or asleep; nothing for a stale handle or a posed person.
std::optional<AskedBody> asked_body(const World& world, Entity person);
/// Returns the gait of a walker with a change. Errors: a stale handle, a posed person, a gait out of range.
Result<Gait<float>> changed_gait(const World& world, Entity person, const GaitChange& change);
Result<Gait<float>> changed_gait(const AskedBody& now, const GaitChange& change);
/// Completes a change with the speed and step length on level ground, if the walker is slowed on a slope (Footing) and
/// the change has neither. Requests always refer to level ground.
GaitChange change_on_level(const World& world, Entity person, const GaitChange& change);
Result<Gait<float>> new_gait(const World& world, Entity person, const GaitRequest& gait);
/// Returns the requested gait of a walker as a request; nothing for a stale handle or a posed person.
std::optional<GaitRequest> gait_request(const World& world, Entity person);
/// Returns the gait of a walker with a new heading (rad about +Y, 0 toward +Z, positive to the left). Errors: a stale
/// handle, a posed person, a heading not within ±10000.
Result<Gait<float>> turned_gait(const World& world, Entity person, float heading_rad);
/// Makes a standing walker step `left_m` to the left and `ahead_m` ahead; negative values are right and back. The
/// limits for a leg of 0.85 m (a body of 1.73 m) are ±0.25 m sideways and ±0.20 m ahead, in proportion to leg length.
/// The motion begins within 0.25 s, or when the feet are side by side, and takes two steps of 0.3 to 0.5 s. Errors: a
/// stale handle, a posed person, a walker with a requested speed above 0, a displacement out of range.
Result<void> step_aside(World& world, Entity person, float left_m, float ahead_m);
/// A rigid motion on the ground, from one position and heading to another.
struct Placing {
  float from_x_m, from_z_m, from_heading_rad, to_x_m, to_z_m, to_heading_rad;

  float turn_rad() const { return to_heading_rad - from_heading_rad; }
  /// Returns a heading rotated by the motion. The heading of a straight walker stays straight to the bit.
  float turned(float rad) const { return rad == from_heading_rad ? to_heading_rad : rad + turn_rad(); }
};
/// Checks a request. Errors: a stale handle, a posed person, a position not within 1000 km, a heading not within
/// ±10000.
Result<void> check_place(const World& world, const PlaceRequest& to);
/// Moves an awake walker at once and returns the motion. Muscles must be moved separately (move_muscles). Pending turns
/// and steps continue, rotated by the same angle. Does not allocate.
Placing place_walker(World& world, const PlaceRequest& to);
/// Subtracts (x, 0, z) from the positions of all people. Muscles are shifted separately
/// (systems/muscles/leg_muscles.h).
void shift_people(World& world, float x_m, float z_m);
/// Sets a posed person's skeleton for the end of the next tick (m, world frame). Joint angles and points of the soles
/// follow at once, the centre of mass in the tick. Errors: a stale handle, a walker, a position not within 1000 km, a
/// quaternion whose length is not 1 within 1 %; the old pose then stays.
Result<void> set_pose(World& world, Entity person, const Pose<float>& pose);
/// Checks a pose without setting it. Errors: those of `set_pose`.
Result<void> check_pose(const World& world, Entity person, const Pose<float>& pose);

}  // namespace mobil::inline v0_3
