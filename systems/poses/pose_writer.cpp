#include <mobil/pose_writer.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <tuple>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/each.h>
#include <mobil/engine/geometry.h>
#include <mobil/rows.h>
#include <mobil/systems/people/sleepers.h>
#include "systems/poses/pose_axes.h"
#include "systems/poses/walk_ahead.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::array<std::size_t, 3> form_floats = {7, 12, 8};

/// Places and quaternions of one segment of sixteen people: x y z, x y z w.
struct Placed {
  float at[3][lane_count], turn[4][lane_count];
};

void segment_of(const Pose<Lanes<float>>& pose, std::size_t s, Placed& out) {
  static_assert(sizeof pose.position_m[0] == sizeof out.at && sizeof pose.rotation[0] == sizeof out.turn);
  std::memcpy(out.at, &pose.position_m[s], sizeof out.at);
  std::memcpy(out.turn, &pose.rotation[s], sizeof out.turn);
}

/// Transforms `placed` to the frame of `from`.
void seen_from(const Placed& from, Placed& placed) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    const Quat<float> back = {-from.turn[0][l], -from.turn[1][l], -from.turn[2][l], from.turn[3][l]};
    const Vec3<float> at = geometry::rotated(
        back, {placed.at[0][l] - from.at[0][l], placed.at[1][l] - from.at[1][l], placed.at[2][l] - from.at[2][l]});
    const Quat<float> turn =
        geometry::product(back, {placed.turn[0][l], placed.turn[1][l], placed.turn[2][l], placed.turn[3][l]});
    placed.at[0][l] = at.x, placed.at[1][l] = at.y, placed.at[2][l] = at.z;
    placed.turn[0][l] = turn.x, placed.turn[1][l] = turn.y, placed.turn[2][l] = turn.z, placed.turn[3][l] = turn.w;
  }
}

/// Converts to other axes and units. A mirrored frame reverses the sense of rotations.
void change_axes(const AxisMap& axes, float units_per_m, const Placed& from, Placed& to) {
  for (std::size_t i = 0; i < 3; ++i) {
    const float length = axes.sign[i] * units_per_m, sense = axes.sign[i] * axes.mirrored();
    for (std::size_t l = 0; l < lane_count; ++l) {
      to.at[i][l] = length * from.at[axes.ours[i]][l];
      to.turn[i][l] = sense * from.turn[axes.ours[i]][l];
    }
  }
  std::memcpy(to.turn[3], from.turn[3], sizeof to.turn[3]);
}

/// A segment's numbers in the host's format, for sixteen people.
using Numbers = float[12][lane_count];

void as_matrix(const Placed& p, Numbers& out) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    const float a = p.turn[0][l], b = p.turn[1][l], c = p.turn[2][l], w = p.turn[3][l];
    const float row[12] = {1 - 2 * (b * b + c * c), 2 * (a * b - c * w),     2 * (a * c + b * w),     p.at[0][l],
                           2 * (a * b + c * w),     1 - 2 * (a * a + c * c), 2 * (b * c - a * w),     p.at[1][l],
                           2 * (a * c - b * w),     2 * (b * c + a * w),     1 - 2 * (a * a + b * b), p.at[2][l]};
    for (std::size_t n = 0; n < 12; ++n) out[n][l] = row[n];
  }
}

void as_dual_quaternion(const Placed& p, Numbers& out) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    const float a = p.turn[0][l], b = p.turn[1][l], c = p.turn[2][l], w = p.turn[3][l];
    const float x = 0.5F * p.at[0][l], y = 0.5F * p.at[1][l], z = 0.5F * p.at[2][l];
    const float row[8] = {
        a, b, c, w, x * w + y * c - z * b, y * w + z * a - x * c, z * w + x * b - y * a, -(x * a + y * b + z * c)};
    for (std::size_t n = 0; n < 8; ++n) out[n][l] = row[n];
  }
}

/// These numbers, person by person.
struct PersonRows {
  float of[lane_count][12];
};

