#include "assets/import/anatomy_manifest.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "assets/files/csv_table.h"
#include "assets/muscles/muscle_table.h"

namespace mobil {
namespace {

constexpr std::array<std::string_view, 5> landmark_columns = {"name", "side", "x", "y", "z"};
constexpr std::array<std::string_view, 5> manifest_columns = {"file", "name", "side", "kind", "group"};

constexpr std::array<std::pair<std::string_view, Segment>, 16> bone_segment = {{
    {"hip_bone", Segment::pelvis},
    {"sacrum", Segment::pelvis},
    {"femur", Segment::thigh_right},
    {"patella", Segment::patella_right},
    {"tibia", Segment::shank_right},
    {"fibula", Segment::shank_right},
    {"talus", Segment::foot_right},
    {"calcaneus", Segment::foot_right},
    {"navicular", Segment::foot_right},
    {"cuboid", Segment::foot_right},
    {"medial_cuneiform", Segment::foot_right},
    {"intermediate_cuneiform", Segment::foot_right},
    {"lateral_cuneiform", Segment::foot_right},
    {"metatarsal", Segment::foot_right},
    {"phalanx", Segment::toes_right},
    {"sesamoid", Segment::toes_right},
}};

/// Of a bone or of several joined by '+', by the first one's name.
std::optional<Segment> segment_of(std::string_view bone) {
  for (const auto& [name, segment] : bone_segment) {
    if (bone.starts_with(name)) return segment;
  }
  return std::nullopt;
}

std::string known_bones() {
  std::string names;
  for (const auto& [name, segment] : bone_segment) names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
  return names;
}

std::optional<Muscle> group_of(std::string_view name) {
  const auto found = find_muscle(name);
  return found && muscle_groups()[static_cast<std::size_t>(*found)] ? found : std::nullopt;
}

/// Letters of a name, small; all else spaces.
std::string plain_words(std::string_view name) {
  std::string words = " ";
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    words += std::isalpha(u) != 0 ? static_cast<char>(std::tolower(u)) : ' ';
  }
  return words + " ";
}

/// The member of the table all of whose name's words are among these.
const MemberMuscle* member_called(std::string_view name) {
  const std::string words = plain_words(name);
  for (const MemberMuscle& m : member_muscles()) {
    std::istringstream wanted(plain_words(m.name));
    std::string word;
    bool all = true;
    while (wanted >> word) all = all && words.find(" " + word + " ") != std::string::npos;
    if (all) return &m;
  }
  return nullptr;
}

/// Group and muscle by the manifest's group and by the names; the group that is written there is the one that counts.
void find_muscle_of(AnatomyPart& part, std::string_view group, std::string_view name, std::string_view file) {
  if (part.kind == AnatomyKind::tendon) {
    part.group = Muscle::triceps_surae;
    return;
  }
  part.group = group_of(group);
  if (!part.group && !group.empty()) return;
  const MemberMuscle* member = member_called(name);
  if (member == nullptr) member = member_called(file);
  if (member == nullptr || (part.group && member->group != *part.group)) return;
  part.group = member->group;
  part.muscle = find_muscle(member->name);
}

/// Where a muscle of this group begins and ends when the manifest does not say.
std::pair<Segment, Segment> usual_ends(AnatomyKind kind, std::optional<Muscle> group) {
  using enum Segment;
  if (kind == AnatomyKind::tendon) return {shank_right, foot_right};
  if (kind == AnatomyKind::skin || !group) return {pelvis, foot_right};
  switch (*group) {
    case Muscle::quadriceps:
      return {pelvis, patella_right};
    case Muscle::triceps_surae:
      return {thigh_right, foot_right};
    case Muscle::tibialis_anterior:
      return {shank_right, foot_right};
    default:
      return {pelvis, shank_right};
  }
}

std::optional<AnatomyKind> kind_of(std::string_view name) {
  if (name == "bone") return AnatomyKind::bone;
  if (name == "muscle") return AnatomyKind::muscle;
  if (name == "tendon") return AnatomyKind::tendon;
  if (name == "skin") return AnatomyKind::skin;
  return std::nullopt;
}

bool wanted(const AnatomyPart& part, const AnatomyOptions& options) {
  if (part.kind == AnatomyKind::bone || part.group) return true;
  if (part.kind == AnatomyKind::skin) return options.skin;
  return options.other_muscles;
}

/// A point of three columns PREFIX_x, _y, _z; nothing where the columns or all three cells are empty.
Result<std::optional<Vec3<float>>> point(const CsvTable& table, std::size_t row, const std::string& prefix,
                                         double metres_per_unit) {
  const std::array<std::string_view, 3> text = {cell(table, row, prefix + "_x"), cell(table, row, prefix + "_y"),
                                                cell(table, row, prefix + "_z")};
  if (text[0].empty() && text[1].empty() && text[2].empty()) return std::optional<Vec3<float>>();
  const auto x = number(text[0]), y = number(text[1]), z = number(text[2]);
  if (!x || !y || !z) {
    return fail(fmt::format("{} line {}: {}_x, _y, _z are '{}', '{}', '{}'; write three numbers or leave all empty",
                            table.path, table.line[row], prefix, text[0], text[1], text[2]));
  }
  return std::optional(to_mobil(*x, *y, *z, metres_per_unit));
}

Result<void> read_attachments(const CsvTable& table, std::size_t row, double metres_per_unit, AnatomyPart& part) {
  std::tie(part.origin, part.insertion) = usual_ends(part.kind, part.group);
  for (const bool origin : {true, false}) {
    const std::string prefix = origin ? "origin" : "insertion";
    const auto bone = cell(table, row, prefix + "_bone");
    if (!bone.empty()) {
      const auto segment = segment_of(bone);
      if (!segment) {
        return fail(fmt::format("{} line {}: {}_bone '{}' is not known; valid: {}", table.path, table.line[row], prefix,
                                bone, known_bones()));
      }
      (origin ? part.origin : part.insertion) = *segment;
    }
    auto place = point(table, row, prefix, metres_per_unit);
    if (!place) return fail(place.error().message);
    (origin ? part.origin_m : part.insertion_m) = *place;
  }
  return {};
}

}  // namespace

