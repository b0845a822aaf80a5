#include "assets/export/figure_pieces.h"

#include <fmt/format.h>

#include "assets/export/mesh_shading.h"

namespace mobil::inline v0_3 {
namespace {

void append_texture(std::span<const Vec3<float>> position, bool z_back, FigurePiece& piece) {
  const std::vector<TexturePlace> places = recorded_texture(position, z_back);
  piece.texture.insert(piece.texture.end(), places.begin(), places.end());
}

Result<void> append_bone(const BoneSurface& surface, const Eigen::Vector3d& standing_m, bool z_back,
                         FigurePiece& piece) {
  const auto& mesh = surface.mesh;
  const Eigen::Matrix3Xd exact = columns_of(mesh.position);
  const auto triangle = triangles_with_area(exact, mesh.triangle);
  if (triangle.empty())
    return fail(fmt::format("surface '{}': none of its triangles has an area; leave it out", mesh.name));
  const auto first = static_cast<std::uint32_t>(piece.position.size());
  for (const auto corner : triangle) piece.triangle.push_back(first + corner);
  append_texture(mesh.position, z_back, piece);
  piece.joint.insert(piece.joint.end(), mesh.position.size(), {static_cast<std::uint8_t>(surface.segment), 0, 0, 0});
  piece.weight.insert(piece.weight.end(), mesh.position.size(), {1, 0, 0, 0});
  for (const auto& column : exact.colwise()) {
    const Eigen::Vector3f at = (standing_m + column).cast<float>();
    piece.position.push_back({at.x(), at.y(), at.z()});
  }
  return {};
}

void append_skin(const SkinnedSurface& surface, bool z_back, FigurePiece& piece) {
  const auto first = static_cast<std::uint32_t>(piece.position.size());
  for (const auto corner : surface.triangle) piece.triangle.push_back(first + corner);
  if (surface.texture.empty()) {
    append_texture(surface.position, z_back, piece);
  } else {
    for (const auto& [right, down] : surface.texture) piece.texture.push_back({right, down});
    piece.tangent.insert(piece.tangent.end(), surface.tangent.begin(), surface.tangent.end());
    piece.atlas = true;
  }
  piece.joint.insert(piece.joint.end(), surface.joint.begin(), surface.joint.end());
  piece.weight.insert(piece.weight.end(), surface.weight.begin(), surface.weight.end());
  piece.position.insert(piece.position.end(), surface.position.begin(), surface.position.end());
  piece.normal.insert(piece.normal.end(), surface.normal.begin(), surface.normal.end());
  piece.drawn_m.resize(surface.drawn_m.size());
  for (std::size_t f = 0; f < surface.drawn_m.size(); ++f)
    piece.drawn_m[f].insert(piece.drawn_m[f].end(), surface.drawn_m[f].begin(), surface.drawn_m[f].end());
  piece.rigid = false;
}

}  // namespace

std::vector<TexturePlace> recorded_texture(std::span<const Vec3<float>> position, bool z_back) {
  if (!z_back) return folded_places(position);
  std::vector<Vec3<float>> unturned(position.begin(), position.end());
  for (Vec3<float>& p : unturned) p = {-p.x, p.y, -p.z};
  return folded_places(unturned);
}

void set_normals(FigurePiece& piece) {
  piece.normal.clear();
  const Eigen::Matrix3Xf normal = vertex_normals(columns_of(piece.position), piece.triangle).cast<float>();
  for (const auto& n : normal.colwise()) piece.normal.push_back({n.x(), n.y(), n.z()});
}

StandingPlaces figure_standing(const SeenFigure& figure, const SeenPerson& first) {
  StandingPlaces standing;
  if (figure.has_standing()) {
    for (std::size_t s = 0; s < segment_count; ++s) standing[s] = widened(figure.standing_m[s]);
    return standing;
  }
  standing = standing_places(*first.frames, figure.surfaces);
  for (auto& place : standing) place = place.cwiseQuotient(widened(first.scale));
  return standing;
}

StandingPlaces person_rest(const StandingPlaces& figure, const Vec3<float>& scale) {
  StandingPlaces rest = figure;
  for (auto& place : rest) place = place.cwiseProduct(widened(scale));
  return rest;
}

Result<std::vector<FigurePiece>> figure_pieces(const SeenFigure& figure, const StandingPlaces& standing) {
  std::vector<FigurePiece> pieces;
  for (std::size_t cloth = 0; cloth < figure.cloths(); ++cloth) {
    FigurePiece piece;
    piece.cloth = cloth;
    for (std::size_t i = 0; i < figure.surfaces.size(); ++i) {
      if (figure.cloth_of(i) != cloth) continue;
      piece.name = "bones";
      const BoneSurface& surface = figure.surfaces[i];
      auto added = append_bone(surface, standing[index(surface.segment)], figure.z_back, piece);
      if (!added) return tl::unexpected(added.error());
    }
    for (const SkinnedSurface& surface : figure.skin) {
      if (surface.cloth != cloth) continue;
      if (piece.name.empty()) piece.name = surface.name;
      append_skin(surface, figure.z_back, piece);
    }
    if (piece.triangle.empty()) continue;
    if (piece.tangent.size() != piece.position.size()) {  // a part of it has no atlas
      piece.tangent.clear();
      piece.atlas = false;
    }
    if (piece.normal.size() != piece.position.size()) set_normals(piece);
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

}  // namespace mobil::inline v0_3
