#pragma once
// A window that shows pictures, with Dear ImGui on top. Only view_window.cpp includes GLFW and OpenGL.

#include <memory>
#include <string>

#include <mobil/engine/error.h>
#include <mobil/systems/render/image.h>

namespace mobil {

/// The user's input to the picture since the last frame.
struct ViewInput {
  float turn_px = 0, tilt_px = 0;  // dragged
  float zoom = 0;                  // steps of the wheel, positive: nearer
  bool pause = false, step = false;
};

class ViewWindow {
 public:
  /// Opens a window. A hidden one is also drawn, for pictures of it. Errors, in one line: no display, no OpenGL 3.
  static Result<ViewWindow> open(const std::string& title, int width, int height, bool hidden);
  ViewWindow(ViewWindow&&) noexcept;
  ViewWindow& operator=(ViewWindow&&) noexcept;
  ~ViewWindow();

  /// Returns true if the user has requested to close the window.
  bool closing() const;
  /// Return the size of the picture area, pixels.
  int width() const;
  int height() const;

  /// Reads the user's input. ImGui calls can follow.
  ViewInput begin_frame();
  /// Shows the picture, stretched to the window, with ImGui's windows on top. `shot` receives the window's content.
  void end_frame(const Image& picture, Image* shot = nullptr);

 private:
  struct Parts;
  explicit ViewWindow(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace mobil
