#include "assets/export/gltf_person.h"

#include <fmt/format.h>

#include <algorithm>

#include "assets/export/figure_pieces.h"
#include "assets/export/mesh_shading.h"
#include "assets/export/morph_targets.h"

namespace mobil::inline v0_3 {
namespace {

int number_of(std::size_t i) {
  return static_cast<int>(i);
}

/// Returns a material per use and colour, made at first use.
int material(GltfScene& scene, const std::string& of, const Vec3<float>& colour, double roughness) {
  tinygltf::Model& model = scene.draft.model;
  const auto [known, is_new] =
      scene.materials.try_emplace({of, {colour.x, colour.y, colour.z}}, number_of(model.materials.size()));
  if (!is_new) return known->second;
  tinygltf::Material made;
  made.name = scene.material_names.take(of);
  made.pbrMetallicRoughness.baseColorFactor = {static_cast<double>(colour.x), static_cast<double>(colour.y),
                                               static_cast<double>(colour.z), 1.0};
  made.pbrMetallicRoughness.metallicFactor = 0.0;
  made.pbrMetallicRoughness.roughnessFactor = roughness;
  model.materials.push_back(std::move(made));
  return number_of(model.materials.size()) - 1;
}

int add_node(tinygltf::Model& model, const std::string& name) {
  model.nodes.emplace_back().name = name;
  return number_of(model.nodes.size()) - 1;
}

/// Adds the root and under it the segments, nested, as they are in the first frame. Returns the pelvis' node; the
/// others follow it in their order.
int add_segments(GltfScene& scene, const SkeletonKeys& skeleton, const std::string& name, const std::string& prefix) {
  tinygltf::Model& model = scene.draft.model;
  const int root = add_node(model, scene.names.take(name)), first = root + 1;
  scene.scene.nodes.push_back(root);
  for (std::size_t s = 0; s < segment_count; ++s) {
    const int number = add_node(model, scene.names.take(prefix + std::string(segment_name[s])));
    auto& node = model.nodes[static_cast<std::size_t>(number)];
    const auto& t = skeleton.segment[s].translation_m.front();
    const auto& q = skeleton.segment[s].rotation.front();
    node.translation = {static_cast<double>(t.x), static_cast<double>(t.y), static_cast<double>(t.z)};
    node.rotation = {static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z),
                     static_cast<double>(q.w)};
    const std::size_t parent = index(segment_parent[s]);
    const int above = parent == s ? root : first + number_of(parent);
    model.nodes[static_cast<std::size_t>(above)].children.push_back(number);
  }
  return first;
}

void animate_joints(GltfScene& scene, const SkeletonKeys& skeleton, int first) {
  for (std::size_t s = 0; s < segment_count; ++s) {
    const SegmentKeys& keys = skeleton.segment[s];
    const int node = first + number_of(s);
    if (keys.translation_m.size() > 1) {
      std::vector<float> value;
      for (const auto& t : keys.translation_m) value.insert(value.end(), {t.x, t.y, t.z});
      add_channel(scene.draft, scene.animation, node, "translation", value, TINYGLTF_TYPE_VEC3);
    }
    if (keys.rotation.size() > 1) {
      std::vector<float> value;
      for (const auto& q : keys.rotation) value.insert(value.end(), {q.x, q.y, q.z, q.w});
      add_channel(scene.draft, scene.animation, node, "rotation", value, TINYGLTF_TYPE_VEC4);
    }
  }
}

/// Adds a skin from the figure's standing place to each segment's frame, scaled there to the person's size.
int add_skin(GltfScene& scene, const GltfFigure& figure, const Vec3<float>& scale, int first, const std::string& name) {
  const Eigen::Vector3d size(static_cast<double>(scale.x), static_cast<double>(scale.y), static_cast<double>(scale.z));
  std::vector<float> matrices;
  tinygltf::Skin skin;
  skin.name = name;
  skin.skeleton = first - 1;
  for (std::size_t s = 0; s < segment_count; ++s) {
    Eigen::Matrix4f inverse = Eigen::Matrix4f::Identity();
    inverse.diagonal().head<3>() = size.cast<float>();
    inverse.block<3, 1>(0, 3) = (-size.cwiseProduct(figure.standing_m[s])).cast<float>();
    matrices.insert(matrices.end(), inverse.data(), inverse.data() + 16);
    skin.joints.push_back(first + number_of(s));
  }
  skin.inverseBindMatrices = add_bind_matrices(scene.draft, matrices);
  scene.draft.model.skins.push_back(std::move(skin));
  return number_of(scene.draft.model.skins.size()) - 1;
}

/// Adds a node at the root of the scene, because nodes above a skinned mesh's node do not move it.
int add_skinned_node(GltfScene& scene, const std::string& name, tinygltf::Mesh mesh, int skin) {
  tinygltf::Model& model = scene.draft.model;
  const int number = add_node(model, scene.names.take(name));
  auto& node = model.nodes.back();
  mesh.name = node.name;
  node.mesh = number_of(model.meshes.size());
  node.skin = skin;
  model.meshes.push_back(std::move(mesh));
  scene.scene.nodes.push_back(number);
  return number;
}

/// `texture`, `joint` and `weight` are per vertex.
tinygltf::Primitive primitive(GltfDraft& draft, const Eigen::Matrix3Xf& position, const Eigen::Matrix3Xf& normal,
                              const std::vector<TexturePlace>& texture,
                              const std::vector<std::array<std::uint8_t, 4>>& joint,
                              const std::vector<std::array<float, 4>>& weight,
                              const std::vector<std::uint32_t>& triangle) {
  tinygltf::Primitive made;
  made.mode = TINYGLTF_MODE_TRIANGLES;
  made.attributes["POSITION"] = add_vertices(draft, position, true);
  made.attributes["NORMAL"] = add_vertices(draft, normal, false);
  made.attributes["TEXCOORD_0"] = add_texture_places(draft, texture);
  const SkinAccessors skin = add_joints(draft, joint, weight);
  made.attributes["JOINTS_0"] = skin.joints;
  made.attributes["WEIGHTS_0"] = skin.weights;
  made.indices = add_indices(draft, triangle, static_cast<std::size_t>(position.cols()));
  return made;
}

Result<GltfFigure> make_gltf_figure(GltfDraft& draft, const SeenFigure& seen, const SkeletonKeys& skeleton) {
  GltfFigure figure;
  figure.standing_m = figure_standing(seen, skeleton);
  const auto pieces = figure_pieces(seen, figure.standing_m);
  if (!pieces) return tl::unexpected(pieces.error());
  for (const FigurePiece& piece : *pieces) {
    const auto columns = [&](const std::vector<Vec3<float>>& v) {
      return Eigen::Map<const Eigen::Matrix3Xf>(&v.front().x, 3, static_cast<Eigen::Index>(v.size()));
    };
    figure.cloth.push_back(piece.cloth);
    figure.name.push_back(piece.name);
    figure.rigid.push_back(piece.rigid);
    figure.primitive.push_back(primitive(draft, columns(piece.position), columns(piece.normal), piece.texture,
                                         piece.joint, piece.weight, piece.triangle));
    if (!piece.tangent.empty()) figure.primitive.back().attributes["TANGENT"] = add_tangents(draft, piece.tangent);
  }
  return figure;
}

void add_figure(GltfScene& scene, const GltfFigure& figure, const SeenPerson& person, int skin,
                const std::string& prefix) {
  const bool dressed_bones = std::ranges::find(figure.rigid, true) != figure.rigid.end() &&
                             std::ranges::find(figure.rigid, false) != figure.rigid.end();
  const auto add = [&](const std::string& name, const auto& is_part) {
    tinygltf::Mesh mesh;
    for (std::size_t i = 0; i < figure.primitive.size(); ++i) {
      if (!is_part(i)) continue;
      mesh.primitives.push_back(figure.primitive[i]);
      mesh.primitives.back().material = material(scene, figure.name[i], person.colour(figure.cloth[i]), 0.7);
    }
    if (!mesh.primitives.empty()) add_skinned_node(scene, prefix + name, std::move(mesh), skin);
  };
  if (dressed_bones) add("bones", [&](std::size_t i) { return figure.rigid[i]; });
  add(person.colours.empty() ? "bones" : "figure", [&](std::size_t i) { return !dressed_bones || !figure.rigid[i]; });
}

/// Returns a column per frame: the vertices in the frame of the segment's node, x y z below one another.
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

/// Adds the mean shape round the segment's standing place, with texture places.
tinygltf::Primitive standing_muscle(GltfDraft& draft, const MorphedSurface& surface, Segment segment,
                                    const Eigen::Vector3d& standing_m, const std::vector<std::uint32_t>& triangle) {
  const auto vertices = static_cast<std::size_t>(surface.position.cols());
  std::vector<Vec3<float>> own(vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto column = surface.position.col(static_cast<Eigen::Index>(v));
    own[v] = {column.x(), column.y(), column.z()};
  }
  const Eigen::Matrix3Xf standing = (surface.position.cast<double>().colwise() + standing_m).cast<float>();
  return primitive(draft, standing, surface.normal, folded_places(own),
                   {vertices, {static_cast<std::uint8_t>(segment), 0, 0, 0}}, {vertices, {1, 0, 0, 0}}, triangle);
}

Result<void> add_muscle(GltfScene& scene, const RecordedMuscle& muscle, const SkeletonKeys& skeleton,
                        const GltfFigure& figure, int skin, const std::string& prefix, const ExportOptions& options,
                        MuscleFidelity& fidelity) {
  GltfDraft& draft = scene.draft;
  const Eigen::MatrixXd frames = in_segment(muscle, skeleton);
  const Eigen::VectorXd mean = frames.rowwise().mean();
  const auto triangle =
      triangles_with_area(Eigen::Map<const Eigen::Matrix3Xd>(mean.data(), 3, mean.size() / 3), muscle.triangle);
  if (triangle.empty())
    return fail(fmt::format("surface '{}': none of its triangles has an area; leave it out", muscle.name));
  const MorphedSurface surface =
      morph_targets(frames, triangle, options.morph_targets, static_cast<double>(options.morph_tolerance_m));
  fidelity = {prefix + muscle.name, number_of(surface.target.size()), surface.max_error_m, surface.rms_error_m};

  tinygltf::Mesh mesh;
  auto shape = standing_muscle(draft, surface, muscle.segment, figure.standing_m[index(muscle.segment)], triangle);
  shape.material = material(scene, "muscle", muscle.colour, 0.5);
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
  const int node = add_skinned_node(scene, prefix + muscle.name, std::move(mesh), skin);
  if (surface.target.empty()) return {};
  std::vector<float> keys;
  for (const auto& weights : surface.weight) keys.insert(keys.end(), weights.begin(), weights.end());
  add_channel(draft, scene.animation, node, "weights", keys, TINYGLTF_TYPE_SCALAR);
  return {};
}

}  // namespace

