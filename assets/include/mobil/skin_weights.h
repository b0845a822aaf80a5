#pragma once
// A body's skin as engines draw it on the graphics card: rest shape, texture coordinates, and up to four segments with
// weights a vertex. The method is linear blend skinning (Magnenat-Thalmann et al., Joint-dependent local deformations,
// 1988).
//
// A vertex is at Σ weight · pose(joint) · inverse_bind(joint) · position, with the pose in the world
// (PoseForm::matrix). All rotations of the rest pose are identity, so `inverse_bind` is the translation by −joint_m.
// SkinWriter bends joints smoothly and spreads the hand's turn along the forearm. Over a walk half of the blended
// vertices are within 1 mm of its, and all within 25 mm of its surface (tests/surfaces/skin_weights_test.cpp). The skin
// of forearms slides along the surface by up to 45 mm.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/skin_atlas.h>

namespace mobil::inline v0_3 {

/// Segments of a vertex, heaviest first, and their weights, which add up to 1. Unused places have weight 0.
struct JointWeights {
  std::array<std::uint8_t, 4> joint{};
  std::array<float, 4> weight{};
};

/// Returns the joints of a point that follows vertices of a skin with the given parts, which add up to 1.
JointWeights joint_weights(const SkinMesh& mesh, std::span<const std::uint32_t> vertex, std::span<const float> part);

/// One body's skin in the anatomical position, m, on the ground with the hips over x = z = 0, facing +Z. A vertex is a
/// point of the skin's SkinAtlas, so a vertex of SkinWriter on a seam of the texture occurs several times.
struct SkinWeights {
  std::vector<Vec3<float>> position, normal;
  std::vector<std::array<float, 4>> tangent;  // skin_tangents
  std::vector<AtlasPlace> texture;
  std::vector<JointWeights> joints;
  std::vector<std::uint32_t> vertex;                           // number in SkinWriter's vertices
  std::vector<std::uint32_t> triangle;                         // three vertices each, wound outwards; part by part
  std::array<std::uint32_t, skin_parts + 1> first_triangle{};  // of each SkinPart; the last is their count
  std::array<Vec3<float>, segment_count> joint_m{};            // of each segment, in the rest pose
};

/// Returns the weights of a skin for a body that is `lengths` times as high (SkinShape::lengths of BodySkins::of).
SkinWeights skin_weights(const BodySkin& skin, float lengths = 1);

}  // namespace mobil::inline v0_3
