#pragma once
// How a failure is handed back: one clear line that says what, where, the valid range and how to mend it; and a code.

#include <string>
#include <tl/expected.hpp>
#include <utility>

#include <mobil/engine/status.h>

namespace mobil::inline v0_3 {

/// Why a call failed: one line for people, a code for the program.
struct Error {
  std::string message;
  Status status = Status::not_valid;  // never ok
};
inline bool operator==(const Error& error, Status status) {
  return error.status == status;
}

/// What was asked for, or an Error.
template <class T>
using Result = tl::expected<T, Error>;

/// The text on one line that a terminal shows as it stands: control characters as \n or \x1b, words of more than 255
/// characters cut to their first 60, and at most 2000 characters in all. Texts within that stay as they are.
std::string one_line(std::string text);

/// The message is made one line.
inline tl::unexpected<Error> fail(std::string message, Status status = Status::not_valid) {
  return tl::unexpected<Error>(Error{one_line(std::move(message)), status});
}
/// With the status' own line, or none where there is no memory for it.
tl::unexpected<Error> fail(Status status) noexcept;

/// A status with its line, which names the call that was refused; without where there is no memory for it.
Result<void> result_of(const char* call, Status status) noexcept;

/// An error with the name of the call that was refused before its message.
template <class T>
Result<T> named(const char* call, Result<T> result) {
  if (result) return result;
  return fail(std::string(call) + ": " + result.error().message, result.error().status);
}

/// Whether it ended like that: simulation.despawn(person) == Status::ok.
template <class T>
bool operator==(const tl::expected<T, Error>& result, Status status) {
  return status == Status::ok ? result.has_value() : !result.has_value() && result.error().status == status;
}

}  // namespace mobil::inline v0_3
