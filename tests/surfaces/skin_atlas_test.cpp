// A skin's atlas: the same triangles over a texture, with few folds, and equal for every detail.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include <mobil/skin_atlas.h>
#include "assets/surfaces/carried_skin.h"
#include "tests/labels.h"

MOBIL_TEST_LABELS("long");

namespace mobil {
namespace {

using namespace geometry;

constexpr std::array every_detail = {SkinDetail::hero, SkinDetail::near, SkinDetail::far, SkinDetail::distant};

TEST(SkinAtlas, ChartsAreDisjointInTheSquare) {
  for (std::size_t i = 0; i < skin_charts; ++i) {
    const ChartBox a = chart_box(static_cast<SkinChart>(i));
    EXPECT_GE(std::min(a.left, a.top), 0) << i;
    EXPECT_LE(std::max(a.right, a.bottom), 1) << i;
    EXPECT_LT(a.left, a.right);
    EXPECT_LT(a.top, a.bottom);
    for (std::size_t j = 0; j < i; ++j) {
      const ChartBox b = chart_box(static_cast<SkinChart>(j));
      constexpr float pixel = 1.0F / 1024;
      EXPECT_TRUE(a.left > b.right + pixel || b.left > a.right + pixel || a.top > b.bottom + pixel ||
                  b.top > a.bottom + pixel)
          << i << " and " << j;
    }
  }
}

TEST(SkinAtlas, HasTheMeshTrianglesEachWithinItsChart) {
  for (const Sex sex : {Sex::man, Sex::woman}) {
    for (const SkinDetail detail : every_detail) {
      const SkinMesh& mesh = skin_mesh(sex, detail);
      const SkinAtlas& atlas = skin_atlas(sex, detail);
      ASSERT_EQ(atlas.triangle.size(), mesh.triangle.size());
      ASSERT_EQ(atlas.chart.size(), mesh.triangle.size() / 3);
      ASSERT_EQ(atlas.place.size(), atlas.vertex.size());
      EXPECT_LT(atlas.vertex.size(), mesh.place.size() * 3 / 2) << "few vertices lie on seams";
      for (std::size_t i = 0; i < mesh.triangle.size(); ++i) {
        ASSERT_EQ(atlas.vertex[atlas.triangle[i]], mesh.triangle[i]);
        const AtlasPlace& at = atlas.place[atlas.triangle[i]];
        const ChartBox box = chart_box(atlas.chart[i / 3]);
        constexpr float rounding = 1e-6F;
        ASSERT_GE(at.right, box.left - rounding);
        ASSERT_LE(at.right, box.right + rounding);
        ASSERT_GE(at.down, box.top - rounding);
        ASSERT_LE(at.down, box.bottom + rounding);
      }
    }
  }
}

/// Largest and smallest stretch of a triangle mapped into the square, and whether it is turned over.
struct Stretch {
  double most, least;
  bool folded;
};
Stretch stretch(const std::array<Vec, 3>& place, const std::array<AtlasPlace, 3>& laid) {
  const Vec first = place[1] - place[0], second = place[2] - place[0];
  const double along = length(first), x = dot(second, first) / along, y = length(second - (x / along) * first);
  const auto step = [&](std::size_t k, float AtlasPlace::*way) {
    return static_cast<double>(laid[k].*way) - static_cast<double>(laid[0].*way);
  };
  const double a = step(1, &AtlasPlace::right) / along, c = -step(1, &AtlasPlace::down) / along;
  const double b = (step(2, &AtlasPlace::right) - a * x) / y, d = (-step(2, &AtlasPlace::down) - c * x) / y;
  const double sum = a * a + b * b + c * c + d * d, turned = a * d - b * c;
  const double apart = std::sqrt(std::max(0.0, sum * sum - 4 * turned * turned));
  return {std::sqrt((sum + apart) / 2), std::sqrt(std::max(0.0, (sum - apart) / 2)), turned < 0};
}

TEST(SkinAtlas, IsStretchedAndFoldedLittle) {
  constexpr double per_m = 1 / 2.02;  // of the square's side
  for (const Sex sex : {Sex::man, Sex::woman}) {
    for (const SkinDetail detail : every_detail) {
      const SkinMesh& mesh = skin_mesh(sex, detail);
      const SkinAtlas& atlas = skin_atlas(sex, detail);
      double all = 0, folded = 0, twice = 0, fourfold = 0;
      for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
        std::array<Vec, 3> place;
        std::array<AtlasPlace, 3> laid;
        for (std::size_t k = 0; k < 3; ++k) {
          place[k] = mesh.place[mesh.triangle[t + k]];
          laid[k] = atlas.place[atlas.triangle[t + k]];
        }
        const double area = 0.5 * length(cross(place[1] - place[0], place[2] - place[0]));
        if (area < 1e-9) continue;
        const double scale = per_m * (atlas.chart[t / 3] == SkinChart::head ? 1.4 : 1);
        const Stretch of = stretch(place, laid);
        all += area;
        folded += of.folded ? area : 0;
        twice += of.most > 2 * scale || of.least < scale / 2 ? area : 0;
        fourfold += of.most > 4 * scale || of.least < scale / 4 ? area : 0;
      }
      EXPECT_LT(folded / all, detail == SkinDetail::hero ? 0.01 : 0.018);
      EXPECT_LT(twice / all, detail == SkinDetail::hero ? 0.083 : 0.11);
      EXPECT_LT(fourfold / all, detail == SkinDetail::hero ? 0.02 : 0.024);
      if (detail == SkinDetail::hero)
        std::printf("[ atlas ] %s: %.1f %% folded, %.1f %% stretched twofold, %.1f %% fourfold\n",
                    sex == Sex::man ? "man" : "woman", 100 * folded / all, 100 * twice / all, 100 * fourfold / all);
    }
  }
}

/// Compares sampled vertices of a detail's atlas with a man's finest one.
void expect_one_texture(Sex sex, SkinDetail detail) {
  const SkinMesh &fine = skin_mesh(Sex::man, SkinDetail::hero), &coarse = skin_mesh(sex, detail);
  const SkinAtlas &fine_atlas = skin_atlas(Sex::man, SkinDetail::hero), &coarse_atlas = skin_atlas(sex, detail);
  const auto chart_of = [](const SkinAtlas& atlas) {
    std::vector<SkinChart> chart(atlas.vertex.size());
    for (std::size_t i = 0; i < atlas.triangle.size(); ++i) chart[atlas.triangle[i]] = atlas.chart[i / 3];
    return chart;
  };
  const std::vector<SkinChart> fine_chart = chart_of(fine_atlas), coarse_chart = chart_of(coarse_atlas);
  const std::vector<Vec> places = carried_skin(coarse, sex, *make_body(skin_body(Sex::man)));
  std::size_t compared = 0, apart = 0;
  for (std::size_t i = 0; i < coarse_atlas.vertex.size(); i += 7) {
    const Vec& at = places[coarse_atlas.vertex[i]];
    double off = 1;
    bool there = false;
    for (std::size_t j = 0; j < fine_atlas.vertex.size(); ++j) {
      constexpr double near_m = 0.004;
      if (length(fine.place[fine_atlas.vertex[j]] - at) > near_m || fine_chart[j] != coarse_chart[i]) continue;
      there = true;
      off = std::min(off, std::hypot(static_cast<double>(coarse_atlas.place[i].right - fine_atlas.place[j].right),
                                     static_cast<double>(coarse_atlas.place[i].down - fine_atlas.place[j].down)));
    }
    compared += there ? 1 : 0;
    apart += there && off > 0.01 ? 1 : 0;
  }
  EXPECT_GT(compared, 50U);
  EXPECT_LT(apart, compared / 8) << "where charts of coarse triangles end";
}

/// Vertices of two details at one place of the body and in one chart are at one place of the texture.
TEST(SkinAtlas, OneTextureFitsEveryDetail) {
  for (const Sex sex : {Sex::man, Sex::woman})
    for (const SkinDetail detail : {SkinDetail::hero, SkinDetail::near, SkinDetail::far, SkinDetail::distant}) {
      SCOPED_TRACE(static_cast<int>(sex) * 10 + static_cast<int>(detail));
      expect_one_texture(sex, detail);
    }
}

TEST(SkinAtlas, TangentsPointToTheRightAndAreNotNormals) {
  for (const SkinDetail detail : {SkinDetail::near, SkinDetail::distant}) {
    const BodySkin skin = *make_body_skin(*make_body({.height_m = 1.68F, .mass_kg = 62, .sex = Sex::woman}), detail);
    const SkinAtlas& atlas = skin_atlas(skin.sex, detail);
    const auto tangent = skin_tangents(skin);
    ASSERT_EQ(tangent.size(), atlas.vertex.size());
    for (std::size_t i = 0; i < tangent.size(); ++i) {
      const Vec t = {double{tangent[i][0]}, double{tangent[i][1]}, double{tangent[i][2]}};
      ASSERT_NEAR(length(t), 1, 1e-5);
      ASSERT_NEAR(dot(t, to_double(skin.normal[atlas.vertex[i]])), 0, 1e-5);
      ASSERT_EQ(std::fabs(tangent[i][3]), 1.0F);
    }
    double agrees = 0, all = 0;
    for (std::size_t i = 0; i < atlas.triangle.size(); i += 3) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = atlas.triangle[i + k], to = atlas.triangle[i + (k + 1) % 3];
        const Vec edge = to_double(skin.rest[atlas.vertex[to]]) - to_double(skin.rest[atlas.vertex[from]]);
        const Vec t = {double{tangent[from][0]}, double{tangent[from][1]}, double{tangent[from][2]}};
        const Vec up = static_cast<double>(tangent[from][3]) * cross(to_double(skin.normal[atlas.vertex[from]]), t);
        const double right = static_cast<double>(atlas.place[to].right) - static_cast<double>(atlas.place[from].right);
        const double rise = static_cast<double>(atlas.place[from].down) - static_cast<double>(atlas.place[to].down);
        // Uses the larger component, whose sign is certain.
        const double same = std::abs(right) > std::abs(rise) ? right * dot(edge, t) : rise * dot(edge, up);
        agrees += same > 0 ? length(edge) : 0;
        all += length(edge);
      }
    }
    EXPECT_GT(agrees / all, 0.95);
  }
}

}  // namespace
}  // namespace mobil
