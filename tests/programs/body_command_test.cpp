// `mobil body`: its figures add up and name their sources; impossible bodies are refused, adjustments are reported.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/program/program.h"

namespace mobil::body_command_test {
using Json = nlohmann::json;

Json parameters(const std::string& options) {
  const TemporaryFolder folder;
  const Ran ran = run_mobil("body --json " + options, folder.path);
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path));
  return Json::parse(ran.out);
}

const Json& reference() {
  static const Json made = parameters("--height 1.80 --mass 80");
  return made;
}

const Json& row(const Json& rows, const std::string& name) {
  const auto at = std::ranges::find_if(rows, [&](const Json& r) { return r.at("name") == name; });
  EXPECT_NE(at, rows.end()) << name;
  return *at;
}

TEST(BodyCommand, SegmentsAddUpToTheBody) {
  for (const char* options : {"--height 1.80 --mass 80", "--height 1.2 --mass 30", "--height 2.2 --mass 200"}) {
    const Json json = parameters(options);
    const double height = json["request"]["height_m"], mass = json["request"]["mass_kg"];
    const Json& rows = json["segments"]["rows"];
    ASSERT_EQ(rows.size(), 48U);
    double sum = 0;
    std::set<std::string> known;
    for (const Json& segment : rows) {
      sum += segment["mass_kg"].get<double>();
      for (const char* key : {"joint_offset_m", "joint_centre_m", "tip_m", "centre_of_mass_m", "inertia_kg_m2"}) {
        ASSERT_EQ(segment.at(key).size(), 3U) << key;
      }
      for (const double inertia : segment["inertia_kg_m2"]) EXPECT_GT(inertia, 0);
      EXPECT_GT(segment["length_m"].get<double>(), 0) << segment["name"];
      known.insert(segment["name"].get<std::string>());
      if (segment["parent"].is_null()) continue;
      const std::string parent = segment["parent"];
      ASSERT_TRUE(known.contains(parent));  // parents first
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double at =
            row(rows, parent)["joint_centre_m"][axis].get<double>() + segment["joint_offset_m"][axis].get<double>();
        EXPECT_NEAR(at, segment["joint_centre_m"][axis].get<double>(), 1e-5);
      }
    }
    EXPECT_NEAR(sum, mass, 1e-3);
    EXPECT_NEAR(row(rows, "head")["joint_centre_m"][1].get<double>() + row(rows, "head")["length_m"].get<double>(),
                height, 1e-4);
    EXPECT_NEAR(json["composition"]["fat_mass_kg"].get<double>() + json["composition"]["lean_mass_kg"].get<double>(),
                mass, 1e-3);
  }
}

TEST(BodyCommand, EveryMuscleHasItsFiguresAndTheGroupsAreTheirMembers) {
  const Json& muscles = reference()["muscles"];
  ASSERT_EQ(muscles["sides"], Json({"right", "left"}));
  const Json& rows = muscles["rows"];
  std::size_t groups = 0;
  for (const Json& muscle : rows) {
    SCOPED_TRACE(muscle["name"].get<std::string>());
    for (const char* key : {"volume_m3", "mass_kg", "muscle_tendon_length_m", "belly_length_m", "fibre_length_m",
                            "tendon_length_m", "section_m2", "physiological_section_m2"}) {
      EXPECT_GT(muscle.at(key).get<double>(), 0) << key;
    }
    EXPECT_GE(muscle.at("pennation_deg").get<double>(), 0);
    EXPECT_GT(muscle.at("mesh").at("belly_length_m").get<double>(), 0);
    if (muscle["kind"] == "group") {
      ++groups;
      if (muscle["members"].size() == 1) continue;
      double volume = 0;
      for (const std::string member : muscle["members"]) {
        const Json& one = row(rows, member);
        volume += one["volume_m3"].get<double>();
        EXPECT_EQ(one["group"], muscle["name"]);
      }
      EXPECT_NEAR(volume / muscle["volume_m3"].get<double>(), 1, 1e-5);
      continue;
    }
    const Json& ends = muscle.at("attachments");
    double from_to = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      from_to +=
          std::pow(ends["origin"]["world_m"][axis].get<double>() - ends["insertion"]["world_m"][axis].get<double>(), 2);
    }
    EXPECT_LE(std::sqrt(from_to), muscle["muscle_tendon_length_m"].get<double>() * (1 + 1e-5));
    EXPECT_GT(std::sqrt(from_to), 0.6 * muscle["muscle_tendon_length_m"].get<double>());
  }
  EXPECT_EQ(groups, 12U);
}