/// Transposes in 4×4 tiles, which compilers do not find by themselves.
void turn_over(const Numbers& numbers, std::size_t count, PersonRows& rows) {
  using Four = float __attribute__((vector_size(16)));
  for (std::size_t n = 0; n < count; n += 4) {
    for (std::size_t l = 0; l < lane_count; l += 4) {
      Four in[4];
      for (std::size_t i = 0; i < 4; ++i) std::memcpy(&in[i], &numbers[n + i][l], sizeof in[i]);
      const Four a = __builtin_shufflevector(in[0], in[1], 0, 4, 1, 5),
                 b = __builtin_shufflevector(in[0], in[1], 2, 6, 3, 7);
      const Four c = __builtin_shufflevector(in[2], in[3], 0, 4, 1, 5),
                 d = __builtin_shufflevector(in[2], in[3], 2, 6, 3, 7);
      const Four out[4] = {__builtin_shufflevector(a, c, 0, 1, 4, 5), __builtin_shufflevector(a, c, 2, 3, 6, 7),
                           __builtin_shufflevector(b, d, 0, 1, 4, 5), __builtin_shufflevector(b, d, 2, 3, 6, 7)};
      for (std::size_t i = 0; i < 4; ++i) std::memcpy(&rows.of[l + i][n], &out[i], sizeof out[i]);
    }
  }
}

}  // namespace

struct PoseWriter::Work {
  const PoseWriter& writer;
  const PoseLayout& layout;
  const PoseTarget& target;
  float ahead_s;
  std::size_t person_stride, segment_stride;

  void write_block(std::size_t block) const;
  void convert(const Pose<Lanes<float>>& pose, std::size_t k, PersonRows& rows) const;
};

void PoseWriter::Work::convert(const Pose<Lanes<float>>& pose, std::size_t k, PersonRows& rows) const {
  const std::size_t s = layout.segments.empty() ? k : index(layout.segments[k]);
  const std::size_t parent = index(segment_parent[s]);
  Placed ours, theirs;
  segment_of(pose, s, ours);
  if (layout.to_parent && parent != s) {
    Placed from;
    segment_of(pose, parent, from);
    seen_from(from, ours);
  }
  change_axes(axes_of[static_cast<std::size_t>(layout.axes)], layout.units_per_m, ours, theirs);
  Numbers numbers;
  if (layout.form == PoseForm::matrix) {
    as_matrix(theirs, numbers);
  } else if (layout.form == PoseForm::dual_quaternion) {
    as_dual_quaternion(theirs, numbers);
  } else {
    std::memcpy(numbers, &theirs, sizeof theirs);
  }
  turn_over(numbers, form_floats[static_cast<std::size_t>(layout.form)], rows);
}

void PoseWriter::Work::write_block(std::size_t b) const {
  const std::span people =
      std::span(writer.places_).subspan(writer.blocks_[b], writer.blocks_[b + 1] - writer.blocks_[b]);
  const Table& table = *people.front().table;
  const std::size_t block = people.front().row / lane_count;
  const TableColumn<Pose> own(table);
  const auto* pose = own ? &own.at(table, block) : nullptr;
  Pose<Lanes<float>> then;
  if (TableColumn<GaitState>(table) && (ahead_s > 0 || pose == nullptr)) {
    pose_ahead(table, block, ahead_s, then);
    pose = &then;
  }
  // Writes person by person, so that memory is written in order, with as many segments at once as a cache holds.
  constexpr std::size_t at_once = 16;
  const std::size_t count = layout.segments.empty() ? segment_count : layout.segments.size();
  PersonRows rows[at_once];
  for (std::size_t first = 0; first < count; first += at_once) {
    const std::size_t end = std::min(first + at_once, count);
    for (std::size_t k = first; k < end; ++k) convert(*pose, k, rows[k - first]);
    for (const Place& person : people) {
      std::byte* out = target.bytes.data() + person.number * person_stride + first * segment_stride;
      const std::size_t lane = person.row % lane_count;
      for (std::size_t k = first; k < end; ++k, out += segment_stride) {
        switch (layout.form) {
          case PoseForm::place_and_quaternion:
            std::memcpy(out, rows[k - first].of[lane], 28);
            break;
          case PoseForm::matrix:
            std::memcpy(out, rows[k - first].of[lane], 48);
            break;
          case PoseForm::dual_quaternion:
            std::memcpy(out, rows[k - first].of[lane], 32);
            break;
        }
      }
    }
  }
}

