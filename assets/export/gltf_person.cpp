#include "assets/export/gltf_person.h"

#include <fmt/format.h>

#include <algorithm>

#include "assets/export/figure_pieces.h"
#include "assets/export/mesh_shading.h"
#include "assets/export/morph_targets.h"
#include "assets/export/skin_shapes.h"

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

/// Adds the root and under it the segments, nested, in their rest pose. Returns the pelvis' node; the others follow it
/// in their order.
int add_segments(GltfScene& scene, const StandingPlaces& rest, const std::string& name, const std::string& prefix) {
  tinygltf::Model& model = scene.draft.model;
  const int root = add_node(model, scene.names.take(name)), first = root + 1;
  scene.scene.nodes.push_back(root);
  for (std::size_t s = 0; s < segment_count; ++s) {
    const int number = add_node(model, scene.names.take(prefix + std::string(segment_name[s])));
    auto& node = model.nodes[static_cast<std::size_t>(number)];
    const Vec3<float> t = rest_offset(rest, s);
    node.translation = {static_cast<double>(t.x), static_cast<double>(t.y), static_cast<double>(t.z)};
    const std::size_t parent = index(segment_parent[s]);
    const int above = parent == s ? root : first + number_of(parent);
    model.nodes[static_cast<std::size_t>(above)].children.push_back(number);
  }
  return first;
}

/// Adds channels of joints that differ from their rest pose in any frame.
void animate_joints(GltfScene& scene, const SkeletonKeys& skeleton, const StandingPlaces& rest, int first) {
  const auto animate = [&](const SegmentKeys& keys, const Vec3<float>& rest_m, int node) {
    if (leaves_rest(keys, rest_m)) {
      std::vector<float> value;
      for (const auto& t : keys.translation_m) value.insert(value.end(), {t.x, t.y, t.z});
      add_channel(scene.draft, scene.animation, node, "translation", value, TINYGLTF_TYPE_VEC3);
    }
    if (turns(keys)) {
      std::vector<float> value;
      for (const auto& q : keys.rotation) value.insert(value.end(), {q.x, q.y, q.z, q.w});
      add_channel(scene.draft, scene.animation, node, "rotation", value, TINYGLTF_TYPE_VEC4);
    }
  };
  animate(skeleton.root, {0, 0, 0}, first - 1);
  for (std::size_t s = 0; s < segment_count; ++s)
    animate(skeleton.segment[s], rest_offset(rest, s), first + number_of(s));
}

/// Adds what engines ask of a person to the root.
void add_facts(GltfScene& scene, const RecordedFacts& facts, int root) {
  tinygltf::Value::Object extras;
  extras["sex"] = tinygltf::Value(facts.sex);
  const auto add = [&](const char* name, float value) { extras[name] = tinygltf::Value(static_cast<double>(value)); };
  add("height_m", facts.height_m);
  add("mass_kg", facts.mass_kg);
  add("heading_rad", facts.heading_rad);
  add("stride_s", facts.stride_s);
  add("speed_m_s", facts.speed_m_s);
  scene.draft.model.nodes[static_cast<std::size_t>(root)].extras = tinygltf::Value(std::move(extras));
}

