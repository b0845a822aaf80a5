#pragma once
// How a failure is handed back: one clear line that says what, where, the valid range and how to mend it.

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace mobil {

struct Error {
  std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(std::string message) {
  return tl::unexpected<Error>(Error{std::move(message)});
}

}  // namespace mobil
