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

#include <mobil/assets/files/csv_table.h>
#include <mobil/muscle_table.h>
#include "assets/import/folder_file.h"
#include "assets/import/mesh_text.h"

namespace mobil::inline v0_3 {
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

/// Returns the segment of a bone or of several joined by '+', by the first one's name in any case.
std::optional<Segment> segment_of(std::string_view bone) {
  for (const auto& [name, segment] : bone_segment) {
    if (begins_with(bone, name)) return segment;
  }
  return std::nullopt;
}

std::string known_bones() {
  std::string names;
  for (const auto& [name, segment] : bone_segment) names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
  return names;
}

/// Returns the letters of a name in lower case; all else is spaces. Peroneal muscles have their older name.
std::string plain_words(std::string_view name) {
  std::string words = " ";
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    words += std::isalpha(u) != 0 ? static_cast<char>(std::tolower(u)) : ' ';
  }
  words += ' ';
  constexpr std::string_view newer = " fibularis ", older = " peroneus ";
  if (const auto at = words.find(newer); at != std::string::npos) words.replace(at, newer.size(), older);
  return words;
}

/// Returns the single muscle of the table whose name's words are all among these. Psoas minor is not in the table.
std::optional<Muscle> muscle_called(std::string_view name) {
  const std::string words = plain_words(name);
  const auto has = [&](std::string_view word) { return words.find(fmt::format(" {} ", word)) != std::string::npos; };
  for (const MemberMuscle& line : member_muscles()) {
    const Muscle muscle = muscle_of_line(line);
    std::istringstream wanted(plain_words(muscle_name(muscle)));
    std::string word;
    bool all = muscle != Muscle::psoas || !has("minor");
    while (wanted >> word) all = all && has(word);
    if (all) return muscle;
  }
  return std::nullopt;
}

/// Finds group and muscle by the manifest's group and by the names. The manifest's group, which can be a single muscle,
/// takes precedence.
void find_muscle_of(AnatomyPart& part, std::string_view group, std::string_view name, std::string_view file) {
  if (part.kind == AnatomyKind::tendon) {
    part.group = Muscle::triceps_surae;
    return;
  }
  const auto named = find_muscle(group);
  if (!named && !group.empty()) return;
  auto muscle = named && !is_muscle_group(*named) ? named : muscle_called(name);
  if (!muscle) muscle = muscle_called(file);
  part.group = named;
  if (!muscle) return;
  const Muscle own = members_of(*muscle).front().group;
  if (named && named != own && named != muscle) return;
  part.group = own;
  part.muscle = muscle;
}

/// Returns the default ends, of a muscle those of its lines that are farthest apart along the leg.
std::pair<Segment, Segment> usual_ends(const AnatomyPart& part) {
  using enum Segment;
  if (part.kind == AnatomyKind::tendon) return {shank_right, foot_right};
  if (part.kind == AnatomyKind::skin || !part.group) return {pelvis, foot_right};
  const auto lines = members_of(part.muscle.value_or(*part.group));
  return {std::ranges::min(lines, {}, &MemberMuscle::origin).origin,
          std::ranges::max(lines, {}, &MemberMuscle::insertion).insertion};
}

std::optional<AnatomyKind> kind_of(std::string_view name) {
  if (name == "bone") return AnatomyKind::bone;
  if (name == "muscle") return AnatomyKind::muscle;
  if (name == "tendon") return AnatomyKind::tendon;
  if (name == "skin") return AnatomyKind::skin;
  return std::nullopt;
}

/// Returns what a spreadsheet means by a word in any case; an empty cell is a no.
std::optional<bool> yes_or_no(std::string_view cell) {
  constexpr std::array<std::string_view, 8> yes = {"yes", "y", "true", "1", "wahr", "ja", "vrai", "oui"};
  constexpr std::array<std::string_view, 9> no = {"no", "n", "false", "0", "falsch", "nein", "faux", "non", ""};
  const auto is_cell = [&](std::string_view word) { return same_word(cell, word); };
  if (std::ranges::any_of(yes, is_cell)) return true;
  return std::ranges::any_of(no, is_cell) ? std::optional(false) : std::nullopt;
}

bool wanted(const AnatomyPart& part, const AnatomyOptions& options) {
  if (part.kind == AnatomyKind::bone || part.group) return true;
  if (part.kind == AnatomyKind::skin) return options.skin;
  return options.other_muscles;
}

/// Returns a point of three columns PREFIX_x, _y, _z; nothing if the columns or all three cells are empty.
Result<std::optional<Vec3<float>>> point(const CsvTable& table, std::size_t row, const std::string& prefix,
                                         const MeshFrame& frame) {
  std::array<std::string, 3> text;
  for (std::size_t i = 0; i < 3; ++i) text[i] = number_cell(table, row, prefix + "_" + "xyz"[i]);
  if (text[0].empty() && text[1].empty() && text[2].empty()) return std::optional<Vec3<float>>();
  const auto x = number(text[0]), y = number(text[1]), z = number(text[2]);
  if (!x || !y || !z) {
    return fail(fmt::format("{} line {}: {}_x, _y, _z are '{}', '{}', '{}'; write three numbers or leave all empty",
                            table.path, table.line[row], prefix, text[0], text[1], text[2]));
  }
  return std::optional(to_mobil(*x, *y, *z, frame));
}

