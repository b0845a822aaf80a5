#pragma once
// What became of a request, for a program to read.

#include <cstdint>
#include <string_view>

namespace mobil::inline v0_3 {

/// What became of a request. Nothing was changed unless it is `ok`.
enum class Status : std::uint8_t {
  ok,
  stale_entity,   ///< the entity was destroyed, or never was
  missing,        ///< it has no such component, field or tag
  already_there,  ///< it has that component, field or tag already
  wrong_width,    ///< the span is not as long as the field
  not_valid,      ///< refused for what the message says: a value out of range, bytes that are damaged, too little room
  not_yours,      ///< a part or an entity that is the library's, where a host's is asked for
  no_memory,      ///< there is no memory for it
};

/// In words.
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
