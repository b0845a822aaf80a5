#pragma once
// An OpenGL ES 3 context without a window.

#include <utility>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Owns one context; every OpenGL object made in it goes with it. The display is shared by the whole process and stays
/// initialised, since EGL does not count its users.
class GlContext {
 public:
  /// Tries each EGL device that draws in hardware, then Mesa's surfaceless platform, devices in software, and the
  /// default display. Error: no driver answers.
  static Result<GlContext> create();

  GlContext() = default;
  GlContext(GlContext&& other) noexcept { swap(other); }
  GlContext& operator=(GlContext&& other) noexcept {
    swap(other);
    return *this;
  }
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
  ~GlContext();

 private:
  friend class CurrentContext;
  void swap(GlContext& other) noexcept {
    std::swap(display_, other.display_);
    std::swap(context_, other.context_);
  }

  void* display_ = nullptr;
  void* context_ = nullptr;
};

/// Makes a context current on this thread for a scope and gives the thread back what it had.
class CurrentContext {
 public:
  explicit CurrentContext(const GlContext& context);
  ~CurrentContext();
  CurrentContext(const CurrentContext&) = delete;
  CurrentContext& operator=(const CurrentContext&) = delete;

  /// False where another thread holds the context or the driver refuses.
  explicit operator bool() const { return current_; }

 private:
  void *display_, *before_display_, *before_context_, *before_draw_, *before_read_;
  bool current_;
};

}  // namespace mobil::inline v0_3
