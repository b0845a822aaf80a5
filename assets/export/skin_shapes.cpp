#include "assets/export/skin_shapes.h"

#include <algorithm>
#include <functional>
#include <map>
#include <vector>

#include "assets/export/closed_surface.h"
#include "assets/export/mesh_shading.h"

namespace mobil::inline v0_3 {
namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Blend = Eigen::Matrix<double, 3, 4>;
using JointMaps = std::array<Blend, segment_count>;

constexpr std::size_t max_checked_frames = 32;
constexpr double margin_m = 0.001;
constexpr double min_volume = 0.05;  // of a blended matrix that can be inverted

/// Returns the maps of all joints from their places at rest to a frame.
JointMaps joint_maps(const std::vector<RigidTransform>& world, const StandingPlaces& standing) {
  JointMaps maps;
  for (std::size_t s = 0; s < segment_count; ++s) {
    maps[s].leftCols<3>() = world[s].rotation.toRotationMatrix();
    maps[s].col(3) = world[s].position_m - maps[s].leftCols<3>() * standing[s];
  }
  return maps;
}

Blend blend(const FigurePiece& piece, std::size_t v, const JointMaps& maps) {
  Blend sum = Blend::Zero();
  for (std::size_t k = 0; k < 4; ++k) sum += static_cast<double>(piece.weight[v][k]) * maps[piece.joint[v][k]];
  return sum;
}

/// The skin's vertices, each once although seams of the texture repeat some.
struct WeldedSkin {
  std::vector<const FigurePiece*> piece;
  std::vector<std::pair<std::size_t, std::size_t>> first;  // piece and vertex of each welded vertex
  std::vector<std::uint32_t> of;                           // welded vertex of each vertex of all pieces
  std::vector<std::uint32_t> triangle;                     // of welded vertices
};

WeldedSkin welded_skin(std::span<const FigurePiece> pieces) {
  WeldedSkin skin;
  std::map<std::array<float, 3>, std::uint32_t> known;
  for (const FigurePiece& piece : pieces) {
    if (piece.rigid) continue;
    const std::size_t base = skin.of.size();
    for (std::size_t v = 0; v < piece.position.size(); ++v) {
      const Vec3<float>& p = piece.position[v];
      const auto [found, is_new] = known.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(skin.first.size()));
      if (is_new) skin.first.emplace_back(skin.piece.size(), v);
      skin.of.push_back(found->second);
    }
    for (const std::uint32_t corner : piece.triangle) skin.triangle.push_back(skin.of[base + corner]);
    skin.piece.push_back(&piece);
  }
  return skin;
}

/// Returns a column per frame: where each welded vertex is at rest if blending is to bring it to its drawn place.
Eigen::MatrixXd drawn_at_rest(const WeldedSkin& skin, const SkeletonKeys& skeleton, const StandingPlaces& standing) {
  Eigen::MatrixXd frames(static_cast<Index>(3 * skin.first.size()), static_cast<Index>(skeleton.world.size()));
  for (std::size_t f = 0; f < skeleton.world.size(); ++f) {
    const JointMaps maps = joint_maps(skeleton.world[f], standing);
    for (std::size_t i = 0; i < skin.first.size(); ++i) {
      const auto [p, v] = skin.first[i];
      const FigurePiece& piece = *skin.piece[p];
      const Blend map = blend(piece, v, maps);
      const Eigen::Matrix3d linear = map.leftCols<3>();
      Vector3d rest = widened(piece.position[v]);
      if (linear.determinant() > min_volume) rest = linear.inverse() * (widened(piece.drawn_m[f][v]) - map.col(3));
      frames.col(static_cast<Index>(f)).segment<3>(static_cast<Index>(3 * i)) = rest;
    }
  }
  return frames;
}

/// Returns the skin in a frame, as other programs show it.
Matrix3Xd shown_skin(const WeldedSkin& skin, const MorphedSurface& surface, const JointMaps& maps, std::size_t frame) {
  Matrix3Xd shown = surface.position.cast<double>();
  for (std::size_t k = 0; k < surface.target.size(); ++k)
    shown += static_cast<double>(surface.weight[frame][k]) * surface.target[k].position.cast<double>();
  for (std::size_t i = 0; i < skin.first.size(); ++i) {
    const auto [p, v] = skin.first[i];
    const Blend map = blend(*skin.piece[p], v, maps);
    const auto column = static_cast<Index>(i);
    shown.col(column) = (map.leftCols<3>() * shown.col(column) + map.col(3)).eval();
  }
  return shown;
}

/// Frames in which bones and muscles are held against the skin, evenly spread.
std::vector<std::size_t> checked_frames(std::size_t frames) {
  const std::size_t count = std::min(frames, max_checked_frames);
  std::vector<std::size_t> checked;
  for (std::size_t i = 0; i < count; ++i) checked.push_back(count == 1 ? 0 : i * (frames - 1) / (count - 1));
  return checked;
}

/// Returns a place below the nearest of a surface, for a point outside it.
Vector3d below(const SurfacePlace& near, const Vector3d& outside) {
  const Vector3d inward = near.distance_m > 1e-6 ? Vector3d((near.at - outside) / near.distance_m) : -near.normal;
  return near.at + margin_m * inward;
}