/// Adds a skin from the places `bound` to each segment's frame, scaled there to the person's size.
int add_skin(GltfScene& scene, const StandingPlaces& bound, const Vec3<float>& scale, int first,
             const std::string& name) {
  const Eigen::Vector3d size(static_cast<double>(scale.x), static_cast<double>(scale.y), static_cast<double>(scale.z));
  std::vector<float> matrices;
  tinygltf::Skin skin;
  skin.name = name;
  skin.skeleton = first - 1;
  for (std::size_t s = 0; s < segment_count; ++s) {
    Eigen::Matrix4f inverse = Eigen::Matrix4f::Identity();
    inverse.diagonal().head<3>() = size.cast<float>();
    inverse.block<3, 1>(0, 3) = (-size.cwiseProduct(bound[s])).cast<float>();
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

/// A muscle's triangles with area, and its shapes in its segment's frame.
struct MuscleShapes {
  std::vector<std::uint32_t> triangle;
  MorphedSurface surface;
};

Result<std::vector<MuscleShapes>> muscle_shapes(std::span<const RecordedMuscle> muscles, const SkeletonKeys& skeleton,
                                                const ExportOptions& options) {
  std::vector<MuscleShapes> shapes;
  for (const RecordedMuscle& muscle : muscles) {
    const Eigen::MatrixXd frames = in_segment(muscle, skeleton);
    const Eigen::VectorXd mean = frames.rowwise().mean();
    auto triangle =
        triangles_with_area(Eigen::Map<const Eigen::Matrix3Xd>(mean.data(), 3, mean.size() / 3), muscle.triangle);
    if (triangle.empty())
      return fail(fmt::format("surface '{}': none of its triangles has an area; leave it out", muscle.name));
    auto surface =
        morph_targets(frames, triangle, options.morph_targets, static_cast<double>(options.morph_tolerance_m));
    shapes.push_back({std::move(triangle), std::move(surface)});
  }
  return shapes;
}

/// Returns the vertices of muscles in a frame, as the file has them.
std::vector<Eigen::Vector3d> written_muscles(std::span<const RecordedMuscle> muscles,
                                             const std::vector<MuscleShapes>& shapes, const SkeletonKeys& skeleton,
                                             std::size_t frame) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t m = 0; m < muscles.size(); ++m) {
    const MorphedSurface& surface = shapes[m].surface;
    Eigen::Matrix3Xf own = surface.position;
    for (std::size_t k = 0; k < surface.target.size(); ++k)
      own += surface.weight[frame][k] * surface.target[k].position;
    const RigidTransform& segment = skeleton.world[frame][index(muscles[m].segment)];
    for (const auto& p : own.cast<double>().colwise()) points.emplace_back(segment.position_m + segment.rotation * p);
  }
  return points;
}

/// Adds the morph targets of a primitive whose vertices begin at column `first` of `surface`.
void add_skin_targets(GltfDraft& draft, const MorphedSurface& surface, Eigen::Index first, Eigen::Index count,
                      bool normals, tinygltf::Primitive& shape) {
  constexpr float negligible_m = 2e-5F, negligible_turn = 2e-3F;
  for (const MorphTarget& target : surface.target) {
    auto& attributes = shape.targets.emplace_back();
    attributes["POSITION"] = add_displacements(draft, target.position.middleCols(first, count), true, negligible_m);
    if (normals)
      attributes["NORMAL"] = add_displacements(draft, target.normal.middleCols(first, count), false, negligible_turn);
  }
}

/// Returns the skin's shapes for weights as the file has them.
SkinShapes shape_skin(std::vector<FigurePiece>& pieces, const SeenPerson& person, const StandingPlaces& standing,
                      const std::vector<MuscleShapes>& muscles, const ExportOptions& options, ExportReport& report) {
  for (FigurePiece& piece : pieces)
    for (auto& weight : piece.weight) weight = byte_weights(weight);
  const SkeletonKeys skeleton = skeleton_keys(*person.frames, standing);
  SkinShapes shapes = skin_shapes(
      pieces, [&](std::size_t frame) { return written_muscles(person.muscles, muscles, skeleton, frame); }, skeleton,
      standing, options.morph_targets, static_cast<double>(options.morph_tolerance_m));
  report.skin = {"figure", number_of(shapes.surface.target.size()), shapes.surface.max_error_m,
                 shapes.surface.rms_error_m};
  report.bones_moved_m = shapes.bones_moved_m;
  return shapes;
}

