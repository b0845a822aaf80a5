// Surfaces bound to one body and displayed on others.
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include "tests/refused.h"
#include "tests/simulation/people.h"

namespace mobil {
namespace {

using geometry::operator-;

struct Walker {
  Simulation simulation{sharing()};
  Entity person;
  Person subject;
  std::vector<SurfaceMuscle> muscles;

  explicit Walker(const BodyRequest& body) {
    person = *simulation.spawn(body, {.speed_m_s = 1.3F});
    EXPECT_TRUE(simulation.set_muscles(person));
    for (int i = 0; i < 40; ++i) simulation.tick();
    subject = *simulation.person(person);
    for (const PersonMuscle& own : subject.muscles) muscles.push_back({own.plan.muscle, own.entity});
  }

  std::vector<Vec3<float>> show(const BodySurfaces& surfaces, const SurfaceFit* fit, std::vector<Vec3<float>>* normal) {
    std::vector<Vec3<float>> position(surfaces.vertices), normals(surfaces.vertices);
    SurfaceWriter writer;
    const SurfaceRequest request{.person = person,
                                 .muscles = muscles,
                                 .surfaces = &surfaces,
                                 .positions = {std::as_writable_bytes(std::span(position))},
                                 .normals = {std::as_writable_bytes(std::span(normals))},
                                 .fit = fit};
    const auto done = writer.write(simulation.world(), {&request, 1});
    EXPECT_TRUE(done) << done.error().message;
    if (normal != nullptr) *normal = normals;
    return position;
  }
};

const std::vector<BodyRequest> bodies = {{.height_m = 1.55F, .mass_kg = 50},
                                         {.height_m = 1.70F, .mass_kg = 62},
                                         {.height_m = 1.80F, .mass_kg = 95, .constitution = Constitution::athletic},
                                         {.height_m = 1.95F, .mass_kg = 88}};

TEST(SurfaceFit, OnTheSameBodyNothingChanges) {
  Walker walker(bodies[1]);
  const BodySurfaces own = bind_surfaces(walker.subject.body).value();
  const SurfaceFit fit = fit_surfaces(own, walker.subject.body);
  std::vector<Vec3<float>> normal, fitted_normal;
  const auto is = walker.show(own, nullptr, &normal), fitted = walker.show(own, &fit, &fitted_normal);
  EXPECT_EQ(std::memcmp(is.data(), fitted.data(), is.size() * sizeof is[0]), 0);
  EXPECT_EQ(std::memcmp(normal.data(), fitted_normal.data(), normal.size() * sizeof normal[0]), 0);
}

/// Returns the mean distance of muscle vertices from those of surfaces drawn for that body, m. Bones must coincide.
double off_m(const BodyRequest& bound, const BodyRequest& body, double farthest_m = 0.03) {
  const BodySurfaces shared = bind_surfaces(make_body(bound).value()).value();
  Walker walker(body);
  const BodySurfaces own = bind_surfaces(walker.subject.body).value();
  const SurfaceFit fit = fit_surfaces(shared, walker.subject.body);
  EXPECT_EQ(own.vertices, shared.vertices);
  const auto is = walker.show(own, nullptr, nullptr), fitted = walker.show(shared, &fit, nullptr);
  double sum = 0, count = 0;
  for (const SurfacePart& part : own.part) {
    for (std::uint32_t v = part.first_vertex; v < part.first_vertex + part.vertices; ++v) {
      const double off = static_cast<double>(geometry::length(is[v] - fitted[v]));
      EXPECT_LT(off, part.driver ? farthest_m : 1e-5) << part.name << " of " << body.height_m << " m";
      if (part.driver) sum += off, count += 1;
    }
  }
  return sum / count;
}

TEST(SurfaceFit, OnOtherBodiesTheyAreNearSurfacesDrawnForThem) {
  const BodyRequest usual{.height_m = 1.75F, .mass_kg = 72};
  const BodyRequest strong{.height_m = 1.75F, .mass_kg = 85, .constitution = Constitution::athletic};
  EXPECT_LT(off_m(usual, bodies[0]), 0.0010);
  EXPECT_LT(off_m(usual, bodies[1]), 0.0010);
  EXPECT_LT(off_m(usual, bodies[3]), 0.0020);
  // Muscles grow away from their bones, meshes about their middles. People of another build therefore need surfaces
  // bound to that build. Some vertices of vastus lateralis are 4 cm off, along the surface: this one is 1.5 times as
  // wide, and cut back by the skin.
  EXPECT_LT(off_m(usual, bodies[2], 0.05), 0.0050);
  EXPECT_LT(off_m(strong, bodies[2]), 0.0015);
}

TEST(SurfaceFit, OfOtherSurfacesIsRefused) {
  Walker walker(bodies[0]);
  const BodySurfaces own = bind_surfaces(walker.subject.body).value();
  SurfaceFit fit = fit_surfaces(own, walker.subject.body);
  fit.belly.pop_back();
  std::vector<Vec3<float>> position(own.vertices);
  const SurfaceRequest request{.person = walker.person,
                               .muscles = walker.muscles,
                               .surfaces = &own,
                               .positions = {std::as_writable_bytes(std::span(position))},
                               .fit = &fit};
  SurfaceWriter writer;
  EXPECT_TRUE(is_refused(writer.write(walker.simulation.world(), {&request, 1}), "fit_surfaces"));
}

}  // namespace
}  // namespace mobil
