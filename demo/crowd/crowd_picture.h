#pragma once
// A crowd as pictures: people with their skin and clothes; of those in front the legs' muscles and bones are seen
// through it.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "demo/crowd/crowd_scene.h"
#include "engine/error.h"
#include "systems/capture/image.h"
#include "systems/capture/scene.h"

namespace mobil {

class CrowdCamera {
 public:
  /// Errors: a size out of range (Renderer::create), no driver.
  static Result<CrowdCamera> create(int width = 1920, int height = 1080);
  CrowdCamera(CrowdCamera&&) noexcept;
  CrowdCamera& operator=(CrowdCamera&&) noexcept;
  ~CrowdCamera();

  /// The crowd as it is, from behind and above who looks. Errors: a driver that gives up.
  Result<void> take(const CrowdScene& scene, Image& image);
  /// These people from anywhere; of the nearest who are `near` the legs' bones and muscles are seen through the skin.
  struct Drawn {
    Entity entity;
    std::uint64_t number;
    bool near;
  };
  Result<void> take(const Simulation& simulation, const Camera& camera, std::span<const Drawn> people, Image& image);
  /// Lets go of the surfaces of who had this number.
  void forget(std::uint64_t number);

 private:
  struct Parts;
  explicit CrowdCamera(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace mobil
