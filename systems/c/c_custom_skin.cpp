// Custom skins in the host's buffers.

#include <fmt/format.h>

#include <vector>

#include <mobil/assets/surfaces/custom_skin.h>
#include <mobil/engine/geometry.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/follow_skin.h>
#include <mobil/systems/surfaces/place_skin.h>
#include <mobil/systems/surfaces/rest_surfaces.h>
#include "assets/surfaces/surface_mesh.h"
#include "systems/c/c_skin.h"
#include "systems/c/c_surfaces.h"
#include "systems/people/person_requests.h"

struct mobil_custom_skin {
  mobil::BodySkin bare;
  mobil::CustomSkin own;
  float height_m = 0;
  bool mirrored = false;  // the host's axes are mirrored, so triangles change their winding
};

namespace {

using namespace mobil;
using namespace mobil::c;

constexpr float furthest_m = 5;  // maximum distance of a leg's vertex from the origin between the feet

/// A skin's vertices, tightly packed.
struct Vertices {
  std::vector<Vec3<float>> position, normal;

  explicit Vertices(std::size_t count) : position(count), normal(count) {}
  VertexStream positions() { return {std::as_writable_bytes(std::span(position))}; }
  VertexStream normals() { return {std::as_writable_bytes(std::span(normal))}; }
};

/// Converts a mesh to the library's axes, without unused vertices. Errors: null, bad indices, a vertex too far away.
int mesh_of(mobil_sim& s, const mobil_leg_mesh& given, SurfaceMesh& to) {
  if (given.positions == nullptr) return s.line.refuse_null("positions");
  if (given.indices == nullptr) return s.line.refuse_null("indices");
  if (given.index_count == 0 || given.index_count % 3 != 0)
    return s.line.refuse(MOBIL_REFUSED, fmt::format("{} indices; give three a triangle", given.index_count));
  for (std::size_t v = 0; v < given.vertices; ++v) {
    const float* const at = given.positions + 3 * v;
    const Vec3<float>& place = to.position.emplace_back(s.axes.place_from(at));
    if (!(geometry::length(place) <= furthest_m))
      return s.line.refuse(MOBIL_REFUSED,
                           fmt::format("vertex {} is at ({}, {}, {}), more than {} m from the origin; is "
                                       "it in the unit of mobil_options?",
                                       v, at[0], at[1], at[2], furthest_m));
  }
  to.triangle.resize(given.index_count);
  for (std::size_t i = 0; i < given.index_count; ++i) {
    if (given.indices[i] >= given.vertices)
      return s.line.refuse(MOBIL_REFUSED,
                           fmt::format("index {} is of vertex {}; there are {}", i, given.indices[i], given.vertices));
  }
  wind({given.indices, given.index_count}, s.axes.mirrored(), to.triangle.data());
  drop_unused(to);  // unused vertices would change the computed end of the leg
  return MOBIL_OK;
}

/// Computes the skin of a standing body over muscles at rest.
Result<Vertices> standing(const BodySkin& skin, const Body& body, const mobil_surfaces* surfaces) {
  std::array<std::vector<Vec3<float>>, 2> of_side;
  if (surfaces != nullptr) {
    const auto rest = surfaces_at_rest(surfaces->bound, body, surfaces->choice());
    if (!rest) return tl::unexpected(rest.error());
    for (const Side side : {Side::right, Side::left})
      of_side[side] = muscle_vertices(surfaces->bound, rest->position, side);
  }
  Vertices at(skin.rest.size());
  std::vector<FrameMap> maps(skin_mesh(skin.sex, skin.detail).frame.size());
  const VertexStream positions = at.positions(), normals = at.normals();
  pose_skin(skin, skin.standing, 1, {0, 0, 0}, {of_side[Side::right], of_side[Side::left]}, nullptr, nullptr, maps,
            {positions.bytes.data(), normals.bytes.data(), positions.stride, normals.stride});
  return at;
}

/// One target: the body's skin and the custom skin that follows it.
struct Following {
  PosedSkin posed;
  Vertices beneath, own;
  VertexStream positions{}, normals{};
};

}  // namespace

int mobil_bind_custom_skin(mobil_sim* sim, mobil_id like, const mobil_leg_mesh* mesh, mobil_custom_skin** out) {
  return call(sim, "mobil_bind_custom_skin", [&](mobil_sim& s) {
    if (out == nullptr) return s.line.refuse_null("out");
    *out = nullptr;
    mobil_leg_mesh given;
    if (const int code = read_struct(s.line, mesh, "mesh", given)) return code;
    SkinDetail detail{};
    if (const int code = one_of(s.line, given.detail, SkinDetail::distant, "detail", detail)) return code;
    SurfaceMesh leg;
    if (const int code = mesh_of(s, given, leg)) return code;
    const auto person = s.world().person(entity_of(like));
    if (!person) return s.line.refuse(Error{{}, Status::stale_entity});
    auto bare = make_body_skin(person->body, detail, {.dressed = false});
    if (!bare) return s.line.refuse(bare.error());
    const auto at = standing(*bare, person->body, given.surfaces);
    if (!at) return s.line.refuse(at.error());
    CustomSkin own = bind_custom_skin(*bare, at->position, at->normal, {&leg, 1}, given.shorts_stay != 0);
    *out = new mobil_custom_skin{std::move(*bare), std::move(own), person->body.request.height_m, s.axes.mirrored()};
    return int{MOBIL_OK};
  });
}

