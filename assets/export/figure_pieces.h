#pragma once
// A figure as meshes for formats with skins: one a cloth, in its standing place.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <mobil/assets/surfaces/texture_places.h>
#include <mobil/engine/error.h>
#include "assets/export/recorded_people.h"
#include "assets/export/skeleton_keys.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

struct FigurePiece {
  std::size_t cloth = 0;
  std::string name;  // bones, or the name of a skin's part
  std::vector<Vec3<float>> position, normal;
  std::vector<TexturePlace> texture;               // folded; or of an atlas, to the right and down
  std::vector<std::array<float, 4>> tangent;       // or empty
  std::vector<std::array<std::uint8_t, 4>> joint;  // segments that each vertex follows
  std::vector<std::array<float, 4>> weight;        // add up to 1
  std::vector<std::uint32_t> triangle;
  std::vector<std::vector<Vec3<float>>> drawn_m;  // as in SkinnedSurface, or empty
  bool rigid = true;                              // each vertex follows only its first joint
  bool atlas = false;                             // texture is of one
};

/// Returns the folded texture places of a surface, which are the same in a recording that put_z_back has turned.
std::vector<TexturePlace> recorded_texture(std::span<const Vec3<float>> position, bool z_back);

/// Sets the normals of a piece from its triangles.
void set_normals(FigurePiece& piece);

/// Returns the rest pose for which a figure is drawn: the recorded one, or without it that of its first person.
StandingPlaces figure_standing(const SeenFigure& figure, const SeenPerson& first);

/// Returns a person's rest pose: the figure's, at the person's size.
StandingPlaces person_rest(const StandingPlaces& figure, const Vec3<float>& scale);

/// Fails on a surface whose triangles have no area.
Result<std::vector<FigurePiece>> figure_pieces(const SeenFigure& figure, const StandingPlaces& standing);

}  // namespace mobil::inline v0_3
