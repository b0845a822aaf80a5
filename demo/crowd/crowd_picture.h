#pragma once
// Pictures of a crowd: dressed people, and the muscles and bones of the legs of those in front. Exports of a crowd as a
// scene for other programs: all people dressed and walking.

#include <map>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/systems/render/image.h>
#include <mobil/systems/render/scene.h>
#include "demo/crowd/crowd_scene.h"
#include "demo/walk/figure.h"

namespace mobil {

/// Bones and muscles of the legs of people near the camera.
class CrowdLegs {
 public:
  /// Returns one frame of the person's current state, valid until the next call with this number. Errors: those of
  /// make_figure; a person who has left.
  Result<const WalkRecording*> of(const Simulation& simulation, Entity person, std::uint64_t number);
  /// Frees the surfaces of the person with this number.
  void forget(std::uint64_t number) { shown_.erase(number); }

 private:
  struct Shown {
    Figure figure;
    WalkRecording recording;
  };
  std::map<std::uint64_t, Shown> shown_;
};

/// Packs the first frame with its bones and muscles, and unpacks the bytes of another rank. Errors: inconsistent bytes.
std::vector<std::byte> pack_legs(const WalkRecording& legs);
Result<WalkRecording> unpack_legs(std::span<const std::byte> bytes);

/// A person in a picture; plain data, which can come from another process.
struct PicturedPerson {
  std::uint64_t number = 0;
  float distance_m = 0;
  std::uint32_t near = 0;  // 1: bones and muscles of the legs are drawn, if among the nearest
  float height_m = 0, mass_kg = 0;
  std::uint32_t sex = 0;
  float age_y = 0;
  Pose<float> pose{};
};
/// Sorts people into drawing order: near ones first, then by distance. The initial order has no effect.
void arrange(std::vector<PicturedPerson>& seen);
/// Maximum number of people whose bones and muscles are drawn, the first of the near ones.
inline constexpr std::size_t max_legs = 64;

/// Returns a camera behind and above the viewer (CrowdScene::viewer_m) of a crowd on a square of that side.
Camera crowd_camera(double side_m);

class CrowdCamera {
 public:
  /// Creates a camera for pictures of that size, pixels. Errors: a size out of range (Renderer::create), no driver.
  static Result<CrowdCamera> create(int width = usual_width, int height = usual_height);
  CrowdCamera(CrowdCamera&&) noexcept;
  CrowdCamera& operator=(CrowdCamera&&) noexcept;
  ~CrowdCamera();

  static constexpr int usual_width = 1920, usual_height = 1080;

  /// Takes a picture of the crowd's current state with `crowd_camera`. Errors: those of the driver.
  Result<void> take(const CrowdScene& scene, Image& image);
  /// A person to be drawn. Bones and muscles of the legs show through the skin of the nearest people who are `near`.
  struct Drawn {
    Entity entity;
    std::uint64_t number;
    bool near;
  };
  Result<void> take(const Simulation& simulation, const Camera& camera, std::span<const Drawn> people, Image& image);
  /// Returns the people who are in a picture of that size, unsorted.
  static std::vector<PicturedPerson> see(const Simulation& simulation, const Camera& camera,
                                         std::span<const Drawn> people, int width = usual_width,
                                         int height = usual_height);
  /// Draws people in the given order. `legs`: recordings of the people whose bones and muscles are drawn, by number.
  using Legs = std::map<std::uint64_t, const WalkRecording*>;
  Result<void> draw(const Camera& camera, std::span<const PicturedPerson> seen, const Legs& legs, Image& image);
  /// Sets the surroundings of all further pictures, which replace the plane with its grid. They must outlive its use.
  void set_backdrop(std::span<const DrawMesh> meshes, std::span<const DrawLines> lines);
  /// Frees the surfaces of the person with this number.
  void forget(std::uint64_t number);

 private:
  struct Parts;
  explicit CrowdCamera(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// Maximum number of poses in a recording, 1.3 kB each.
inline constexpr std::size_t max_recorded_poses = 800'000;

/// Checks the names of files for a crowd. Errors: an ending other than .glb or .usda, a name given twice, a path that
/// cannot be written.
Result<void> check_crowd_exports(const std::vector<std::filesystem::path>& files);

/// Records all people for the next `seconds` at 30 frames per second, while the crowd walks on. People are named
/// person_NUMBER, by their number in the crowd, and must not be despawned until it returns. Errors: those of the
/// simulation.
Result<CrowdRecording> record_crowd(CrowdScene& scene, double seconds, const CrowdScene::Progress& progress = {});

/// Writes the recording to each file. Errors begin with the option.
Result<void> write_crowd_exports(const CrowdRecording& recording, const std::vector<std::filesystem::path>& files);

}  // namespace mobil
