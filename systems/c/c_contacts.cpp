// Contacts of muscles in the host's buffers.

#include <fmt/format.h>

#include <vector>

#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/rest_surfaces.h>
#include "systems/c/c_surfaces.h"

struct mobil_contacts {
  mobil::SurfaceContacts found;
  std::size_t vertices = 0;
};

namespace {

using namespace mobil;
using namespace mobil::c;

/// Vertices written for one target, in the library's axes, at any origin.
struct Written {
  VertexStream positions, normals;
  std::vector<Vec3<float>> position, normal;
};

template <class Turn>
void read_vertices(const VertexStream& from, std::vector<Vec3<float>>& to, const Turn& turn) {
  for (std::size_t v = 0; v < to.size(); ++v) {
    float value[3];
    std::memcpy(value, from.bytes.data() + v * from.stride, sizeof value);
    to[v] = turn(value);
  }
}

int written_of(mobil_sim& s, const mobil_contacts& contacts, const void* target, Written& to) {
  mobil_surface_target as;
  if (const int code = read_struct(s.line, target, "targets", as)) return code;
  constexpr std::size_t three = 3 * sizeof(float);
  if (as.positions == nullptr) return s.line.refuse_null("positions");
  if (as.normals == nullptr) return s.line.refuse_null("normals");
  if (const int code =
          stream_of(s.line, as.positions, as.position_stride, as.position_bytes, three, "positions", to.positions))
    return code;
  if (const int code = stream_of(s.line, as.normals, as.normal_stride, as.normal_bytes, three, "normals", to.normals))
    return code;
  if (as.surfaces == nullptr || as.surfaces->bound.vertices != contacts.vertices)
    return s.line.refuse(MOBIL_REFUSED, "a target's surfaces are not those that contacts were found for");
  for (const auto& [name, stream] : {std::pair{"positions", to.positions}, std::pair{"normals", to.normals}})
    if (auto ok = check_stream(name, stream, contacts.vertices, three); !ok) return s.line.refuse(ok.error());
  if (lie_over(to.positions, three, to.normals, three, contacts.vertices))
    return s.line.refuse(MOBIL_REFUSED, "normals lie over positions; put them into slots or memory of their own");
  return MOBIL_OK;
}

}  // namespace

int mobil_find_contacts(mobil_sim* sim, mobil_id like, const mobil_surfaces* surfaces, mobil_contacts** out) {
  return call(sim, "mobil_find_contacts", [&](mobil_sim& s) {
    if (out == nullptr) return s.line.refuse_null("out");
    *out = nullptr;
    if (surfaces == nullptr) return s.line.refuse_null("surfaces");
    const auto person = s.world().person(entity_of(like));
    if (!person) return s.line.refuse(Error{{}, Status::stale_entity});
    auto found = find_contacts(surfaces->bound, person->body, surfaces->choice());
    if (!found) return s.line.refuse(found.error());
    *out = new mobil_contacts{std::move(*found), surfaces->bound.vertices};
    return int{MOBIL_OK};
  });
}

void mobil_drop_contacts(mobil_contacts* contacts) {
  delete contacts;
}

int mobil_keep_apart(mobil_sim* sim, const mobil_contacts* contacts, const mobil_surface_target* targets, size_t stride,
                     size_t count) {
  return call(sim, "mobil_keep_apart", [&](mobil_sim& s) {
    if (contacts == nullptr) return s.line.refuse_null("contacts");
    if (const int code = struct_stride(s.line, targets, count, "targets", stride)) return code;
    std::vector<Written> written(count);
    for (std::size_t i = 0; i < count; ++i)
      if (const int code = written_of(s, *contacts, row_at(targets, i, stride, 0), written[i])) return code;
    in_parallel(s.jobs, count, [&](std::size_t begin, std::size_t end) {
      ContactWork work;
      for (std::size_t i = begin; i < end; ++i) {
        Written& one = written[i];
        one.position.resize(contacts->vertices);
        one.normal.resize(contacts->vertices);
        read_vertices(one.positions, one.position, [&](const float* v) { return s.axes.place_from(v); });
        read_vertices(one.normals, one.normal, [&](const float* v) { return s.axes.direction_from(v); });
        keep_apart(contacts->found, one.position, one.normal, work);
      }
    });
    for (const Written& one : written) {
      write_vertices(one.position, one.positions, [&](const Vec3<float>& v, float* to) { s.axes.place_to(v, to); });
      write_vertices(one.normal, one.normals, [&](const Vec3<float>& v, float* to) { s.axes.direction_to(v, to); });
    }
    return int{MOBIL_OK};
  });
}