Result<void> read_attachments(const CsvTable& table, std::size_t row, const MeshFrame& frame, AnatomyPart& part) {
  std::tie(part.origin, part.insertion) = usual_ends(part);
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
    auto place = point(table, row, prefix, frame);
    if (!place) return fail(place.error().message);
    (origin ? part.origin_m : part.insertion_m) = *place;
  }
  return {};
}

using LandmarkPoint = std::array<double, 3>;

/// Returns nothing if the table has no such row.
Result<std::optional<LandmarkPoint>> landmark(const CsvTable& table, std::string_view name, std::string_view side) {
  for (std::size_t row = 0; row < table.row.size(); ++row) {
    if (cell(table, row, "name") != name || cell(table, row, "side") != side) continue;
    const auto x = number(number_cell(table, row, "x")), y = number(number_cell(table, row, "y")),
               z = number(number_cell(table, row, "z"));
    if (!x || !y || !z) {
      return fail(fmt::format("{} line {}: {} is not three finite numbers; write x, y and z with decimal points",
                              table.path, table.line[row], name));
    }
    return std::optional(LandmarkPoint{*x, *y, *z});
  }
  return std::optional<LandmarkPoint>();
}

/// Returns unit and up of all rows, which must be those of the first.
Result<std::pair<std::string_view, std::string_view>> frame_cells(const CsvTable& table) {
  const auto unit = cell(table, 0, "unit"), up = cell(table, 0, "up");
  for (std::size_t row = 1; row < table.row.size(); ++row) {
    if (cell(table, row, "unit") == unit && cell(table, row, "up") == up) continue;
    return fail(
        fmt::format("{} line {}: unit and up are '{}' and '{}', in the first row '{}' and '{}'; write the same "
                    "in every row",
                    table.path, table.line[row], cell(table, row, "unit"), cell(table, row, "up"), unit, up));
  }
  return std::pair(unit, up);
}

bool stands(const std::array<LandmarkPoint, 3>& joint, std::size_t up, double length) {
  return joint[0][up] > joint[1][up] && joint[1][up] > joint[2][up] && joint[0][up] - joint[2][up] > 0.8 * length;
}

/// Returns the frame by the columns or, where they are empty, by the distance from hip to ankle.
Result<MeshFrame> landmark_frame(const CsvTable& table, const std::array<LandmarkPoint, 3>& joint, double x_left) {
  const auto cells = frame_cells(table);
  if (!cells) return tl::unexpected(cells.error());
  const auto [unit, up] = *cells;
  auto frame = read_frame(unit, up, {}, fmt::format("{} line {}", table.path, table.line[0]));
  if (!frame) return frame;
  const double length = std::hypot(joint[0][0] - joint[2][0], joint[0][1] - joint[2][1], joint[0][2] - joint[2][2]);
  const auto is_leg = [&](double metres_per_unit) {
    return length * metres_per_unit >= 0.4 && length * metres_per_unit <= 1.3;
  };
  for (const double metres : {1.0, 0.01, 0.001}) {
    if (unit.empty() && is_leg(metres)) frame->metres_per_unit = metres;
  }
  if (!is_leg(frame->metres_per_unit)) {
    return fail(
        unit.empty()
            ? fmt::format("{}: hip to ankle is {:.4g}; expected 0.4 to 1.3 (metres), 40 to 130 (centimetres) or 400 to "
                          "1300 (millimetres): write the folder in one of them, or name its unit in a column 'unit'",
                          table.path, length)
            : fmt::format("{}: hip to ankle is {:.4g} {}; expected 0.4 to 1.3 m: mend the column 'unit'", table.path,
                          length, unit));
  }
  const bool upright_z = stands(joint, 2, length), upright_y = stands(joint, 1, length);
  if (up.empty()) frame->y_up = upright_y;
  if (!(frame->y_up ? upright_y : upright_z) || x_left <= joint[0][0]) {
    return fail(
        fmt::format("{}: hip, knee and ankle do not lie one below the other along z or y with the right leg at smaller "
                    "x; expected a standing leg, axes +x left, +y back, +z up, or +x left, +y up, +z forward: turn the "
                    "folder's frame",
                    table.path));
  }
  return frame;
}

