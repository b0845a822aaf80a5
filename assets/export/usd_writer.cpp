#include <mobil/usd_writer.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include <mobil/assets/files/output_file.h>
#include <mobil/assets/surfaces/texture_places.h>
#include <mobil/gltf_writer.h>
#include "assets/export/figure_pieces.h"
#include "assets/export/mesh_shading.h"
#include "assets/export/recording_check.h"
#include "assets/export/skeleton_keys.h"
#include "assets/export/skin_shapes.h"
#include "assets/export/unique_names.h"

namespace mobil::inline v0_3 {
namespace {

/// A file being written: lines are indented as prims nest.
struct UsdText {
  std::string text;
  std::size_t depth = 0;

  void line(std::string_view content) {
    text.append(4 * depth, ' ');
    text += content;
    text += '\n';
  }
  /// Opens a prim. `metadata` is written in parentheses after the name, if any.
  void open(std::string_view type, std::string_view name, std::string_view metadata = {}) {
    line(fmt::format("{} \"{}\"{}", type, name, metadata.empty() ? std::string() : fmt::format(" ({})", metadata)));
    line("{");
    ++depth;
  }
  void close() {
    --depth;
    line("}");
  }
};

/// Returns "[a, b, …]" with the output of `write` for each.
template <class Range, class Write>
std::string usd_array(const Range& values, const Write& write) {
  std::string text = "[";
  for (const auto& value : values) {
    if (text.size() > 1) text += ", ";
    write(text, value);
  }
  text += "]";
  return text;
}

std::string usd_numbers(std::span<const std::uint32_t> values) {
  return usd_array(values, [](std::string& out, std::uint32_t value) { out += fmt::format("{}", value); });
}
std::string usd_points(std::span<const Vec3<float>> points) {
  return usd_array(
      points, [](std::string& out, const auto& p) { out += fmt::format("({:.5f}, {:.5f}, {:.5f})", p.x, p.y, p.z); });
}
std::string usd_normals(std::span<const Vec3<float>> position, const std::vector<std::uint32_t>& triangle) {
  return usd_array(vertex_normals(columns_of(position), triangle).colwise(), [](std::string& out, const auto& n) {
    out += fmt::format("({:.3f}, {:.3f}, {:.3f})", n.x(), n.y(), n.z());
  });
}
std::string usd_extent(std::span<const Vec3<float>> points) {
  constexpr float far = std::numeric_limits<float>::max();
  std::array<Vec3<float>, 2> box = {Vec3<float>{far, far, far}, Vec3<float>{-far, -far, -far}};
  for (const auto& p : points) {
    box[0] = {std::min(box[0].x, p.x), std::min(box[0].y, p.y), std::min(box[0].z, p.z)};
    box[1] = {std::max(box[1].x, p.x), std::max(box[1].y, p.y), std::max(box[1].z, p.z)};
  }
  return usd_points(box);
}
/// `atlas` marks places to the right and down from the upper left corner; USD counts up from the lower left one.
std::string usd_texture(std::span<const TexturePlace> places, bool atlas = false) {
  return usd_array(places, [&](std::string& out, const TexturePlace& place) {
    out += fmt::format("({:.4f}, {:.4f})", place.along, atlas ? 1 - place.around : place.around);
  });
}
std::string usd_tissue(std::span<const Tissue> tissue) {
  return usd_array(tissue, [](std::string& out, const Tissue& t) {
    out += fmt::format("({:.3f}, {:.3f}, {:.3f}, {:.3f})", t.along / 255.0, t.around / 255.0, t.tendon / 255.0,
                       t.aponeurosis / 255.0);
  });
}
std::string usd_colour(const Vec3<float>& c) {
  return fmt::format("[({:.4f}, {:.4f}, {:.4f})]", c.x, c.y, c.z);
}

/// Returns "pelvis/L5/L4": joint names are paths.
std::string joint_tokens() {
  std::vector<std::string> path(segment_count);
  for (std::size_t s = 0; s < segment_count; ++s) {
    const std::size_t parent = index(segment_parent[s]);
    path[s] = (parent == s ? "" : path[parent] + "/") + std::string(segment_name[s]);
  }
  return usd_array(path, [](std::string& out, const std::string& name) { out += fmt::format("\"{}\"", name); });
}

std::string usd_matrix(const Eigen::Vector3d& scale, const Eigen::Vector3d& place) {
  return fmt::format("( ({:.6f}, 0, 0, 0), (0, {:.6f}, 0, 0), (0, 0, {:.6f}, 0), ({:.6f}, {:.6f}, {:.6f}, 1) )",
                     scale.x(), scale.y(), scale.z(), place.x(), place.y(), place.z());
}

/// Adds `value` of each frame, at its time code.
template <class Value>
void add_samples(UsdText& usd, std::string_view attribute, std::size_t frames, const Value& value) {
  usd.line(fmt::format("{}.timeSamples = {{", attribute));
  for (std::size_t f = 0; f < frames; ++f) usd.line(fmt::format("    {}: {},", f, value(f)));
  usd.line("}");
}

void add_skeleton(UsdText& usd, const StandingPlaces& own, const StandingPlaces& figure, const Vec3<float>& scale,
                  const std::string& body_path) {
  const Eigen::Vector3d smaller(1.0 / static_cast<double>(scale.x), 1.0 / static_cast<double>(scale.y),
                                1.0 / static_cast<double>(scale.z));
  std::array<std::string, segment_count> bind, rest;
  for (std::size_t s = 0; s < segment_count; ++s) {
    const std::size_t parent = index(segment_parent[s]);
    const Eigen::Vector3d from = parent == s ? Eigen::Vector3d::Zero() : own[parent];
    bind[s] = usd_matrix(smaller, figure[s]);
    rest[s] = usd_matrix(Eigen::Vector3d::Ones(), own[s] - from);
  }
  const auto write = [](std::string& out, const std::string& matrix) { out += matrix; };
  usd.open("def Skeleton", "Skeleton", "prepend apiSchemas = [\"SkelBindingAPI\"]");
  usd.line("uniform token[] joints = " + joint_tokens());
  usd.line("uniform matrix4d[] bindTransforms = " + usd_array(bind, write));
  usd.line("uniform matrix4d[] restTransforms = " + usd_array(rest, write));
  usd.line(fmt::format("rel skel:animationSource = <{}/Animation>", body_path));
  usd.close();
}

std::string shape_names(std::size_t targets) {
  std::vector<std::size_t> numbers(targets);
  std::iota(numbers.begin(), numbers.end(), std::size_t{1});
  return usd_array(numbers, [](std::string& out, std::size_t number) { out += fmt::format("\"shape_{}\"", number); });
}

void add_animation(UsdText& usd, const SkeletonKeys& keys, const MorphedSurface& skin) {
  usd.open("def SkelAnimation", "Animation");
  usd.line("uniform token[] joints = " + joint_tokens());
  std::size_t frames = keys.world.size();
  const auto key = [](const auto& all, std::size_t f) { return all[std::min(f, all.size() - 1)]; };
  add_samples(usd, "float3[] translations", frames, [&](std::size_t f) {
    return usd_array(keys.segment, [&](std::string& out, const SegmentKeys& segment) {
      const auto t = key(segment.translation_m, f);
      out += fmt::format("({:.6f}, {:.6f}, {:.6f})", t.x, t.y, t.z);
    });
  });
  add_samples(usd, "quatf[] rotations", frames, [&](std::size_t f) {
    return usd_array(keys.segment, [&](std::string& out, const SegmentKeys& segment) {
      const auto q = key(segment.rotation, f);
      out += fmt::format("({:.7f}, {:.7f}, {:.7f}, {:.7f})", q.w, q.x, q.y, q.z);
    });
  });
  if (!skin.target.empty()) {
    usd.line("uniform token[] blendShapes = " + shape_names(skin.target.size()));
    add_samples(usd, "float[] blendShapeWeights", frames, [&](std::size_t f) {
      return usd_array(skin.weight[f], [](std::string& out, float w) { out += fmt::format("{:.7g}", w); });
    });
  }
  usd.line("half3[] scales = " +
           usd_array(keys.segment, [](std::string& out, const SegmentKeys&) { out += "(1, 1, 1)"; }));
  usd.close();
}

/// Adds the constant part of a mesh.
void add_topology(UsdText& usd, std::span<const std::uint32_t> triangle) {
  const std::vector<std::uint32_t> threes(triangle.size() / 3, 3);
  usd.line("uniform token subdivisionScheme = \"none\"");
  usd.line("int[] faceVertexCounts = " + usd_numbers(threes));
  usd.line("int[] faceVertexIndices = " + usd_numbers(triangle));
}

/// Adds one cloth as a mesh, in the figure's standing place.
void add_cloth(UsdText& usd, const FigurePiece& piece) {
  add_topology(usd, piece.triangle);
  usd.line("point3f[] points = " + usd_points(piece.position));
  usd.line("normal3f[] normals = " + usd_points(piece.normal) + " (interpolation = \"vertex\")");
  usd.line("float3[] extent = " + usd_extent(piece.position));
  usd.line("texCoord2f[] primvars:st = " + usd_texture(piece.texture, piece.atlas) + " (interpolation = \"vertex\")");
  const std::size_t joints = piece.rigid ? 1 : 4;
  std::vector<std::uint32_t> joint;
  std::vector<float> weight;
  for (std::size_t v = 0; v < piece.position.size(); ++v) {
    for (std::size_t k = 0; k < joints; ++k) {
      joint.push_back(piece.joint[v][k]);
      weight.push_back(piece.weight[v][k]);
    }
  }
  const std::string each = fmt::format(" (elementSize = {}; interpolation = \"vertex\")", joints);
  usd.line("int[] primvars:skel:jointIndices = " + usd_numbers(joint) + each);
  usd.line("float[] primvars:skel:jointWeights = " +
           usd_array(weight, [](std::string& out, float w) { out += fmt::format("{:.9g}", w); }) + each);
  usd.line("matrix4d primvars:skel:geomBindTransform = " +
           usd_matrix(Eigen::Vector3d::Ones(), Eigen::Vector3d::Zero()));
}

void add_muscle_cache(UsdText& usd, const RecordedMuscle& muscle, const std::string& name, bool z_back) {
  const std::size_t frames = muscle.position_m.size();
  usd.open("def Mesh", name);
  add_topology(usd, muscle.triangle);
  add_samples(usd, "point3f[] points", frames, [&](std::size_t f) { return usd_points(muscle.position_m[f]); });
  // A list of samples has its metadata where the attribute is declared.
  usd.line("normal3f[] normals (interpolation = \"vertex\")");
  add_samples(usd, "normal3f[] normals", frames,
              [&](std::size_t f) { return usd_normals(muscle.position_m[f], muscle.triangle); });
  add_samples(usd, "float3[] extent", frames, [&](std::size_t f) { return usd_extent(muscle.position_m[f]); });
  usd.line("texCoord2f[] primvars:st = " + usd_texture(recorded_texture(muscle.position_m.front(), z_back)) +
           " (interpolation = \"vertex\")");
  if (muscle.tissue.empty()) {
    usd.line("color3f[] primvars:displayColor = " + usd_colour(muscle.colour));
  } else {
    usd.line("color3f[] primvars:displayColor = " + usd_points(tissue_colours(muscle)) +
             " (interpolation = \"vertex\")");
    usd.line("float4[] primvars:tissue = " + usd_tissue(muscle.tissue) + " (interpolation = \"vertex\")");
  }
  usd.close();
}

/// Adds the shapes of a cloth, whose vertices begin at column `first` of the skin.
void add_shapes(UsdText& usd, const MorphedSurface& skin, std::size_t first, std::size_t vertices,
                const std::string& path) {
  constexpr float negligible_m = 2e-5F;
  usd.line("uniform token[] skel:blendShapes = " + shape_names(skin.target.size()));
  std::string targets;
  for (std::size_t k = 0; k < skin.target.size(); ++k)
    targets += fmt::format("{}<{}/shape_{}>", k == 0 ? "" : ", ", path, k + 1);
  usd.line(fmt::format("rel skel:blendShapeTargets = [{}]", targets));
  for (std::size_t k = 0; k < skin.target.size(); ++k) {
    std::vector<std::uint32_t> moved;
    std::vector<Vec3<float>> offset, turn;
    for (std::size_t v = 0; v < vertices; ++v) {
      const auto column = static_cast<Eigen::Index>(first + v);
      const auto p = skin.target[k].position.col(column), n = skin.target[k].normal.col(column);
      if (p.norm() <= negligible_m) continue;
      moved.push_back(static_cast<std::uint32_t>(v));
      offset.push_back({p.x(), p.y(), p.z()});
      turn.push_back({n.x(), n.y(), n.z()});
    }
    usd.open("def BlendShape", fmt::format("shape_{}", k + 1));
    usd.line("uniform vector3f[] offsets = " + usd_points(offset));
    usd.line("uniform vector3f[] normalOffsets = " + usd_points(turn));
    usd.line("uniform int[] pointIndices = " + usd_numbers(moved));
    usd.close();
  }
}

/// Adds the motion of a person's root.
void add_way(UsdText& usd, std::span<const RecordedRoot> root) {
  constexpr double usd_degrees = 180 / std::numbers::pi;
  add_samples(usd, "double3 xformOp:translate", root.size(),
              [&](std::size_t f) { return fmt::format("({:.6f}, 0, {:.6f})", root[f].x_m, root[f].z_m); });
  add_samples(usd, "float xformOp:rotateY", root.size(), [&](std::size_t f) {
    return fmt::format("{:.6f}", usd_degrees * static_cast<double>(root[f].heading_rad));
  });
  usd.line("uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:rotateY\"]");
}

/// Returns a muscle relative to the root of each frame.
RecordedMuscle in_root(const RecordedMuscle& muscle, std::span<const RecordedRoot> root) {
  RecordedMuscle moved = muscle;
  for (std::size_t f = 0; f < root.size(); ++f) {
    const RigidTransform from = root_transform(root[f]);
    for (Vec3<float>& p : moved.position_m[f]) {
      const Eigen::Vector3d own = from.rotation.conjugate() * (widened(p) - from.position_m);
      p = {static_cast<float>(own.x()), static_cast<float>(own.y()), static_cast<float>(own.z())};
    }
  }
  return moved;
}

/// A file's people, and the standing places of their figures.
struct UsdScene {
  const RecordedPeople& recorded;
  UsdText usd{};
  std::vector<std::vector<const SeenPerson*>> wearers{};  // by figure
  std::vector<StandingPlaces> standing{};                 // of figures
  std::vector<std::vector<FigurePiece>> pieces{};         // of figures
  std::vector<MorphedSurface> skin{};                     // of figures with drawn places, else empty
  bool shared(std::size_t figure) const { return wearers[figure].size() > 1; }
};

std::string cloth_name(const SeenPerson& person, const SeenFigure& figure, std::size_t cloth) {
  const std::string name = person.colours.empty() ? "bones" : "figure";
  return figure.cloths() > 1 ? fmt::format("{}_{}", name, cloth + 1) : name;
}

void add_body(UsdScene& scene, const SeenPerson& person, const std::string& path) {
  UsdText& usd = scene.usd;
  const SeenFigure& figure = scene.recorded.figures[person.figure];
  const StandingPlaces rest = person_rest(scene.standing[person.figure], person.scale);
  const SkeletonKeys keys = skeleton_keys(*person.frames, rest, person.root);
  const std::string body = path + "/Body";
  usd.open("def SkelRoot", "Body");
  add_skeleton(usd, rest, scene.standing[person.figure], person.scale, body);
  const MorphedSurface& skin = scene.skin[person.figure];
  add_animation(usd, keys, skin);
  std::size_t first_shaped = 0;
  for (const FigurePiece& piece : scene.pieces[person.figure]) {
    const std::size_t cloth = piece.cloth;
    const bool shared = scene.shared(person.figure);
    std::string metadata = "prepend apiSchemas = [\"SkelBindingAPI\"]";
    if (shared) metadata += fmt::format("; prepend references = </figures/figure_{}/cloth_{}>", person.figure, cloth);
    usd.open("def Mesh", cloth_name(person, figure, cloth), metadata);
    if (!shared) add_cloth(usd, piece);
    usd.line("color3f[] primvars:displayColor = " + usd_colour(person.colour(cloth)));
    usd.line(fmt::format("rel skel:skeleton = <{}/Skeleton>", body));
    if (!piece.rigid && !skin.target.empty()) {
      const std::size_t vertices = piece.position.size();
      add_shapes(usd, skin, first_shaped, vertices, body + "/" + cloth_name(person, figure, cloth));
      first_shaped += vertices;
    }
    usd.close();
  }
  usd.close();
}

void add_usd_person(UsdScene& scene, const SeenPerson& person, const std::string& name) {
  UsdText& usd = scene.usd;
  usd.open("def Xform", name);
  if (!person.root.empty()) add_way(usd, person.root);
  add_body(scene, person, "/walk/" + name);
  if (!person.muscles.empty()) {
    UniqueNames names;
    usd.open("def Xform", "Muscles");
    for (const auto& muscle : person.muscles)
      add_muscle_cache(usd, in_root(muscle, person.root), names.take(identifier(muscle.name)), person.z_back);
    usd.close();
  }
  usd.close();
}

/// Adds surfaces that several people share, as a class, which is not drawn itself.
void add_shared_figures(UsdScene& scene) {
  UsdText& usd = scene.usd;
  usd.open("class Scope", "figures");
  for (std::size_t i = 0; i < scene.recorded.figures.size(); ++i) {
    if (!scene.shared(i)) continue;
    usd.open("def Scope", fmt::format("figure_{}", i));
    for (const FigurePiece& piece : scene.pieces[i]) {
      usd.open("def Mesh", fmt::format("cloth_{}", piece.cloth));
      add_cloth(usd, piece);
      usd.close();
    }
    usd.close();
  }
  usd.close();
}

Result<std::string> usda_text(const RecordedPeople& recorded) {
  UsdScene scene{recorded};
  scene.wearers.resize(recorded.figures.size());
  scene.standing.resize(recorded.figures.size());
  scene.pieces.resize(recorded.figures.size());
  scene.skin.resize(recorded.figures.size());
  for (const SeenPerson& person : recorded.people) {
    auto& wearers = scene.wearers[person.figure];
    if (wearers.empty()) {
      const SeenFigure& figure = recorded.figures[person.figure];
      scene.standing[person.figure] = figure_standing(figure, person);
      auto pieces = figure_pieces(figure, scene.standing[person.figure]);
      if (!pieces) return tl::unexpected(pieces.error());
      if (has_drawn_skin(*pieces)) {
        const StandingPlaces& standing = scene.standing[person.figure];
        const ExportOptions usual;
        const auto muscles = [&](std::size_t frame) {
          std::vector<Eigen::Vector3d> points;
          for (const RecordedMuscle& muscle : person.muscles)
            for (const Vec3<float>& p : muscle.position_m[frame]) points.push_back(widened(p));
          return points;
        };
        scene.skin[person.figure] = skin_shapes(*pieces, muscles, skeleton_keys(*person.frames, standing), standing,
                                                usual.morph_targets, static_cast<double>(usual.morph_tolerance_m))
                                        .surface;
        if (person.loops) scene.skin[person.figure].weight.back() = scene.skin[person.figure].weight.front();
      }
      scene.pieces[person.figure] = std::move(*pieces);
    }
    wearers.push_back(&person);
  }
  const double a_second = 1.0 / recorded.frame_s;
  scene.usd.text = fmt::format(
      "#usda 1.0\n(\n    defaultPrim = \"walk\"\n    upAxis = \"Y\"\n    metersPerUnit = 1\n    startTimeCode = 0\n"
      "    endTimeCode = {}\n    timeCodesPerSecond = {:.6g}\n    framesPerSecond = {:.6g}\n)\n\n",
      recorded.people.front().frames->size() - 1, a_second, a_second);
  const bool any_shared = std::ranges::any_of(scene.wearers, [](const auto& wearers) { return wearers.size() > 1; });
  if (any_shared) add_shared_figures(scene);
  UniqueNames names;
  scene.usd.open("def Xform", "walk");
  for (const SeenPerson& person : recorded.people) add_usd_person(scene, person, names.take(identifier(person.name)));
  scene.usd.close();
  return std::move(scene.usd.text);
}

Result<void> write_usda_people(const std::filesystem::path& path, const RecordedPeople& recorded) {
  if (auto ok = check_recording(recorded); !ok) return fail(fmt::format("{}: {}", path.string(), ok.error().message));
  const auto text = usda_text(recorded);
  if (!text) return fail(fmt::format("{}: {}", path.string(), text.error().message));
  return write_file(path, *text);
}

}  // namespace

Result<void> write_usda(const std::filesystem::path& path, const WalkRecording& recording) {
  return write_usda_people(path, recorded_people(recording));
}

Result<void> write_usda(const std::filesystem::path& path, const CrowdRecording& recording) {
  return write_usda_people(path, recorded_people(recording));
}

}  // namespace mobil::inline v0_3
