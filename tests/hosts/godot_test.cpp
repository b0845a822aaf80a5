// The example for Godot 3, built with the C compiler and run with a virtual display: bones, found by name, are where
// the library's segments are, and people walk ahead in the picture.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/hosts/picture.h"
#include "tests/labels.h"
#include "tests/program/program.h"

MOBIL_TEST_LABELS("long");

namespace mobil::godot_test {

const char* const scene = R"([gd_scene load_steps=2 format=2]

[ext_resource path="res://godot_check.gd" type="Script" id=1]

[node name="check" type="Node"]
script = ExtResource( 1 )
)";

/// Numbers and words of the line that begins with `name`.
std::vector<std::string> line_of(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  for (std::string line, word; std::getline(lines, line);) {
    if (!line.starts_with(name + " ")) continue;
    std::istringstream in(line.substr(name.size()));
    return {std::istream_iterator<std::string>(in), {}};
  }
  return {};
}

TEST(Godot, MovesBonesByNameAndDrawsPeople) {
#ifndef MOBIL_LIBRARY
  GTEST_SKIP() << "built without libmobil.so";
#else
  const TemporaryFolder folder;
  for (const char* program : {"godot3", "xvfb-run"}) {
    if (run_shell(fmt::format("command -v {}", program), folder.path).status != 0)
      GTEST_SKIP() << program << " is not installed (apt-get install godot3 xvfb)";
  }
  std::filesystem::copy(MOBIL_SOURCE_DIR "/demo/examples/godot", folder.path);
  std::filesystem::copy(MOBIL_SOURCE_DIR "/tests/hosts/godot_check.gd", folder.path);
  folder.write("check.tscn", scene);
  const Ran built =
      run_shell("cp -L '" MOBIL_LIBRARY
                "' libmobil.so && ln -s libmobil.so \"$(objdump -p libmobil.so | sed -n 's/.*SONAME *//p')\" && "
                "${CC:-cc} -std=c99 -Wall -Wextra -Wpedantic -Werror -shared -fPIC mobil_crowd.c -I'" MOBIL_SOURCE_DIR
                "/systems/c/include' -L. -lmobil '-Wl,-rpath,$ORIGIN' -o libmobil_crowd.so",
                folder.path);
  ASSERT_EQ(built.status, 0) << built.err;
  const Ran ran = run_shell(
      "HOME=\"$PWD\" timeout 300 xvfb-run -a -s '-screen 0 1280x1024x24' godot3 --video-driver GLES2 --audio-driver "
      "Dummy "
      "--fixed-fps 30 --path . check.tscn",
      folder.path);
  ASSERT_EQ(ran.status, 0) << ran.out << ran.err;
  RecordProperty("output", ran.out);
  constexpr std::size_t people = 12;
  ASSERT_FALSE(line_of(ran.out, "people").empty()) << ran.out << ran.err;
  EXPECT_EQ(line_of(ran.out, "people")[0], std::to_string(people));
  EXPECT_GT(std::stoi(line_of(ran.out, "renumbered").at(0)), 0) << "bones have the numbers of segments";
  const std::vector<std::string> nothing{"-1", "Null", "Null", "Null", "0", "0", "Null"};
  EXPECT_EQ(line_of(ran.out, "refused"), nothing) << ran.out;
  for (const char* cause : {"height = 3 m", "no person has that number", "number of arguments", "detail",
                            "not a Skeleton", "not the skeleton of bind()"})
    EXPECT_NE(ran.err.find(cause), std::string::npos) << cause << " is missing: " << ran.err;

  const auto bones = line_of(ran.out, "bones_mm");
  ASSERT_EQ(bones.size(), 3U) << ran.out;
  EXPECT_LT(std::stod(bones[0]), 0.01);
  EXPECT_GE(std::stoi(bones[2]), 200);
  for (std::size_t i = 0; i < people; ++i) {  // ahead is -z
    const auto person = line_of(ran.out, fmt::format("person {}", i));
    ASSERT_EQ(person.size(), 4U) << ran.out;
    const double speed_m_s = 1.0 + 0.05 * static_cast<double>(i % 7), seconds = (33 - 8) / 30.0;
    EXPECT_NEAR(std::stod(person[1]), -speed_m_s * seconds, 0.06) << "way of person " << i;
    EXPECT_NEAR(std::stod(person[0]), 0, 0.06);
    EXPECT_LT(std::stod(person[2]), -0.15) << "feet of person " << i;
    EXPECT_GT(std::stod(person[3]), 0.5) << "person " << i << " is not upright";
  }

  ASSERT_EQ(read_pixels(folder.path / "picture.png").size(), 960U * 640U);
  for (const int i : {0, 1, 2, 3}) {  // the skin is where the bones are: colours at a shirt, a shoe and a hand
    const auto seen = [&](const char* segment) {
      std::array<double, 3> colour{};
      const auto words = line_of(ran.out, fmt::format("seen {} {}", i, segment));
      for (std::size_t c = 0; c < 3; ++c) colour[c] = std::stod(words.at(c));
      return colour;
    };
    const auto [red, green, blue] = seen("T8");
    const std::array shirt{blue > 1.5 * green, red > 2 * green, green > 1.5 * red, std::min({red, green, blue}) > 100};
    EXPECT_TRUE(shirt[static_cast<std::size_t>(i)]) << i << ": " << red << ' ' << green << ' ' << blue;
    const auto shoe = seen("toes_left"), hand = seen("hand_left");
    EXPECT_LT(shoe[0], 60) << i;
    EXPECT_GT(shoe[0], 1.1 * shoe[2]) << i;
    EXPECT_GT(hand[0], 1.3 * hand[2]) << i;
  }
#endif
}

}  // namespace mobil::godot_test
