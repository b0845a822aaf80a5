#pragma once
// Conversion of a person's skin and clothes for exporters.

#include <span>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/assets/surfaces/custom_skin.h>

namespace mobil::inline v0_3 {

/// Returns a surface per part (SkinPart) with its places in the skin's atlas (mobil/skin_atlas.h). Its cloth is the
/// part's number plus `first_cloth`. A vertex keeps the four heaviest of its joints. Formats blend their matrices,
/// which at a bent elbow loses a little of the girth that the library's own skin keeps. Parts that `own` replaces are
/// left out.
std::vector<SkinnedSurface> recorded_skin(const BodySkin& skin, std::size_t first_cloth = 0,
                                          const CustomSkin* own = nullptr);
/// Returns a custom skin mesh of that cloth. `bare` is the body's skin to which it was bound; `position` and `normal`
/// are of its vertices in that stance (follow_skin). Each vertex follows the segments of the nearest skin.
SkinnedSurface recorded_custom_skin(const BodySkin& bare, const CustomSkin& own, std::span<const Vec3<float>> position,
                                    std::span<const Vec3<float>> normal, std::size_t cloth);
/// Returns the standing places of its segments.
std::array<Vec3<float>, segment_count> standing_of(const BodySkin& skin);

}  // namespace mobil::inline v0_3
