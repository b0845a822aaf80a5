// A custom skin mesh moves with the skin of its body.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/export/recorded_skin.h>
#include <mobil/assets/surfaces/custom_skin.h>
#include <mobil/systems/surfaces/follow_skin.h>
#include "assets/surfaces/surface_mesh.h"
#include "tests/labels.h"
#include "tests/surfaces/skin_placed.h"

MOBIL_TEST_LABELS("long");

namespace mobil::custom_skin_test {
using namespace geometry;
using skin_test::bent;
using skin_test::place;
using skin_test::Placed;

constexpr float top_m = 0.80F, seam_m = 0.06F;

/// The right leg of a coarser skin up to a height, pushed out by a distance. `from`: its vertices in that skin.
struct Leg {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> from;
};
Leg leg_of(const BodySkin& skin, float out_m) {
  const SkinMesh& shared = skin_mesh(skin.sex, skin.detail);
  const auto is_leg = [&](std::uint32_t v) {
    using enum Segment;
    const auto segment = static_cast<Segment>(segment_of(shared.frame[shared.vertex[v].frame[0]].to));
    const auto of_leg = {thigh_right, patella_right, shank_right, foot_right, toes_right};
    return skin.rest[v].y < top_m && std::ranges::find(of_leg, segment) != of_leg.end();
  };
  Leg leg;
  std::vector<std::uint32_t> number(skin.rest.size(), ~0U);
  for (std::size_t t = 0; t < shared.triangle.size(); t += 3) {
    const std::uint32_t* const corner = &shared.triangle[t];
    if (!std::all_of(corner, corner + 3, is_leg)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& n = number[corner[k]];
      if (n == ~0U) {
        n = static_cast<std::uint32_t>(leg.from.size());
        leg.from.push_back(corner[k]);
        leg.mesh.position.push_back(skin.rest[corner[k]] + out_m * skin.normal[corner[k]]);
      }
      leg.mesh.triangle.push_back(n);
    }
  }
  return leg;
}

struct Followed {
  explicit Followed(const BodyRequest& request, float out_m)
      : body(*make_body(request)),
        skin(*make_body_skin(body, SkinDetail::hero, {.dressed = false})),
        coarse(*make_body_skin(body, SkinDetail::near, {.dressed = false})),
        leg(leg_of(coarse, out_m)),
        own(bind_custom_skin(skin, place(skin, skin.standing).position, place(skin, skin.standing).normal,
                             {&leg.mesh, 1})) {}
  Placed follow(const Pose<float>& pose) const {
    const Placed at = place(skin, pose);
    Placed to{std::vector<Vec3<float>>(own.vertex.size()), std::vector<Vec3<float>>(own.vertex.size())};
    follow_skin(own, at.position, at.normal, to.position, to.normal);
    return to;
  }
  Body body;
  BodySkin skin, coarse;
  Leg leg;
  CustomSkin own;
};

TEST(CustomSkin, KeepsItsPlaceAndMeetsTheBodyAtItsTop) {
  const Followed one({.height_m = 1.75F, .mass_kg = 75}, 0.012F);
  const Placed at = one.follow(one.skin.standing);
  const std::size_t count = one.leg.mesh.position.size();
  ASSERT_GT(count, 1000U);
  ASSERT_EQ(at.position.size(), 2 * count) << "both legs";
  double furthest = 0, max_top = 0;
  for (std::size_t v = 0; v < count; ++v) {
    const Vec3<float>&own = one.leg.mesh.position[v], &right = at.position[v], &left = at.position[count + v];
    const auto off = static_cast<double>(length(right - own));
    if (own.y < top_m - seam_m - 0.02F) furthest = std::max(furthest, off);
    if (own.y > top_m - 0.004F) max_top = std::max(max_top, std::abs(off - 0.012));
    // The body's skin has different triangles on the two sides.
    EXPECT_NEAR(left.x, -right.x, 0.003F);
    EXPECT_NEAR(left.y, right.y, 0.005F);
    EXPECT_NEAR(length(at.normal[v]), 1, 1e-3F);
  }
  EXPECT_LT(furthest, 1e-5);
  EXPECT_LT(max_top, 0.004) << "drawn in by what it stood off";
}

/// In files a custom leg is bound like the skin that it was cut out of, which is omitted there.
TEST(CustomSkin, IsBoundInFilesAsTheBodySkin) {
  const Followed one({.height_m = 1.75F, .mass_kg = 75}, 0);
  const Placed at = one.follow(one.skin.standing);
  const SkinnedSurface own = recorded_custom_skin(one.skin, one.own, at.position, at.normal, 4);
  EXPECT_EQ(own.cloth, 4U);
  EXPECT_EQ(own.triangle, one.own.triangle);
  ASSERT_EQ(own.weight.size(), one.own.vertex.size());
  const std::size_t shin = index(Segment::shank_right);
  int shins = 0;
  for (std::size_t v = 0; v < own.weight.size() / 2; ++v) {
    EXPECT_NEAR(own.weight[v][0] + own.weight[v][1] + own.weight[v][2] + own.weight[v][3], 1, 1e-5F);
    if (at.position[v].y < 0.25F || at.position[v].y > 0.4F) continue;
    ++shins;
    EXPECT_EQ(own.joint[v][0], shin) << v;
    EXPECT_GT(own.weight[v][0], 0.9F) << v;
  }
  EXPECT_GT(shins, 50);
  std::size_t all = 0, left = 0;
  for (const SkinnedSurface& part : recorded_skin(one.skin)) all += part.triangle.size();
  for (const SkinnedSurface& part : recorded_skin(one.skin, 0, &one.own)) left += part.triangle.size();
  EXPECT_EQ(left, one.own.left.size());
  EXPECT_LT(left, all);
}

/// A leg cut into two pieces at the knee moves as in one piece: only its top is a seam.
TEST(CustomSkin, CanHaveSeveralPieces) {
  const Followed one({.height_m = 1.75F, .mass_kg = 75}, 0.012F);
  const SurfaceMesh& whole = one.leg.mesh;
  std::array<SurfaceMesh, 2> pieces;
  for (SurfaceMesh& piece : pieces) piece.position = whole.position;
  for (std::size_t t = 0; t < whole.triangle.size(); t += 3) {
    const std::uint32_t* const corner = &whole.triangle[t];
    auto& to = pieces[whole.position[corner[0]].y > 0.45F ? 0 : 1].triangle;
    to.insert(to.end(), corner, corner + 3);
  }
  for (SurfaceMesh& piece : pieces) drop_unused(piece);
  const Placed standing = place(one.skin, one.skin.standing);
  const CustomSkin own = bind_custom_skin(one.skin, standing.position, standing.normal, pieces);
  EXPECT_EQ(own.triangle.size(), one.own.triangle.size());
  std::vector<Vec3<float>> at(own.vertex.size()), normal(own.vertex.size());
  follow_skin(own, standing.position, standing.normal, at, normal);
  for (std::size_t v = 0; v < pieces[0].position.size() + pieces[1].position.size(); ++v) {
    const std::size_t upper = pieces[0].position.size();
    const Vec3<float>& is = v < upper ? pieces[0].position[v] : pieces[1].position[v - upper];
    if (is.y < top_m - seam_m - 0.02F) {
      EXPECT_LT(length(at[v] - is), 1e-5F) << v;
    }
  }
}

/// A coarser mesh of the same skin matches that skin's positions, in poses up to a knee of 110 degrees.
TEST(CustomSkin, MovesAsTheBodySkin) {
  for (const BodyRequest& request : {BodyRequest{.height_m = 1.75F, .mass_kg = 75},
                                     BodyRequest{.height_m = 1.62F, .mass_kg = 70, .sex = Sex::woman}}) {
    const Followed one(request, 0);
    for (const auto& [knee, hip] : {std::pair{0.5F, 0.3F}, {1.2F, 0.8F}, {1.92F, 1.4F}}) {
      const Pose<float> pose = bent(one.body, knee, hip, 0);
      const Placed own = one.follow(pose), itself = place(one.coarse, pose);
      double squares = 0, most = 0;
      for (std::size_t v = 0; v < one.leg.from.size(); ++v) {
        const auto off = static_cast<double>(length(own.position[v] - itself.position[one.leg.from[v]]));
        squares += off * off;
        most = std::max(most, off);
      }
      const double rms = std::sqrt(squares / static_cast<double>(one.leg.from.size()));
      std::printf("[ own skin ] knee %.0f deg: %.2f mm rms, %.1f at most\n", static_cast<double>(knee) * 57.3,
                  1e3 * rms, 1e3 * most);
      EXPECT_LT(rms, 0.0005);
      EXPECT_LT(most, 0.004);
    }
  }
}

/// The replaced part of the body's skin is removed completely, and the rest stays.
TEST(CustomSkin, ReplacesOnlyTheLegs) {
  const Followed one({.height_m = 1.75F, .mass_kg = 75}, 0);
  const SkinMesh& mesh = skin_mesh(one.skin.sex, one.skin.detail);
  ASSERT_EQ(one.own.first_left[skin_parts], one.own.left.size() / 3);
  float top = 0;
  for (const Vec3<float>& at : one.leg.mesh.position) top = std::max(top, at.y);
  std::size_t shown = 0;
  for (std::size_t t = 0; t < one.own.left.size(); t += 3) {
    float highest = 0, side = 0;
    bool hand = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = one.own.left[t + k];
      highest = std::max(highest, one.skin.rest[v].y);
      side = std::max(side, std::fabs(one.skin.rest[v].x));
      hand = hand || mesh.frame[mesh.vertex[v].frame[0]].to >= index(Segment::clavicle_right);
    }
    EXPECT_TRUE(highest >= top || hand) << highest << ' ' << side;
    ++shown;
  }
  EXPECT_GT(shown, mesh.triangle.size() / 3 / 4);
  EXPECT_LT(shown, mesh.triangle.size() / 3);
}

