#include <mobil/gl_writer.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <mobil/assets/files/output_file.h>
#include <mobil/engine/geometry.h>
#include "assets/export/mesh_shading.h"
#include "assets/export/recording_check.h"

namespace mobil::inline v0_3 {
namespace {

static_assert(std::endian::native == std::endian::little, "the file holds little-endian numbers");

struct GlPart {
  const std::string* name;
  Vec3<float> colour;
  std::size_t vertices;
  const std::vector<std::uint32_t>* triangle;
};

template <class T>
void put_number(std::string& bytes, T value) {
  static_assert(sizeof(T) == 4);
  const auto raw = std::bit_cast<std::array<char, 4>>(value);
  bytes.append(raw.data(), raw.size());
}

void put_size(std::string& bytes, std::size_t value) {
  put_number(bytes, static_cast<std::uint32_t>(value));
}

/// Returns the mean of the vertices' colours, because a part has one.
Vec3<float> mean_colour(const RecordedMuscle& muscle) {
  const std::vector<Vec3<float>> colours = tissue_colours(muscle);
  if (colours.empty()) return muscle.colour;
  Vec3<float> sum{0, 0, 0};
  for (const Vec3<float>& c : colours) sum = {sum.x + c.x, sum.y + c.y, sum.z + c.z};
  const float share = 1 / static_cast<float>(colours.size());
  return {share * sum.x, share * sum.y, share * sum.z};
}

std::vector<GlPart> gl_parts(const WalkRecording& recording) {
  std::vector<GlPart> parts;
  for (const auto& bone : recording.bones) {
    parts.push_back({&bone.mesh.name, ivory_colour, bone.mesh.position.size(), &bone.mesh.triangle});
  }
  for (const auto& muscle : recording.muscles) {
    parts.push_back({&muscle.name, mean_colour(muscle), muscle.position_m.front().size(), &muscle.triangle});
  }
  return parts;
}

void put_vertices(std::string& bytes, const Eigen::Matrix3Xd& position, const std::vector<std::uint32_t>& triangle) {
  const Eigen::Matrix3Xd normal = vertex_normals(position, triangle);
  for (Eigen::Index v = 0; v < position.cols(); ++v) {
    for (Eigen::Index c = 0; c < 3; ++c) put_number(bytes, static_cast<float>(position(c, v)));
    for (Eigen::Index c = 0; c < 3; ++c) put_number(bytes, static_cast<float>(normal(c, v)));
  }
}

void put_frame(std::string& bytes, const WalkRecording& recording, std::size_t frame) {
  using namespace geometry;
  const Pose<float>& pose = recording.frames[frame];
  Eigen::Matrix3Xd position;
  const auto set = [&](std::size_t v, const Vec& p) { position.col(static_cast<Eigen::Index>(v)) << p.x, p.y, p.z; };
  for (const auto& bone : recording.bones) {
    const std::size_t s = index(bone.segment);
    const Quat<double> turn = to_double(pose.rotation[s]);
    position.resize(3, static_cast<Eigen::Index>(bone.mesh.position.size()));
    for (std::size_t v = 0; v < bone.mesh.position.size(); ++v) {
      set(v, to_double(pose.position_m[s]) + rotated(turn, to_double(bone.mesh.position[v])));
    }
    put_vertices(bytes, position, bone.mesh.triangle);
  }
  for (const auto& muscle : recording.muscles) {
    const auto& places = muscle.position_m[frame];
    position.resize(3, static_cast<Eigen::Index>(places.size()));
    for (std::size_t v = 0; v < places.size(); ++v) set(v, to_double(places[v]));
    put_vertices(bytes, position, muscle.triangle);
  }
}

/// Returns the bytes of the file.
Result<std::string> gl_bytes(const WalkRecording& recording) {
  constexpr std::size_t name_room = 64;
  const std::vector<GlPart> parts = gl_parts(recording);
  std::size_t vertices = 0, indices = 0;
  for (const GlPart& part : parts) {
    vertices += part.vertices;
    indices += part.triangle->size();
  }
  if (std::max(vertices, indices) > std::numeric_limits<std::uint32_t>::max()) {
    return fail("more vertices than 32 bits count; record coarser surfaces");
  }
  std::string bytes = "MOBILGL1";
  bytes.reserve(28 + 92 * parts.size() + 4 * indices + 24 * vertices * recording.frames.size());
  for (const std::size_t count : {recording.frames.size(), parts.size(), vertices, indices}) put_size(bytes, count);
  put_number(bytes, static_cast<float>(recording.frame_s));
  std::size_t first_vertex = 0, first_index = 0;
  for (const GlPart& part : parts) {
    std::string name = *part.name;
    if (std::size_t cut = name_room - 1; name.size() > cut) {
      while (cut > 0 && (static_cast<unsigned char>(name[cut]) & 0xC0U) == 0x80U) --cut;  // to a character's beginning
      name.resize(cut);
    }
    name.resize(name_room, '\0');
    bytes += name;
    for (const std::size_t count : {first_vertex, part.vertices, first_index, part.triangle->size()}) {
      put_size(bytes, count);
    }
    for (const float c : {part.colour.x, part.colour.y, part.colour.z}) put_number(bytes, c);
    first_vertex += part.vertices;
    first_index += part.triangle->size();
  }
  first_vertex = 0;
  for (const GlPart& part : parts) {
    for (const std::uint32_t corner : *part.triangle) put_size(bytes, first_vertex + corner);
    first_vertex += part.vertices;
  }
  for (std::size_t frame = 0; frame < recording.frames.size(); ++frame) put_frame(bytes, recording, frame);
  return bytes;
}

}  // namespace

Result<void> write_gl(const std::filesystem::path& path, const WalkRecording& recording) {
  if (auto ok = check_recording(recorded_people(recording)); !ok) {
    return fail(fmt::format("{}: {}", path.string(), ok.error().message));
  }
  const auto bytes = gl_bytes(recording);
  if (!bytes) return fail(fmt::format("{}: {}", path.string(), bytes.error().message));
  return write_file(path, *bytes);
}

}  // namespace mobil::inline v0_3
