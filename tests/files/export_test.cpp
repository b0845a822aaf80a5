// The GLB of a recorded walk, read back and reassembled as a viewer does, compared with the recording.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/export/recorded_skin.h>
#include <mobil/gltf_writer.h>
#include "engine/eigen.h"
#include "tests/files/export_fixture.h"
#include "tests/files/temporary_folder.h"
#include "tests/refused.h"

namespace mobil::export_test {
namespace fs = std::filesystem;
using namespace export_fixture;

using Folder = TemporaryFolder;

Viewer viewed(const WalkRecording& walk) {
  const Folder folder;
  const auto written = write_glb(folder.path / "walk.glb", walk);
  EXPECT_TRUE(written) << written.error().message;
  return Viewer(folder.path / "walk.glb");
}

void expect_same_poses(const Viewer& viewer, const std::vector<Pose<float>>& frames) {
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (std::size_t s = 0; s < segment_count; ++s) {
      const auto world = viewer.world(viewer.node.at(std::string(segment_name[s])), f);
      ASSERT_LT((world.translation() - widened(frames[f].position_m[s])).norm(), 1e-5)
          << segment_name[s] << " at " << f;
      ASSERT_LT(Quaterniond(world.linear()).angularDistance(widened(frames[f].rotation[s]).normalized()), 1e-5)
          << segment_name[s] << " at " << f;
    }
  }
}

std::string parent_name(const Viewer& viewer, const std::string& name) {
  const int parent = viewer.parent[viewer.node.at(name)];
  return parent < 0 ? "" : viewer.model.nodes[static_cast<std::size_t>(parent)].name;
}

TEST(Export, NodesAreTheSegmentsNestedUnderOneRootAndTheJointsOfOneSkin) {
  const auto walk = small_walk();
  const Viewer viewer = viewed(walk);  // the viewer detects duplicate node names
  ASSERT_EQ(viewer.model.nodes.size(), 1 + segment_count + 1 + walk.muscles.size());
  ASSERT_EQ(viewer.model.scenes.size(), 1U);
  EXPECT_EQ(parent_name(viewer, "pelvis"), "walker");
  for (std::size_t s = 1; s < segment_count; ++s) {
    EXPECT_EQ(parent_name(viewer, std::string(segment_name[s])), segment_name[index(segment_parent[s])]);
  }
  ASSERT_EQ(viewer.model.skins.size(), 1U);
  const auto& skin = viewer.model.skins[0];
  EXPECT_EQ(skin.skeleton, static_cast<int>(viewer.node.at("walker")));
  ASSERT_EQ(skin.joints.size(), segment_count);
  for (std::size_t s = 0; s < segment_count; ++s) {
    EXPECT_EQ(viewer.model.nodes[static_cast<std::size_t>(skin.joints[s])].name, segment_name[s]);
  }
  std::set<std::string> roots, skinned;
  for (const int n : viewer.model.scenes[0].nodes) roots.insert(viewer.model.nodes[static_cast<std::size_t>(n)].name);
  for (const auto& node : viewer.model.nodes) {
    if (node.mesh >= 0) skinned.insert(node.name);
    EXPECT_EQ(node.mesh >= 0, node.skin == 0) << node.name;
  }
  EXPECT_EQ(skinned, (std::set<std::string>{"bones", "bulging", "travelling", "rigid"}));
  skinned.insert("walker");
  EXPECT_EQ(roots, skinned);
}

TEST(Export, BonesFollowTheirSegmentsAndHaveTextureCoordinates) {
  const auto walk = small_walk();
  const Viewer viewer = viewed(walk);
  const auto n = viewer.node.at("bones");
  for (const std::size_t f : {0U, 7U, 44U}) {
    const auto drawn = viewer.drawn(n, f);
    std::size_t v = 0;
    for (const auto& bone : walk.bones) {
      const std::size_t s = index(bone.segment);
      for (const auto& p : bone.mesh.position) {
        const Vector3d expected =
            widened(walk.frames[f].position_m[s]) + widened(walk.frames[f].rotation[s]).normalized() * widened(p);
        ASSERT_LT((drawn.at(v++) - expected).norm(), 1e-5);
      }
    }
    EXPECT_EQ(v, drawn.size());
  }
  for (const auto& mesh : viewer.model.meshes) {
    const auto& attributes = mesh.primitives[0].attributes;
    const auto place = viewer.floats(attributes.at("TEXCOORD_0"));
    EXPECT_EQ(place.size() / 2, viewer.floats(attributes.at("POSITION")).size() / 3);
    const auto [low, high] = std::ranges::minmax(place);
    EXPECT_TRUE(low >= 0 && high <= 1 && high > low) << mesh.name << " " << low << " " << high;
  }
}

