#pragma once
// A person's skin and clothes, and a recorded walk, as meshes for the renderer.

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

/// Colours by SkinPart.
using SkinColours = std::array<Colour, skin_parts>;
/// Returns a variation of skin, hair and clothes, chosen by a number.
SkinColours skin_colours(std::uint64_t number);
/// Converts displayed sRGB to the linear colour of files.
Vec3<float> linear_colour(const Colour& shown);
/// Returns a single skin colour for all parts, for a body without clothes.
SkinColours bare_colours();

/// Returns a single opacity for all parts.
constexpr std::array<float, skin_parts> opacity_of(float share) {
  std::array<float, skin_parts> all{};
  all.fill(share);
  return all;
}

/// Muscle vertices of the right and the left leg, world, m.
using LegVertices = std::array<std::vector<Vec3<float>>, 2>;

/// Returns the vertices of a right leg and their mirror images.
LegVertices legs_at_rest(std::span<const Vec3<float>> right_m);

struct DrawnSkin {
  const BodySkin* skin = nullptr;  // as in SkinShape
  float lengths = 1;
  SkinColours colours{};
  std::array<float, skin_parts> opacity = opacity_of(1);
  std::vector<Vec3<float>> position{}, normal{};
  std::optional<CustomSkin> own{};  // custom skin of the legs, and the skin that it follows
  std::optional<BodySkin> bare{};
  std::vector<Vec3<float>> own_position{}, own_normal{};

  /// Replaces the legs by these meshes of right legs. `body`: the body of this skin. `rest_m`: vertices of the right
  /// leg's muscles at rest. `shorts_stay`: as in bind_custom_skin.
  Result<void> follow(const Body& body, std::span<const SurfaceMesh> legs, std::span<const Vec3<float>> rest_m,
                      bool shorts_stay);
  /// Moves the skin to a pose. `muscles`: leg muscles in that pose, which the skin covers. `fat`: displacement of fat.
  void pose(const Pose<float>& pose, const LegVertices& muscles = {}, const FatBeside* fat = nullptr);
  /// Adds one mesh per part, valid until the next `pose`.
  void draw(std::vector<DrawMesh>& out) const;
};

/// Meshes that refer to recordings, and the placements that they refer to.
struct RecordedScene {
  std::vector<DrawMesh> meshes;
  std::deque<Placement> placement;
};

/// Adds the bones of a frame, moved by `shift`. `first_key`: bone i is uploaded once, under the key `first_key` + i;
/// with 0 bones are uploaded each time.
void add_bones(const WalkRecording& recording, std::size_t frame, const Vec3<float>& shift, std::uint64_t first_key,
               RecordedScene& scene);

/// Returns the muscle vertices of a frame.
LegVertices muscles_of(const WalkRecording& recording, std::size_t frame);
/// Adds the muscles of a frame, moved by `shift`.
void add_muscles(const WalkRecording& recording, std::size_t frame, const Vec3<float>& shift, RecordedScene& scene);

}  // namespace mobil