TEST(BodyCommand, EveryBlockOfFiguresNamesItsSource) {
  for (const char* block : {"composition", "standing", "segments", "joint_limits", "muscles"}) {
    EXPECT_FALSE(reference().at(block).at("source").empty()) << block;
  }
  EXPECT_TRUE(reference().at("notes").empty());
  for (const Json& limit : reference()["joint_limits"]["limbs"]) {
    EXPECT_TRUE(reference()["joint_limits"]["source"].contains(limit["source"].get<std::string>()));
    EXPECT_LT(limit["low_deg"].get<double>(), limit["high_deg"].get<double>());
  }
  EXPECT_EQ(reference()["joint_limits"]["column"].size(), 24U);
}

TEST(BodyCommand, ImpossibleBodiesAreRefusedInOneLine) {
  const TemporaryFolder folder;
  expect_refused("body",
                 {{"--height 2.2 --mass 30 --out out", {"2.2 m", "30 kg", "58.1–200.0 kg"}},
                  {"--height 120cm --mass 200 --out out", {"1.2 m", "30.0–132.4 kg"}},
                  {"--height 2.5 --out out", {"--height", "1.2 to 2.2 m"}},
                  {"--mass 20 --json", {"--mass", "30 to 200 kg"}},
                  {"--age 6 --json", {"nobody of 6 years is 1.75 m tall", "0.92–1.38 m"}},
                  {"--age 6 --height 1.8 --json", {"--height", "0.92 to 1.38 m"}},
                  {"--age 5 --json", {"--age", "6 to 95"}},
                  {"--typical --height 1.8 --json", {"--typical", "--height"}},
                  {"--biotype 3-5 --out out", {"--biotype", "endo-meso-ecto"}},
                  {"--constitution fat --out out", {"--constitution", "thin, average, athletic, heavy"}},
                  {"--speed 3 --out out", {"--speed"}},
                  {"--out ''", {"--out"}}},
                 folder.path);
}

TEST(BodyCommand, TypicalBodiesFollowFromSexAndAge) {
  const Json girl = parameters("--age 10 --sex woman --typical");
  EXPECT_EQ(girl["request"]["age_y"], 10);
  EXPECT_EQ(girl["request"]["sex"], "woman");
  EXPECT_NEAR(girl["request"]["height_m"].get<double>(), 1.38, 0.005);
  EXPECT_NEAR(girl["composition"]["fat_share"].get<double>(), 0.20, 0.01);
  EXPECT_EQ(parameters("--height 1.8")["request"]["age_y"], 25);
}

TEST(BodyCommand, ReportsAdjustments) {
  const Json thin = parameters("--height 1.80 --mass 60 --biotype 2-3-1");
  ASSERT_EQ(thin["notes"].size(), 1U);
  EXPECT_NE(thin["notes"][0].get<std::string>().find("ectomorphy 1.0"), std::string::npos);
  EXPECT_NEAR(thin["composition"]["biotype_taken"]["ectomorphy"].get<double>(), 5.1, 0.1);
  const Json strong = parameters("--height 1.80 --mass 80 --biotype 4-12-2 --constitution athletic");
  ASSERT_EQ(strong["notes"].size(), 1U);
  EXPECT_NE(strong["notes"][0].get<std::string>().find("lean mass"), std::string::npos);
  const Json stout = parameters("--height 1.50 --mass 200 --biotype 2-4-0.1");
  EXPECT_NE(stout["notes"].dump().find("81 kg without fat"), std::string::npos) << stout["notes"];
}

/// Different colours of a picture, and its size.
struct Picture {
  unsigned width = 0, height = 0;
  std::set<std::uint32_t> colours;
};
Picture read_picture(const std::filesystem::path& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  Picture read;
  if (png_image_begin_read_from_file(&image, file.c_str()) == 0) return read;
  image.format = PNG_FORMAT_RGBA;
  std::vector<std::uint32_t> pixels(std::size_t{image.width} * image.height);
  if (png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) == 0) return read;
  read.width = image.width, read.height = image.height;
  read.colours.insert(pixels.begin(), pixels.end());
  return read;
}

TEST(BodyCommand, WritesItsOutputAndAPicture) {
  const TemporaryFolder folder;
  const Ran ran = run_mobil("body --height 1.65 --mass 58 --out one/two", folder.path);
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(read_bytes(folder.path / "one/two/body.json"),
            run_mobil("body --height 1.65 --mass 58 --json", folder.path).out);
  for (const char* word : {"thigh", "soleus", "body mass index 21.3", "look at one/two"}) {
    EXPECT_NE(ran.out.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(run_mobil("body --height 1.65 --mass 58 --quiet --out quiet", folder.path).out, "");
  if (ran.err.find("EGL") != std::string::npos) GTEST_SKIP() << ran.err;
  EXPECT_EQ(ran.err, "");
  const Picture picture = read_picture(folder.path / "one/two/body.png");
  EXPECT_GE(picture.width, 800U);
  EXPECT_GE(picture.height, 800U);
  EXPECT_GT(picture.colours.size(), 2000U);
  // No other file, and none incomplete.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path / "one/two"), {}), 2);
}

}  // namespace mobil::body_command_test
