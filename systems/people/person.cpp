#include "systems/people/person.h"

#include <fmt/format.h>

#include <cmath>
#include <tuple>

#include "assets/body/anthropometry.h"
#include "assets/body/body_composition.h"
#include "systems/gait/gait.h"

namespace mobil {

bool is_person(const World& world, Entity entity) {
  return world.has<Physique>(entity);
}

bool is_posed(const World& world, Entity entity) {
  return is_person(world, entity) && !world.has<Gait>(entity);
}

BodyRequest body_request(const World& world, Entity person) {
  const BodySize<float> size = *world.get<BodySize>(person);
  const Physique<float> of = *world.get<Physique>(person);
  return {size.height_m, size.mass_kg, {of.endo, of.meso, of.ecto}, static_cast<Constitution>(of.constitution)};
}

BodySize<float> body_size(const BodyRequest& request) {
  return {request.height_m, request.mass_kg, static_cast<float>(extra_fat_of(body_composition(request)))};
}

Physique<float> physique(const BodyRequest& request) {
  const Biotype& of = request.biotype;
  return {of.endo, of.meso, of.ecto, static_cast<std::uint32_t>(request.constitution)};
}

Result<void> change_gait(World& world, Entity person, const GaitRequest& request) {
  if (!is_person(world, person)) return fail("change_gait: that person is not there (a stale handle); spawn one first");
  if (is_posed(world, person))
    return fail("change_gait: this person's host animates the skeleton; spawn a walker instead");
  auto gait = resolve_gait(*make_body(body_request(world, person)), request);
  if (!gait) return tl::unexpected(gait.error());
  const Gait<float> before = *world.get<Gait>(person);
  gait->heading_rad = before.heading_rad;
  gait->left_m = before.left_m;
  gait->ahead_m = before.ahead_m;
  gait->displacement = before.displacement;
  gait->revision = before.revision + 1;
  world.set(person, *gait);
  return {};
}

Result<void> turn_to(World& world, Entity person, float heading_rad) {
  if (!is_person(world, person)) return fail("turn_to: that person is not there (a stale handle); spawn one first");
  if (is_posed(world, person)) return fail("turn_to: this person's host animates the skeleton; turn the pose instead");
  if (!(std::fabs(heading_rad) < 1e4F))
    return fail(fmt::format("turn_to: a heading of {} rad is not within ±10000; give an angle about +Y", heading_rad));
  Gait<float> gait = *world.get<Gait>(person);
  gait.heading_rad = heading_rad;
  world.set(person, gait);
  return {};
}

Result<void> step_aside(World& world, Entity person, float left_m, float ahead_m) {
  if (!is_person(world, person)) return fail("step_aside: that person is not there (a stale handle); spawn one first");
  if (is_posed(world, person))
    return fail("step_aside: this person's host animates the skeleton; move the pose instead");
  Gait<float> gait = *world.get<Gait>(person);
  if (gait.speed_m_s > 0.0F) return fail("step_aside: this person is to walk; change the gait to a speed of 0 first");
  const auto body = make_body(body_request(world, person));
  const float scale = (body->thigh_length_m + body->shank_length_m) / 0.90F;
  for (const auto& [name, way, most] :
       {std::tuple{"to the left", left_m, 0.25F * scale}, std::tuple{"ahead", ahead_m, 0.20F * scale}}) {
    if (!(std::fabs(way) <= most))
      return fail(fmt::format("step_aside: {:.3g} m {} is outside {:.2f}–{:.2f} m for this leg; take more steps", way,
                              name, -most, most));
  }
  gait.left_m = left_m;
  gait.ahead_m = ahead_m;
  ++gait.displacement;
  ++gait.revision;
  world.set(person, gait);
  return {};
}

Status set_pose(World& world, Entity person, const Pose<float>& pose) {
  if (!is_person(world, person)) return Status::stale_entity;
  if (!is_posed(world, person)) return Status::missing;
  return world.set(person, pose);
}

}  // namespace mobil
