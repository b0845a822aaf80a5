// BVH, USD, X3D, VRML and GL coordinates of a recorded walk, read back by other programs: assimp for formats that it
// supports, else read_formats.py, which shares no code with the writers, and pxr if Python has it.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <mobil/bvh_writer.h>
#include <mobil/gl_writer.h>
#include <mobil/gltf_writer.h>
#include <mobil/opensim_writer.h>
#include <mobil/usd_writer.h>
#include <mobil/x3d_writer.h>
#include "assets/export/joint_angles.h"
#include "assets/export/unique_names.h"
#include "tests/files/formats_fixture.h"
#include "tests/labels.h"

MOBIL_TEST_LABELS("long");

namespace mobil::formats_test {

TEST(Formats, AssimpReadsTheJointsOfAGlbAndOneSkinOfAllBones) {
  const TemporaryFolder place;
  const auto file = place.path / "walk.glb";
  const auto walk = small_walk();
  ASSERT_TRUE(write_glb(file, walk));
  expect_assimp_joints(file, walk.frames);
  const AssimpWalk read(file);
  for (unsigned m = 0; m < read.scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *read.scene->mMeshes[m];
    EXPECT_GT(mesh.mNumBones, 0U);
    EXPECT_TRUE(mesh.HasTextureCoords(0));
    unsigned weights = 0;
    for (unsigned b = 0; b < mesh.mNumBones; ++b) weights += mesh.mBones[b]->mNumWeights;
    EXPECT_GE(weights, mesh.mNumVertices);
  }
}

TEST(Formats, AssimpReadsBvhJointsAtAnyRotation) {
  const TemporaryFolder place;
  for (const unsigned seed : {0U, 1U, 2U}) {
    WalkRecording walk;
    walk.frames = seed == 0 ? swinging(45) : writhing(45, seed);
    ASSERT_TRUE(write_bvh(place.path / "walk.bvh", walk));
    expect_assimp_joints(place.path / "walk.bvh", walk.frames);
  }
}

TEST(Formats, BvhContainsTipsFramesAndSlidingJoints) {
  const TemporaryFolder place;
  WalkRecording walk;
  walk.frames = swinging(45);
  walk.tip_m.assign(segment_count, {0, 0, 0});
  walk.tip_m[index(Segment::head)] = {0, 0.25F, 0};
  ASSERT_TRUE(write_bvh(place.path / "walk.bvh", walk));
  std::ifstream in(place.path / "walk.bvh");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(text.find("OFFSET 0.000000 0.250000 0.000000"), std::string::npos);
  EXPECT_NE(text.find("Frames: 45\nFrame Time: 0.0333333"), std::string::npos);
  std::size_t six = 0, three = 0;
  for (std::size_t at = 0; (at = text.find("CHANNELS ", at)) != std::string::npos; ++at) {
    const bool slides = text[at + 9] == '6';
    ++(slides ? six : three);
    const std::size_t offset = text.rfind("OFFSET ", at);
    // A program that adds position channels to the offset reads the same place as one that replaces it.
    if (slides) {
      EXPECT_TRUE(text.substr(offset).starts_with("OFFSET 0.000000 0.000000 0.000000\n"));
    }
  }
  EXPECT_EQ(six, 2U);  // the pelvis and the sliding kneecap
  EXPECT_EQ(three, segment_count - 2);
  const auto last = text.find_last_of('\n', text.size() - 2);
  std::istringstream row(text.substr(last));
  std::size_t numbers = 0;
  for (double value = 0; row >> value;) ++numbers;
  EXPECT_EQ(numbers, 6 * six + 3 * three);
}

RC_GTEST_PROP(Formats, AnglesReproduceTheRotationWithoutJumps, ()) {
  std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
  std::normal_distribution<double> normal;
  std::vector<Quaterniond> rotations = {
      Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized()};
  for (int i = 0; i < 200; ++i) {
    const Vector3d axis = Vector3d(normal(random), normal(random), normal(random)).normalized();
    rotations.push_back((rotations.back() * Quaterniond(Eigen::AngleAxisd(0.05, axis))).normalized());
  }
  rotations.push_back(Quaterniond(Eigen::AngleAxisd(pi / 2, Vector3d::UnitZ())));
  const auto turns = joint_turns(rotations);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const auto& [x, z, y] = turns[i];
    const Quaterniond again = Eigen::AngleAxisd(x, Vector3d::UnitX()) * Eigen::AngleAxisd(z, Vector3d::UnitZ()) *
                              Eigen::AngleAxisd(y, Vector3d::UnitY());
    RC_ASSERT(again.angularDistance(rotations[i]) < 1e-6);
    if (i == 0 || i + 1 == turns.size()) continue;
    RC_ASSERT(std::abs(z - turns[i - 1].z) < 0.2);  // x and y can turn fast where z is near a right angle
  }
}

