#pragma once
// A synthetic walk to export, a viewer that reassembles a GLB, and runs of other programs.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <mobil/assets/export/walk_recording.h>
#include "assets/export/skeleton_keys.h"
#include "engine/eigen.h"

namespace mobil::export_fixture {
using Eigen::Quaterniond;
using Eigen::Vector3d;

inline constexpr double pi = 3.14159265358979323846;

/// Output and exit status of a command.
struct Said {
  int status = -1;
  std::string text;
};
inline Said said_by(const std::string& command) {
  Said said;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return said;
  for (char piece[4096]; std::fgets(piece, sizeof piece, pipe) != nullptr;) said.text += piece;
  const int status = pclose(pipe);
  said.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return said;
}

inline Vec3<float> rounded(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}
using mobil::widened;
inline Quaterniond widened(const Quat<float>& q) {
  return {static_cast<double>(q.w), static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z)};
}

inline void set_world(Pose<float>& pose, std::size_t s, const Vector3d& p, const Quaterniond& q) {
  pose.position_m[s] = rounded(p);
  pose.rotation[s] = {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()),
                      static_cast<float>(q.w())};
}

/// Returns a walk: right thigh and shank swing, the pelvis travels, the right kneecap slides a millimetre, and all
/// other offsets are fixed.
inline std::vector<Pose<float>> swinging(std::size_t frame_count) {
  std::vector<Pose<float>> frames(frame_count);
  for (std::size_t f = 0; f < frame_count; ++f) {
    const double t = static_cast<double>(f) / 30.0;
    std::vector<Vector3d> p(segment_count);
    std::vector<Quaterniond> q(segment_count);
    for (std::size_t s = 0; s < segment_count; ++s) {
      const auto segment = static_cast<Segment>(s);
      const std::size_t parent = index(segment_parent[s]);
      const double swing = segment == Segment::thigh_right   ? 0.5 * std::sin(2 * pi * t)
                           : segment == Segment::shank_right ? 0.6 - 0.6 * std::cos(2 * pi * t)
                                                             : 0.0;
      const Quaterniond local(Eigen::AngleAxisd(swing, Vector3d::UnitX()));
      if (parent == s) {
        p[s] = {0.02 * std::sin(2 * pi * t), 1.0 + 0.02 * std::cos(4 * pi * t), 1.4 * t};
        q[s] = Eigen::AngleAxisd(0.1 * std::sin(2 * pi * t), Vector3d::UnitY());
      } else {
        const double slide = segment == Segment::patella_right ? 0.001 * std::sin(2 * pi * t) : 0.0;
        const Vector3d offset(0.01 * static_cast<double>(s % 5) - 0.02, segment < Segment::thigh_right ? 0.04 : -0.3,
                              0.01 + slide);
        p[s] = p[parent] + q[parent] * offset;
        q[s] = q[parent] * local;
      }
      set_world(frames[f], s, p[s], q[s]);
    }
  }
  return frames;
}

inline SurfaceMesh tube(const std::string& name, std::uint32_t rings, std::uint32_t around, double radius,
                        double length) {
  SurfaceMesh mesh{name, {}, {}};
  for (std::uint32_t r = 0; r < rings; ++r) {
    for (std::uint32_t a = 0; a < around; ++a) {
      const double angle = 2 * pi * a / around;
      mesh.position.push_back(rounded({radius * std::cos(angle), -length * r / (rings - 1), radius * std::sin(angle)}));
      if (r + 1 == rings) continue;
      const std::uint32_t i = r * around + a, right = r * around + (a + 1) % around;
      for (const auto corner : {i, right, i + around, right, right + around, i + around})
        mesh.triangle.push_back(corner);
    }
  }
  return mesh;
}

/// Position of a muscle's vertex in its segment's frame, at rest position p and time t.
using Motion = std::function<Vector3d(const Vector3d& p, double t)>;

