#pragma once
// Pictures of the town and its people. The camera is above the town, or goes along beside the person on the tour.

#include <vector>

#include <mobil/engine/error.h>
#include "demo/crowd/crowd_picture.h"
#include "demo/town/town_map.h"
#include "demo/town/town_scene.h"

namespace mobil {

enum class TownView { follow, above };

class TownCamera {
 public:
  /// Errors: a size out of range, no driver.
  static Result<TownCamera> create(int width, int height, TownView view);

  /// Goes along, once a picture; a little late, so that it sways less than who is followed.
  void follow(const TownScene& scene);
  /// Errors: a driver that fails.
  Result<void> take(const TownScene& scene, Image& image);

 private:
  TownCamera(CrowdCamera camera, TownView view);

  CrowdCamera people_;
  TownView view_;
  Camera camera_;
  bool looks_ = false;
  std::vector<TownMesh> town_;
  std::vector<Vec3<float>> paving_;
  std::vector<DrawMesh> meshes_;
  std::vector<DrawLines> lines_;
};

}  // namespace mobil
