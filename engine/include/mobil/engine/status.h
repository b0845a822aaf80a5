#pragma once
// Result codes of requests.

#include <cstdint>
#include <string_view>

#if defined(Status)
#error "X11 has made Status a macro: write #undef Status between its headers and those of mobil"
#undef Status
#endif

namespace mobil::inline v0_3 {

/// Result of a request. Nothing was changed unless it is `ok`.
enum class Status : std::uint8_t {
  ok,
  stale_entity,   ///< the entity was destroyed or never existed
  missing,        ///< the entity has no such component, field or tag
  already_there,  ///< the entity already has that component, field or tag
  wrong_width,    ///< the span's length is not the field's
  not_valid,      ///< refused, with the reason in the message: a value out of range, damaged bytes, too little room
  not_yours,      ///< a part or an entity of the library, where one of the host's is required
  no_memory,      ///< memory ran out
};

/// Returns a status as text.
constexpr std::string_view status_text(Status status) {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::stale_entity:
      return "that entity is gone, or never was";
    case Status::missing:
      return "the entity has no such component";
    case Status::already_there:
      return "the entity has that component already";
    case Status::wrong_width:
      return "the span is not as long as the field";
    case Status::not_valid:
      return "a value is not finite or out of its range";
    case Status::not_yours:
      return "that part or entity is the library's; use the call that is for it";
    case Status::no_memory:
      return "there is no memory for it; give the simulation more";
  }
  return "no status";
}

}  // namespace mobil::inline v0_3
