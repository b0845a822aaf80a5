#pragma once
// Pictures without a window: OpenGL ES 3 through EGL, on a graphics card or in software.

#include <cstdint>
#include <memory>

#include <mobil/engine/error.h>
#include <mobil/systems/render/image.h>
#include <mobil/systems/render/scene.h>

namespace mobil::inline v0_3 {

/// Renders scenes of one picture size with four samples a pixel. Holds no global state; several may live side by side.
/// One thread at a time may use a renderer; any thread may. On one machine and driver, the same scene gives the same
/// picture.
class Renderer {
 public:
  /// Width and height in pixels, 1–8192. Errors: size out of range, no driver (with the packages to install).
  static Result<Renderer> create(int width, int height);

  /// Into the caller's picture, whose memory is kept. Errors: an invalid mesh (see MeshStore::place) or camera, a
  /// driver that fails.
  Result<void> render(const Scene& scene, Image& image);
  Result<Image> render(const Scene& scene);

  /// Frees a mesh that was sent under this key (DrawMesh::key); the next one under it is sent anew.
  void forget(std::uint64_t key);

  /// The driver's own name, for reports.
  const char* driver() const;

  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

 private:
  struct Device;
  explicit Renderer(std::unique_ptr<Device> device);
  std::unique_ptr<Device> device_;
};

}  // namespace mobil::inline v0_3