/// Lifts the shape where muscles come through the morphed skin.
void lift_over_muscles(const WeldedSkin& skin, const MusclePoints& muscles, const SkeletonKeys& skeleton,
                       const StandingPlaces& standing, MorphedSurface& surface) {
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    Matrix3Xd lift = Matrix3Xd::Zero(3, surface.position.cols());
    for (const std::size_t f : checked_frames(skeleton.world.size())) {
      const JointMaps maps = joint_maps(skeleton.world[f], standing);
      const ClosedSurface closed(shown_skin(skin, surface, maps, f), skin.triangle);
      for (const Vector3d& at : muscles(f)) {
        if (!closed.is_outside(at)) continue;
        const SurfacePlace near = closed.nearest(at);
        const Vector3d out = at - below(near, at);
        for (std::size_t c = 0; c < 3; ++c) {
          const std::uint32_t corner = skin.triangle[3 * near.triangle + c];
          const auto [p, v] = skin.first[corner];
          const Vector3d own = blend(*skin.piece[p], v, maps).leftCols<3>().inverse() * out;
          if (own.norm() > lift.col(corner).norm()) lift.col(corner) = own;
        }
      }
    }
    if (lift.isZero()) return;
    surface.position += lift.cast<float>();
  }
}

/// A vertex of a bone.
struct BoneVertex {
  FigurePiece* piece;
  std::size_t vertex;
};

/// Moves bones' vertices below the skin; returns the largest displacement.
double move_bones_inside(std::span<FigurePiece> pieces, const WeldedSkin& skin, const MorphedSurface& surface,
                         const SkeletonKeys& skeleton, const StandingPlaces& standing) {
  std::vector<BoneVertex> left;
  for (FigurePiece& piece : pieces) {
    for (std::size_t v = 0; piece.rigid && v < piece.position.size(); ++v) left.push_back({&piece, v});
  }
  std::vector<std::vector<Vec3<float>>> before;
  for (const FigurePiece& piece : pieces) before.push_back(piece.position);
  constexpr int rounds = 4;
  for (int round = 0; round < rounds && !left.empty(); ++round) {
    std::vector<bool> moved(left.size(), false);
    for (const std::size_t f : checked_frames(skeleton.world.size())) {
      const JointMaps maps = joint_maps(skeleton.world[f], standing);
      const ClosedSurface closed(shown_skin(skin, surface, maps, f), skin.triangle);
      for (std::size_t b = 0; b < left.size(); ++b) {
        Vec3<float>& at = left[b].piece->position[left[b].vertex];
        const Blend& map = maps[left[b].piece->joint[left[b].vertex][0]];
        const Vector3d world = map.leftCols<3>() * widened(at) + map.col(3);
        if (!closed.is_outside(world)) continue;
        const Vector3d rest = map.leftCols<3>().transpose() * (below(closed.nearest(world), world) - map.col(3));
        at = {static_cast<float>(rest.x()), static_cast<float>(rest.y()), static_cast<float>(rest.z())};
        moved[b] = true;
      }
    }
    std::vector<BoneVertex> again;
    for (std::size_t b = 0; b < left.size(); ++b)
      if (moved[b]) again.push_back(left[b]);
    left = std::move(again);
  }
  double largest_m = 0;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (!pieces[p].rigid) continue;
    for (std::size_t v = 0; v < before[p].size(); ++v)
      largest_m = std::max(largest_m, (widened(pieces[p].position[v]) - widened(before[p][v])).norm());
    if (largest_m > 0) set_normals(pieces[p]);
  }
  return largest_m;
}

}  // namespace

bool has_drawn_skin(std::span<const FigurePiece> pieces) {
  const auto is_drawn = [](const FigurePiece& piece) {
    return piece.rigid || (!piece.drawn_m.empty() && piece.drawn_m.front().size() == piece.position.size());
  };
  return std::ranges::all_of(pieces, is_drawn) && std::ranges::any_of(pieces, std::logical_not{}, &FigurePiece::rigid);
}

SkinShapes skin_shapes(std::span<FigurePiece> pieces, const MusclePoints& muscles, const SkeletonKeys& skeleton,
                       const StandingPlaces& standing, int max_targets, double tolerance_m) {
  const WeldedSkin skin = welded_skin(pieces);
  SkinShapes shapes;
  MorphedSurface& surface = shapes.surface;
  surface = morph_targets(drawn_at_rest(skin, skeleton, standing), skin.triangle, max_targets, tolerance_m);
  lift_over_muscles(skin, muscles, skeleton, standing, surface);
  shapes.bones_moved_m = move_bones_inside(pieces, skin, surface, skeleton, standing);
  std::vector<Index> columns;
  for (const std::uint32_t vertex : skin.of) columns.push_back(static_cast<Index>(vertex));
  const auto expand = [&](Eigen::Matrix3Xf& m) { m = m(Eigen::all, columns).eval(); };
  expand(surface.position);
  expand(surface.normal);
  for (MorphTarget& target : surface.target) {
    expand(target.position);
    expand(target.normal);
  }
  Index column = 0;
  for (FigurePiece& piece : pieces) {
    for (std::size_t v = 0; !piece.rigid && v < piece.position.size(); ++v, ++column) {
      const auto p = surface.position.col(column), n = surface.normal.col(column);
      piece.position[v] = {p.x(), p.y(), p.z()};
      piece.normal[v] = {n.x(), n.y(), n.z()};
    }
  }
  return shapes;
}

}  // namespace mobil::inline v0_3