/// Three people: two with one figure, the second of them taller, wider and in colour, and one with a muscle.
CrowdRecording small_crowd() {
  CrowdRecording crowd;
  const auto walk = small_walk();
  crowd.figures.push_back({walk.bones, {0, 1}, {}, {}});
  crowd.figures.push_back({{walk.bones[1]}, {}, {}, {}});
  crowd.people.push_back({"anna", 0, {1, 1, 1}, {{0.1F, 0.2F, 0.3F}, {0.4F, 0.5F, 0.6F}}, walk.frames, {}});
  crowd.people.push_back({"bert", 0, {1.2F, 1.1F, 1.3F}, {{0.1F, 0.2F, 0.3F}, {0.9F, 0.5F, 0.6F}}, walk.frames, {}});
  crowd.people.push_back({"cleo", 1, {1, 1, 1}, {}, walk.frames, {walk.muscles[0]}});
  for (std::size_t i = 0; i < crowd.people.size(); ++i) {
    for (auto& pose : crowd.people[i].frames) {
      for (auto& p : pose.position_m) p.x += static_cast<float>(i);
    }
  }
  for (auto& frame : crowd.people[2].muscles[0].position_m) {
    for (auto& p : frame) p.x += 2;
  }
  return crowd;
}

TEST(Export, PeopleHaveTheirOwnRootsAndShareFigures) {
  const Folder folder;
  const auto crowd = small_crowd();
  const auto report = write_glb(folder.path / "crowd.glb", crowd);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->muscles.at(0).name, "cleo_bulging");
  const Viewer viewer(folder.path / "crowd.glb");
  ASSERT_EQ(viewer.model.animations.size(), 1U);
  for (const auto& person : crowd.people) {
    EXPECT_EQ(parent_name(viewer, person.name + "_pelvis"), person.name);
    EXPECT_EQ(parent_name(viewer, person.name), "");
    const auto n = viewer.node.at(person.name + (person.colours.empty() ? "_bones" : "_figure"));
    for (const std::size_t f : {0U, 20U}) {
      std::size_t part = 0;
      for (const auto& surface : crowd.figures[person.figure].surfaces) {
        const auto drawn = viewer.drawn(n, f, part++);
        const std::size_t s = index(surface.segment);
        const Quaterniond turn = widened(person.frames[f].rotation[s]).normalized();
        for (std::size_t v = 0; v < drawn.size(); ++v) {
          const Vector3d own = widened(person.scale).cwiseProduct(widened(surface.mesh.position[v]));
          ASSERT_LT((drawn[v] - (widened(person.frames[f].position_m[s]) + turn * own)).norm(), 1e-5) << person.name;
        }
      }
    }
  }
  const auto primitives = [&](const std::string& name) { return viewer.mesh_of(viewer.node.at(name)).primitives; };
  const auto anna = primitives("anna_figure"), bert = primitives("bert_figure");
  ASSERT_EQ(anna.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(anna[i].attributes, bert[i].attributes);
    EXPECT_EQ(anna[i].indices, bert[i].indices);
  }
  EXPECT_EQ(anna[0].material, bert[0].material);
  EXPECT_NE(anna[1].material, bert[1].material);
  const auto drawn = viewer.drawn(viewer.node.at("cleo_bulging"), 11);
  for (std::size_t v = 0; v < drawn.size(); ++v) {
    ASSERT_LT((drawn[v] - widened(crowd.people[2].muscles[0].position_m[11][v])).norm(), 1e-5);
  }
}