PoseWriter::PoseWriter(std::pmr::memory_resource* memory) : places_(memory), blocks_(memory) {}

Result<void> PoseWriter::write(const World& world, std::span<const Entity> people, double ahead_s,
                               const PoseLayout& layout, const PoseTarget& target, const Jobs& jobs) {
  const FloatMode mode;
  if (auto done = check_ahead(ahead_s); !done) return fail(fmt::format("poses: {}", done.error().message));
  if (!(std::fabs(layout.units_per_m) > 1e-6F && std::fabs(layout.units_per_m) < 1e6F))
    return fail(fmt::format("poses: {} units a metre; 0.000001 to 1000000", layout.units_per_m));
  for (const Segment s : layout.segments)
    if (index(s) >= segment_count)
      return fail(fmt::format("poses: segment number {}; there are {}", index(s), segment_count));
  const std::size_t segments = layout.segments.empty() ? segment_count : layout.segments.size();
  const std::size_t bytes = form_floats[static_cast<std::size_t>(layout.form)] * sizeof(float);
  const std::size_t segment_stride = target.segment_stride == 0 ? bytes : target.segment_stride;
  const std::size_t one = (segments - 1) * segment_stride + bytes;
  const std::size_t person_stride = target.person_stride == 0 ? one : target.person_stride;
  if (segment_stride < bytes)
    return fail(fmt::format("poses: segments {} bytes apart; at least {}", segment_stride, bytes));
  if (person_stride < bytes)
    return fail(fmt::format("poses: people {} bytes apart; at least {}", person_stride, bytes));
  const std::size_t needed = people.empty() ? 0 : (people.size() - 1) * person_stride + one;
  if (target.bytes.size() < needed)
    return fail(fmt::format("poses: {} bytes for {} people of {} segments; {} are needed", target.bytes.size(),
                            people.size(), segments, needed));

  places_.clear();
  places_.reserve(people.size());
  for (std::size_t i = 0; i < people.size(); ++i) {
    const auto place = world.find(people[i]);
    if (is_asleep(world, people[i]))
      return fail(fmt::format("poses: person {} of the list sleeps; wake them or leave them out", i), Status::missing);
    if (!place || !(TableColumn<Pose>(*place.table) || TableColumn<GaitState>(*place.table)))
      return fail(fmt::format("poses: person {} of the list is not there (a stale handle)", i), Status::stale_entity);
    places_.push_back({place.table, place.row, static_cast<std::uint32_t>(i)});
  }
  auto block_of = [](const Place& p) { return std::tuple(p.table, p.row / lane_count); };
  const auto order = [&](const Place& p) { return std::tuple_cat(block_of(p), std::tuple(p.number)); };
  if (!std::ranges::is_sorted(places_, {}, order)) std::ranges::sort(places_, {}, order);
  blocks_.clear();
  blocks_.reserve(people.size() + 1);
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (i == 0 || block_of(places_[i]) != block_of(places_[i - 1])) blocks_.push_back(static_cast<std::uint32_t>(i));
  const std::size_t count = blocks_.size();
  blocks_.push_back(static_cast<std::uint32_t>(places_.size()));
  const Work work{*this, layout, target, static_cast<float>(ahead_s), person_stride, segment_stride};
  in_parallel(jobs, count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) work.write_block(b);
  });
  return {};
}

}  // namespace mobil::inline v0_3