/// Returns a row of the manifest; nothing if it is not wanted.
Result<std::optional<ManifestRow>> read_row(const CsvTable& table, std::size_t row, const std::string& folder,
                                            const MeshFrame& usual, const AnatomyOptions& options) {
  const std::optional<ManifestRow> passed_over;
  ManifestRow read;
  read.where = fmt::format("{} line {}", table.path, table.line[row]);
  const auto file = cell(table, row, "file"), side = cell(table, row, "side");
  if (file.empty()) return fail(fmt::format("{}: the cell 'file' is empty; name a mesh in the folder", read.where));
  if (side != "left" && side != "right" && side != "mid") {
    return fail(fmt::format("{}: side '{}' is not known; valid: right, left, mid", read.where, side));
  }
  const auto kind = kind_of(cell(table, row, "kind"));
  if (!kind) {
    return fail(fmt::format("{}: kind '{}' is not known; valid: bone, muscle, tendon, skin", read.where,
                            cell(table, row, "kind")));
  }
  if (side == "left") return passed_over;
  const auto group = cell(table, row, "group");
  read.part.kind = *kind;
  const auto path = file_below(folder, file);
  const std::string stem = path.value_or(std::filesystem::path(file)).stem().string();
  if (*kind == AnatomyKind::muscle || *kind == AnatomyKind::tendon) {
    find_muscle_of(read.part, group, cell(table, row, "name"), stem);
  }
  if (!wanted(read.part, options)) return passed_over;
  if (!path) return fail(fmt::format("{}: {}", read.where, path.error().message));
  const auto frame = read_frame(cell(table, row, "unit"), cell(table, row, "up"), usual, read.where);
  if (!frame) return tl::unexpected(frame.error());
  read.frame = *frame;
  read.part.midline = side == "mid";
  read.part.mesh.name = stem;
  read.name = file;
  read.file = path->string();
  if (*kind == AnatomyKind::bone) {
    const auto segment = segment_of(read.part.mesh.name);
    if (!segment) {
      return fail(fmt::format("{}: '{}' is not a bone of the leg; valid beginnings of the file's name: {}", read.where,
                              file, known_bones()));
    }
    read.part.origin = read.part.insertion = *segment;
  } else if (auto done = read_attachments(table, row, *frame, read.part); !done) {
    return tl::unexpected(done.error());
  }
  const auto triangles = number_cell(table, row, "triangles");
  if (!triangles.empty()) {
    const auto count = number(triangles);
    if (!count || *count < 1 || *count > 1e9 || *count != std::floor(*count)) {
      return fail(fmt::format("{}: triangles '{}' is not a count; write a whole number from 1, or leave it empty",
                              read.where, triangles));
    }
    read.triangles = static_cast<std::size_t>(*count);
  }
  const auto watertight = cell(table, row, "watertight");
  const auto closed = yes_or_no(watertight);
  if (!closed) {
    return fail(fmt::format("{}: watertight '{}' is not known; valid: yes, no, true, false, 1, 0, or empty", read.where,
                            watertight));
  }
  read.watertight = *closed;
  return std::optional(std::move(read));
}

}  // namespace

Result<LandmarkTable> read_landmarks(const std::string& folder) {
  const auto table = read_csv(folder + "/landmarks.csv", landmark_columns);
  if (!table) return tl::unexpected(table.error());
  std::array<LandmarkPoint, 3> joint{};
  constexpr std::array<std::string_view, 3> names = {"hip_joint_centre", "knee_joint_centre", "ankle_joint_centre"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto found = landmark(*table, names[i], "right");
    if (!found) return tl::unexpected(found.error());
    if (!*found)
      return fail(fmt::format("{}: no row '{},right'; add the joint centre's x, y, z", table->path, names[i]));
    joint[i] = **found;
  }
  const auto hip_left = landmark(*table, names[0], "left");
  if (!hip_left) return tl::unexpected(hip_left.error());
  const double x_left = *hip_left ? (**hip_left)[0] : -joint[0][0];
  const auto frame = landmark_frame(*table, joint, x_left);
  if (!frame) return tl::unexpected(frame.error());
  LandmarkTable read;
  read.frame = *frame;
  const bool told = !cell(*table, 0, "unit").empty() && !cell(*table, 0, "up").empty();
  const bool usual = !frame->y_up && (frame->metres_per_unit == 1 || frame->metres_per_unit == 0.001);
  if (!told && !usual) {
    read.said.push_back(fmt::format("{}: taken as {}, by hip to ankle; columns 'unit' and 'up' would say it",
                                    table->path, frame_name(*frame)));
  }
  const auto metres = [&](const LandmarkPoint& p) { return to_mobil(p[0], p[1], p[2], *frame); };
  read.landmarks = {metres(joint[0]), metres(joint[1]), metres(joint[2]),
                    static_cast<float>((x_left + joint[0][0]) / 2 * frame->metres_per_unit)};
  return read;
}

Result<Manifest> read_manifest(const std::string& folder, const MeshFrame& frame, const AnatomyOptions& options) {
  const auto table = read_csv(folder + "/manifest.csv", manifest_columns);
  if (!table) return tl::unexpected(table.error());
  Manifest manifest;
  for (std::size_t row = 0; row < table->row.size(); ++row) {
    auto read = read_row(*table, row, folder, frame, options);
    if (!read) {
      manifest.faults.push_back(std::move(read.error().message));
    } else if (*read) {
      manifest.row.push_back(std::move(**read));
    }
  }
  if (manifest.row.empty() && manifest.faults.empty()) {
    return fail(
        fmt::format("{}: no row of kind bone, muscle or tendon on the right side; add at least one", table->path));
  }
  return manifest;
}

}  // namespace mobil::inline v0_3