TEST(Export, SkinHasItsAtlasCoordinatesAndTangents) {
  const Folder folder;
  const BodySkin skin = *make_body_skin(*make_body({.sex = Sex::woman}), SkinDetail::distant);
  CrowdRecording crowd;
  crowd.figures.push_back({{}, {}, recorded_skin(skin), standing_of(skin)});
  crowd.people.push_back({"anna", 0, {1, 1, 1}, std::vector<Vec3<float>>(skin_parts), small_walk().frames, {}});
  const auto report = write_glb(folder.path / "skin.glb", crowd);
  ASSERT_TRUE(report) << report.error().message;
  const Viewer viewer(folder.path / "skin.glb");
  const auto& parts = viewer.model.meshes.at(0).primitives;
  ASSERT_EQ(parts.size(), crowd.figures[0].skin.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const SkinnedSurface& surface = crowd.figures[0].skin[i];
    const auto place = viewer.floats(parts[i].attributes.at("TEXCOORD_0"));
    const auto tangent = viewer.floats(parts[i].attributes.at("TANGENT"));
    ASSERT_EQ(place.size(), 2 * surface.position.size());
    ASSERT_EQ(tangent.size(), 4 * surface.position.size());
    for (std::size_t v = 0; v < surface.position.size(); ++v) {
      ASSERT_EQ(place[2 * v], surface.texture[v][0]);
      ASSERT_EQ(place[2 * v + 1], surface.texture[v][1]);
      for (std::size_t k = 0; k < 4; ++k) ASSERT_EQ(tangent[4 * v + k], surface.tangent[v][k]);
    }
  }
  crowd.figures[0].skin[1].tangent.pop_back();
  EXPECT_FALSE(write_glb(folder.path / "skin.glb", crowd));
  crowd.figures[0].skin[1] = recorded_skin(skin)[1];
  crowd.figures[0].skin[1].texture[3][0] = 1.5F;
  EXPECT_FALSE(write_glb(folder.path / "skin.glb", crowd));
  crowd.figures[0].skin[1] = recorded_skin(skin)[1];
  crowd.figures[0].skin[1].normal[2] = {0, 0, 0};
  EXPECT_FALSE(write_glb(folder.path / "skin.glb", crowd));
  crowd.figures[0].skin[1] = recorded_skin(skin)[1];
  crowd.figures[0].standing_m[3].y = NAN;
  EXPECT_FALSE(write_glb(folder.path / "skin.glb", crowd));
  crowd.figures[0].standing_m = {};
  EXPECT_FALSE(write_glb(folder.path / "skin.glb", crowd));
  crowd.figures[0].standing_m = standing_of(skin);
  EXPECT_TRUE(write_glb(folder.path / "skin.glb", crowd));
}

TEST(Export, WorldPosesRoundTripAndFixedJointsHaveNoTranslationKeys) {
  const auto walk = small_walk();
  const Viewer viewer = viewed(walk);
  expect_same_poses(viewer, walk.frames);
  for (const auto& channel : viewer.model.animations[0].channels) {
    const auto& name = viewer.model.nodes[static_cast<std::size_t>(channel.target_node)].name;
    if (channel.target_path == "translation") {
      EXPECT_TRUE(name == "pelvis" || name == "patella_right") << name;
    } else if (channel.target_path == "rotation") {
      EXPECT_TRUE(name == "pelvis" || name == "thigh_right" || name == "shank_right") << name;
    } else {
      EXPECT_TRUE(name == "bulging" || name == "travelling") << name;
    }
  }
}

RC_GTEST_PROP(Export, AnySkeletonRoundTripsWithoutFixedOffsets, ()) {
  std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
  std::normal_distribution<double> normal;
  WalkRecording walk;
  walk.frames.resize(static_cast<std::size_t>(*rc::gen::inRange(1, 6)));
  for (auto& pose : walk.frames) {
    for (std::size_t s = 0; s < segment_count; ++s) {
      const Quaterniond q(normal(random), normal(random), normal(random), normal(random));
      set_world(pose, s, {normal(random), normal(random), 3 * normal(random)}, q.normalized());
    }
  }
  expect_same_poses(viewed(walk), walk.frames);
  RC_ASSERT(!testing::Test::HasFatalFailure());
}

TEST(Export, RotationKeysHaveUnitLengthAndTakeTheShortestPath) {
  auto walk = small_walk();
  for (std::size_t f = 0; f < walk.frames.size(); f += 2) {  // the same rotations with the opposite sign
    for (auto& q : walk.frames[f].rotation) q = {-q.x, -q.y, -q.z, -q.w};
  }
  const Viewer viewer = viewed(walk);
  for (std::size_t s = 0; s < segment_count; ++s) {
    const auto n = viewer.node.at(std::string(segment_name[s]));
    if (viewer.key(n, "rotation", 0).empty()) continue;
    for (std::size_t f = 0; f < walk.frames.size(); ++f) {
      const auto key = viewer.key(n, "rotation", f);
      const Eigen::Map<const Eigen::Vector4d> now(key.data());
      EXPECT_NEAR(now.norm(), 1.0, 2e-7);
      if (f == 0) continue;
      const auto before = viewer.key(n, "rotation", f - 1);
      EXPECT_GT(now.dot(Eigen::Map<const Eigen::Vector4d>(before.data())), 0.0);
    }
  }
}

