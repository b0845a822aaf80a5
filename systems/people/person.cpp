#include "systems/people/person.h"

#include <fmt/format.h>

#include <cmath>

#include "assets/body/anthropometry.h"
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
  return {request.height_m, request.mass_kg};
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

Status set_pose(World& world, Entity person, const Pose<float>& pose) {
  if (!is_person(world, person)) return Status::stale_entity;
  if (!is_posed(world, person)) return Status::missing;
  return world.set(person, pose);
}

}  // namespace mobil