Result<void> add_person(GltfScene& scene, const SeenPerson& person, const SeenFigure& figure, const std::string& prefix,
                        const ExportOptions& options, std::vector<MuscleFidelity>& fidelity) {
  const SkeletonKeys skeleton = skeleton_keys(*person.frames);
  auto made = scene.figures.find(person.figure);
  if (made == scene.figures.end()) {
    auto figure_made = make_gltf_figure(scene.draft, figure, skeleton);
    if (!figure_made) return tl::unexpected(figure_made.error());
    made = scene.figures.emplace(person.figure, std::move(*figure_made)).first;
  }
  const int first = add_segments(scene, skeleton, person.name, prefix);
  animate_joints(scene, skeleton, first);
  if (made->second.primitive.empty() && person.muscles.empty()) return {};
  const int skin = add_skin(scene, made->second, person.scale, first, person.name);
  add_figure(scene, made->second, person, skin, prefix);
  if (person.muscles.empty()) return {};
  // Muscles are recorded at their full size.
  const bool scaled = person.scale.x != 1 || person.scale.y != 1 || person.scale.z != 1;
  const int own = scaled ? add_skin(scene, made->second, {1, 1, 1}, first, person.name + "_muscles") : skin;
  for (const auto& muscle : person.muscles) {
    auto added = add_muscle(scene, muscle, skeleton, made->second, own, prefix, options, fidelity.emplace_back());
    if (!added) return added;
  }
  return {};
}

}  // namespace mobil::inline v0_3
