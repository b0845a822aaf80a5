// `--axes y_up_z_back` of walks and crowds: half a turn of everything about the vertical, segments' frames as well.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <mobil/pose_writer.h>
#include <mobil/simulation.h>
#include <mobil/usual_gait.h>
#include "tests/files/export_fixture.h"
#include "tests/labels.h"
#include "tests/program/program.h"

MOBIL_TEST_LABELS("long");

namespace mobil::file_axes_test {
using Eigen::Vector3d;
using export_fixture::Viewer;

struct Written {
  TemporaryFolder folder;
  explicit Written(const std::string& command) {
    const Ran ran = run_mobil(command, folder.path);
    EXPECT_EQ(ran.status, 0) << command << ": " << ran.err;
  }
  Viewer glb(const std::string& file) const { return Viewer(folder.path / file); }
};

Vector3d half_turn(const Vector3d& v) {
  return {-v.x(), v.y(), -v.z()};
}

/// Expects that all meshes of `turned` are those of `usual` after half a turn, drawn by their joints at that key.
void expect_half_turn(const Viewer& usual, const Viewer& turned, std::size_t key) {
  std::size_t vertices = 0;
  for (const auto& [name, n] : usual.node) {
    if (usual.model.nodes[n].mesh < 0) continue;
    const std::size_t other = turned.node.at(name);
    for (std::size_t part = 0; part < usual.mesh_of(n).primitives.size(); ++part) {
      const auto a = usual.blended(n, key, part), b = turned.blended(other, key, part);
      ASSERT_EQ(a.size(), b.size());
      vertices += a.size();
      double worst = 0;
      for (std::size_t v = 0; v < a.size(); ++v) worst = std::max(worst, (half_turn(a[v]) - b[v]).norm());
      EXPECT_LT(worst, 2e-5) << name << " at " << key;
      const auto texture = [part](const Viewer& viewer, std::size_t node) {
        return viewer.floats(viewer.mesh_of(node).primitives[part].attributes.at("TEXCOORD_0"));
      };
      const auto u = texture(usual, n), w = texture(turned, other);
      ASSERT_EQ(u.size(), w.size());
      for (std::size_t i = 0; i < u.size(); ++i) ASSERT_NEAR(u[i], w[i], 2e-5F) << name;
      EXPECT_EQ(usual.indices(usual.mesh_of(n).primitives[part].indices),
                turned.indices(turned.mesh_of(other).primitives[part].indices));
    }
  }
  EXPECT_GT(vertices, 1000U);
}

TEST(FileAxes, PosesOfTheLibraryInTheSameAxesAreThoseOfTheFile) {
  const Written turned("walk --quiet --method none --speed 1.3m/s --seconds 0.5 --skin --axes y_up_z_back --out out");
  const Viewer viewer = turned.glb("out/walk.glb");
  Simulation simulation;
  const Entity person = simulation.spawn(BodyRequest{}, {.speed_m_s = 1.3F, .style = usual_style({})}).value();
  PoseWriter writer;
  for (std::size_t f = 0; f < 15; ++f) {
    simulation.tick(f == 0 ? 1 : 2);
    std::array<std::array<float, 7>, segment_count> pose{};
    ASSERT_TRUE(writer.write(simulation.world(), {&person, 1}, 0, {.axes = PoseAxes::y_up_z_back},
                             {std::as_writable_bytes(std::span(pose))}));
    for (std::size_t s = 0; s < segment_count; ++s) {
      const auto& p = pose[s];
      const auto world = viewer.world(viewer.node.at(std::string(segment_name[s])), f);
      const Vector3d place(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
      ASSERT_LT((world.translation() - place).norm(), 1e-5) << segment_name[s] << " at " << f;
      const Eigen::Quaterniond turn(static_cast<double>(p[6]), static_cast<double>(p[3]), static_cast<double>(p[4]),
                                    static_cast<double>(p[5]));
      ASSERT_LT(Eigen::Quaterniond(world.linear()).angularDistance(turn.normalized()), 1e-5) << segment_name[s];
    }
  }
}

TEST(FileAxes, SurfacesOfAWalkTurn) {
  for (const std::string options : {"--skin --skin-anatomy", "--cycle 1 --root-motion", "--in-place --skin"}) {
    const std::string walk = "walk --quiet --muscles soleus,hamstrings --out out " + options +
                             (options.find("--cycle") == std::string::npos ? " --seconds 0.5" : "");
    const Viewer usual = Written(walk).glb("out/walk.glb"),
                 turned = Written(walk + " --axes y_up_z_back").glb("out/walk.glb");
    for (const std::size_t key : {0U, 9U}) expect_half_turn(usual, turned, key);
  }
}

/// Returns the rows of numbers of a BVH file.
std::vector<std::vector<double>> bvh_rows(const std::string& text) {
  std::istringstream lines(text.substr(text.find("Frame Time")));
  std::string line;
  std::getline(lines, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(lines, line)) {
    std::istringstream row(line);
    rows.emplace_back(std::istream_iterator<double>(row), std::istream_iterator<double>());
  }
  return rows;
}

/// Returns the axis of each channel of a BVH file, in its order.
std::string bvh_axes(const std::string& text) {
  std::istringstream words(text.substr(0, text.find("MOTION")));
  std::string word, axes;
  while (words >> word)
    if (word.ends_with("position") || word.ends_with("rotation")) axes += word[0];
  return axes;
}

TEST(FileAxes, BvhTurnsAndModelsKeepTheirAxes) {
  const std::string walk =
      "walk --quiet --method none --seconds 0.3 --export w.bvh --export w.mot --export w.xml --export w.osim --out out";
  const Written usual(walk), turned(walk + " --axes y_up_z_back");
  const auto text_of = [](const Written& written, const std::string& file) {
    return read_bytes(written.folder.path / "out" / file);
  };
  for (const std::string file : {"w.mot", "w.xml", "w.osim", "w_motion.csv"})
    EXPECT_EQ(text_of(usual, file), text_of(turned, file)) << file;
  const std::string axes = bvh_axes(text_of(usual, "w.bvh"));
  const auto a = bvh_rows(text_of(usual, "w.bvh")), b = bvh_rows(text_of(turned, "w.bvh"));
  ASSERT_EQ(a.size(), b.size());
  ASSERT_EQ(a.size(), 18U);
  for (std::size_t row = 0; row < a.size(); ++row) {
    ASSERT_EQ(a[row].size(), axes.size());
    for (std::size_t i = 0; i < axes.size(); ++i)
      EXPECT_NEAR(b[row][i], axes[i] == 'Y' ? a[row][i] : -a[row][i], 2e-4) << row << " " << i;
  }
}

/// Returns the numbers of a text.
std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  for (const char* at = text.c_str(); *at != 0;) {
    char* end = nullptr;
    const double number = std::strtod(at, &end);
    if (end == at) {
      ++at;
      continue;
    }
    numbers.push_back(number);
    at = end;
  }
  return numbers;
}

/// Returns how many numbers differ in more than their signs. Those of a line are compared in any order, because the
/// minimum of an extent becomes the maximum.
std::size_t other_numbers(const std::string& usual, const std::string& turned) {
  std::istringstream a(usual), b(turned);
  std::size_t other = 0;
  for (std::string x, y; std::getline(a, x) && std::getline(b, y);) {
    auto m = numbers_of(x), n = numbers_of(y);
    if (m.size() != n.size()) return usual.size();
    for (auto* const numbers : {&m, &n}) {
      for (double& number : *numbers) number = std::abs(number);
      std::ranges::sort(*numbers);
    }
    for (std::size_t k = 0; k < m.size(); ++k) other += std::abs(m[k] - n[k]) > 2e-5 ? 1 : 0;
  }
  return other;
}

TEST(FileAxes, OtherFormatsChangeSignsOnly) {
  const std::string walk =
      "walk --quiet --muscles soleus --seconds 0.1 --export w.usda --export w.x3d --export w.wrl --out out";
  const Written usual(walk), turned(walk + " --axes y_up_z_back");
  for (const std::string file : {"w.usda", "w.x3d", "w.wrl"}) {
    const std::string a = read_bytes(usual.folder.path / "out" / file),
                      b = read_bytes(turned.folder.path / "out" / file);
    EXPECT_NE(a, b);
    EXPECT_EQ(other_numbers(a, b), 0U) << file;
  }
}

TEST(FileAxes, CrowdsTurn) {
  const std::string crowd =
      "crowd --people 3 --seconds 0.1 --tolerance 100mm --near 0 --export-seconds 0.5 --root-motion --export c.glb";
  const Viewer usual = Written(crowd).glb("c.glb"), turned = Written(crowd + " --axes y_up_z_back").glb("c.glb");
  expect_half_turn(usual, turned, 7);
}

TEST(FileAxes, UnknownOnesAreRefusedInOneLine) {
  const TemporaryFolder folder;
  expect_refused("walk", {{"--axes z_up", {"--axes", "y_up_z_back"}}}, folder.path);
  expect_refused("crowd", {{"--axes y_up_z_back", {"--axes", "--export"}}}, folder.path);
}

}  // namespace mobil::file_axes_test
