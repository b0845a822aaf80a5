#include "systems/people/person_requests.h"

#include <fmt/format.h>

#include <cmath>
#include <tuple>

#include <mobil/anthropometry.h>
#include <mobil/body_composition.h>
#include <mobil/components/avoidance.h>
#include <mobil/components/fat.h>
#include <mobil/components/footing.h>
#include <mobil/components/step_plan.h>
#include <mobil/each.h>
#include <mobil/forces.h>
#include <mobil/rows.h>
#include <mobil/systems/people/sleepers.h>
#include "assets/body/body_scales.h"
#include "assets/gait/slope_pace.h"
#include "systems/gait/gait.h"
#include "systems/gait/kinematics.h"
#include "systems/gait/step_limits.h"
#include "systems/people/compact_pose.h"
#include "systems/people/fat_wobble.h"
#include "systems/people/pose_measures.h"

namespace mobil::inline v0_3 {

bool is_rotation(const Quat<float>& q) {
  constexpr float rounding = 0.01F;
  return std::fabs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) < 2 * rounding;
}

bool is_person(const World& world, Entity entity) {
  return world.has<Physique>(entity) || is_asleep(world, entity);
}

bool is_posed(const World& world, Entity entity) {
  return world.has<Physique>(entity) && !world.has<Gait>(entity);
}

BodyRequest body_request(const World& world, Entity person) {
  if (is_asleep(world, person)) return sleeper_body(world, person);
  const BodySize<float> size = *world.get<BodySize>(person);
  const Physique<float> of = *world.get<Physique>(person);
  return {size.height_m,
          size.mass_kg,
          {of.endo, of.meso, of.ecto},
          constitution_of(of.build),
          world.get<LimbLengths>(person).value_or(LimbLengths<float>{}),
          sex_of(of.build),
          age_of(of.build)};
}

BodySize<float> body_size(const BodyRequest& request) {
  return make_size(request, static_cast<float>(fat_share_of(body_composition(request))));
}

BodySize<float> body_size(const World& world, Entity person) {
  if (const auto size = world.get<BodySize>(person)) return *size;
  return size_of(*world.get<Asleep>(person));
}

Physique<float> physique(const BodyRequest& request) {
  const Biotype& of = request.biotype;
  return {of.endo, of.meso, of.ecto, build_word(request.constitution, request.sex, request.age_y)};
}

namespace {

/// Returns an error for a stale handle or a posed person. `asked` is the name of the call, `mend` the remedy.
Result<void> is_walker(const World& world, Entity person, std::string_view asked, std::string_view mend) {
  if (!is_person(world, person))
    return fail(fmt::format("{}: that person is not there (a stale handle); spawn one first", asked),
                Status::stale_entity);
  if (is_posed(world, person))
    return fail(fmt::format("{}: this person's host animates the skeleton; {}", asked, mend), Status::missing);
  return {};
}

/// Returns the number of the next request, modulo 2¹⁶ because a sleeper stores 16 bits.
std::uint32_t next_request(std::uint32_t before) {
  return (before + 1) & 0xFFFFU;
}

GaitRequest request_of(const Gait<float>& gait) {
  if (gait.speed_m_s == 0) return {.speed_m_s = 0.0F, .style = gait.style};
  return {.speed_m_s = gait.speed_m_s, .step_length_m = gait.step_length_m, .style = gait.style};
}

Result<Gait<float>> next_gait(const AskedBody& now, const GaitRequest& request) {
  auto gait = resolve_gait(now.size, request, now.age_y);
  if (!gait) return gait;
  const Gait<float>& before = now.gait;
  gait->heading_rad = before.heading_rad;
  gait->left_m = before.left_m;
  gait->ahead_m = before.ahead_m;
  gait->displacement = before.displacement;
  gait->revision = next_request(before.revision);
  return gait;
}

}  // namespace

std::optional<Gait<float>> gait_of(const World& world, Entity person) {
  if (is_asleep(world, person)) return sleeper_gait(world, person);
  const auto gait = world.get<Gait>(person);
  return gait ? std::optional(*gait) : std::nullopt;
}

std::optional<GaitRequest> gait_request(const World& world, Entity person) {
  const auto gait = gait_of(world, person);
  return gait ? std::optional(request_of(*gait)) : std::nullopt;
}

std::optional<AskedBody> asked_body(const World& world, Entity person) {
  if (is_asleep(world, person)) {
    const Asleep<float> asleep = *world.get<Asleep>(person);
    const BodySize<float> size = size_of(asleep);
    return AskedBody{size, gait_of(size.leg_scale_m, asleep.walk, sleeper_style(world, person)), age_of(asleep.build)};
  }
  const auto gait = world.get<Gait>(person);
  if (!gait) return std::nullopt;
  return AskedBody{*world.get<BodySize>(person), *gait, age_of(world.get<Physique>(person)->build)};
}