/// `standing`: the figure's places; `muscles`: those of `first`.
Result<GltfFigure> make_gltf_figure(GltfDraft& draft, const SeenFigure& seen, const SeenPerson& first,
                                    const StandingPlaces& standing, const std::vector<MuscleShapes>& muscles,
                                    const ExportOptions& options, ExportReport& report) {
  GltfFigure figure;
  figure.standing_m = standing;
  auto pieces = figure_pieces(seen, figure.standing_m);
  if (!pieces) return tl::unexpected(pieces.error());
  SkinShapes shapes;
  if (has_drawn_skin(*pieces)) shapes = shape_skin(*pieces, first, standing, muscles, options, report);
  figure.skin_weight = shapes.surface.weight;
  Eigen::Index first_shaped = 0;
  for (const FigurePiece& piece : *pieces) {
    const auto columns = [&](const std::vector<Vec3<float>>& v) {
      return Eigen::Map<const Eigen::Matrix3Xf>(&v.front().x, 3, static_cast<Eigen::Index>(v.size()));
    };
    figure.cloth.push_back(piece.cloth);
    figure.name.push_back(piece.name);
    figure.rigid.push_back(piece.rigid);
    figure.primitive.push_back(primitive(draft, columns(piece.position), columns(piece.normal), piece.texture,
                                         piece.joint, piece.weight, piece.triangle));
    tinygltf::Primitive& shape = figure.primitive.back();
    if (!piece.tangent.empty()) shape.attributes["TANGENT"] = add_tangents(draft, piece.tangent);
    if (piece.rigid || shapes.surface.target.empty()) continue;
    const auto count = static_cast<Eigen::Index>(piece.position.size());
    add_skin_targets(draft, shapes.surface, first_shaped, count, options.morph_normals, shape);
    first_shaped += count;
  }
  return figure;
}

/// Names a mesh's targets, and adds a channel of their weights if it has any. The weights of a loop end as they begin,
/// which rounding of small shapes would change.
void animate_weights(GltfScene& scene, int node, std::vector<std::vector<float>> weight, bool loops) {
  tinygltf::Model& model = scene.draft.model;
  auto& mesh = model.meshes[static_cast<std::size_t>(model.nodes[static_cast<std::size_t>(node)].mesh)];
  const std::size_t targets = weight.empty() ? 0 : weight.front().size();
  if (targets == 0) return;
  if (loops) weight.back() = weight.front();
  tinygltf::Value::Array names;
  for (std::size_t k = 0; k < targets; ++k) names.emplace_back(fmt::format("shape_{}", k + 1));
  mesh.extras = tinygltf::Value(tinygltf::Value::Object{{"targetNames", tinygltf::Value(std::move(names))}});
  for (const float w : weight.front()) mesh.weights.push_back(static_cast<double>(w));
  std::vector<float> keys;
  for (const auto& weights : weight) keys.insert(keys.end(), weights.begin(), weights.end());
  add_channel(scene.draft, scene.animation, node, "weights", keys, TINYGLTF_TYPE_SCALAR);
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
    if (mesh.primitives.empty()) return;
    const bool morphs = !mesh.primitives.front().targets.empty();
    const int node = add_skinned_node(scene, prefix + name, std::move(mesh), skin);
    if (morphs) animate_weights(scene, node, figure.skin_weight, person.loops);
  };
  if (dressed_bones) add("bones", [&](std::size_t i) { return figure.rigid[i]; });
  add(person.colours.empty() ? "bones" : "figure", [&](std::size_t i) { return !dressed_bones || !figure.rigid[i]; });
}

/// Adds the shape without targets round the segment's place at rest, with texture places.
tinygltf::Primitive standing_muscle(GltfDraft& draft, const MorphedSurface& surface, Segment segment,
                                    const Eigen::Vector3d& rest_m, const std::vector<std::uint32_t>& triangle,
                                    bool z_back) {
  const auto vertices = static_cast<std::size_t>(surface.position.cols());
  std::vector<Vec3<float>> own(vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto column = surface.position.col(static_cast<Eigen::Index>(v));
    own[v] = {column.x(), column.y(), column.z()};
  }
  const Eigen::Matrix3Xf standing = (surface.position.cast<double>().colwise() + rest_m).cast<float>();
  return primitive(draft, standing, surface.normal, recorded_texture(own, z_back),
                   {vertices, {static_cast<std::uint8_t>(segment), 0, 0, 0}}, {vertices, {1, 0, 0, 0}}, triangle);
}

