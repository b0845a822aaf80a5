#include "demo/walk/walk_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "demo/program/units.h"

namespace mobil {
namespace {

constexpr float stair_count = 40;
constexpr float half_width_m = 1.5F, behind_m = 3;

struct GroundRow {
  GroundKind kind;
  std::string_view name;
  Quantity quantity;
  double low, high;
};
constexpr std::array rows = {GroundRow{GroundKind::slope, "slope", Quantity::ratio, -0.3, 0.3},
                             GroundRow{GroundKind::cross, "cross", Quantity::ratio, -0.2, 0.2},
                             GroundRow{GroundKind::hills, "hills", Quantity::length, 0, 0.3},
                             GroundRow{GroundKind::kerb, "kerb", Quantity::length, -0.2, 0.2},
                             GroundRow{GroundKind::stairs, "stairs", Quantity::length, -0.22, 0.22}};

Result<double> read_rise(const GroundRow& row, std::string text) {
  double unit = 1;
  if (row.quantity == Quantity::ratio && text.ends_with('%')) text.pop_back(), unit = 0.01;
  auto value = read_value("--ground " + std::string(row.name), text, row.quantity, row.low / unit, row.high / unit);
  if (value) *value *= unit;
  return value;
}

bool has_edges(GroundKind kind) {
  return kind == GroundKind::kerb || kind == GroundKind::stairs;
}

}  // namespace

const char* const walk_ground_help =
    "Ground: slope:10% and cross:10% rise forward and to the left; hills:20cm; kerb:15cm and\n"
    "    stairs:16cm/30cm (rise and tread) start after two steps. Negative values descend. On stairs the\n"
    "    default step length is the tread.";

Result<WalkGround> read_walk_ground(const std::string& text) {
  WalkGround ground;
  if (text == "level") return ground;
  const std::size_t colon = text.find(':');
  const auto row = std::ranges::find(rows, std::string_view(text).substr(0, colon), &GroundRow::name);
  if (row == rows.end() || colon == std::string::npos)
    return fail("--ground: choose one of level, slope:10%, cross:10%, hills:20cm, kerb:15cm or stairs:16cm/30cm");
  ground.kind = row->kind;
  std::string value = text.substr(colon + 1);
  if (row->kind == GroundKind::stairs) {
    const auto parts = split(value, '/');
    if (parts.size() != 2) return fail("--ground stairs: give rise and tread, as stairs:16cm/30cm");
    const auto tread = read_value("--ground stairs, tread", parts[1], Quantity::length, 0.22, 0.6);
    if (!tread) return tl::unexpected(tread.error());
    ground.tread_m = static_cast<float>(*tread);
    value = parts[0];
  }
  const auto rise = read_rise(*row, value);
  if (!rise) return tl::unexpected(rise.error());
  ground.rise = static_cast<float>(*rise);
  return ground;
}

void set_edges(WalkGround& ground, float height_m, float step_length_m) {
  constexpr float behind_ankle_h[2] = {0.03F, 0.06F};  // of the edge, in body heights: up, down
  constexpr float first_step = 2;
  ground.edge_m = first_step * step_length_m - behind_ankle_h[ground.rise < 0 ? 1 : 0] * height_m;
}

TerrainHeight WalkGround::at(float x_m, float z_m) const {
  constexpr float wave_per_m = 1;
  switch (kind) {
    case GroundKind::level:
      return {};
    case GroundKind::slope:
      return {rise * z_m, 0, rise};
    case GroundKind::cross:
      return {rise * x_m, rise, 0};
    case GroundKind::hills: {
      const double x = double{wave_per_m * x_m}, z = double{wave_per_m * z_m};
      const auto times = [&](double a, double b) { return rise * static_cast<float>(a) * static_cast<float>(b); };
      return {times(std::sin(z), std::cos(x)), -wave_per_m * times(std::sin(z), std::sin(x)),
              wave_per_m * times(std::cos(z), std::cos(x))};
    }
    case GroundKind::kerb:
      return {z_m >= edge_m ? rise : 0, 0, 0};
    case GroundKind::stairs:
      return {rise * std::clamp(std::floor((z_m - edge_m) / tread_m) + 1, 0.0F, stair_count), 0, 0};
  }
  return {};
}

GroundPicture picture_of(const WalkGround& ground, float length_m) {
  GroundPicture picture;
  const auto put = [&](float x, float y, float z, const Vec3<float>& normal) {
    picture.position.push_back({x, y, z});
    picture.normal.push_back(normal);
    return static_cast<std::uint32_t>(picture.position.size() - 1);
  };
  const auto quad = [&](const std::array<std::uint32_t, 4>& of) {
    for (const std::size_t i : {0U, 1U, 2U, 0U, 2U, 3U}) picture.triangle.push_back(of[i]);
  };
  const auto across = [&](float y, float z) {
    picture.line.push_back({-half_width_m, y, z});
    picture.line.push_back({half_width_m, y, z});
  };
  if (has_edges(ground.kind)) {
    const float tread_m = ground.kind == GroundKind::kerb ? length_m : ground.tread_m;
    float z = -behind_m, next = ground.edge_m;
    while (z < length_m) {
      const float y = ground.at(0, 0.5F * (z + next)).height_m, after = ground.at(0, next + 0.5F * tread_m).height_m;
      const Vec3<float> up = {0, 1, 0}, out = {0, 0, after > y ? -1.0F : 1.0F};
      quad({put(-half_width_m, y, z, up), put(-half_width_m, y, next, up), put(half_width_m, y, next, up),
            put(half_width_m, y, z, up)});
      const float low = std::min(y, after), high = std::max(y, after), side = after > y ? 1.0F : -1.0F;
      quad({put(-side * half_width_m, low, next, out), put(-side * half_width_m, high, next, out),
            put(side * half_width_m, high, next, out), put(side * half_width_m, low, next, out)});
      across(high, next);
      z = next;
      next += tread_m;
    }
    return picture;
  }
  constexpr float apart_m = 0.1F;
  const auto columns = static_cast<std::uint32_t>(std::lround(2 * half_width_m / apart_m));
  const int count = static_cast<int>((length_m + behind_m) / apart_m) + 1;
  for (int row = 0; row <= count; ++row) {
    for (std::uint32_t column = 0; column <= columns; ++column) {
      const float x = -half_width_m + apart_m * static_cast<float>(column);
      const float z = -behind_m + apart_m * static_cast<float>(row);
      const TerrainHeight here = ground.at(x, z);
      const float per = 1 / std::sqrt(1 + here.rise_x * here.rise_x + here.rise_z * here.rise_z);
      const std::uint32_t last = put(x, here.height_m, z, {-here.rise_x * per, per, -here.rise_z * per});
      if (row > 0 && column > 0) quad({last - columns - 2, last - 1, last, last - columns - 1});
      if (row % 5 == 0 && column > 0) {
        picture.line.push_back(picture.position[last - 1]);
        picture.line.push_back(picture.position[last]);
      }
    }
  }
  return picture;
}

}  // namespace mobil
