#include <mobil/surfaces.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include <mobil/components/activation.h>
#include <mobil/components/leg_frames.h>
#include <mobil/components/pose.h>
#include <mobil/engine/interrupt.h>
#include <mobil/rows.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include <mobil/systems/surfaces/write_vertices.h>
#include "assets/surfaces/bone_surfaces.h"
#include "systems/lines/elongations.h"
#include "systems/lines/line_of_action.h"
#include "systems/muscles/pose_history.h"
#include "systems/poses/walk_ahead.h"
#include "systems/surfaces/clear_of_bones.h"
#include "systems/surfaces/place_vertices.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::size_t vertex_bytes = 3 * sizeof(float), tangent_bytes = 4 * sizeof(float);

/// Returns the words of an entity's row of a component; null if the entity is stale or has none.
template <template <class> class C>
const float* lane_of(const World& world, Entity entity) {
  const auto place = world.find(entity);
  if (!place) return nullptr;
  const std::uint32_t column = place.table->column(type_id<C<float>>());
  if (column == Table::no_column) return nullptr;
  return place.table->block(place.row / lane_count) + column * lane_count + place.row % lane_count;
}

template <class T, class Row>
T read(const Row& row, std::size_t first_word = 0) {
  std::array<float, sizeof(T) / sizeof(float)> word;
  for (std::size_t w = 0; w < word.size(); ++w) word[w] = row.word[(first_word + w) * row.stride];
  return std::bit_cast<T>(word);
}

template <class Row>
RigidPose segment_pose(const Row& pose, Segment segment) {
  return {read<Vec3<float>>(pose, 3 * index(segment)), read<Quat<float>>(pose, 3 * segment_count + 4 * index(segment))};
}

/// Returns the scale of the leg's bones.
float leg_lengths(const SurfaceFit& fit) {
  return fit.bone[index(Segment::thigh_right)].x;
}
/// Returns the scale of a bone along itself, relative to the leg's other bones.
float stretch(const SurfaceFit& fit, Segment segment) {
  const float s = fit.bone[index(segment)].y / leg_lengths(fit);
  return std::abs(s - 1) < 1e-5F ? 1.0F : s;  // in proportion up to rounding
}

/// Writes displacements of a belly at rest that is drawn out evenly.
void draw_out(const BodySurfaces::Driver& driver, float longer_m, float* node) {
  for (std::size_t n = 0; n < driver.nodes; ++n) {
    node[3 * n] = node[3 * n + 1] = 0;
    node[3 * n + 2] = longer_m * driver.along[n];
  }
}

Result<void> check_buffers(const SurfaceRequest& request) {
  if (request.surfaces == nullptr) return fail("no surfaces; bind_surfaces makes them");
  if (request.fit != nullptr && request.fit->belly.size() != request.surfaces->driver.size())
    return fail("a fit of other surfaces; give what fit_surfaces made of these");
  struct Stream {
    const char* name;
    const VertexStream& stream;
    std::size_t bytes;
    bool needed;
  };
  const std::array<Stream, 3> streams = {{{"positions", request.positions, vertex_bytes, true},
                                          {"normals", request.normals, vertex_bytes, false},
                                          {"tangents", request.tangents, tangent_bytes, false}}};
  const std::size_t vertices = request.surfaces->vertices;
  for (const Stream& one : streams) {
    if (!one.needed && one.stream.bytes.empty()) continue;
    if (auto done = check_stream(one.name, one.stream, vertices, one.bytes); !done) return done;
    for (const Stream& other : streams) {
      if (&other == &one) break;
      if (!other.stream.bytes.empty() && lie_over(one.stream, one.bytes, other.stream, other.bytes, vertices))
        return fail(fmt::format("{} lie over {}; put them into slots of their own, or into other memory", one.name,
                                other.name));
    }
  }
  if (request.tangents.bytes.empty()) return {};
  if (request.surfaces->texture.size() != vertices)
    return fail("tangents of surfaces without texture coordinates; choose them textured");
  if (request.normals.bytes.empty()) return fail("tangents without normals; ask for both");
  return {};
}

VertexTarget target_of(const SurfaceRequest& request, std::uint32_t first_vertex) {
  const auto at = [&](const VertexStream& s) {
    return s.bytes.empty() ? nullptr : s.bytes.data() + std::size_t{first_vertex} * s.stride;
  };
  return {at(request.positions),  at(request.normals),  request.positions.stride,
          request.normals.stride, at(request.tangents), request.tangents.stride};
}

void write_bone(const SurfaceRequest& request, RigidPose now, const RigidSurface& surface, const SurfacePart& part) {
  const Vec3<float>& o = request.origin_m;
  now.position_m = {now.position_m.x - o.x, now.position_m.y - o.y, now.position_m.z - o.z};
  const VertexTarget target = target_of(request, part.first_vertex);
  if (request.fit == nullptr) return write_rigid(surface, affine_map(now), target);
  write_rigid(surface, affine_map(now), target, request.fit->bone[index(part.segment)]);
}

}  // namespace

