#pragma once
// A person's skin and clothes, and a recorded walk, as a renderer draws them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/assets/surfaces/custom_skin.h>
#include <mobil/components/pose.h>
#include <mobil/systems/render/scene.h>
#include <mobil/systems/surfaces/place_skin.h>

namespace mobil {

/// Of each SkinPart.
using SkinColours = std::array<Colour, skin_parts>;
/// Skin, hair and clothes that a number chooses, as people vary.
SkinColours skin_colours(std::uint64_t number);
/// From sRGB as shown to linear as files store it.
Vec3<float> linear_colour(const Colour& shown);
/// The same colour everywhere, as of a body without clothes.
SkinColours bare_colours();

/// The same of each part.
constexpr std::array<float, skin_parts> opacity_of(float share) {
  std::array<float, skin_parts> all{};
  all.fill(share);
  return all;
}

/// Muscles' vertices of the right leg and the left one, world, m.
using LegVertices = std::array<std::vector<Vec3<float>>, 2>;

/// Of a right leg's, and of their mirror images.
LegVertices legs_at_rest(std::span<const Vec3<float>> right_m);

struct DrawnSkin {
  const BodySkin* skin = nullptr;  // as in SkinShape
  float lengths = 1;
  SkinColours colours{};
  std::array<float, skin_parts> opacity = opacity_of(1);
  std::vector<Vec3<float>> position{}, normal{};
  std::optional<CustomSkin> own{};  // the legs', in their place, and what it moves with
  std::optional<BodySkin> bare{};
  std::vector<Vec3<float>> own_position{}, own_normal{};

  /// Legs are drawn as these meshes of right legs (bind_custom_skin). `rest_m`: of the right leg's muscles. `body`:
  /// whose skin it is. `shorts_stay`: as there.
  Result<void> follow(const Body& body, std::span<const SurfaceMesh> legs, std::span<const Vec3<float>> rest_m,
                      bool shorts_stay);
  /// `muscles`: of the right and the left leg, as they are drawn in that pose; the skin covers them. `fat`: what
  /// wobbles.
  void pose(const Pose<float>& pose, const LegVertices& muscles = {}, const FatBeside* fat = nullptr);
  /// One mesh a part; good until the next `pose`.
  void draw(std::vector<DrawMesh>& out) const;
};

/// Meshes that look into recordings, and the placements that they look at.
struct RecordedScene {
  std::vector<DrawMesh> meshes;
  std::deque<Placement> placement;
};

/// Adds the bones of a frame, moved by `shift`. `first_key`: bone i is sent to the device once, as this + i; 0 for each
/// time.
void add_bones(const WalkRecording& recording, std::size_t frame, const Vec3<float>& shift, std::uint64_t first_key,
               RecordedScene& scene);

/// A frame's muscles.
LegVertices muscles_of(const WalkRecording& recording, std::size_t frame);
/// Adds the muscles of a frame, moved by `shift`.
void add_muscles(const WalkRecording& recording, std::size_t frame, const Vec3<float>& shift, RecordedScene& scene);

}  // namespace mobil
