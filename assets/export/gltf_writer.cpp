#include "assets/export/gltf_writer.h"

#include <fmt/format.h>

#include "assets/export/gltf_buffers.h"
#include "assets/export/mesh_shading.h"
#include "assets/export/morph_targets.h"
#include "assets/export/recording_check.h"
#include "assets/export/skeleton_keys.h"
#include "assets/files/output_file.h"

namespace mobil {
namespace {

constexpr Vec3<float> ivory{0.80F, 0.74F, 0.60F};

int number_of(std::size_t i) {
  return static_cast<int>(i);
}

/// A material per colour, made when first asked for.
int material(tinygltf::Model& model, const std::string& name, const Vec3<float>& colour, double roughness) {
  const std::vector<double> factor = {static_cast<double>(colour.x), static_cast<double>(colour.y),
                                      static_cast<double>(colour.z), 1.0};
  for (std::size_t m = 0; m < model.materials.size(); ++m) {
    if (model.materials[m].pbrMetallicRoughness.baseColorFactor == factor && model.materials[m].name == name) {
      return number_of(m);
    }
  }
  tinygltf::Material made;
  made.name = name;
  made.pbrMetallicRoughness.baseColorFactor = factor;
  made.pbrMetallicRoughness.metallicFactor = 0.0;
  made.pbrMetallicRoughness.roughnessFactor = roughness;
  model.materials.push_back(std::move(made));
  return number_of(model.materials.size()) - 1;
}

void add_segments(tinygltf::Model& model, const SkeletonKeys& skeleton) {
  model.nodes.resize(segment_count);
  for (std::size_t s = 0; s < segment_count; ++s) {
    auto& node = model.nodes[s];
    node.name = segment_name[s];
    const auto& t = skeleton.segment[s].translation_m.front();
    const auto& q = skeleton.segment[s].rotation.front();
    node.translation = {static_cast<double>(t.x), static_cast<double>(t.y), static_cast<double>(t.z)};
    node.rotation = {static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z),
                     static_cast<double>(q.w)};
    const std::size_t parent = index(segment_parent[s]);
    if (parent != s) model.nodes[parent].children.push_back(number_of(s));
  }
  tinygltf::Scene scene;
  scene.name = "walk";
  scene.nodes = {0};
  model.scenes.push_back(std::move(scene));
  model.defaultScene = 0;
}

int add_surface_node(tinygltf::Model& model, Segment segment, const std::string& name, tinygltf::Mesh mesh) {
  mesh.name = name;
  tinygltf::Node node;
  node.name = name;
  node.mesh = number_of(model.meshes.size());
  model.meshes.push_back(std::move(mesh));
  const int number = number_of(model.nodes.size());
  model.nodes.push_back(std::move(node));
  model.nodes[index(segment)].children.push_back(number);
  return number;
}

Error no_area(const std::string& name) {
  return Error{fmt::format("surface '{}': none of its triangles has an area; leave it out", name)};
}

tinygltf::Primitive primitive(GltfDraft& draft, const Eigen::Matrix3Xf& position, const Eigen::Matrix3Xf& normal,
                              const std::vector<std::uint32_t>& triangle, int material_number) {
  tinygltf::Primitive made;
  made.mode = TINYGLTF_MODE_TRIANGLES;
  made.material = material_number;
  made.attributes["POSITION"] = add_vertices(draft, position, true);
  made.attributes["NORMAL"] = add_vertices(draft, normal, false);
  made.indices = add_indices(draft, triangle, static_cast<std::size_t>(position.cols()));
  return made;
}

Result<void> add_bone(GltfDraft& draft, const BoneSurface& bone) {
  const auto count = static_cast<Eigen::Index>(bone.mesh.position.size());
  Eigen::Matrix3Xf position(3, count);
  for (Eigen::Index v = 0; v < count; ++v) {
    const auto& p = bone.mesh.position[static_cast<std::size_t>(v)];
    position.col(v) << p.x, p.y, p.z;
  }
  const Eigen::Matrix3Xd exact = position.cast<double>();
  const auto triangle = triangles_with_area(exact, bone.mesh.triangle);
  if (triangle.empty()) return tl::unexpected(no_area(bone.mesh.name));
  tinygltf::Mesh mesh;
  mesh.primitives.push_back(primitive(draft, position, vertex_normals(exact, triangle).cast<float>(), triangle,
                                      material(draft.model, "bone", ivory, 0.7)));
  add_surface_node(draft.model, bone.segment, bone.mesh.name, std::move(mesh));
  return {};
}

/// A column per frame: the vertices in the frame of the segment's node, x y z below one another.
Eigen::MatrixXd in_segment(const RecordedMuscle& muscle, const SkeletonKeys& skeleton) {
  const std::size_t vertex_count = muscle.position_m.front().size();
  Eigen::MatrixXd frames(static_cast<Eigen::Index>(3 * vertex_count),
                         static_cast<Eigen::Index>(muscle.position_m.size()));
  for (std::size_t f = 0; f < muscle.position_m.size(); ++f) {
    const RigidTransform& segment = skeleton.world[f][index(muscle.segment)];
    const Eigen::Matrix3d to_segment = segment.rotation.conjugate().toRotationMatrix();
    for (std::size_t v = 0; v < vertex_count; ++v) {
      const auto& p = muscle.position_m[f][v];
      const Eigen::Vector3d world(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
      frames.col(static_cast<Eigen::Index>(f)).segment<3>(static_cast<Eigen::Index>(3 * v)) =
          to_segment * (world - segment.position_m);
    }
  }
  return frames;
}

struct WeightKeys {
  int node = 0;
  std::vector<float> value;
};

Result<WeightKeys> add_muscle(GltfDraft& draft, const RecordedMuscle& muscle, const SkeletonKeys& skeleton,
                              const ExportOptions& options, MuscleFidelity& fidelity) {
  const Eigen::MatrixXd frames = in_segment(muscle, skeleton);
  const Eigen::VectorXd mean = frames.rowwise().mean();
  const auto triangle =
      triangles_with_area(Eigen::Map<const Eigen::Matrix3Xd>(mean.data(), 3, mean.size() / 3), muscle.triangle);
  if (triangle.empty()) return tl::unexpected(no_area(muscle.name));
  const MorphedSurface surface =
      morph_targets(frames, triangle, options.morph_targets, static_cast<double>(options.morph_tolerance_m));
  fidelity = {muscle.name, number_of(surface.target.size()), surface.max_error_m, surface.rms_error_m};

  tinygltf::Mesh mesh;
  auto shape =
      primitive(draft, surface.position, surface.normal, triangle, material(draft.model, "muscle", muscle.colour, 0.5));
  tinygltf::Value::Array target_names;
  for (const auto& target : surface.target) {
    auto& attributes = shape.targets.emplace_back();
    attributes["POSITION"] = add_vertices(draft, target.position, true);
    if (options.morph_normals) attributes["NORMAL"] = add_vertices(draft, target.normal, false);
    target_names.emplace_back(fmt::format("shape_{}", shape.targets.size()));
  }
  mesh.primitives.push_back(std::move(shape));
  if (!target_names.empty()) {
    mesh.extras = tinygltf::Value(tinygltf::Value::Object{{"targetNames", tinygltf::Value(std::move(target_names))}});
    for (const float w : surface.weight.front()) mesh.weights.push_back(static_cast<double>(w));
  }
  WeightKeys keys;
  keys.node = add_surface_node(draft.model, muscle.segment, muscle.name, std::move(mesh));
  for (const auto& weights : surface.weight) keys.value.insert(keys.value.end(), weights.begin(), weights.end());
  return keys;
}

void animate_segments(GltfDraft& draft, GltfAnimation& walk, const SkeletonKeys& skeleton) {
  for (std::size_t s = 0; s < segment_count; ++s) {
    const SegmentKeys& keys = skeleton.segment[s];
    if (keys.translation_m.size() > 1) {
      std::vector<float> value;
      for (const auto& t : keys.translation_m) value.insert(value.end(), {t.x, t.y, t.z});
      add_channel(draft, walk, number_of(s), "translation", value, TINYGLTF_TYPE_VEC3);
    }
    if (keys.rotation.size() > 1) {
      std::vector<float> value;
      for (const auto& q : keys.rotation) value.insert(value.end(), {q.x, q.y, q.z, q.w});
      add_channel(draft, walk, number_of(s), "rotation", value, TINYGLTF_TYPE_VEC4);
    }
  }
}

Result<void> check_options(const ExportOptions& options) {
  if (options.morph_targets < 0 || options.morph_targets > 8) {
    return fail(fmt::format("{} morph targets a muscle; the range is 0–8", options.morph_targets));
  }
  if (!(options.morph_tolerance_m >= 0.0F && options.morph_tolerance_m <= 1.0F)) {
    return fail(fmt::format("morph tolerance {} m; the range is 0–1 m", options.morph_tolerance_m));
  }
  return {};
}

/// The bytes of the file.
Result<std::string> encode(const WalkRecording& recording, const ExportOptions& options, ExportReport& report) {
  if (auto ok = check_options(options); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_recording(recording); !ok) return tl::unexpected(ok.error());

  GltfDraft draft;
  draft.model.asset.version = "2.0";
  draft.model.asset.generator = "mobil";
  const SkeletonKeys skeleton = skeleton_keys(recording.frames);
  add_segments(draft.model, skeleton);
  GltfAnimation walk;
  walk.animation.name = "walk";
  walk.frames = recording.frames.size();
  walk.frame_s = recording.frame_s;
  animate_segments(draft, walk, skeleton);
  for (const auto& bone : recording.bones) {
    if (auto ok = add_bone(draft, bone); !ok) return tl::unexpected(ok.error());
  }
  for (const auto& muscle : recording.muscles) {
    const auto keys = add_muscle(draft, muscle, skeleton, options, report.muscles.emplace_back());
    if (!keys) return tl::unexpected(keys.error());
    if (keys->value.empty()) continue;
    add_channel(draft, walk, keys->node, "weights", keys->value, TINYGLTF_TYPE_SCALAR);
  }
  if (!walk.animation.channels.empty()) draft.model.animations.push_back(std::move(walk.animation));
  return glb_bytes(draft);
}

}  // namespace

Result<ExportReport> write_glb(const std::filesystem::path& path, const WalkRecording& recording,
                               const ExportOptions& options) {
  ExportReport report;
  const auto bytes = encode(recording, options, report);
  if (!bytes) return fail(fmt::format("{}: {}", path.string(), bytes.error().message));
  report.bytes = bytes->size();
  if (auto ok = write_file(path, *bytes); !ok) return tl::unexpected(ok.error());
  return report;
}

}  // namespace mobil
