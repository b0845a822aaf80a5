#pragma once
// The meshes of an anatomy folder as a picture.

#include <mobil/assets/import/anatomy_folder.h>
#include <mobil/engine/error.h>
#include <mobil/systems/capture/image.h>

namespace mobil {

/// From the front and from the right, 1120 × 1080. Skins are left out; so are meshes with a fault. Errors: no usable
/// mesh, those of the renderer.
Result<Image> anatomy_picture(const AnatomySurvey& survey);

}  // namespace mobil