Result<Gait<float>> changed_gait(const World& world, Entity person, const GaitChange& change) {
  if (auto walks = is_walker(world, person, "change_gait", "spawn a walker instead"); !walks)
    return tl::unexpected(walks.error());
  return changed_gait(*asked_body(world, person), change_on_level(world, person, change));
}

static bool sets_pace(const GaitChange& change) {
  return change.speed_m_s || change.step_length_m || change.step_frequency_hz;
}

GaitChange change_on_level(const World& world, Entity person, const GaitChange& change) {
  if (sets_pace(change)) return change;
  const auto footing = world.get<Footing>(person);
  if (!footing || footing->level_speed_m_s == 0 || !is_slowed(*gait_of(world, person), *footing)) return change;
  GaitChange level = change;
  level.speed_m_s = footing->level_speed_m_s;
  level.step_length_m = footing->level_length_m;
  return level;
}

Result<Gait<float>> changed_gait(const AskedBody& now, const GaitChange& change) {
  GaitRequest request = request_of(now.gait);
  if (change.style) request.style = *change.style;
  if (sets_pace(change)) {
    request.speed_m_s = change.speed_m_s;
    request.step_length_m = change.step_length_m;
    request.step_frequency_hz = change.step_frequency_hz;
  }
  return next_gait(now, request);
}

Result<Gait<float>> new_gait(const World& world, Entity person, const GaitRequest& request) {
  if (auto walks = is_walker(world, person, "set_gait", "spawn a walker instead"); !walks)
    return tl::unexpected(walks.error());
  return next_gait(*asked_body(world, person), request);
}

Result<Gait<float>> turned_gait(const World& world, Entity person, float heading_rad) {
  if (auto walks = is_walker(world, person, "turn_to", "turn the pose instead"); !walks)
    return tl::unexpected(walks.error());
  if (!(std::fabs(heading_rad) <= 1e4F))
    return fail(fmt::format("turn_to: a heading of {} rad is not within ±10000; give an angle about +Y", heading_rad));
  Gait<float> gait = *gait_of(world, person);
  gait.heading_rad = heading_rad;
  return gait;
}

Result<void> step_aside(World& world, Entity person, float left_m, float ahead_m) {
  if (auto walks = is_walker(world, person, "step_aside", "move the pose instead"); !walks) return walks;
  Gait<float> gait = *world.get<Gait>(person);
  if (gait.speed_m_s > 0.0F) return fail("step_aside: this person is to walk; change the gait to a speed of 0 first");
  const auto body = make_body(body_request(world, person));
  const float scale = (body->thigh_length_m + body->shank_length_m) / step_limits::aside_leg_m;
  for (const auto& [name, way, most] : {std::tuple{"to the left", left_m, step_limits::aside_m * scale},
                                        std::tuple{"ahead", ahead_m, step_limits::ahead_m * scale}}) {
    if (!(std::fabs(way) <= most))
      return fail(fmt::format("step_aside: {:.3g} m {} is outside {:.2f}–{:.2f} m for this leg; take more steps", way,
                              name, -most, most));
  }
  gait.left_m = left_m;
  gait.ahead_m = ahead_m;
  gait.displacement = next_request(gait.displacement);
  gait.revision = next_request(gait.revision);
  world.set(person, gait);
  return {};
}

Result<void> check_place(const World& world, const PlaceRequest& to) {
  if (auto walks = is_walker(world, to.person, "place", "hand it another pose"); !walks) return walks;
  if (!(std::fabs(to.x_m) <= farthest_m && std::fabs(to.z_m) <= farthest_m))
    return fail(fmt::format("place: ({}, {}) m is not within ±1000000 m; shift the world's origin", to.x_m, to.z_m));
  if (!(std::fabs(to.heading_rad) <= 1e4F))
    return fail(fmt::format("place: a heading of {} rad is not within ±10000; give an angle about +Y", to.heading_rad));
  return {};
}

