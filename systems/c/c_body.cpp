// Segments of a body, and a host's bones by name.

#include <algorithm>
#include <cctype>
#include <string_view>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include <mobil/systems/muscles/person.h>
#include "systems/c/c_call.h"

namespace {

using namespace mobil;
using namespace mobil::c;

/// Returns the number of the segment whose name a bone has, by itself or behind a prefix; −1 for other names.
int segment_of_bone(std::string_view bone) {
  const auto matches = [&](std::string_view segment) {
    if (!bone.ends_with(segment)) return false;
    const std::string_view prefix = bone.substr(0, bone.size() - segment.size());
    return prefix.empty() || std::isalnum(static_cast<unsigned char>(prefix.back())) == 0;
  };
  const auto found = std::ranges::find_if(segment_name, matches);
  return found == segment_name.end() ? -1 : static_cast<int>(found - segment_name.begin());
}

mobil_segment segment_for(const HostAxes& axes, const Body& body, Segment segment) {
  mobil_segment to = usual<mobil_segment>();
  const std::size_t s = index(segment);
  to.parent = static_cast<int>(segment_parent[s]);
  axes.place_to(body.joint_offset_m[s], to.offset);
  axes.place_to(body.tip_m[s], to.tip);
  axes.place_to(body.centre_of_mass_m[s], to.centre);
  to.mass_kg = body.mass_kg[s];
  axes.direction_to(geometry::to_float(segment_inertia_kg_m2(body, segment)), to.inertia_kg_m2);
  for (float& moment : to.inertia_kg_m2) moment = std::abs(moment);  // the host's axes can be opposite
  return to;
}

}  // namespace

int mobil_get_body(mobil_sim* sim, mobil_id id, mobil_segment* out, size_t stride) {
  return call(sim, "mobil_get_body", [&](mobil_sim& s) {
    if (const int code = struct_stride(s.line, out, segment_count, "out", stride)) return code;
    const std::size_t size = out->size;
    const auto person = s.world().person(entity_of(id));
    if (!person) return s.line.refuse(Error{{}, Status::stale_entity});
    for (std::size_t i = 0; i < segment_count; ++i) {
      mobil_segment* const to = row_at(out, i, stride, 0);
      to->size = size;
      const mobil_segment made = segment_for(s.axes, person->body, static_cast<Segment>(i));
      if (const int code = write_struct(s.line, made, to, "out")) return code;
    }
    return int{MOBIL_OK};
  });
}

int mobil_segments_of(const char* const* names, size_t count, int* out) {
  if (count > 0 && (names == nullptr || out == nullptr)) return MOBIL_REFUSED;
  bool any = false;
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = names[i] == nullptr ? -1 : segment_of_bone(names[i]);
    any = any || out[i] >= 0;
  }
  return any ? int{MOBIL_OK} : int{MOBIL_MISSING};
}
