// The rest pose of exported skeletons: the anatomical position, the same in nodes, skins and all formats.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/export/recorded_skin.h>
#include <mobil/bvh_writer.h>
#include <mobil/engine/world.h>
#include <mobil/gltf_writer.h>
#include <mobil/simulation.h>
#include <mobil/usd_writer.h>
#include "tests/files/export_fixture.h"
#include "tests/files/temporary_folder.h"

namespace mobil::rest_pose_test {
using namespace export_fixture;

/// A second of a person's walk, with the skin or with bones.
WalkRecording real_walk(const BodyRequest& request, bool with_skin) {
  Simulation simulation;
  const Entity person = simulation.spawn(request, {}).value();
  const Body body = make_body(request).value();
  WalkRecording walk;
  for (int tick = 0; tick < 60; ++tick) {
    simulation.tick();
    if (tick % 2 == 0) walk.frames.push_back(*simulation.get<Pose>(person));
  }
  const Pose<float> standing = standing_pose(body);
  std::copy_n(standing.position_m, segment_count, walk.standing_m.begin());
  if (!with_skin) {
    walk.bones.push_back({Segment::thigh_right, tube("femur_right", 6, 8, 0.015, 0.3)});
    return walk;
  }
  const BodySkin skin = make_body_skin(body, SkinDetail::distant).value();
  walk.skin = recorded_skin(skin);
  walk.colours.resize(skin_parts);
  return walk;
}

/// A node's place in the world without any animation.
Eigen::Affine3d at_rest(const Viewer& viewer, std::size_t n) {
  const tinygltf::Node& node = viewer.model.nodes[n];
  EXPECT_TRUE(node.rotation.empty() && node.scale.empty() && node.matrix.empty()) << node.name;
  Eigen::Affine3d local = Eigen::Affine3d::Identity();
  if (!node.translation.empty())
    local.translation() = Vector3d(node.translation[0], node.translation[1], node.translation[2]);
  return viewer.parent[n] < 0 ? local : at_rest(viewer, static_cast<std::size_t>(viewer.parent[n])) * local;
}

/// Expects that skins leave their vertices in place where the nodes rest, except for their size.
void expect_bound_at_rest(const Viewer& viewer, const std::map<std::string, Vector3d>& size = {}) {
  for (const tinygltf::Skin& skin : viewer.model.skins) {
    const auto inverse = viewer.floats(skin.inverseBindMatrices);
    Eigen::Matrix4d expected = Eigen::Matrix4d::Identity();
    if (size.contains(skin.name)) expected.diagonal().head<3>() = size.at(skin.name);
    ASSERT_EQ(skin.joints.size(), segment_count);
    for (std::size_t s = 0; s < segment_count; ++s) {
      const Eigen::Matrix4d bound = Eigen::Map<const Eigen::Matrix4f>(inverse.data() + 16 * s).cast<double>();
      const Eigen::Matrix4d world = at_rest(viewer, static_cast<std::size_t>(skin.joints[s])).matrix();
      EXPECT_LT((world * bound - expected).cwiseAbs().maxCoeff(), 1e-5) << skin.name << " " << segment_name[s];
    }
  }
}

std::array<Vector3d, segment_count> glb_offsets(const Viewer& viewer) {
  std::array<Vector3d, segment_count> offset;
  for (std::size_t s = 0; s < segment_count; ++s) {
    const auto& t = viewer.model.nodes[viewer.node.at(std::string(segment_name[s]))].translation;
    offset[s] = {t.at(0), t.at(1), t.at(2)};
  }
  return offset;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Returns the translations of a USD attribute of matrices.
std::vector<Vector3d> usd_translations(const std::string& text, const std::string& attribute) {
  const std::size_t first = text.find(attribute), last = text.find('\n', first);
  EXPECT_NE(first, std::string::npos);
  const std::string line = text.substr(first, last - first);
  const std::regex row(R"(\(([-.0-9e]+), ([-.0-9e]+), ([-.0-9e]+), 1\) \))");
  std::vector<Vector3d> found;
  for (std::sregex_iterator at(line.begin(), line.end(), row), end; at != end; ++at)
    found.emplace_back(std::stod((*at)[1]), std::stod((*at)[2]), std::stod((*at)[3]));
  return found;
}

TEST(RestPose, SkinsAreBoundWhereTheNodesRest) {
  const TemporaryFolder folder;
  const auto file = folder.path / "walk.glb";
  for (const WalkRecording& walk : {small_walk(), real_walk({}, true), real_walk({.sex = Sex::woman}, false)}) {
    ASSERT_TRUE(write_glb(file, walk));
    expect_bound_at_rest(Viewer(file));
  }
}

TEST(RestPose, PeopleOfACrowdRestAtTheirSize) {
  const TemporaryFolder folder;
  const auto walk = small_walk();
  CrowdRecording crowd;
  crowd.figures.push_back({walk.bones, {}, {}, {}});
  crowd.people.push_back({"anna", 0, {0.9F, 0.9F, 0.9F}, {}, walk.frames, {}});
  crowd.people.push_back({"bert", 0, {1.2F, 1.1F, 1.3F}, {}, walk.frames, {walk.muscles[0]}});
  ASSERT_TRUE(write_glb(folder.path / "crowd.glb", crowd));
  const Viewer viewer(folder.path / "crowd.glb");
  ASSERT_EQ(viewer.model.skins.size(), 3U);  // bert's muscle has its own size
  constexpr double anna = 0.9F;
  expect_bound_at_rest(
      viewer, {{"anna", Vector3d(anna, anna, anna)}, {"bert", Vector3d(double{1.2F}, double{1.1F}, double{1.3F})}});
}

TEST(RestPose, AllFormatsHaveTheAnatomicalOffsetsWithAndWithoutSkin) {
  const TemporaryFolder folder;
  const BodyRequest request{.height_m = 1.63F, .mass_kg = 82, .sex = Sex::woman};
  const Body body = make_body(request).value();
  for (const bool with_skin : {false, true}) {
    const WalkRecording walk = real_walk(request, with_skin);
    ASSERT_TRUE(write_glb(folder.path / "walk.glb", walk));
    ASSERT_TRUE(write_usda(folder.path / "walk.usda", walk));
    ASSERT_TRUE(write_bvh(folder.path / "walk.bvh", walk));
    const auto glb = glb_offsets(Viewer(folder.path / "walk.glb"));
    const std::string usd = text_of(folder.path / "walk.usda"), bvh = text_of(folder.path / "walk.bvh");
    const auto rest = usd_translations(usd, "restTransforms"), bind = usd_translations(usd, "bindTransforms");
    ASSERT_EQ(rest.size(), segment_count);
    ASSERT_EQ(bind.size(), segment_count);
    for (std::size_t s = 0; s < segment_count; ++s) {
      const std::string name(segment_name[s]);
      EXPECT_LT((glb[s] - widened(body.joint_offset_m[s])).norm(), 1e-6) << name;
      EXPECT_LT((glb[s] - rest[s]).norm(), 2e-6) << name;
      const std::size_t parent = index(segment_parent[s]);
      const Vector3d from = parent == s ? Vector3d(Vector3d::Zero()) : bind[parent];
      EXPECT_LT((glb[s] - (bind[s] - from)).norm(), 2e-6) << name;
      std::smatch joint;
      ASSERT_TRUE(std::regex_search(
          bvh, joint, std::regex(" " + name + "\\n\\s*\\{\\n\\s*OFFSET (\\S+) (\\S+) (\\S+)\\n\\s*CHANNELS (\\d)")));
      if (joint[4] == "6") continue;  // has its place in each frame
      const Vector3d offset(std::stod(joint[1]), std::stod(joint[2]), std::stod(joint[3]));
      EXPECT_LT((glb[s] - offset).norm(), 1e-5) << name;
    }
  }
}

TEST(RestPose, AnimationReproducesThePosesOfARealWalk) {
  const TemporaryFolder folder;
  const WalkRecording walk = real_walk({}, true);
  ASSERT_TRUE(write_glb(folder.path / "walk.glb", walk));
  const Viewer viewer(folder.path / "walk.glb");
  for (std::size_t f = 0; f < walk.frames.size(); ++f) {
    for (std::size_t s = 0; s < segment_count; ++s) {
      const auto world = viewer.world(viewer.node.at(std::string(segment_name[s])), f);
      ASSERT_LT((world.translation() - widened(walk.frames[f].position_m[s])).norm(), 1e-5) << segment_name[s];
      ASSERT_LT(Quaterniond(world.linear()).angularDistance(widened(walk.frames[f].rotation[s]).normalized()), 1e-5);
    }
  }
}

}  // namespace mobil::rest_pose_test