inline Vector3d two_shapes(const Vector3d& p, double t) {
  const double along = std::sin(-p.y() / 0.3 * pi);
  return p + 0.015 * std::sin(2 * pi * t) * along * Vector3d(p.x(), 0, p.z()) / 0.04 +
         0.01 * std::cos(6 * pi * t) * along * Vector3d::UnitX();
}

/// A swelling that travels along the tube. No finite number of shapes reproduces it.
inline Vector3d travelling(const Vector3d& p, double t) {
  return p + 0.02 * std::exp(-std::pow((-p.y() - 0.15 - 0.12 * std::sin(2 * pi * t)) / 0.04, 2)) *
                 Vector3d(p.x(), 0, p.z()) / 0.04;
}

inline RecordedMuscle muscle(const std::string& name, Segment segment, const std::vector<Pose<float>>& frames,
                             const Motion& motion, std::uint32_t rings = 12) {
  const SurfaceMesh rest = tube(name, rings, 16, 0.04, 0.3);
  RecordedMuscle made;
  made.name = name;
  made.segment = segment;
  made.triangle = rest.triangle;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    auto& positions = made.position_m.emplace_back();
    const Vector3d origin = widened(frames[f].position_m[index(segment)]);
    const Quaterniond rotation = widened(frames[f].rotation[index(segment)]).normalized();
    for (const auto& p : rest.position) {
      positions.push_back(rounded(origin + rotation * motion(widened(p), static_cast<double>(f) / 30.0)));
    }
  }
  return made;
}

/// Gives a muscle tissue of all values.
inline void put_tissue(RecordedMuscle& muscle) {
  const std::size_t vertices = muscle.position_m.front().size();
  const auto byte = [](std::size_t i) { return static_cast<std::uint8_t>(i % 256); };
  for (std::size_t v = 0; v < vertices; ++v)
    muscle.tissue.push_back({byte(255 * v / (vertices - 1)), byte(7 * v), byte(13 * v), byte(29 * v)});
}

inline WalkRecording small_walk() {
  WalkRecording walk;
  walk.frames = swinging(45);
  walk.bones.push_back({Segment::thigh_right, tube("femur_right", 6, 8, 0.015, 0.3)});
  walk.bones.push_back({Segment::pelvis, tube("sacrum", 3, 5, 0.03, 0.1)});
  walk.muscles.push_back(muscle("bulging", Segment::thigh_right, walk.frames, two_shapes));
  walk.muscles.push_back(muscle("travelling", Segment::shank_right, walk.frames, travelling));
  walk.muscles.push_back(muscle("rigid", Segment::T7, walk.frames, [](const Vector3d& p, double) { return p; }));
  return walk;
}

inline Vector3d vertex(const std::vector<float>& values, std::size_t v) {
  return {static_cast<double>(values[3 * v]), static_cast<double>(values[3 * v + 1]),
          static_cast<double>(values[3 * v + 2])};
}

/// The parts of a viewer that these tests need.
struct Viewer {
  tinygltf::Model model;
  std::map<std::string, std::size_t> node;
  std::vector<int> parent;