/// A walk with a name that no other notation accepts unchanged.
WalkRecording oddly_named_walk() {
  auto walk = small_walk();
  walk.name = "1st walker's";
  walk.muscles[2].name = "rigid";
  put_tissue(walk.muscles[0]);
  return walk;
}

TEST(Formats, UsdKeepsJointsBonesAndMuscles) {
  if (!has_python()) GTEST_SKIP() << "python3 is not installed";
  const TemporaryFolder place;
  const auto file = place.path / "walk.usda";
  const auto walk = oddly_named_walk();
  ASSERT_TRUE(write_usda(file, walk));
  expect_python_joints("joints", file, walk.frames);
  expect_python_surfaces(file, walk);
}

TEST(Formats, UsdPeopleReferToSharedFigures) {
  if (!has_python()) GTEST_SKIP() << "python3 is not installed";
  const TemporaryFolder place;
  const auto walk = small_walk();
  CrowdRecording crowd;
  crowd.figures.push_back({walk.bones, {0, 1}, {}, {}});
  crowd.people.push_back({"anna", 0, {1, 1, 1}, {{0, 0, 0}, {1, 1, 1}}, walk.frames, {}});
  crowd.people.push_back({"bert", 0, {1.2F, 1.1F, 1.3F}, {{0, 0, 1}, {1, 1, 0}}, writhing(45, 3), {}});
  ASSERT_TRUE(write_usda(place.path / "crowd.usda", crowd));
  const auto said = read_by_python("bones", place.path / "crowd.usda", some_frames);
  for (std::size_t i = 0; i < some_frames.size(); ++i) {
    const auto rows = number_rows(said.at(i));
    std::size_t at = 0, f = some_frames[i];
    for (const auto& person : crowd.people) {
      for (const auto& [segment, mesh] : crowd.figures[0].surfaces) {
        for (const auto& p : mesh.position) {
          const Vec3<float> own{person.scale.x * p.x, person.scale.y * p.y, person.scale.z * p.z};
          ASSERT_LT(distance(rows.at(at++), on_bone(person.frames[f], segment, own)), near_m) << person.name;
        }
      }
    }
    EXPECT_EQ(at, rows.size());
  }
}

TEST(Formats, TheUsdLibraryReadsTheSameJoints) {
  if (!has_python()) GTEST_SKIP() << "python3 is not installed";
  const TemporaryFolder place;
  const auto walk = oddly_named_walk();
  ASSERT_TRUE(write_usda(place.path / "walk.usda", walk));
  expect_python_joints("pxr", place.path / "walk.usda", walk.frames);
}

TEST(Formats, VrmlAndX3dKeepJointsBonesAndMuscles) {
  if (!has_python()) GTEST_SKIP() << "python3 is not installed";
  const TemporaryFolder place;
  const auto walk = oddly_named_walk();
  for (const auto& [name, notation] :
       {std::pair{"walk.wrl", SceneNotation::vrml}, std::pair{"walk.x3d", SceneNotation::x3d}}) {
    ASSERT_TRUE(write_x3d(place.path / name, walk, notation));
    expect_python_joints("joints", place.path / name, walk.frames);
    expect_python_surfaces(place.path / name, walk);
    std::ifstream in(place.path / name);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::string shape = notation == SceneNotation::x3d ? "<Shape DEF='" : " Shape {";
    std::size_t named = 0;
    for (std::size_t at = text.find(shape); at != text.npos; at = text.find(shape, at + 1))
      named += notation == SceneNotation::x3d || text.rfind("DEF ", at) > text.rfind('\n', at) ? 1 : 0;
    EXPECT_EQ(named, walk.bones.size() + walk.muscles.size()) << name;
  }
}

TEST(Formats, AssimpReadsTheFirstPoseOfAnX3d) {
  Assimp::Importer importer;
  if (!importer.IsExtensionSupported(".x3d")) GTEST_SKIP() << "this assimp does not read X3D";
  const TemporaryFolder place;
  const auto file = place.path / "walk.x3d";
  auto walk = small_walk();
  walk.bones.clear();  // assimp 5.2 fails at an empty Transform
  for (std::size_t s = 0; s < segment_count; ++s) {
    walk.bones.push_back({static_cast<Segment>(s), tube(std::string(segment_name[s]), 2, 3, 0.01, 0.03)});
  }
  ASSERT_TRUE(write_x3d(file, walk, SceneNotation::x3d));
  const AssimpWalk read(file);
  ASSERT_NE(read.scene, nullptr);
  for (std::size_t s = 0; s < segment_count; ++s) {
    ASSERT_LT((read.joint(std::string(segment_name[s]), 0) - widened(walk.frames[0].position_m[s])).norm(), near_m)
        << segment_name[s];
  }
  std::size_t triangles = 0, expected = 0;
  for (unsigned m = 0; m < read.scene->mNumMeshes; ++m) triangles += read.scene->mMeshes[m]->mNumFaces;
  for (const auto& bone : walk.bones) expected += bone.mesh.triangle.size() / 3;
  for (const auto& muscle : walk.muscles) expected += muscle.triangle.size() / 3;
  EXPECT_EQ(triangles, expected);
}