void add_muscle(GltfScene& scene, const RecordedMuscle& muscle, const MuscleShapes& shapes, const StandingPlaces& rest,
                int skin, const std::string& prefix, const SeenPerson& person, const ExportOptions& options,
                MuscleFidelity& fidelity) {
  GltfDraft& draft = scene.draft;
  const MorphedSurface& surface = shapes.surface;
  fidelity = {prefix + muscle.name, number_of(surface.target.size()), surface.max_error_m, surface.rms_error_m};

  tinygltf::Mesh mesh;
  auto shape =
      standing_muscle(draft, surface, muscle.segment, rest[index(muscle.segment)], shapes.triangle, person.z_back);
  const bool coloured = !muscle.tissue.empty();  // by vertex, which multiplies the material's
  if (coloured) {
    shape.attributes["_TISSUE"] = add_tissue(draft, muscle.tissue);
    shape.attributes["COLOR_0"] = add_colours(draft, tissue_colours(muscle));
  }
  shape.material = material(scene, "muscle", coloured ? Vec3<float>{1, 1, 1} : muscle.colour, 0.5);
  for (const auto& target : surface.target) {
    auto& attributes = shape.targets.emplace_back();
    attributes["POSITION"] = add_vertices(draft, target.position, true);
    if (options.morph_normals) attributes["NORMAL"] = add_vertices(draft, target.normal, false);
  }
  mesh.primitives.push_back(std::move(shape));
  const int node = add_skinned_node(scene, prefix + muscle.name, std::move(mesh), skin);
  animate_weights(scene, node, surface.weight, person.loops);
}

}  // namespace

Result<void> add_person(GltfScene& scene, const SeenPerson& person, const SeenFigure& figure, const std::string& prefix,
                        const ExportOptions& options, ExportReport& report) {
  auto made = scene.figures.find(person.figure);
  const StandingPlaces standing =
      made == scene.figures.end() ? figure_standing(figure, person) : made->second.standing_m;
  const StandingPlaces rest = person_rest(standing, person.scale);
  const SkeletonKeys skeleton = skeleton_keys(*person.frames, rest, person.root);
  const auto muscles = muscle_shapes(person.muscles, skeleton, options);
  if (!muscles) return tl::unexpected(muscles.error());
  if (made == scene.figures.end()) {
    auto figure_made = make_gltf_figure(scene.draft, figure, person, standing, *muscles, options, report);
    if (!figure_made) return tl::unexpected(figure_made.error());
    made = scene.figures.emplace(person.figure, std::move(*figure_made)).first;
  }
  const int first = add_segments(scene, rest, person.name, prefix);
  animate_joints(scene, skeleton, rest, first);
  if (person.facts != nullptr) add_facts(scene, *person.facts, first - 1);
  if (made->second.primitive.empty() && person.muscles.empty()) return {};
  const int skin = add_skin(scene, standing, person.scale, first, person.name);
  add_figure(scene, made->second, person, skin, prefix);
  if (person.muscles.empty()) return {};
  // Muscles are recorded at their full size.
  const bool scaled = person.scale.x != 1 || person.scale.y != 1 || person.scale.z != 1;
  const int own = scaled ? add_skin(scene, rest, {1, 1, 1}, first, person.name + "_muscles") : skin;
  for (std::size_t m = 0; m < person.muscles.size(); ++m)
    add_muscle(scene, person.muscles[m], (*muscles)[m], rest, own, prefix, person, options,
               report.muscles.emplace_back());
  return {};
}

}  // namespace mobil::inline v0_3
