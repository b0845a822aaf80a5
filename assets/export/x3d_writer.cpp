#include <mobil/x3d_writer.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <mobil/assets/files/output_file.h>
#include "assets/export/figure_pieces.h"
#include "assets/export/recording_check.h"
#include "assets/export/skeleton_keys.h"
#include "assets/export/unique_names.h"

namespace mobil::inline v0_3 {
namespace {

/// Joints' places have one digit more, because they add up along the chain.
void append_point(std::string& text, const Vec3<float>& p) {
  text += fmt::format("{:.5f} {:.5f} {:.5f} ", p.x, p.y, p.z);
}
void append_place(std::string& text, const Vec3<float>& p) {
  text += fmt::format("{:.6f} {:.6f} {:.6f} ", p.x, p.y, p.z);
}

/// Appends axis and angle.
void append_turn(std::string& text, const Quat<float>& q) {
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(static_cast<double>(q.w), static_cast<double>(q.x),
                                                  static_cast<double>(q.y), static_cast<double>(q.z)));
  const Eigen::Vector3d& axis = turn.axis();
  text += fmt::format("{:.6f} {:.6f} {:.6f} {:.6f} ", axis.x(), axis.y(), axis.z(), turn.angle());
}

std::string points_text(const std::vector<Vec3<float>>& position) {
  std::string text;
  for (const auto& p : position) append_point(text, p);
  return text;
}

/// A scene with its moving fields.
struct MovingScene {
  SceneText text;
  UniqueNames names{};
  std::size_t frames = 0;
  std::array<std::string, segment_count> segment{};  // names of their Transforms
  std::vector<std::array<std::string, 3>> moved{};   // interpolator, node, its field
  struct Interpolator {
    std::string type, name, values;
  };
  std::vector<Interpolator> interpolators{};

