#include "demo/walk/drawn_skin.h"

#include <cmath>
#include <utility>

#include <mobil/engine/geometry.h>
#include <mobil/systems/surfaces/follow_skin.h>
#include "demo/scene/scatter.h"

namespace mobil {
namespace {

constexpr std::array skins = {Colour{0.87F, 0.70F, 0.60F}, Colour{0.80F, 0.62F, 0.50F}, Colour{0.62F, 0.44F, 0.33F},
                              Colour{0.45F, 0.31F, 0.23F}, Colour{0.91F, 0.76F, 0.67F}};
constexpr std::array hairs = {Colour{0.13F, 0.10F, 0.09F}, Colour{0.28F, 0.19F, 0.13F}, Colour{0.47F, 0.34F, 0.21F},
                              Colour{0.66F, 0.53F, 0.34F}, Colour{0.55F, 0.54F, 0.53F}};
constexpr std::array shirts = {Colour{0.40F, 0.48F, 0.56F}, Colour{0.74F, 0.70F, 0.63F}, Colour{0.45F, 0.53F, 0.48F},
                               Colour{0.70F, 0.56F, 0.42F}, Colour{0.50F, 0.48F, 0.54F}, Colour{0.84F, 0.83F, 0.80F},
                               Colour{0.29F, 0.34F, 0.41F}, Colour{0.62F, 0.34F, 0.30F}, Colour{0.30F, 0.44F, 0.42F}};
constexpr std::array shorts = {Colour{0.22F, 0.26F, 0.34F}, Colour{0.38F, 0.36F, 0.34F}, Colour{0.55F, 0.50F, 0.42F},
                               Colour{0.27F, 0.36F, 0.47F}, Colour{0.18F, 0.18F, 0.19F}};
constexpr std::array shoes = {Colour{0.16F, 0.15F, 0.15F}, Colour{0.34F, 0.25F, 0.19F}, Colour{0.82F, 0.81F, 0.79F}};

struct PosedSkin {
  std::vector<Vec3<float>> position, normal;
};
PosedSkin posed(const BodySkin& skin, float lengths, const Pose<float>& pose, const LegVertices& muscles,
                const FatBeside* fat) {
  PosedSkin at{std::vector<Vec3<float>>(skin.rest.size()), std::vector<Vec3<float>>(skin.rest.size())};
  std::vector<FrameMap> maps(skin_mesh(skin.sex, skin.detail).frame.size());
  constexpr std::size_t stride = sizeof(Vec3<float>);
  pose_skin(skin, pose, lengths, {0, 0, 0}, {muscles[Side::right], muscles[Side::left]}, nullptr, fat, maps,
            {std::as_writable_bytes(std::span(at.position)).data(), std::as_writable_bytes(std::span(at.normal)).data(),
             stride, stride});
  return at;
}

using namespace geometry;

/// Converts a recording's linear colour to the renderer's sRGB.
Colour display_colour(const Vec3<float>& linear) {
  const auto encode = [](float x) { return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F; };
  return {encode(linear.x), encode(linear.y), encode(linear.z)};
}

}  // namespace

SkinColours skin_colours(std::uint64_t number) {
  std::uint64_t draw = scatter(number + 1);
  const auto choose = [&](const auto& from) {
    const Colour chosen = from[draw % from.size()];
    draw = scatter(draw);
    return chosen;
  };
  const Colour skin = choose(skins);
  const Colour lips{0.85F * skin.red, 0.66F * skin.green, 0.66F * skin.blue};
  return {skin, skin, lips, choose(hairs), choose(shirts), choose(shorts), choose(shoes)};
}

Vec3<float> linear_colour(const Colour& shown) {
  const auto decode = [](float x) { return x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F); };
  return {decode(shown.red), decode(shown.green), decode(shown.blue)};
}

SkinColours bare_colours() {
  SkinColours all;
  all.fill(skins[0]);
  return all;
}