TEST(Formats, GlCoordinatesMatchTheFrameWithUnitNormals) {
  if (!has_python()) GTEST_SKIP() << "python3 is not installed";
  const TemporaryFolder place;
  const auto file = place.path / "walk.gl";
  const auto walk = small_walk();
  ASSERT_TRUE(write_gl(file, walk));
  const auto said = read_by_python("gl", file, some_frames);
  for (std::size_t i = 0; i < some_frames.size(); ++i) {
    const auto rows = number_rows(said.at(i));
    const std::size_t f = some_frames[i];
    std::vector<Vector3d> expected;
    for (const auto& bone : walk.bones) {
      for (const auto& p : bone.mesh.position) expected.push_back(on_bone(walk.frames[f], bone.segment, p));
    }
    for (const auto& muscle : walk.muscles) {
      for (const auto& p : muscle.position_m[f]) expected.push_back(widened(p));
    }
    EXPECT_EQ(rows.at(0).at(0), 45);
    EXPECT_EQ(rows.at(0).at(1), 5);
    ASSERT_EQ(rows.size(), 1 + expected.size());
    for (std::size_t v = 0; v < expected.size(); ++v) {
      ASSERT_LT(distance(rows[v + 1], expected[v]), 1e-6);
      ASSERT_NEAR(Vector3d(rows[v + 1].at(3), rows[v + 1].at(4), rows[v + 1].at(5)).norm(), 1, 1e-5);
    }
  }
}

TEST(Formats, StandingBodyHasNoAnimation) {
  const TemporaryFolder place;
  auto walk = small_walk();
  walk.frames.resize(1);
  for (auto& muscle : walk.muscles) muscle.position_m.resize(1);
  ASSERT_TRUE(write_x3d(place.path / "still.wrl", walk, SceneNotation::vrml));
  std::ifstream in(place.path / "still.wrl");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(text.find("TimeSensor"), std::string::npos);
  EXPECT_EQ(text.find("ROUTE"), std::string::npos);
  EXPECT_TRUE(write_bvh(place.path / "still.bvh", walk));
  EXPECT_TRUE(write_usda(place.path / "still.usda", walk));
  EXPECT_TRUE(write_gl(place.path / "still.gl", walk));
}

TEST(Formats, UnwritableRecordingsAreRefusedWithoutFiles) {
  const TemporaryFolder place;
  WalkRecording walk = small_walk();
  walk.frames[3].position_m[index(Segment::head)].y = NAN;
  const auto file = place.path / "walk";
  for (const auto& result : {write_bvh(file, walk), write_opensim_motion(file, walk), write_opensim_forces(file, walk),
                             write_usda(file, walk), write_x3d(file, walk, SceneNotation::x3d), write_gl(file, walk)}) {
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("frame 3 of walker: head"), std::string::npos) << result.error().message;
  }
  CrowdRecording crowd;
  EXPECT_NE(write_usda(file, crowd).error().message.find("nobody"), std::string::npos);
  crowd.figures.push_back({});
  crowd.people.push_back({"anna", 0, {1, 1, 1}, {}, swinging(3), {}});
  crowd.people.push_back({"anna", 0, {1, 1, 1}, {}, swinging(3), {}});
  EXPECT_NE(write_usda(file, crowd).error().message.find("two people are called 'anna'"), std::string::npos);
  crowd.people[1].name = "bert";
  crowd.people[1].frames.pop_back();
  EXPECT_NE(write_glb(file, crowd).error().message.find("bert has 2 frames, anna has 3"), std::string::npos);
  crowd.people[1] = {"bert", 1, {1, 1, 1}, {}, swinging(3), {}};
  EXPECT_NE(write_glb(file, crowd).error().message.find("figure 1 of 1"), std::string::npos);
  EXPECT_TRUE(fs::is_empty(place.path));
}

TEST(Formats, NamesAreUniqueIdentifiers) {
  UniqueNames names;
  EXPECT_EQ(names.take("a"), "a");
  EXPECT_EQ(names.take("a"), "a_2");
  EXPECT_EQ(names.take("a_2"), "a_2_2");
  EXPECT_EQ(names.take("a"), "a_3");
  EXPECT_EQ(identifier("1st walker's"), "_1st_walker_s");
  EXPECT_EQ(identifier("übel"), "__bel");
  EXPECT_EQ(identifier(""), "_");
}

}  // namespace mobil::formats_test
