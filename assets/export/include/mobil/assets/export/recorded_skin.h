#pragma once
// A person's skin and clothes as exporters take them.

#include <span>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/assets/surfaces/custom_skin.h>

namespace mobil::inline v0_3 {

/// A surface a part (SkinPart), whose number is its cloth, from `first_cloth` on, with its places in the skin's atlas
/// (mobil/skin_atlas.h). Of several joints that a vertex follows the four heaviest are kept: formats blend their
/// matrices, which at a bent elbow loses a little of the girth that the library's own skin keeps.
/// `own`: what has taken the place of some of it, which is left out.
std::vector<SkinnedSurface> recorded_skin(const BodySkin& skin, std::size_t first_cloth = 0,
                                          const CustomSkin* own = nullptr);
/// A skin mesh of somebody's own, of that cloth. `bare`: the body's skin that it was bound to; `position`, `normal`: of
/// its vertices where that stands (follow_skin). Each follows the segments that the skin nearest to it does.
SkinnedSurface recorded_custom_skin(const BodySkin& bare, const CustomSkin& own, std::span<const Vec3<float>> position,
                                    std::span<const Vec3<float>> normal, std::size_t cloth);
/// Where its segments stand.
std::array<Vec3<float>, segment_count> standing_of(const BodySkin& skin);

}  // namespace mobil::inline v0_3