  /// Moves `field` of `node` through `values` (one a frame).
  void move(const std::string& node, const std::string& field, const char* type, std::string values) {
    const std::string name = names.take(node + "_" + field);
    interpolators.push_back({type, name, std::move(values)});
    moved.push_back({name, node, field});
  }
};

std::string shown_colour(const Vec3<float>& colour) {
  const auto shown = [](float linear) {  // these formats' colours are those of screens
    return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
  };
  return fmt::format("{:.4f} {:.4f} {:.4f}", shown(colour.x), shown(colour.y), shown(colour.z));
}

/// Importers name objects after the Shape. `name` is that of the coordinates, if they move. `colours` are the
/// vertices', or none.
void add_shape(MovingScene& scene, const std::string& shape, const Vec3<float>& colour,
               std::span<const Vec3<float>> colours, const std::vector<Vec3<float>>& position,
               const std::vector<std::uint32_t>& triangle, const std::string& name) {
  SceneText& text = scene.text;
  text.open("Shape", scene.names.take(identifier(shape + "_surface")));
  text.open("Appearance", {}, "appearance");
  text.open("Material", {}, "material");
  text.field("diffuseColor", shown_colour(colour));
  text.close();
  text.close();
  text.open("IndexedFaceSet", {}, "geometry");
  text.field("creaseAngle", "3.1416");
  std::string corners;
  for (std::size_t i = 0; i + 2 < triangle.size(); i += 3) {
    corners += fmt::format("{} {} {} -1 ", triangle[i], triangle[i + 1], triangle[i + 2]);
  }
  text.fields("coordIndex", corners);
  if (!colours.empty()) {
    std::string values;
    for (const Vec3<float>& c : colours) values += shown_colour(c) + " ";
    text.open("Color", {}, "color");
    text.fields("color", values);
    text.close();
  }
  text.open("Coordinate", name, "coord");
  text.fields("point", points_text(position));
  text.close();
  text.close();
  text.close();
}

void add_segment(MovingScene& scene, const WalkRecording& recording, const SkeletonKeys& skeleton, std::size_t s) {
  const SegmentKeys& keys = skeleton.segment[s];
  const std::string& name = scene.segment[s];
  scene.text.open("Transform", name);
  std::string place, turn;
  append_place(place, keys.translation_m.front());
  append_turn(turn, keys.rotation.front());
  scene.text.field("translation", place);
  scene.text.field("rotation", turn);
  if (keys.translation_m.size() > 1) {
    std::string values;
    for (const auto& t : keys.translation_m) append_place(values, t);
    scene.move(name, "translation", "PositionInterpolator", std::move(values));
  }
  if (keys.rotation.size() > 1) {
    std::string values;
    for (const auto& q : keys.rotation) append_turn(values, q);
    scene.move(name, "rotation", "OrientationInterpolator", std::move(values));
  }
  for (const auto& bone : recording.bones) {
    if (index(bone.segment) == s)
      add_shape(scene, bone.mesh.name, ivory_colour, {}, bone.mesh.position, bone.mesh.triangle, {});
  }
  for (std::size_t child = s + 1; child < segment_count; ++child) {
    if (index(segment_parent[child]) == s) add_segment(scene, recording, skeleton, child);
  }
  scene.text.close();
}

void add_movement(MovingScene& scene, double frame_s) {
  if (scene.interpolators.empty()) return;
  SceneText& text = scene.text;
  const std::size_t last = scene.frames - 1;
  std::string keys;
  for (std::size_t f = 0; f <= last; ++f) {
    keys += fmt::format("{:.8f} ", static_cast<double>(f) / static_cast<double>(last));
  }
  const std::string clock = scene.names.take("clock");
  text.open("TimeSensor", clock);
  text.field("cycleInterval", fmt::format("{:.6f}", static_cast<double>(last) * frame_s));
  text.field("loop", "TRUE");
  text.close();
  for (const auto& [type, name, values] : scene.interpolators) {
    text.open(type, name);
    text.fields("key", keys);
    text.fields("keyValue", values);
    text.close();
    text.route(clock, "fraction_changed", name, "set_fraction");
  }
  for (const auto& [name, node, field] : scene.moved) text.route(name, "value_changed", node, "set_" + field);
}

std::string x3d_text(const WalkRecording& recording, SceneNotation notation) {
  const RecordedPeople people = recorded_people(recording);
  const SkeletonKeys skeleton = skeleton_keys(recording.frames, figure_standing(people.figures[0], people.people[0]));
  MovingScene scene{.text = SceneText(notation, "walk")};
  scene.frames = recording.frames.size();
  scene.text.open("Transform", scene.names.take(identifier(recording.name)));
  for (std::size_t s = 0; s < segment_count; ++s) scene.segment[s] = scene.names.take(std::string(segment_name[s]));
  std::vector<std::string> muscle_names;  // of Transforms, before any Shape takes them
  for (const auto& muscle : recording.muscles) muscle_names.push_back(scene.names.take(identifier(muscle.name)));
  add_segment(scene, recording, skeleton, 0);
  for (std::size_t m = 0; m < recording.muscles.size(); ++m) {
    const RecordedMuscle& muscle = recording.muscles[m];
    const std::string& name = muscle_names[m];
    scene.text.open("Transform", name);
    const std::string coordinates = scene.names.take(name + "_coordinates");
    add_shape(scene, muscle.name, muscle.colour, tissue_colours(muscle), muscle.position_m.front(), muscle.triangle,
              coordinates);
    scene.text.close();
    if (scene.frames == 1) continue;
    std::string values;
    for (const auto& position : muscle.position_m) values += points_text(position);
    scene.move(coordinates, "point", "CoordinateInterpolator", std::move(values));
  }
  scene.text.close();
  add_movement(scene, recording.frame_s);
  return std::move(scene.text).text();
}

}  // namespace

Result<void> write_x3d(const std::filesystem::path& path, const WalkRecording& recording, SceneNotation notation) {
  if (auto ok = check_recording(recorded_people(recording)); !ok) {
    return fail(fmt::format("{}: {}", path.string(), ok.error().message));
  }
  return write_file(path, x3d_text(recording, notation));
}

}  // namespace mobil::inline v0_3