TEST(Export, MusclesRoundTripWithinTheReportedError) {
  const Folder folder;
  const auto walk = small_walk();
  const auto report = write_glb(folder.path / "walk.glb", walk);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->bytes, fs::file_size(folder.path / "walk.glb"));
  const Viewer viewer(folder.path / "walk.glb");
  ASSERT_EQ(report->muscles.size(), walk.muscles.size());
  for (std::size_t m = 0; m < walk.muscles.size(); ++m) {
    const auto& recorded = walk.muscles[m];
    const auto& fidelity = report->muscles[m];
    EXPECT_EQ(fidelity.name, recorded.name);
    const auto n = viewer.node.at(recorded.name);
    double largest = 0, sum = 0;
    for (std::size_t f = 0; f < walk.frames.size(); ++f) {
      const auto shape = viewer.drawn(n, f);
      ASSERT_EQ(shape.size(), recorded.position_m[f].size());
      for (std::size_t v = 0; v < shape.size(); ++v) {
        const double error = (shape[v] - widened(recorded.position_m[f][v])).norm();
        largest = std::max(largest, error);
        sum += error * error;
      }
    }
    const double count = static_cast<double>(walk.frames.size() * recorded.position_m[0].size());
    EXPECT_NEAR(largest, fidelity.max_error_m, 3e-7) << recorded.name;
    EXPECT_NEAR(std::sqrt(sum / count), fidelity.rms_error_m, 3e-7) << recorded.name;
  }
}

/// Returns the accessor's bytes, four a vertex.
std::vector<std::array<std::uint8_t, 4>> bytes_of(const Viewer& viewer, int accessor) {
  const auto& from = viewer.model.accessors[static_cast<std::size_t>(accessor)];
  EXPECT_EQ(from.componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE);
  EXPECT_EQ(from.type, TINYGLTF_TYPE_VEC4);
  EXPECT_TRUE(from.normalized);
  const auto& view = viewer.model.bufferViews[static_cast<std::size_t>(from.bufferView)];
  const auto& data = viewer.model.buffers[static_cast<std::size_t>(view.buffer)].data;
  std::vector<std::array<std::uint8_t, 4>> bytes(from.count);
  std::memcpy(bytes.data(), data.data() + view.byteOffset + from.byteOffset, 4 * from.count);
  return bytes;
}

TEST(Export, TissueRoundTripsAndColoursTendons) {
  auto walk = small_walk();
  put_tissue(walk.muscles[0]);
  const Viewer viewer = viewed(walk);
  for (const RecordedMuscle& muscle : walk.muscles) {
    const auto& node = viewer.model.nodes[viewer.node.at(muscle.name)];
    const auto& shape = viewer.model.meshes[static_cast<std::size_t>(node.mesh)].primitives[0];
    const auto& base = viewer.model.materials[static_cast<std::size_t>(shape.material)].pbrMetallicRoughness;
    if (muscle.tissue.empty()) {
      EXPECT_EQ(shape.attributes.count("_TISSUE") + shape.attributes.count("COLOR_0"), 0U);
      EXPECT_NEAR(base.baseColorFactor[0], static_cast<double>(muscle.colour.x), 1e-6);
      continue;
    }
    EXPECT_EQ(base.baseColorFactor, (std::vector<double>{1, 1, 1, 1}));
    const auto tissue = bytes_of(viewer, shape.attributes.at("_TISSUE"));
    const auto colour = bytes_of(viewer, shape.attributes.at("COLOR_0"));
    ASSERT_EQ(tissue.size(), muscle.tissue.size());
    ASSERT_EQ(colour.size(), muscle.tissue.size());
    for (std::size_t v = 0; v < tissue.size(); ++v) {
      const Tissue& own = muscle.tissue[v];
      ASSERT_EQ(tissue[v], (std::array{own.along, own.around, own.tendon, own.aponeurosis})) << v;
      const double share = std::max(own.tendon / 255.0, 0.6 * own.aponeurosis / 255.0);
      constexpr double ivory_green = 0.53;
      const auto green = static_cast<double>(muscle.colour.y);
      EXPECT_NEAR(colour[v][1] / 255.0, green + share * (ivory_green - green), 0.5 / 255 + 1e-6) << v;
      EXPECT_EQ(colour[v][3], 255);
    }
  }
}

