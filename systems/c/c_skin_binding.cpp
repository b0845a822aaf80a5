// Skins for the graphics card, and skins baked before.

#include <mobil/skin_weights.h>
#include "systems/c/c_skin.h"
#include "systems/people/person_requests.h"

namespace {

using namespace mobil;
using namespace mobil::c;

/// Writes `convert(value, out)` for each value, `floats` of the host's numbers apart, unless `out` is null.
template <class T, class To, class F>
void write_rows(const std::vector<T>& from, To* out, std::size_t numbers, F convert) {
  for (std::size_t i = 0; i < from.size() && out != nullptr; ++i, out += numbers) convert(from[i], out);
}

void write_vertices(const SkinWeights& skin, const HostAxes& axes, const mobil_skin_binding& to) {
  write_rows(skin.position, to.positions, 3, [&](const auto& v, float* out) { axes.place_to(v, out); });
  write_rows(skin.normal, to.normals, 3, [&](const auto& v, float* out) { axes.direction_to(v, out); });
  write_rows(skin.tangent, to.tangents, 4, [&](const auto& v, float* out) {
    axes.direction_to({v[0], v[1], v[2]}, out);
    out[3] = axes.mirrored() ? -v[3] : v[3];
  });
  write_rows(skin.texture, to.texture, 2, [](const AtlasPlace& v, float* out) {
    out[0] = v.right;
    out[1] = v.down;
  });
  write_rows(skin.joints, to.joints, 4,
             [](const JointWeights& v, unsigned char* out) { std::ranges::copy(v.joint, out); });
  write_rows(skin.joints, to.weights, 4, [](const JointWeights& v, float* out) { std::ranges::copy(v.weight, out); });
  write_rows(skin.vertex, to.same_as, 1, [](std::uint32_t v, unsigned int* out) { *out = v; });
}

void write_inverse_binds(const SkinWeights& skin, const HostAxes& axes, float* out) {
  for (std::size_t s = 0; s < segment_count && out != nullptr; ++s, out += 12) {
    float joint[3];
    axes.place_to(skin.joint_m[s], joint);
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) out[4 * row + column] = row == column ? 1.0F : 0.0F;
      out[4 * row + 3] = -joint[row];
    }
  }
}

}  // namespace

size_t mobil_binding_vertex_count(int sex, int detail) {
  return skin_count(sex, detail, [](Sex of, SkinDetail at) { return skin_atlas(of, at).vertex.size(); });
}

int mobil_bake_skins(mobil_sim* sim, void* out, size_t room, size_t* bytes) {
  return call(sim, "mobil_bake_skins", [&](mobil_sim& s) {
    s.skins.prepare();
    return write_baked(s.line, s.skins.bake(), out, room, bytes);
  });
}

int mobil_load_skins(mobil_sim* sim, const void* baked, size_t bytes) {
  return call(sim, "mobil_load_skins", [&](mobil_sim& s) {
    if (baked == nullptr) return s.line.refuse_null("baked");
    return code_of(s.line, s.skins.load({static_cast<const std::byte*>(baked), bytes}));
  });
}

int mobil_get_skin_binding(mobil_sim* sim, mobil_id like, const mobil_skin_binding* binding) {
  return call(sim, "mobil_get_skin_binding", [&](mobil_sim& s) {
    mobil_skin_binding to;
    if (const int code = read_struct(s.line, binding, "binding", to)) return code;
    SkinDetail detail{};
    if (const int code = one_of(s.line, to.detail, SkinDetail::distant, "detail", detail)) return code;
    const Entity person = entity_of(like);
    if (!s.world().is_person(person)) return s.line.refuse(Error{{}, Status::stale_entity});
    const BodyRequest body = body_request(s.world().world(), person);
    if (const int code = same_sex(s, to.sex, body)) return code;
    const auto shape = s.skins.of(body, detail);
    if (!shape) return s.line.refuse(shape.error());
    const SkinWeights skin = skin_weights(*shape->skin, shape->lengths);
    const bool asked = to.positions != nullptr || to.normals != nullptr || to.tangents != nullptr ||
                       to.texture != nullptr || to.joints != nullptr || to.weights != nullptr || to.same_as != nullptr;
    if (asked && to.vertices < skin.position.size()) {
      return s.line.refuse(MOBIL_ROOM,
                           fmt::format("room for {} vertices; {} are needed", to.vertices, skin.position.size()));
    }
    if (to.indices != nullptr && to.index_room < skin.triangle.size()) {
      return s.line.refuse(MOBIL_ROOM,
                           fmt::format("room for {} indices; {} are needed", to.index_room, skin.triangle.size()));
    }
    write_vertices(skin, s.axes, to);
    if (to.indices != nullptr) wind(skin.triangle, s.axes.mirrored(), to.indices);
    write_inverse_binds(skin, s.axes, to.inverse_binds);
    return int{MOBIL_OK};
  });
}
