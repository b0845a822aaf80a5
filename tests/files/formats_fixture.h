#pragma once
// Common to tests of export formats: other programs as readers, and walks in which every joint moves.

#include <assimp/anim.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "engine/eigen.h"
#include "tests/files/export_fixture.h"
#include "tests/files/temporary_folder.h"

namespace mobil::formats_test {
namespace fs = std::filesystem;
using namespace export_fixture;

inline constexpr double near_m = 1e-4;
inline const std::vector<std::size_t> some_frames = {0, 9, 44};

inline bool has_python() {
  return said_by("python3 --version").status == 0;
}

/// Returns a Python library's output for each frame, and for each of `names` if given; empty if the library is missing.
inline std::vector<std::string> read_by_python(const std::string& what, const fs::path& file,
                                               const std::vector<std::size_t>& frames, const std::string& names = {}) {
  std::string at;
  for (const std::size_t f : frames) at += (at.empty() ? "" : ",") + std::to_string(f);
  const Said said = said_by("python3 '" MOBIL_SOURCE_DIR "/tests/files/read_formats.py' " + what + " '" +
                            file.string() + "' " + at + " " + names);
  if (said.status == 77) return {};
  EXPECT_EQ(said.status, 0) << said.text;
  std::vector<std::string> of(1);
  std::istringstream lines(said.text);
  for (std::string line; std::getline(lines, line);)
    line == "." ? void(of.emplace_back()) : void(of.back() += line + '\n');
  return of;
}

/// Parses lines of "NAME X Y Z".
inline std::map<std::string, Vector3d> named_places(const std::string& text) {
  std::map<std::string, Vector3d> places;
  std::istringstream lines(text);
  std::string name;
  for (Vector3d p; lines >> name >> p.x() >> p.y() >> p.z();) {
    EXPECT_TRUE(places.emplace(name, p).second) << name << " twice";
  }
  return places;
}

/// Parses lines of numbers.
inline std::vector<std::vector<double>> number_rows(const std::string& text) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream in(line);
    auto& row = rows.emplace_back();
    for (double value = 0; in >> value;) row.push_back(value);
  }
  return rows;
}

inline double distance(const std::vector<double>& row, const Vector3d& p) {
  return (Vector3d(row.at(0), row.at(1), row.at(2)) - p).norm();
}

inline Vector3d on_bone(const Pose<float>& pose, Segment segment, const Vec3<float>& p) {
  const std::size_t s = index(segment);
  return widened(pose.position_m[s]) + widened(pose.rotation[s]).normalized() * widened(p);
}