TEST(Export, WeightsOfEachTargetReachZeroAndOneAndNotBeyond) {
  const auto walk = small_walk();
  const Viewer viewer = viewed(walk);  // Blender limits weights to 0 to 1, or to the first one if that is less
  const auto n = viewer.node.at("travelling");
  std::vector<double> low(viewer.key(n, "weights", 0).size(), 1.0), high(low.size(), 0.0);
  ASSERT_EQ(low.size(), 4U);
  for (std::size_t f = 0; f < walk.frames.size(); ++f) {
    const auto weight = viewer.key(n, "weights", f);
    for (std::size_t k = 0; k < weight.size(); ++k) {
      low[k] = std::min(low[k], weight[k]);
      high[k] = std::max(high[k], weight[k]);
    }
  }
  for (const double w : low) EXPECT_EQ(w, 0.0);
  for (const double w : high) EXPECT_EQ(w, 1.0);
}

TEST(Export, TwoShapeMotionNeedsTwoTargetsAndRigidMotionNone) {
  const Folder folder;
  const auto report = write_glb(folder.path / "walk.glb", small_walk());
  ASSERT_TRUE(report);
  EXPECT_EQ(report->muscles[0].morph_targets, 2);
  EXPECT_LT(report->muscles[0].max_error_m, 2e-6);
  EXPECT_EQ(report->muscles[1].morph_targets, 4);
  EXPECT_EQ(report->muscles[2].morph_targets, 0);
  EXPECT_LT(report->muscles[2].max_error_m, 2e-6);
}

TEST(Export, MoreTargetsAreNeverWorseAndToleranceIsKeptWhenReachable) {
  const Folder folder;
  auto walk = small_walk();
  walk.muscles = {walk.muscles[1]};
  double before = std::numeric_limits<double>::infinity();
  for (int targets = 0; targets <= 8; ++targets) {
    const auto report = write_glb(folder.path / "walk.glb", walk, {targets, 0.0F, false});
    ASSERT_TRUE(report);
    EXPECT_LE(report->muscles[0].rms_error_m, before * (1 + 1e-6));
    before = report->muscles[0].rms_error_m;
    if (targets == 8) {
      const auto reachable = static_cast<float>(report->muscles[0].max_error_m * 1.01);
      EXPECT_LE(write_glb(folder.path / "walk.glb", walk, {8, reachable, false})->muscles[0].max_error_m, reachable);
    }
  }
}

TEST(Export, MorphedNormalsFollowTheDeformedSurface) {
  const auto walk = small_walk();
  const Viewer viewer = viewed(walk);
  const auto n = viewer.node.at("bulging");
  const auto& triangle = walk.muscles[0].triangle;
  double morphed_worst = 0, mean_worst = 0;
  for (std::size_t f = 0; f < walk.frames.size(); ++f) {
    const auto position = viewer.morphed(n, "POSITION", f), normal = viewer.morphed(n, "NORMAL", f);
    const auto mean = viewer.floats(
        viewer.model.meshes[static_cast<std::size_t>(viewer.model.nodes[n].mesh)].primitives[0].attributes.at(
            "NORMAL"));
    std::vector<Vector3d> truth(position.size(), Vector3d::Zero());
    for (std::size_t t = 0; t < triangle.size(); t += 3) {
      const auto &a = position[triangle[t]], &b = position[triangle[t + 1]], &c = position[triangle[t + 2]];
      for (std::size_t i = 0; i < 3; ++i) truth[triangle[t + i]] += (b - a).cross(c - a);
    }
    for (std::size_t v = 0; v < truth.size(); ++v) {
      const Vector3d base = vertex(mean, v);
      EXPECT_NEAR(base.norm(), 1.0, 1e-6);
      morphed_worst = std::max(morphed_worst, (truth[v].normalized() - normal[v].normalized()).norm());
      mean_worst = std::max(mean_worst, (truth[v].normalized() - base).norm());
    }
  }
  EXPECT_LT(morphed_worst, 0.25 * mean_worst);
}

TEST(Export, TheSameRecordingGivesTheSameBytes) {
  const Folder folder;
  ASSERT_TRUE(write_glb(folder.path / "a.glb", small_walk()));
  ASSERT_TRUE(write_glb(folder.path / "b.glb", small_walk()));
  EXPECT_EQ(read_bytes(folder.path / "a.glb"), read_bytes(folder.path / "b.glb"));
}

