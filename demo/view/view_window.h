#pragma once
// A window that shows pictures, with Dear ImGui on top. GLFW and OpenGL stand in view_window.cpp alone.

#include <memory>
#include <string>

#include <mobil/engine/error.h>
#include <mobil/systems/render/image.h>

namespace mobil {

/// What the user did to the picture since the last frame.
struct ViewInput {
  float turn_px = 0, tilt_px = 0;  // dragged
  float zoom = 0;                  // steps of the wheel, nearer positive
  bool pause = false, step = false;
};

class ViewWindow {
 public:
  /// Hidden ones are drawn like others, for pictures of them. Errors, in one line: no display, no OpenGL 3.
  static Result<ViewWindow> open(const std::string& title, int width, int height, bool hidden);
  ViewWindow(ViewWindow&&) noexcept;
  ViewWindow& operator=(ViewWindow&&) noexcept;
  ~ViewWindow();

  /// The user wants to close it.
  bool closing() const;
  /// Of the picture area, pixels.
  int width() const;
  int height() const;

  /// Takes what the user did; ImGui calls may follow.
  ViewInput begin_frame();
  /// Shows the picture, stretched to the window, and ImGui's windows on it. `shot`: what the window shows, where asked.
  void end_frame(const Image& picture, Image* shot = nullptr);

 private:
  struct Parts;
  explicit ViewWindow(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace mobil
