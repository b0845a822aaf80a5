#pragma once
// Renders pictures without a window by OpenGL ES 3 and EGL, on a graphics card or in software.

#include <cstdint>
#include <memory>

#include <mobil/engine/error.h>
#include <mobil/systems/render/image.h>
#include <mobil/systems/render/scene.h>

namespace mobil::inline v0_3 {

/// Renders scenes at one picture size with four samples a pixel. It has no global state, and several renderers can
/// exist. Any thread can use a renderer, one at a time. On one machine and driver equal scenes give equal pictures.
class Renderer {
 public:
  /// Creates a renderer. Width and height are in pixels, 1–8192. Errors: a size out of range, no driver (with the
  /// packages to install).
  static Result<Renderer> create(int width, int height);

  /// Renders a scene into the caller's picture and reuses its memory. Errors: an invalid mesh (an index out of range, a
  /// number of indices that is not a multiple of three) or camera, a failure of the driver.
  Result<void> render(const Scene& scene, Image& image);
  Result<Image> render(const Scene& scene);

  /// Frees the mesh with this key (DrawMesh::key). The next mesh with it is sent again.
  void forget(std::uint64_t key);

  /// Returns the driver's name, for reports.
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