/// Returns a walk with all joints bent in every direction, and a pelvis that turns more than once around.
inline std::vector<Pose<float>> writhing(std::size_t frame_count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> some(-1.2, 1.2);
  std::vector<Vector3d> swing(segment_count), offset(segment_count);
  for (auto& v : swing) v = {some(random), some(random), some(random)};
  for (auto& v : offset) v = 0.2 * Vector3d(some(random), some(random), some(random));
  std::vector<Pose<float>> frames(frame_count);
  for (std::size_t f = 0; f < frame_count; ++f) {
    const double t = static_cast<double>(f) / 30.0, wave = std::sin(2 * pi * t);
    std::vector<Vector3d> p(segment_count);
    std::vector<Quaterniond> q(segment_count);
    for (std::size_t s = 0; s < segment_count; ++s) {
      const std::size_t parent = index(segment_parent[s]);
      const Quaterniond local = Eigen::AngleAxisd(swing[s].x() * wave, Vector3d::UnitX()) *
                                Eigen::AngleAxisd(swing[s].z() * wave, Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(parent == s ? 8 * t : swing[s].y() * wave, Vector3d::UnitY());
      p[s] = parent == s ? Vector3d(0.1 * wave, 1, t) : Vector3d(p[parent] + q[parent] * offset[s]);
      q[s] = parent == s ? local : q[parent] * local;
      set_world(frames[f], s, p[s], q[s]);
    }
  }
  return frames;
}

/// A file read by assimp, with its first animation.
struct AssimpWalk {
  Assimp::Importer importer;
  const aiScene* scene;
  explicit AssimpWalk(const fs::path& file) : scene(importer.ReadFile(file.string(), 0)) {
    EXPECT_NE(scene, nullptr) << importer.GetErrorString();
  }

  Eigen::Affine3d local(const aiNode& node, std::size_t f) const {
    aiMatrix4x4 m = node.mTransformation;
    for (unsigned a = 0; scene->mNumAnimations > 0 && a < scene->mAnimations[0]->mNumChannels; ++a) {
      const aiNodeAnim& keys = *scene->mAnimations[0]->mChannels[a];
      if (keys.mNodeName != node.mName) continue;
      const auto at = [f](unsigned count) { return std::min(static_cast<unsigned>(f), count - 1); };
      m = aiMatrix4x4({1, 1, 1}, keys.mRotationKeys[at(keys.mNumRotationKeys)].mValue,
                      keys.mPositionKeys[at(keys.mNumPositionKeys)].mValue);
    }
    Eigen::Matrix4f rows = Eigen::Map<const Eigen::Matrix<float, 4, 4, Eigen::RowMajor>>(&m.a1);
    return Eigen::Affine3d(rows.cast<double>());
  }

  Vector3d joint(const std::string& name, std::size_t f) const {
    const aiNode* node = scene->mRootNode->FindNode(name.c_str());
    EXPECT_NE(node, nullptr) << name;
    Vector3d p = Vector3d::Zero();
    for (; node != nullptr; node = node->mParent) p = local(*node, f) * p;
    return p;
  }
};

inline void expect_assimp_joints(const fs::path& file, const std::vector<Pose<float>>& frames) {
  const AssimpWalk read(file);
  ASSERT_NE(read.scene, nullptr);
  for (const std::size_t f : some_frames) {
    for (std::size_t s = 0; s < segment_count; ++s) {
      ASSERT_LT((read.joint(std::string(segment_name[s]), f) - widened(frames[f].position_m[s])).norm(), near_m)
          << segment_name[s] << " at " << f;
    }
  }
}

inline void expect_python_joints(const std::string& what, const fs::path& file,
                                 const std::vector<Pose<float>>& frames) {
  const auto said = read_by_python(what, file, some_frames);
  if (said.empty()) GTEST_SKIP() << "Python has no such library";
  for (std::size_t i = 0; i < some_frames.size(); ++i) {
    const auto places = named_places(said.at(i));
    const std::size_t f = some_frames[i];
    for (std::size_t s = 0; s < segment_count; ++s) {
      const std::string name(segment_name[s]);
      ASSERT_TRUE(places.contains(name)) << name;
      ASSERT_LT((places.at(name) - widened(frames[f].position_m[s])).norm(), near_m) << name << " at " << f;
    }
  }
}

inline void expect_python_surfaces(const fs::path& file, const WalkRecording& walk) {
  constexpr std::size_t f = 30;
  std::vector<Vector3d> expected;
  for (const auto& bone : walk.bones) {
    for (const auto& p : bone.mesh.position) expected.push_back(on_bone(walk.frames[f], bone.segment, p));
  }
  const auto rows = number_rows(read_by_python("bones", file, {f}).at(0));
  ASSERT_EQ(rows.size(), expected.size());
  for (const auto& row : rows) {  // segments can be in any order
    ASSERT_TRUE(std::ranges::any_of(expected, [&](const Vector3d& p) { return distance(row, p) < near_m; }));
  }
  std::string names;
  for (const auto& muscle : walk.muscles) names += muscle.name + " ";
  const auto said = read_by_python("muscle", file, {f}, names);
  for (std::size_t m = 0; m < walk.muscles.size(); ++m) {
    const auto places = number_rows(said.at(m));
    const auto& wanted = walk.muscles[m].position_m[f];
    ASSERT_EQ(places.size(), wanted.size()) << walk.muscles[m].name;
    for (std::size_t v = 0; v < places.size(); ++v) {
      ASSERT_LT(distance(places[v], widened(wanted[v])), near_m) << walk.muscles[m].name;
    }
  }
}

}  // namespace mobil::formats_test