struct SurfaceWriter::Work {
  SurfaceWriter& writer;
  std::span<const SurfaceRequest> requests;
  const World& world;
  const VertexAxes& axes;

  void write_piece(std::size_t request, const BodySurfaces::Piece& piece, float* scratch) const;
  void write_side(std::size_t request, const BodySurfaces::Piece& piece, Side side, float* scratch) const;
  void convert(const SurfaceRequest& request, const SurfacePart& part) const;
};

void SurfaceWriter::Work::write_side(std::size_t r, const BodySurfaces::Piece& piece, Side side, float* scratch) const {
  const SurfaceRequest& request = requests[r];
  const auto& packed = std::get<PackedSurface>(piece.surface);
  const Resolved& person = writer.person_[r];
  const Line& muscle = writer.line_[person.first_line + 2 * piece.driver + side];
  const auto line = read<LineOfAction<float>>(muscle.line);
  const BodySurfaces::Driver& driver = request.surfaces->driver[piece.driver];
  float *places = scratch, *node = scratch + 4 * packed.places();
  if (muscle.node == nullptr) {
    const float longer_m = muscle.pull.word == nullptr
                               ? line.length_m - line.rest_length_m
                               : read<Musculotendon<float>>(muscle.pull).belly_m + muscle.longer_m;
    draw_out(driver, longer_m, node);
  } else {
    for (std::size_t w = 0; w < 3 * std::size_t{packed.nodes}; ++w) node[w] = muscle.node[w * lane_count];
    for (std::size_t n = 0; muscle.longer_m != 0 && n < driver.nodes; ++n)
      node[3 * n + 2] += muscle.longer_m * driver.along[n];
  }
  const SurfaceRest& rest = packed.rest;
  SurfaceScale scale;
  if (const SurfaceFit* fit = request.fit; fit != nullptr) {
    scale = {leg_lengths(*fit), stretch(*fit, rest.origin.bone[side]), stretch(*fit, rest.insertion.bone[side]),
             fit->belly[piece.driver]};
  }
  const SkinMaps maps = skin_maps(rest, side, segment_pose(person.pose, rest.origin.bone[side]),
                                  segment_pose(person.pose, rest.insertion.bone[side]), line, request.origin_m, scale);
  place_vertices(packed, maps, node, side, places);
  if (request.surfaces->clear_of != nullptr) {
    std::array<PosedBone, LegBones::hard.size()> posed;
    for (std::size_t b = 0; b < posed.size(); ++b) {
      const Segment bone =
          LegBones::hard[b] < Segment::thigh_right ? LegBones::hard[b] : on_side(LegBones::hard[b], side);
      posed[b].pose = segment_pose(person.pose, bone);
      if (request.fit != nullptr) posed[b].scale = request.fit->bone[index(bone)];
      posed[b].pose.position_m = posed[b].pose.position_m - request.origin_m;
    }
    keep_clear(*request.surfaces->clear_of, posed, side, places,
               packed.places() - block_vertices * packed.fixed_blocks);  // ends stay on their bones
  }
  const SurfacePart& part = request.surfaces->part[*piece.part[side]];
  write_vertices(packed.rings, packed.along, places, side == Side::left ? -1.0F : 1.0F,
                 target_of(request, part.first_vertex));
}

void SurfaceWriter::Work::write_piece(std::size_t r, const BodySurfaces::Piece& piece, float* scratch) const {
  if (const auto* rigid = std::get_if<RigidSurface>(&piece.surface)) {
    const SurfacePart& part = requests[r].surfaces->part[*piece.part[0]];
    write_bone(requests[r], segment_pose(writer.person_[r].pose, part.segment), *rigid, part);
    convert(requests[r], part);
    return;
  }
  for (const Side side : {Side::right, Side::left}) {
    if (!piece.part[side]) continue;
    write_side(r, piece, side, scratch);
    convert(requests[r], requests[r].surfaces->part[*piece.part[side]]);
  }
}

void SurfaceWriter::Work::convert(const SurfaceRequest& request, const SurfacePart& part) const {
  convert_axes(request.positions, part.first_vertex, part.vertices, VertexField::position, axes);
  convert_axes(request.normals, part.first_vertex, part.vertices, VertexField::normal, axes);
  convert_axes(request.tangents, part.first_vertex, part.vertices, VertexField::tangent, axes);
}

SurfaceWriter::SurfaceWriter(std::pmr::memory_resource* memory)
    : person_(memory), line_(memory), later_pose_(memory), later_line_(memory), scratch_(memory) {}

