// A walk in Blender: bones, rest pose and loop of an imported GLB are those of the file, and its skin covers all
// inside.
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>

#include "tests/files/export_fixture.h"
#include "tests/labels.h"
#include "tests/program/program.h"

MOBIL_TEST_LABELS("long");

namespace mobil::blender_test {
using Eigen::Vector3d;
using export_fixture::Viewer;

constexpr double near_m = 1e-5;

/// Output of tests/hosts/read_glb.py.
struct ReadByBlender {
  std::map<std::string, Vector3d> rest;
  std::map<std::pair<std::size_t, std::string>, Vector3d> bone;  // by key and name
  std::map<std::size_t, std::pair<int, double>> outside;         // by key: vertices, mm
  int actions = 0;
};

ReadByBlender parsed(const std::string& text) {
  ReadByBlender read;
  std::istringstream lines(text);
  for (std::string line, word, name; std::getline(lines, line);) {
    std::istringstream in(line);
    std::size_t key = 0;
    Vector3d p;
    in >> word;
    if (word == "rest" && in >> name >> p.x() >> p.y() >> p.z()) read.rest[name] = p;
    if (word == "bone" && in >> key >> name >> p.x() >> p.y() >> p.z()) read.bone[{key, name}] = p;
    if (word == "outside" && in >> key) in >> read.outside[key].first >> read.outside[key].second;
    if (word == "actions") in >> read.actions;
  }
  return read;
}

TEST(Blender, WalkIsTheSameInBlenderAndStaysInItsSkin) {
  const TemporaryFolder folder;
  if (run_shell("blender --version", folder.path).status != 0) GTEST_SKIP() << "blender is not installed";
  const Ran ran = run_mobil("walk --skin --skin-anatomy --cycle 1 --root-motion --out out", folder.path);
  ASSERT_EQ(ran.status, 0) << ran.err;
  const Viewer viewer(folder.path / "out" / "walk.glb");
  const auto times = viewer.floats(viewer.model.animations.at(0).samplers.at(0).input);
  const std::size_t keys = times.size(), last = keys - 1;
  const double frame_s = static_cast<double>(times.back()) / static_cast<double>(last);
  const Ran blender = run_shell(fmt::format("blender -b --factory-startup --python '{}' -- out/walk.glb {} {:.9f}",
                                            MOBIL_SOURCE_DIR "/tests/hosts/read_glb.py", keys, frame_s),
                                folder.path);
  ASSERT_EQ(blender.status, 0) << blender.err;
  const ReadByBlender read = parsed(blender.out);
  ASSERT_EQ(read.rest.size(), segment_count) << blender.out << blender.err;
  ASSERT_EQ(read.bone.size(), keys * segment_count);
  double worst_m = 0;
  for (std::size_t s = 0; s < segment_count; ++s) {
    const std::string name(segment_name[s]);
    Vector3d rest = Vector3d::Zero();
    for (auto n = static_cast<int>(viewer.node.at(name)); n >= 0; n = viewer.parent[static_cast<std::size_t>(n)]) {
      const auto& t = viewer.model.nodes[static_cast<std::size_t>(n)].translation;
      if (!t.empty()) rest += Vector3d(t[0], t[1], t[2]);
    }
    EXPECT_LT((read.rest.at(name) - rest).norm(), near_m) << name;
    for (std::size_t key = 0; key < keys; ++key) {
      const Vector3d expected = viewer.world(viewer.node.at(name), key).translation();
      worst_m = std::max(worst_m, (read.bone.at({key, name}) - expected).norm());
    }
    const auto way = viewer.key(viewer.node.at("walker"), "translation", last);
    const Vector3d closed = read.bone.at({last, name}) - Vector3d(way.at(0), way.at(1), way.at(2));
    EXPECT_LT((closed - read.bone.at({0, name})).norm(), near_m) << name;
  }
  EXPECT_LT(worst_m, near_m);
  RecordProperty("bones_mm", std::to_string(1e3 * worst_m));
  ASSERT_FALSE(read.outside.empty());
  for (const auto& [key, found] : read.outside)
    EXPECT_EQ(found.first, 0) << "key " << key << ", " << found.second << " mm";
  // One of the armature with the root's way, one of each mesh with morph targets.
  const auto& channels = viewer.model.animations[0].channels;
  EXPECT_EQ(read.actions,
            1 + std::ranges::count(channels, "weights", [](const auto& channel) { return channel.target_path; }));
}

}  // namespace mobil::blender_test
