#pragma once
// A crowd as pictures: people with their skin and clothes; of those in front the legs' muscles and bones are seen
// through it. A crowd as a scene for other programs: all people dressed, walking.

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
  /// One frame, as the person now is; good until asked for that number again. Errors: what make_figure refuses;
  /// somebody who has left.
  Result<const WalkRecording*> of(const Simulation& simulation, Entity person, std::uint64_t number);
  /// Lets go of the surfaces of who had this number.
  void forget(std::uint64_t number) { shown_.erase(number); }

 private:
  struct Shown {
    Figure figure;
    WalkRecording recording;
  };
  std::map<std::uint64_t, Shown> shown_;
};

/// The first frame, its bones and muscles; and taken out again, where another rank packed them. Errors: bytes that do
/// not agree with themselves.
std::vector<std::byte> pack_legs(const WalkRecording& legs);
Result<WalkRecording> unpack_legs(std::span<const std::byte> bytes);

/// One who is in a picture: plain data, which may come from another process.
struct PicturedPerson {
  std::uint64_t number = 0;
  float distance_m = 0;
  std::uint32_t near = 0;  // of the nearest of these the legs' bones and muscles are seen
  float height_m = 0, mass_kg = 0;
  std::uint32_t sex = 0, spare = 0;
  Pose<float> pose{};
};
/// Who is drawn first, whatever order they were found in: those who are near, then the nearest.
void arrange(std::vector<PicturedPerson>& seen);
/// Of how many at most, the first of who is near, legs are drawn.
inline constexpr std::size_t max_legs = 64;

/// Behind and above the viewer (CrowdScene::viewer_m), over a crowd on a square of that side.
Camera crowd_camera(double side_m);

class CrowdCamera {
 public:
  /// Errors: a size out of range (Renderer::create), no driver.
  static Result<CrowdCamera> create(int width = usual_width, int height = usual_height);
  CrowdCamera(CrowdCamera&&) noexcept;
  CrowdCamera& operator=(CrowdCamera&&) noexcept;
  ~CrowdCamera();

  static constexpr int usual_width = 1920, usual_height = 1080;

  /// The crowd as it is, seen from behind and above the viewer. Errors: a driver that fails.
  Result<void> take(const CrowdScene& scene, Image& image);
  /// These people from anywhere; of the nearest who are `near` the legs' bones and muscles are seen through the skin.
  struct Drawn {
    Entity entity;
    std::uint64_t number;
    bool near;
  };
  Result<void> take(const Simulation& simulation, const Camera& camera, std::span<const Drawn> people, Image& image);
  /// Those of them who are in a picture of that size, in no order.
  static std::vector<PicturedPerson> see(const Simulation& simulation, const Camera& camera,
                                         std::span<const Drawn> people, int width = usual_width,
                                         int height = usual_height);
  /// A picture of them in that order. `legs`: by number, of those whose legs are drawn.
  using Legs = std::map<std::uint64_t, const WalkRecording*>;
  Result<void> draw(const Camera& camera, std::span<const PicturedPerson> seen, const Legs& legs, Image& image);
  /// What stands round the people in all pictures to come, instead of the plane with its grid. It must live until then.
  void set_backdrop(std::span<const DrawMesh> meshes, std::span<const DrawLines> lines);
  /// Lets go of the surfaces of who had this number.
  void forget(std::uint64_t number);

 private:
  struct Parts;
  explicit CrowdCamera(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// Poses that a recording may hold, 1.3 kB each.
inline constexpr std::size_t max_recorded_poses = 800'000;

/// Files that a crowd can be written to, by their ending. Errors: another ending, twice the same name, a place that
/// cannot be written.
Result<void> check_crowd_exports(const std::vector<std::filesystem::path>& files);

/// Records all people for the next `seconds`, as many pictures a second as films have; the crowd walks on. People are
/// called person_NUMBER, by their number in the crowd, and must not be despawned until it returns. Errors: those of the
/// simulation.
Result<CrowdRecording> record_crowd(CrowdScene& scene, double seconds, const CrowdScene::Progress& progress = {});

/// Writes the recording to each file. Errors begin with the option.
Result<void> write_crowd_exports(const CrowdRecording& recording, const std::vector<std::filesystem::path>& files);

}  // namespace mobil