Result<LandmarkTable> read_landmarks(const std::string& folder) {
  const auto table = read_csv(folder + "/landmarks.csv", landmark_columns);
  if (!table) return fail(table.error().message);
  using Point = std::array<double, 3>;
  const auto find = [&](std::string_view name, std::string_view side) -> Result<std::optional<Point>> {
    for (std::size_t row = 0; row < table->row.size(); ++row) {
      if (cell(*table, row, "name") != name || cell(*table, row, "side") != side) continue;
      const auto x = number(cell(*table, row, "x")), y = number(cell(*table, row, "y")),
                 z = number(cell(*table, row, "z"));
      if (!x || !y || !z) {
        return fail(fmt::format("{} line {}: {} is not three finite numbers; write x, y and z", table->path,
                                table->line[row], name));
      }
      return std::optional(Point{*x, *y, *z});
    }
    return std::optional<Point>();
  };
  std::array<Point, 3> joint{};
  constexpr std::array<std::string_view, 3> names = {"hip_joint_centre", "knee_joint_centre", "ankle_joint_centre"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto found = find(names[i], "right");
    if (!found) return fail(found.error().message);
    if (!*found)
      return fail(fmt::format("{}: no row '{},right'; add the joint centre's x, y, z", table->path, names[i]));
    joint[i] = **found;
  }
  const auto hip_left = find(names[0], "left");
  if (!hip_left) return fail(hip_left.error().message);

  const double length = std::hypot(joint[0][0] - joint[2][0], joint[0][1] - joint[2][1], joint[0][2] - joint[2][2]);
  LandmarkTable read;
  if (length >= 0.4 && length <= 1.3) {
    read.metres_per_unit = 1;
  } else if (length < 400 || length > 1300) {
    return fail(
        fmt::format("{}: hip to ankle is {:.4g}; expected 0.4 to 1.3 (metres) or 400 to 1300 (millimetres): "
                    "write the folder in one of the two",
                    table->path, length));
  }
  const double x_left = *hip_left ? (**hip_left)[0] : -joint[0][0];
  const bool upright =
      joint[0][2] > joint[1][2] && joint[1][2] > joint[2][2] && joint[0][2] - joint[2][2] > 0.8 * length;
  if (!upright || x_left <= joint[0][0]) {
    return fail(
        fmt::format("{}: hip, knee and ankle do not lie one below the other along z with the right leg at "
                    "smaller x; expected a standing leg, axes +x left, +y back, +z up: turn the folder's frame",
                    table->path));
  }
  const auto metres = [&](const Point& p) { return to_mobil(p[0], p[1], p[2], read.metres_per_unit); };
  read.landmarks = {metres(joint[0]), metres(joint[1]), metres(joint[2]),
                    static_cast<float>((x_left + joint[0][0]) / 2 * read.metres_per_unit)};
  return read;
}

