// Meshes of the table's muscles, for every allowed body.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include <mobil/anthropometry.h>
#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/assets/surfaces/muscle_surfaces.h>
#include <mobil/assets/surfaces/surface_binding.h>
#include <mobil/engine/geometry.h>
#include <mobil/muscle_table.h>
#include "assets/surfaces/muscle_lattice.h"
#include "tests/simulation/people.h"

namespace mobil::muscle_mesh_test {
using namespace geometry;

constexpr Cells coarse{2, 2, 8}, middle{4, 4, 16}, fine{8, 8, 32};

HexahedralMesh mesh_of(Muscle muscle, const Cells& cells, double across = 1, double along = 1) {
  const auto mesh = bend_block(cells, muscle_lattice(muscle), reference_belly_m(muscle), belly_grading).value();
  return scaled(mesh, BellyScale<double>{across, along});
}

std::vector<Muscle> all_muscles() {
  std::vector<Muscle> all;
  for (std::size_t i = 0; i < muscles().size(); ++i) all.push_back(static_cast<Muscle>(i));
  return all;
}

Body reference() {
  return make_body({static_cast<float>(reference_body_height_m), static_cast<float>(reference_body_mass_kg)}).value();
}

/// Returns a body from the least to the most muscular of its height, short or tall, light or heavy.
Body any_body() {
  const auto part = [] { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 1001)) / 1000.0; };
  BodyRequest request;
  request.height_m = static_cast<float>(1.2 + part());
  request.mass_kg = living_mass(request.height_m, part());
  request.biotype.meso = static_cast<float>(1 + 8 * part());
  request.constitution = static_cast<Constitution>(*rc::gen::inRange(0, 4));
  return make_body(request).value();
}

TEST(MuscleMesh, SingleMuscleHasItsVolumeAndGroupEnclosesIt) {
  const Body body = reference();
  for (const Muscle muscle : all_muscles()) {
    const MusclePlan plan = make_muscle_plan(body, muscle).value();
    const double share = volume(mesh_of(muscle, coarse)) / plan.volume_m3;
    if (is_single_muscle(muscle)) {
      EXPECT_NEAR(share, 1, 0.02) << muscle_name(muscle);
    } else {
      EXPECT_GT(share, 1.1) << muscle_name(muscle);
      EXPECT_LT(share, muscle == Muscle::hip_abductors ? 3.2 : 2.2) << muscle_name(muscle);
    }
  }
}

TEST(MuscleMesh, RefinedMeshesHaveTheCoarseOnesNodes) {
  for (const Muscle muscle : all_muscles()) {
    const auto a = mesh_of(muscle, coarse), b = mesh_of(muscle, middle), c = mesh_of(muscle, fine);
    for (std::uint32_t k = 0; k <= coarse[2]; ++k) {
      for (std::uint32_t j = 0; j <= coarse[1]; ++j) {
        for (std::uint32_t i = 0; i <= coarse[0]; ++i) {
          const Vec at = a.node[node_index(coarse, i, j, k)];
          EXPECT_LT(length(b.node[node_index(middle, 2 * i, 2 * j, 2 * k)] - at), 1e-12) << muscle_name(muscle);
          EXPECT_LT(length(c.node[node_index(fine, 4 * i, 4 * j, 4 * k)] - at), 1e-12) << muscle_name(muscle);
        }
      }
    }
  }
}

RC_GTEST_PROP(MuscleMesh, ElementsAreWellShapedInEveryBody, ()) {
  const Body body = any_body();
  for (const Muscle muscle : all_muscles()) {
    const MusclePlan plan = make_muscle_plan(body, muscle).value();
    const auto across = static_cast<double>(plan.scale.across), along = static_cast<double>(plan.scale.along);
    for (const Cells& cells : {coarse, middle, fine}) {
      const double quality = smallest_scaled_jacobian(mesh_of(muscle, cells, across, along));
      if (quality < 0.295) RC_FAIL(std::string(muscle_name(muscle)) + ": " + std::to_string(quality));
    }
  }
}

RC_GTEST_PROP(MuscleMesh, ScaledTemplateHasThePlannedSize, ()) {
  const Body body = any_body();
  for (const Muscle muscle : all_muscles()) {
    const MusclePlan plan = make_muscle_plan(body, muscle).value(), one = make_muscle_plan(reference(), muscle).value();
    const auto across = static_cast<double>(plan.scale.across), along = static_cast<double>(plan.scale.along);
    const auto mesh = mesh_of(muscle, coarse, across, along);
    RC_ASSERT(std::abs(mesh.node.back().z / plan.belly_length_m - 1) < 1e-6);
    const double grown = volume(mesh) / volume(mesh_of(muscle, coarse));
    RC_ASSERT(std::abs(grown / (plan.volume_m3 / one.volume_m3) - 1) < 1e-5);
  }
}

/// True if a straight block of elliptical sections is not the shape of the muscle, only near it.
bool is_sheet_or_winds(Muscle muscle) {
  switch (muscle) {
    case Muscle::gluteus_maximus:
    case Muscle::gluteus_medius:
    case Muscle::sartorius:
    case Muscle::peroneus_brevis:
    case Muscle::obturator_internus:
    case Muscle::obturator_externus:
      return true;
    default:
      return false;
  }
}

// Measures how far surface vertices within the belly's span are outside the mesh.
TEST(MuscleMesh, FollowsTheSurfacesOfItsMuscle) {
  const Body body = reference();
  const auto surfaces = make_muscle_surfaces(body, muscle_members(), MuscleRoom::alone);
  for (const Muscle muscle : all_muscles()) {
    const MusclePlan plan = make_muscle_plan(body, muscle).value();
    const auto mesh = mesh_of(muscle, middle);
    double outside = 0, farthest = 0;
    std::size_t count = 0;
    for (const auto& s : surfaces) {
      if (!is_single_muscle(s.muscle) || (s.muscle != muscle && s.group != muscle)) continue;
      for (const auto& p : s.surface.mesh.position) {
        const Vec at = rotated(conjugate(plan.rotation), to_double(p) - plan.start_m);
        if (at.z < 0 || at.z > plan.belly_length_m) continue;
        const LatticePlace place = place_in_lattice(mesh, at);
        Vec near{0, 0, 0};
        for (std::size_t a = 0; a < 8; ++a) near = near + place.weight[a] * mesh.node[place.node[a]];
        outside += length(at - near);
        farthest = std::max(farthest, length(at - near));
        ++count;
      }
    }
    ASSERT_GT(count, 100U);
    const double width = std::sqrt(plan.section_m2);
    if (is_sheet_or_winds(muscle)) {
      EXPECT_LT(outside / static_cast<double>(count), 0.013) << muscle_name(muscle);
      EXPECT_LT(farthest, 0.055) << muscle_name(muscle);
      continue;
    }
    EXPECT_LT(outside / static_cast<double>(count), std::max(0.0015, is_single_muscle(muscle) ? 0.12 * width : 0.002))
        << muscle_name(muscle);
    EXPECT_LT(farthest, std::max(0.009, is_single_muscle(muscle) ? 0.6 * width : 0.012)) << muscle_name(muscle);
  }
}

}  // namespace mobil::muscle_mesh_test
