#pragma once
// A walking person drawn with the meshes of an anatomy folder.

#include "demo/walk/figure.h"

namespace mobil {

/// Fits the folder's bones, muscles and skin to the person's body and generates missing bones. `contact` keeps muscles
/// from penetrating each other and bones. Errors: those of reading and fitting the meshes.
Result<Figure> real_figure(const Person& person, const std::filesystem::path& folder, bool contact);

}  // namespace mobil
