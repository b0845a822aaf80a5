#pragma once
// What a body looks like at rest: bones and built-in muscles in the anatomical position.

#include <mobil/components/body.h>
#include <mobil/engine/error.h>
#include <mobil/systems/capture/image.h>

namespace mobil {

/// From the front and from the body's right beside each other, to the same scale. Error: no graphics driver (with the
/// packages to install), or one that fails.
Result<Image> body_picture(const Body& body);

}  // namespace mobil
