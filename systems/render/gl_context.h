#pragma once
// An OpenGL ES 3 context without a window.

#include <utility>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Owns one context, and all OpenGL objects made in it. The display is shared by the whole process and stays
/// initialised, because EGL does not count its users.
class GlContext {
 public:
  /// Creates a context on the first available of: EGL devices with hardware rendering, Mesa's surfaceless platform,
  /// devices with software rendering, the default display. Errors: no driver.
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

/// Makes a context current on this thread for a scope, then restores the previous one.
class CurrentContext {
 public:
  explicit CurrentContext(const GlContext& context);
  ~CurrentContext();
  CurrentContext(const CurrentContext&) = delete;
  CurrentContext& operator=(const CurrentContext&) = delete;

  /// Returns false if another thread has the context, or the driver refuses.
  explicit operator bool() const { return current_; }

 private:
  void *display_, *before_display_, *before_context_, *before_draw_, *before_read_;
  bool current_;
};

}  // namespace mobil::inline v0_3
