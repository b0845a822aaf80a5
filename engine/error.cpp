#include "engine/error.h"

#include <new>

namespace mobil {

namespace {

Error error_of(const char* call, Status status) noexcept {
  Error error{{}, status};
  try {
    if (call != nullptr) error.message = std::string(call) + ": ";
    error.message += status_text(status);
  } catch (const std::bad_alloc&) {
    error.message.clear();
  }
  return error;
}

}  // namespace

tl::unexpected<Error> fail(Status status) noexcept {
  return tl::unexpected<Error>(error_of(nullptr, status));
}

Result<void> result_of(const char* call, Status status) noexcept {
  if (status == Status::ok) return {};
  return tl::unexpected<Error>(error_of(call, status));
}

}  // namespace mobil