/// A leg that is thicker than its shorts stays inside them.
TEST(CustomSkin, StaysUnderShorts) {
  const Followed one({.height_m = 1.75F, .mass_kg = 75}, 0.03F);
  const SkinMesh& mesh = skin_mesh(one.skin.sex, one.skin.detail);
  const Placed standing = place(one.skin, one.skin.standing);
  const CustomSkin own = bind_custom_skin(one.skin, standing.position, standing.normal, {&one.leg.mesh, 1}, true);
  constexpr auto shorts = static_cast<std::size_t>(SkinPart::shorts);
  EXPECT_EQ(own.first_left[shorts + 1] - own.first_left[shorts],
            mesh.first_triangle[shorts + 1] - mesh.first_triangle[shorts]);
  EXPECT_LT(own.triangle.size(), one.own.triangle.size());
  float hem = 9;
  for (std::size_t i = 3 * std::size_t{mesh.first_triangle[shorts]};
       i < 3 * std::size_t{mesh.first_triangle[shorts + 1]}; ++i)
    hem = std::min(hem, one.skin.rest[mesh.triangle[i]].y);
  std::vector<Vec3<float>> position(own.vertex.size()), normal(own.vertex.size());
  follow_skin(own, standing.position, standing.normal, position, normal);
  std::size_t under = 0;
  for (std::size_t v = 0; v < own.vertex.size(); ++v) {
    if (position[v].y < hem + 0.01F) continue;
    ++under;
    EXPECT_LT(own.vertex[v].beside_m.z, 0.0041F);
    EXPECT_LT(position[v].y, hem + 0.09F);
  }
  EXPECT_GT(under, 10U);
}

TEST(CustomSkin, WithoutAMeshNothingChanges) {
  const Body body = *make_body({.height_m = 1.75F, .mass_kg = 75});
  const BodySkin skin = *make_body_skin(body, SkinDetail::near, {.dressed = false});
  const Placed at = place(skin, skin.standing);
  const CustomSkin own = bind_custom_skin(skin, at.position, at.normal, {});
  EXPECT_TRUE(own.vertex.empty());
  EXPECT_EQ(own.left, skin_mesh(skin.sex, skin.detail).triangle);
}

}  // namespace mobil::custom_skin_test