Result<void> SurfaceWriter::resolve(const World& world, const SurfaceRequest& request) {
  if (auto done = check_buffers(request); !done) return done;
  if (auto done = check_ahead(request.ahead_s); !done) return done;
  if (!world.alive(request.person)) return fail("the person is not there (a stale handle)", Status::stale_entity);
  const Resolved person{{lane_of<Pose>(world, request.person)}, line_.size()};
  if (person.pose.word == nullptr)
    return fail("the person has no pose; who is compact or asleep must be whole first", Status::missing);
  person_.push_back(person);
  for (const BodySurfaces::Driver& driver : request.surfaces->driver) {
    const auto own = std::ranges::find(request.muscles, driver.muscle, &SurfaceMuscle::muscle);
    const std::string_view name = muscle_name(driver.muscle);
    for (const Side side : {Side::right, Side::left}) {
      Line& line = line_.emplace_back();
      if (!request.surfaces->sides[side]) continue;
      if (own == request.muscles.end()) return fail(fmt::format("{} is not among the muscles", name));
      const auto owner = world.get<MuscleOwner>(own->entity[side]);
      line.line.word = lane_of<LineOfAction>(world, own->entity[side]);
      line.pull.word = lane_of<Musculotendon>(world, own->entity[side]);
      if (request.ahead_s > 0) line.scale.word = lane_of<LegScale>(world, own->entity[side]);
      if (!owner || line.line.word == nullptr)
        return fail(fmt::format("{} is not there (a stale handle)", name), Status::stale_entity);
      if (owner->index != request.person.index || owner->generation != request.person.generation || owner->side != side)
        return fail(fmt::format("{} is another person's or of the other side", name));
      const NodalView nodes = nodal_displacement(world, own->entity[side]);
      line.node = nodes.first;
      if (nodes.first != nullptr && nodes.nodes != driver.nodes) {
        return fail(fmt::format("{} has {} nodes, its surfaces are bound to {}; bind them to its cells", name,
                                nodes.nodes, driver.nodes));
      }
    }
  }
  return {};
}

/// Replaces poses and lines of action of people at a later instant.
void SurfaceWriter::look_ahead(void* context, std::size_t begin, std::size_t end) {
  const auto& work = *static_cast<const Work*>(context);
  SurfaceWriter& writer = work.writer;
  for (std::size_t r = begin; r < end; ++r) {
    const SurfaceRequest& request = work.requests[r];
    if (request.ahead_s == 0) continue;
    Resolved& person = writer.person_[r];
    Pose<float>& pose = writer.later_pose_[r] =
        pose_ahead(work.world, request.person, static_cast<float>(request.ahead_s));
    person.pose = {reinterpret_cast<const float*>(&pose), 1};
    for (const Side side : {Side::right, Side::left}) {
      if (!request.surfaces->sides[side]) continue;
      const LegFrames<Lanes<float>> leg = leg_of(pose, side);
      for (std::size_t d = 0; d < request.surfaces->driver.size(); ++d) {
        const std::size_t l = person.first_line + 2 * d + side;
        Line& line = writer.line_[l];
        const auto before = read<LineOfAction<float>>(line.line);
        auto lanes = broadcast(before);
        EndDrive<Lanes<float>> end_drive{};
        lines_of_action(lines_of(request.surfaces->driver[d].muscle), broadcast(read<LegScale<float>>(line.scale)), leg,
                        FarEnd::held, lanes, end_drive);
        const LineOfAction<float>& then = writer.later_line_[l] = row_of(lanes, 0);
        line.longer_m = then.length_m - before.length_m;
        line.line = {reinterpret_cast<const float*>(&then), 1};
      }
    }
  }
}

void SurfaceWriter::write_pieces(void* context, std::size_t begin, std::size_t end) {
  const auto& work = *static_cast<const Work*>(context);
  const ScratchLease scratch(&work.writer.scratch_);
  // piece by piece for all people: those who share their surfaces find them in the cache
  for (std::size_t i = begin; i < end; ++i) {
    check_interrupt();
    const std::size_t r = i % work.requests.size(), p = i / work.requests.size();
    const auto& pieces = work.requests[r].surfaces->piece;
    if (p < pieces.size()) work.write_piece(r, pieces[p], scratch.data());
  }
}

Result<void> SurfaceWriter::write(const World& world, std::span<const SurfaceRequest> requests, const Jobs& jobs,
                                  const VertexAxes& axes) {
  const FloatMode mode;
  if (auto done = check_axes(axes); !done) return done;
  person_.clear();
  line_.clear();
  std::size_t pieces = 0, nodes = 0, places = 0;
  for (std::size_t r = 0; r < requests.size(); ++r) {
    if (auto done = resolve(world, requests[r]); !done)
      return fail(fmt::format("surfaces of request {}: {}", r, done.error().message), done.error().status);
    pieces = std::max(pieces, requests[r].surfaces->piece.size());
    nodes = std::max(nodes, requests[r].surfaces->max_nodes);
    places = std::max(places, requests[r].surfaces->max_places);
  }
  scratch_.prepare(4 * places + 3 * nodes, jobs.threads);
  Work work{*this, requests, world, axes};
  if (std::ranges::any_of(requests, [](const SurfaceRequest& one) { return one.ahead_s > 0; })) {
    later_pose_.resize(requests.size());
    later_line_.resize(line_.size());
    run_in_parallel(jobs, requests.size(), look_ahead, &work);
  }
  run_in_parallel(jobs, pieces * requests.size(), write_pieces, &work);
  return {};
}

}  // namespace mobil::inline v0_3