  explicit Viewer(const std::filesystem::path& file) {
    std::string error, warning;
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromMemory(&model, &error, &warning,
                                                          reinterpret_cast<const unsigned char*>(bytes.data()),
                                                          static_cast<unsigned>(bytes.size())))
        << error;
    EXPECT_EQ(warning, "");
    parent.assign(model.nodes.size(), -1);
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
      EXPECT_TRUE(node.emplace(model.nodes[n].name, n).second) << "two nodes named " << model.nodes[n].name;
      for (const int child : model.nodes[n].children) parent[static_cast<std::size_t>(child)] = static_cast<int>(n);
    }
  }

  std::vector<float> floats(int accessor_number) const {
    const auto& accessor = model.accessors[static_cast<std::size_t>(accessor_number)];
    EXPECT_EQ(accessor.componentType, TINYGLTF_COMPONENT_TYPE_FLOAT);
    const auto width =
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
    std::vector<float> values(accessor.count * width);  // zeros without a view
    if (accessor.bufferView >= 0) copy(accessor.bufferView, accessor.byteOffset, values);
    if (!accessor.sparse.isSparse) return values;
    const auto count = static_cast<std::size_t>(accessor.sparse.count);
    std::vector<std::uint32_t> changed(count);
    std::vector<float> replaced(count * width);
    EXPECT_EQ(accessor.sparse.indices.componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
    copy(accessor.sparse.indices.bufferView, static_cast<std::size_t>(accessor.sparse.indices.byteOffset), changed);
    copy(accessor.sparse.values.bufferView, static_cast<std::size_t>(accessor.sparse.values.byteOffset), replaced);
    for (std::size_t i = 0; i < count; ++i)
      std::copy_n(replaced.data() + width * i, width, values.data() + width * changed[i]);
    return values;
  }

  template <class T>
  void copy(int view_number, std::size_t offset, std::vector<T>& values) const {
    const auto& view = model.bufferViews[static_cast<std::size_t>(view_number)];
    std::memcpy(values.data(), model.buffers[0].data.data() + view.byteOffset + offset, values.size() * sizeof(T));
  }

  std::vector<std::uint32_t> indices(int accessor_number) const {
    const auto& accessor = model.accessors[static_cast<std::size_t>(accessor_number)];
    std::vector<std::uint32_t> values(accessor.count);
    if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
      copy(accessor.bufferView, accessor.byteOffset, values);
      return values;
    }
    EXPECT_EQ(accessor.componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
    std::vector<std::uint16_t> narrow(accessor.count);
    copy(accessor.bufferView, accessor.byteOffset, narrow);
    values.assign(narrow.begin(), narrow.end());
    return values;
  }

  /// Returns the values of a node's property at a key, or nothing if it is not animated.
  std::vector<double> key(std::size_t n, const std::string& path, std::size_t f) const {
    if (model.animations.empty()) return {};
    for (const auto& channel : model.animations[0].channels) {
      if (channel.target_node != static_cast<int>(n) || channel.target_path != path) continue;
      const auto& sampler = model.animations[0].samplers[static_cast<std::size_t>(channel.sampler)];
      const auto values = floats(sampler.output);
      const std::size_t keys = floats(sampler.input).size(), width = values.size() / keys;
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(std::min(f, keys - 1) * width);
      return {first, first + static_cast<std::ptrdiff_t>(width)};
    }
    return {};
  }

  Eigen::Isometry3d world(std::size_t n, std::size_t f) const {
    auto t = key(n, "translation", f), r = key(n, "rotation", f);
    if (t.empty()) t = model.nodes[n].translation;
    if (r.empty()) r = model.nodes[n].rotation;
    Eigen::Isometry3d local = Eigen::Isometry3d::Identity();
    if (!r.empty()) local.linear() = Quaterniond(r[3], r[0], r[1], r[2]).normalized().toRotationMatrix();
    if (!t.empty()) local.translation() = Vector3d(t[0], t[1], t[2]);
    return parent[n] < 0 ? local : world(static_cast<std::size_t>(parent[n]), f) * local;
  }

  const tinygltf::Mesh& mesh_of(std::size_t n) const {
    return model.meshes[static_cast<std::size_t>(model.nodes[n].mesh)];
  }

  /// Returns POSITION (or NORMAL, before normalisation) of a mesh's primitive with its targets' weights at a key, as
  /// bound.
  std::vector<Vector3d> morphed(std::size_t n, const std::string& attribute, std::size_t f,
                                std::size_t part = 0) const {
    const auto& primitive = mesh_of(n).primitives[part];
    const auto base = floats(primitive.attributes.at(attribute));
    std::vector<Vector3d> result(base.size() / 3);
    for (std::size_t v = 0; v < result.size(); ++v) result[v] = vertex(base, v);
    const auto weight = primitive.targets.empty() ? std::vector<double>() : key(n, "weights", f);
    EXPECT_EQ(weight.size(), primitive.targets.size());
    for (std::size_t k = 0; k < weight.size(); ++k) {
      const auto delta = floats(primitive.targets[k].at(attribute));
      for (std::size_t v = 0; v < result.size(); ++v) {
        result[v] += weight[k] * vertex(delta, v);
      }
    }
    return result;
  }

  std::vector<std::uint8_t> bytes(int accessor_number) const {
    const auto& accessor = model.accessors[static_cast<std::size_t>(accessor_number)];
    const auto& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
    EXPECT_EQ(accessor.componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE);
    const auto* first = model.buffers[0].data.data() + view.byteOffset + accessor.byteOffset;
    return {first, first + 4 * accessor.count};
  }

  /// Returns the joint that each vertex follows; all have weight 1.
  std::vector<std::size_t> joints(std::size_t n, std::size_t part = 0) const {
    const auto& attributes = mesh_of(n).primitives[part].attributes;
    const auto joint = bytes(attributes.at("JOINTS_0")), weight = bytes(attributes.at("WEIGHTS_0"));
    std::vector<std::size_t> followed;
    for (std::size_t v = 0; v < joint.size(); v += 4) {
      EXPECT_TRUE(weight[v] == 255 && weight[v + 1] == 0 && weight[v + 2] == 0 && weight[v + 3] == 0) << v / 4;
      followed.push_back(joint[v]);
    }
    return followed;
  }

  /// Returns the transform from bound positions to the joint's pose at a key.
  Eigen::Affine3d skinning(std::size_t n, std::size_t joint, std::size_t f) const {
    const auto& skin = model.skins.at(static_cast<std::size_t>(model.nodes[n].skin));
    const auto inverse = floats(skin.inverseBindMatrices);
    const Eigen::Map<const Eigen::Matrix4f> bound(inverse.data() + 16 * joint);
    EXPECT_EQ(bound.row(3), Eigen::RowVector4f(0, 0, 0, 1));
    const Eigen::Affine3d world_of(world(static_cast<std::size_t>(skin.joints.at(joint)), f).matrix());
    return Eigen::Affine3d(world_of.matrix() * bound.cast<double>());
  }

  /// Returns the vertices of a skinned mesh at a key, of which each follows up to four joints.
  std::vector<Vector3d> blended(std::size_t n, std::size_t f, std::size_t part = 0) const {
    auto shape = morphed(n, "POSITION", f, part);
    const auto& attributes = mesh_of(n).primitives[part].attributes;
    const auto joint = bytes(attributes.at("JOINTS_0")), weight = bytes(attributes.at("WEIGHTS_0"));
    std::vector<Eigen::Matrix4d> map;
    for (std::size_t s = 0; s < segment_count; ++s) map.push_back(skinning(n, s, f).matrix());
    for (std::size_t v = 0; v < shape.size(); ++v) {
      Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
      for (std::size_t k = 4 * v; k < 4 * v + 4; ++k) sum += weight[k] / 255.0 * map[joint[k]];
      shape[v] = (sum * shape[v].homogeneous()).head<3>();
    }
    return shape;
  }

  /// Returns the vertices of a skinned mesh at a key, as a viewer draws them.
  std::vector<Vector3d> drawn(std::size_t n, std::size_t f, std::size_t part = 0) const {
    auto shape = morphed(n, "POSITION", f, part);
    const auto followed = joints(n, part);
    EXPECT_EQ(followed.size(), shape.size());
    std::map<std::size_t, Eigen::Affine3d> by_joint;
    for (std::size_t v = 0; v < shape.size(); ++v) {
      auto found = by_joint.find(followed[v]);
      if (found == by_joint.end()) found = by_joint.emplace(followed[v], skinning(n, followed[v], f)).first;
      shape[v] = found->second * shape[v];
    }
    return shape;
  }
};

}  // namespace mobil::export_fixture
