#pragma once
// Errors: one line with the cause, the place, the valid range and the remedy; and a status code.

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

#if defined(Status)
#error "X11 has made Status a macro: write #undef Status between its headers and those of mobil"
#undef Status
#endif

#if defined(_LIBCPP_VERSION)
#define MOBIL_CONTAINERS library_is_built_with_libcxx
#elif defined(_GLIBCXX_DEBUG)
#define MOBIL_CONTAINERS library_is_built_with_GLIBCXX_DEBUG
#elif defined(_GLIBCXX_USE_CXX11_ABI) && !_GLIBCXX_USE_CXX11_ABI
#define MOBIL_CONTAINERS library_is_built_with_GLIBCXX_USE_CXX11_ABI_0
#else
#define MOBIL_CONTAINERS library_is_built_without_GLIBCXX_DEBUG
#endif

namespace mobil::inline v0_3 {

/// The layout of standard containers, which host and library share. A host that differs fails to link, and the linker
/// names this symbol.
extern const char MOBIL_CONTAINERS;
/// A reference to the symbol from every file of a host.
[[gnu::used]] static const char* const containers = &MOBIL_CONTAINERS;

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

/// Reason of a failed call: one line of text and a status code.
struct Error {
  std::string message;
  Status status = Status::not_valid;  // never ok
};
inline bool operator==(const Error& error, Status status) {
  return error.status == status;
}

/// A result, or an Error.
template <class T>
using Result = tl::expected<T, Error>;

/// Returns the text on one line that terminals show unchanged. Control characters become \n or \x1b. Words of more than
/// 255 characters are cut to their first 60, and the text to 2000 characters. Other texts are unchanged.
std::string one_line(std::string text);

/// Returns a number with up to seven digits, and with a point in any locale.
std::string decimal(double value);

/// Returns an error; the message is put on one line.
inline tl::unexpected<Error> fail(std::string message, Status status = Status::not_valid) {
  return tl::unexpected<Error>(Error{one_line(std::move(message)), status});
}
/// Returns an error with the status' text, or without text if memory runs out.
tl::unexpected<Error> fail(Status status) noexcept;

/// Returns a status with a text that names the refused call, or without text if memory runs out.
Result<void> result_of(const char* call, Status status) noexcept;

/// Prefixes an error with the name of the refused call.
template <class T>
Result<T> named(const char* call, Result<T> result) {
  if (result) return result;
  return fail(std::string(call) + ": " + result.error().message, result.error().status);
}

/// Returns true if a call ended with that status: simulation.despawn(person) == Status::ok.
template <class T>
bool operator==(const tl::expected<T, Error>& result, Status status) {
  return status == Status::ok ? result.has_value() : !result.has_value() && result.error().status == status;
}

}  // namespace mobil::inline v0_3