Placing place_walker(World& world, const PlaceRequest& to) {
  const Entity person = to.person;
  GaitState<float> state = *world.get<GaitState>(person);
  Gait<float> gait = *world.get<Gait>(person);
  const Placing way = {state.line_x_m, state.line_z_m, state.heading_rad, to.x_m, to.z_m, to.heading_rad};
  state.line_x_m = state.anchor_x_m = to.x_m;
  state.line_z_m = state.anchor_z_m = to.z_m;
  state.heading_rad = to.heading_rad;
  state.anchor_steps = state.steps;
  gait.heading_rad = way.turned(gait.heading_rad);
  world.set(person, state);
  world.set(person, gait);
  auto footing = world.get<Footing>(person);
  bool poses_anew = footing.has_value();  // the ground differs, or shoulders are straightened
  if (auto course = world.get<AvoidanceState>(person)) {
    poses_anew = poses_anew || course->turn_rad != 0;
    course->turn_rad = course->turn_rad_s = course->turn_to_rad = 0;
    world.set(person, *course);
  }
  poses_anew ? settle_fat(world, person) : place_fat(world, person, way);
  if (footing) {
    footing->known = footing_unknown;
    for (std::size_t i = 0; i < 3; ++i) footing->moved_x_m[i] = footing->moved_z_m[i] = 0;
    world.set(person, *footing);
  }
  if (!world.has<Pose>(person)) return way;  // compact
  const auto size = broadcast(*world.get<BodySize>(person));
  Pose<Lanes<float>> pose;
  JointAngles<Lanes<float>> angles;
  Feet<Lanes<float>> feet;
  CentreOfMass<Lanes<float>> centre;
  const auto under = broadcast(footing.value_or(Footing<float>{}));
  pose_skeleton(size, broadcast(*world.get<StepPlan>(person)), broadcast(state), footing ? &under : nullptr, pose,
                angles, feet);
  centre_of_mass(size, pose, centre);
  world.set(person, first_lane(pose));
  world.set(person, first_lane(feet));
  world.set(person, first_lane(centre));
  return way;
}

void shift_people(World& world, float x_m, float z_m) {
  const auto shift = [&](Vec3<Lanes<float>>& at) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) at.x[lane] -= x_m, at.z[lane] -= z_m;
  };
  each(world, [&](Pose<Lanes<float>>& pose) {
    for (auto& at : pose.position_m) shift(at);
  });
  each(world, [&](Feet<Lanes<float>>& feet) {
    for (auto* const points : {feet.heel_m, feet.toe_m, feet.tip_m}) shift(points[0]), shift(points[1]);
  });
  each(world, [&](PoseHistory<Lanes<float>>& past) {
    for (auto& pose : past.pose) {
      for (auto& at : pose.position_m) shift(at);
    }
  });
  each(world, [&](CentreOfMass<Lanes<float>>& centre) { shift(centre.position_m); });
  each(world, [&](FatWobble<Lanes<float>>& fat) {
    for (auto& at : fat.carried_m) shift(at);
  });
  each(world, [&](Footing<Lanes<float>>& footing) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      footing.stance_x_m[lane] -= x_m, footing.stance_z_m[lane] -= z_m;
      footing.landing_x_m[lane] -= x_m, footing.landing_z_m[lane] -= z_m;
    }
  });
  each(world, [&](GaitState<Lanes<float>>& state) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) state.line_x_m[lane] -= x_m, state.line_z_m[lane] -= z_m;
    state.anchor_x_m = state.line_x_m;
    state.anchor_z_m = state.line_z_m;
    state.anchor_steps = state.steps;
  });
}

Result<void> check_pose(const World& world, Entity person, const Pose<float>& pose) {
  if (!is_person(world, person))
    return fail("set_pose: that person is not there (a stale handle); spawn one first", Status::stale_entity);
  if (!is_posed(world, person))
    return fail("set_pose: this person walks; spawn_posed makes people whom the host poses", Status::missing);
  for (std::size_t s = 0; s < segment_count; ++s) {
    const auto& [x, y, z] = pose.position_m[s];
    const auto& [qx, qy, qz, qw] = pose.rotation[s];
    // Comparisons with NaN are false.
    if (!(std::fabs(x) <= farthest_m && std::fabs(y) <= farthest_m && std::fabs(z) <= farthest_m))
      return fail(fmt::format("set_pose: {} is at ({}, {}, {}) m; give a finite place within 1000 km", segment_name[s],
                              x, y, z));
    if (!is_rotation(pose.rotation[s]))
      return fail(fmt::format("set_pose: the quaternion of {} has the length {:.4g}; give one of length 1",
                              segment_name[s], std::sqrt(qx * qx + qy * qy + qz * qz + qw * qw)));
  }
  return {};
}

Result<void> set_pose(World& world, Entity person, const Pose<float>& pose) {
  if (auto ok = check_pose(world, person, pose); !ok) return ok;
  world.set(person, joint_angles(pose));
  world.set(person, sole_points(world.get<BodySize>(person)->leg_scale_m, pose));
  return result_of("set_pose", world.set(person, pose));
}

std::optional<PersonState> person_state(const World& world, Entity person) {
  if (!is_person(world, person)) return std::nullopt;
  if (is_asleep(world, person)) return PersonState::asleep;
  if (is_posed(world, person)) return PersonState::posed;
  return is_compact(world, person) ? PersonState::compact : PersonState::full;
}

}  // namespace mobil::inline v0_3
