#pragma once
// Errors that end a measurement: thrown where they appear and caught by the subcommand, which reports them. Functions
// of the laboratory without a Result throw Stopped for the errors that their comments name.

#include <stdexcept>
#include <type_traits>
#include <utility>

#include <mobil/engine/error.h>

namespace mobil {

/// A measurement that cannot continue, and why.
struct Stopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The value of `result`. Throws Stopped with its error's message.
template <class T>
T must(Result<T> result) {
  if (!result) throw Stopped(result.error().message);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

/// The result of `work()`, or the error of what stopped it.
template <class Work>
auto attempt(Work&& work) -> Result<decltype(work())> {
  try {
    if constexpr (!std::is_void_v<decltype(work())>) return work();
    work();
    return {};
  } catch (const Stopped& stopped) {
    return fail(stopped.what());
  }
}

}  // namespace mobil
