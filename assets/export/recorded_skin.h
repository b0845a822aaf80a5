#pragma once
// A person's skin and clothes as exporters take them.

#include "assets/export/walk_recording.h"
#include "assets/skin/body_skin.h"

namespace mobil {

/// A surface a part (SkinPart), whose number is its cloth, from `first_cloth` on, with its places in the skin's atlas
/// (assets/skin/skin_atlas.h). Of several joints that a vertex follows the four heaviest are kept: formats blend their
/// matrices, which at a bent elbow loses a little of the girth that the library's own skin keeps.
std::vector<SkinnedSurface> recorded_skin(const BodySkin& skin, std::size_t first_cloth = 0);
/// Where its segments stand.
std::array<Vec3<float>, segment_count> standing_of(const BodySkin& skin);

}  // namespace mobil
