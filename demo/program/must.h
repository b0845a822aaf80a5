#pragma once
// Errors that end a measurement. They are thrown where they occur and caught by the subcommand, which reports them.
// Functions of demo/lab without a Result throw Stopped for the errors listed in their comments.

#include <stdexcept>
#include <type_traits>
#include <utility>

#include <mobil/engine/error.h>

namespace mobil {

/// The reason why a measurement cannot continue.
struct Stopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Returns the value of `result`, or throws Stopped with its error message.
template <class T>
T must(Result<T> result) {
  if (!result) throw Stopped(result.error().message);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

/// Returns the result of `work()`, or the error if it throws Stopped.
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