Result<std::vector<ManifestRow>> read_manifest(const std::string& folder, double metres_per_unit,
                                               const AnatomyOptions& options) {
  const auto table = read_csv(folder + "/manifest.csv", manifest_columns);
  if (!table) return fail(table.error().message);
  std::vector<ManifestRow> rows;
  for (std::size_t row = 0; row < table->row.size(); ++row) {
    ManifestRow read;
    read.where = fmt::format("{} line {}", table->path, table->line[row]);
    const auto file = cell(*table, row, "file"), side = cell(*table, row, "side");
    if (file.empty()) return fail(fmt::format("{}: the cell 'file' is empty; name a mesh in the folder", read.where));
    if (side != "left" && side != "right" && side != "mid") {
      return fail(fmt::format("{}: side '{}' is not known; valid: right, left, mid", read.where, side));
    }
    const auto kind = kind_of(cell(*table, row, "kind"));
    if (!kind) {
      return fail(fmt::format("{}: kind '{}' is not known; valid: bone, muscle, tendon, skin", read.where,
                              cell(*table, row, "kind")));
    }
    if (side == "left") continue;
    const auto group = cell(*table, row, "group");
    read.part.kind = *kind;
    if (*kind == AnatomyKind::muscle || *kind == AnatomyKind::tendon) {
      find_muscle_of(read.part, group, cell(*table, row, "name"), std::filesystem::path(file).stem().string());
    }
    if (!wanted(read.part, options)) continue;
    read.part.midline = side == "mid";
    read.part.mesh.name = std::filesystem::path(file).stem().string();
    read.file = folder + "/" + std::string(file);
    if (*kind == AnatomyKind::bone) {
      const auto segment = segment_of(read.part.mesh.name);
      if (!segment) {
        return fail(fmt::format("{}: '{}' is not a bone of the leg; valid beginnings of the file's name: {}",
                                read.where, file, known_bones()));
      }
      read.part.origin = read.part.insertion = *segment;
    } else if (auto done = read_attachments(*table, row, metres_per_unit, read.part); !done) {
      return fail(done.error().message);
    }
    const auto triangles = cell(*table, row, "triangles");
    if (!triangles.empty()) {
      const auto count = number(triangles);
      if (!count || *count < 1 || *count > 1e9) {
        return fail(fmt::format("{}: triangles '{}' is not a count; write a number from 1, or leave it empty",
                                read.where, triangles));
      }
      read.triangles = static_cast<std::size_t>(*count);
    }
    read.watertight = cell(*table, row, "watertight") == "yes";
    rows.push_back(std::move(read));
  }
  if (rows.empty()) {
    return fail(
        fmt::format("{}: no row of kind bone, muscle or tendon on the right side; add at least one", table->path));
  }
  return rows;
}

}  // namespace mobil