void DrawnSkin::pose(const Pose<float>& pose, const LegVertices& muscles, const FatBeside* fat) {
  PosedSkin at = posed(*skin, lengths, pose, muscles, fat);
  position = std::move(at.position);
  normal = std::move(at.normal);
  if (!own) return;
  const PosedSkin under = posed(*bare, lengths, pose, muscles, fat);
  own_position.resize(own->vertex.size());
  own_normal.resize(own->vertex.size());
  follow_skin(*own, under.position, under.normal, own_position, own_normal);
}

LegVertices legs_at_rest(std::span<const Vec3<float>> right_m) {
  LegVertices at_rest;
  for (const Vec3<float>& at : right_m) {
    at_rest[Side::right].push_back(at);
    at_rest[Side::left].push_back({-at.x, at.y, at.z});
  }
  return at_rest;
}

Result<void> DrawnSkin::follow(const Body& body, std::span<const SurfaceMesh> legs, std::span<const Vec3<float>> rest_m,
                               bool shorts_stay) {
  auto made = make_body_skin(body, skin->detail, {.dressed = false});
  if (!made) return tl::unexpected(made.error());
  bare = std::move(*made);
  const PosedSkin under = posed(*bare, 1, bare->standing, legs_at_rest(rest_m), nullptr);
  own = bind_custom_skin(*bare, under.position, under.normal, legs, shorts_stay);
  return {};
}

void DrawnSkin::draw(std::vector<DrawMesh>& out) const {
  const SkinMesh& mesh = skin_mesh(skin->sex, skin->detail);
  const auto& triangles = own ? own->left : mesh.triangle;
  const auto& first_of = own ? own->first_left : mesh.first_triangle;
  constexpr float wetness = 0.08F;
  for (std::size_t part = 0; part < skin_parts; ++part) {
    const std::size_t first = 3 * std::size_t{first_of[part]}, last = 3 * std::size_t{first_of[part + 1]};
    if (first == last) continue;
    out.push_back({.position = position,
                   .triangle = std::span(triangles).subspan(first, last - first),
                   .normal = normal,
                   .colour = colours[part],
                   .wetness = wetness,
                   .opacity = opacity[part]});
  }
  if (own)
    out.push_back({.position = own_position,
                   .triangle = own->triangle,
                   .normal = own_normal,
                   .colour = colours.front(),
                   .wetness = wetness,
                   .opacity = opacity.front()});
}

void add_bones(const WalkRecording& recording, std::size_t frame, const Vec3<float>& shift, std::uint64_t first_key,
               RecordedScene& scene) {
  const Pose<float>& pose = recording.frames[frame];
  for (std::size_t i = 0; i < recording.bones.size(); ++i) {
    const BoneSurface& bone = recording.bones[i];
    const std::size_t s = index(bone.segment);
    scene.placement.push_back({.position = pose.position_m[s] + shift, .rotation = pose.rotation[s]});
    scene.meshes.push_back({.position = bone.mesh.position,
                            .triangle = bone.mesh.triangle,
                            .colour = bone_ivory,
                            .placement = {&scene.placement.back(), 1},
                            .key = first_key == 0 ? 0 : first_key + i});
  }
}

LegVertices muscles_of(const WalkRecording& recording, std::size_t frame) {
  LegVertices muscles;
  for (const RecordedMuscle& muscle : recording.muscles) {
    auto& own = muscles[muscle.name.ends_with("_left") ? Side::left : Side::right];
    own.insert(own.end(), muscle.position_m[frame].begin(), muscle.position_m[frame].end());
  }
  return muscles;
}

void add_muscles(const WalkRecording& recording, std::size_t frame, const Vec3<float>& shift, RecordedScene& scene) {
  for (const RecordedMuscle& muscle : recording.muscles) {
    scene.placement.push_back({.position = shift});
    scene.meshes.push_back({.position = muscle.position_m[frame],
                            .triangle = muscle.triangle,
                            .colour = display_colour(muscle.colour),
                            .tissue = muscle.tissue,
                            .fibres = muscle.fibres,
                            .wetness = 0.5F,
                            .placement = {&scene.placement.back(), 1}});
  }
}

}  // namespace mobil