TEST(Export, FailureIsOneLineAndLeavesFilesUnchanged) {
  const Folder folder;
  const auto good = small_walk();
  const auto expect_failure = [&](const fs::path& path, const WalkRecording& walk, const std::string& says) {
    EXPECT_TRUE(is_refused(write_glb(path, walk), says)) << says;
  };
  expect_failure(folder.path / "absent" / "walk.glb", good, "absent");
  EXPECT_EQ(folder.files(), 0U);
  fs::create_directories(folder.path / "taken" / "inside");
  expect_failure(folder.path / "taken", good, "taken");
  EXPECT_EQ(folder.files(), 1U);

  std::ofstream(folder.path / "walk.glb") << "before";
  const auto spoilt = [&](const std::function<void(WalkRecording&)>& spoil, const std::string& says) {
    auto walk = good;
    spoil(walk);
    expect_failure(folder.path / "walk.glb", walk, says);
    EXPECT_EQ(read_bytes(folder.path / "walk.glb"), "before");
    EXPECT_EQ(folder.files(), 2U);
  };
  spoilt([](auto& w) { w.frames.clear(); }, "no frames");
  spoilt([](auto& w) { w.frame_s = 0; }, "0.001");
  spoilt([](auto& w) { w.frames[3].position_m[index(Segment::head)].y = NAN; }, "head");
  spoilt([](auto& w) { w.frames[3].rotation[index(Segment::C4)] = {0, 0, 0, 0}; }, "C4");
  spoilt([](auto& w) { w.bones[0].mesh.triangle[4] = 4000; }, "4000");
  spoilt([](auto& w) { w.bones[0].mesh.triangle.pop_back(); }, "femur_right");
  spoilt([](auto& w) { w.bones[0].mesh.triangle.assign(3, 1); }, "area");
  spoilt([](auto& w) { w.muscles[0].name = "\xff\xfe"; }, "UTF-8");
  spoilt([](auto& w) { w.muscles[1].position_m.pop_back(); }, "frames");
  spoilt([](auto& w) { w.muscles[1].position_m[7].pop_back(); }, "vertices");
  spoilt([](auto& w) { w.muscles[1].position_m[7][5].x = INFINITY; }, "frame 7");
  spoilt([](auto& w) { w.muscles[1].colour.x = 255; }, "colour");
  spoilt([](auto& w) { w.muscles[1].tissue.resize(3); }, "tissue of 3 vertices");
}

TEST(Export, KhronosValidatorFindsNoErrorAndNoWarning) {
  if (said_by("node --version").status != 0) GTEST_SKIP() << "node is not installed";
  const Folder folder;
  std::map<std::string, WalkRecording> walks;
  walks["whole"] = small_walk();
  put_tissue(walks["whole"].muscles[0]);
  walks["stick_figure"].frames = swinging(10);
  walks["still"] = walks["whole"];
  walks["still"].frames.resize(1);
  for (auto& m : walks["still"].muscles) m.position_m.resize(1);
  walks["still_stick_figure"].frames = swinging(1);
  walks["flat_triangles"] = walks["whole"];
  for (auto* triangle :
       {&walks["flat_triangles"].bones[0].mesh.triangle, &walks["flat_triangles"].muscles[0].triangle}) {
    triangle->insert(triangle->end(), {0, 0, 1, 2, 2, 2});
  }
  walks["unused_vertices"] = walks["whole"];
  walks["unused_vertices"].bones[0].mesh.position.push_back({1, 1, 1});
  walks["many_vertices"].frames = swinging(3);
  walks["many_vertices"].muscles = {
      muscle("fine", Segment::thigh_right, walks["many_vertices"].frames, travelling, 4200)};
  std::vector<fs::path> files;
  for (const auto& [name, walk] : walks) {
    const auto written = write_glb(files.emplace_back(folder.path / (name + ".glb")), walk);
    ASSERT_TRUE(written) << written.error().message;
  }
  ASSERT_TRUE(write_glb(files.emplace_back(folder.path / "crowd.glb"), small_crowd()));
  for (const auto& file : files) {
    const Said ran = said_by("node '" MOBIL_SOURCE_DIR "/tests/validate_glb.mjs' '" + file.string() + "'");
    if (ran.status == 77) GTEST_SKIP() << ran.text;
    EXPECT_EQ(ran.status, 0) << ran.text;
    EXPECT_NE(ran.text.find("0 errors, 0 warnings"), std::string::npos) << ran.text;
  }
}

}  // namespace mobil::export_test