void mobil_drop_custom_skin(mobil_custom_skin* skin) {
  delete skin;
}

size_t mobil_custom_skin_vertex_count(const mobil_custom_skin* skin) {
  return skin == nullptr ? 0 : skin->own.vertex.size();
}

size_t mobil_custom_skin_index_count(const mobil_custom_skin* skin) {
  return skin == nullptr ? 0 : skin->own.triangle.size();
}

int mobil_custom_skin_indices(const mobil_custom_skin* skin, unsigned int* out, size_t room) {
  if (skin == nullptr || out == nullptr) return MOBIL_REFUSED;
  if (room < skin->own.triangle.size()) return MOBIL_ROOM;
  wind(skin->own.triangle, skin->mirrored, out);
  return MOBIL_OK;
}

int mobil_custom_skin_rest(const mobil_custom_skin* skin, unsigned int* out, size_t room, size_t* count) {
  if (skin == nullptr || (out == nullptr && count == nullptr)) return MOBIL_REFUSED;
  if (count != nullptr) *count = skin->own.left.size();
  if (out == nullptr) return MOBIL_OK;
  if (room < skin->own.left.size()) return MOBIL_ROOM;
  wind(skin->own.left, skin->mirrored, out);
  return MOBIL_OK;
}

int mobil_write_custom_skin(mobil_sim* sim, const mobil_custom_skin* skin, const mobil_skin_target* targets,
                            size_t stride, size_t count) {
  return call(sim, "mobil_write_custom_skin", [&](mobil_sim& s) {
    if (skin == nullptr) return s.line.refuse_null("skin");
    if (const int code = same_handedness(s, skin->mirrored)) return code;
    if (const int code = struct_stride(s.line, targets, count, "targets", stride)) return code;
    const std::size_t vertices = skin->own.vertex.size(), three = 3 * sizeof(float);
    std::vector<Following> following(count, {{}, Vertices(skin->bare.rest.size()), Vertices(vertices)});
    std::vector<SkinRequest> requests(count);
    for (std::size_t i = 0; i < count; ++i) {
      Following& one = following[i];
      mobil_skin_target as;
      if (const int code = read_struct(s.line, row_at(targets, i, stride, 0), "targets", as)) return code;
      if (const int code = skin_person(s, as, static_cast<int>(skin->bare.sex), one.posed, requests[i])) return code;
      if (const int code = skin_streams(s, as, one.positions, one.normals)) return code;
      if (auto ok = check_stream("positions", one.positions, vertices, three); !ok) return s.line.refuse(ok.error());
      if (!one.normals.bytes.empty()) {
        if (auto ok = check_stream("normals", one.normals, vertices, three); !ok) return s.line.refuse(ok.error());
        if (lie_over(one.positions, three, one.normals, three, vertices))
          return s.line.refuse(MOBIL_REFUSED, "normals lie over positions; put them into slots or memory of their own");
      }
      const float height_m = body_request(s.world().world(), requests[i].person).height_m;
      requests[i].shape = {&skin->bare, height_m / skin->height_m};
      requests[i].positions = one.beneath.positions();
      requests[i].normals = one.beneath.normals();
    }
    if (const auto done = s.skin_writer.write(s.world().world(), requests, s.jobs); !done)
      return s.line.refuse(done.error());
    in_parallel(s.jobs, count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        check_interrupt();
        Following& one = following[i];
        follow_skin(skin->own, one.beneath.position, one.beneath.normal, one.own.position, one.own.normal);
        write_vertices(one.own.position, one.positions,
                       [&](const Vec3<float>& v, float* to) { s.axes.place_to(v, to); });
        write_vertices(one.own.normal, one.normals,
                       [&](const Vec3<float>& v, float* to) { s.axes.direction_to(v, to); });
      }
    });
    return int{MOBIL_OK};
  });
}

// Deprecated names, removed in 0.5.
int mobil_bind_own_skin(mobil_sim* sim, mobil_id like, const mobil_leg_mesh* mesh, mobil_custom_skin** out) {
  return mobil_bind_custom_skin(sim, like, mesh, out);
}
void mobil_drop_own_skin(mobil_custom_skin* skin) {
  mobil_drop_custom_skin(skin);
}
size_t mobil_own_skin_vertex_count(const mobil_custom_skin* skin) {
  return mobil_custom_skin_vertex_count(skin);
}
size_t mobil_own_skin_index_count(const mobil_custom_skin* skin) {
  return mobil_custom_skin_index_count(skin);
}
int mobil_own_skin_indices(const mobil_custom_skin* skin, unsigned int* out, size_t room) {
  return mobil_custom_skin_indices(skin, out, room);
}
int mobil_own_skin_rest(const mobil_custom_skin* skin, unsigned int* out, size_t room, size_t* count) {
  return mobil_custom_skin_rest(skin, out, room, count);
}
int mobil_write_own_skin(mobil_sim* sim, const mobil_custom_skin* skin, const mobil_skin_target* targets, size_t stride,
                         size_t count) {
  return mobil_write_custom_skin(sim, skin, targets, stride, count);
}
