// Baked skins: the same bits as made ones, and refusals.

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include <mobil/skin_writer.h>
#include "tests/labels.h"

MOBIL_TEST_LABELS("long");

namespace mobil::baked_skins_test {
namespace {

const BodyRequest bodies[] = {{.height_m = 1.81F, .mass_kg = 79}, {.height_m = 1.6F, .mass_kg = 80, .sex = Sex::woman}};

std::vector<std::byte> baked() {
  BodySkins skins;
  for (const BodyRequest& body : bodies) EXPECT_TRUE(skins.of(body, SkinDetail::far));
  EXPECT_FALSE(skins.of({.height_m = 3}, SkinDetail::far));
  return skins.bake();
}

TEST(BakedSkins, HaveTheBitsOfMadeOnes) {
  BodySkins made, loaded;
  const auto bytes = baked();
  ASSERT_TRUE(loaded.load(bytes));
  ASSERT_TRUE(loaded.load(bytes)) << "twice";
  for (const BodyRequest& body : bodies) {
    // The second detail is not in the file, and is made from the loaded fit.
    for (const SkinDetail detail : {SkinDetail::far, SkinDetail::distant}) {
      const SkinShape a = *made.of(body, detail), b = *loaded.of(body, detail);
      ASSERT_NE(a.skin, b.skin);
      EXPECT_EQ(a.lengths, b.lengths);
      EXPECT_EQ(a.skin->leg.base, b.skin->leg.base);
      EXPECT_EQ(a.skin->leg.fat, b.skin->leg.fat);
      EXPECT_EQ(std::memcmp(&a.skin->standing, &b.skin->standing, sizeof a.skin->standing), 0);
      ASSERT_EQ(a.skin->rest.size(), b.skin->rest.size());
      EXPECT_EQ(std::memcmp(a.skin->rest.data(), b.skin->rest.data(), a.skin->rest.size() * sizeof(Vec3<float>)), 0);
      EXPECT_EQ(std::memcmp(a.skin->normal.data(), b.skin->normal.data(), a.skin->rest.size() * sizeof(Vec3<float>)),
                0);
    }
  }
  EXPECT_EQ(loaded.bake().size(), [&] {
    BodySkins again;
    EXPECT_TRUE(again.load(loaded.bake()));
    return again.bake().size();
  }());
}

TEST(BakedSkins, AreRefusedIfAltered) {
  const auto bytes = baked();
  BodySkins skins;
  const auto refused = [&](std::span<const std::byte> some, const char* what) {
    const auto done = skins.load(some);
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().message.find(what), std::string::npos) << done.error().message;
  };
  refused({}, "no baked skins");
  refused(std::span(bytes).first(31), "no baked skins");
  refused(std::span(bytes).first(bytes.size() - 1), "cut or altered");
  std::mt19937 random(5);
  for (int i = 0; i < 20; ++i) {
    auto other = bytes;
    other[32 + random() % (bytes.size() - 32)] ^= std::byte{4};
    refused(other, "cut or altered");
  }
  auto other = bytes;
  other[9] ^= std::byte{1};
  refused(other, "another version");
  BodySkins bare(SkinDress{.dressed = false});
  const auto clothes = bare.load(bytes);
  ASSERT_FALSE(clothes);
  EXPECT_NE(clothes.error().message.find("clothes"), std::string::npos);
}

}  // namespace
}  // namespace mobil::baked_skins_test
