#include "engine/error.h"

#include <new>

namespace mobil {

tl::unexpected<Error> fail(Status status) noexcept {
  Error error{{}, status};
  try {
    error.message = status_text(status);
  } catch (const std::bad_alloc&) {
  }
  return tl::unexpected<Error>(std::move(error));
}

}  // namespace mobil
