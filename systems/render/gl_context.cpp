#include "systems/render/gl_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstring>

namespace mobil::inline v0_3 {
namespace {

template <class Function>
Function entry_point(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// Returns an OpenGL ES 3 context of that display, or null.
EGLContext context_of(EGLDisplay display) {
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) return EGL_NO_CONTEXT;
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  if (extensions == nullptr || std::strstr(extensions, "EGL_KHR_surfaceless_context") == nullptr) return EGL_NO_CONTEXT;
  constexpr std::array<EGLint, 5> wanted = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint found = 0;
  if (eglChooseConfig(display, wanted.data(), &config, 1, &found) == EGL_FALSE || found == 0) return EGL_NO_CONTEXT;
  const EGLenum api_before = eglQueryAPI();
  if (eglBindAPI(EGL_OPENGL_ES_API) == EGL_FALSE) return EGL_NO_CONTEXT;
  constexpr std::array<EGLint, 3> version = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version.data());
  eglBindAPI(api_before);
  return context;
}

/// Available EGL devices.
struct Devices {
  std::array<EGLDeviceEXT, 16> device{};
  std::array<bool, 16> is_software{};
  std::size_t count = 0;
};
Devices all_devices() {
  Devices all;
  const auto query_devices = entry_point<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto query_string = entry_point<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  EGLint count = 0;
  if (query_devices == nullptr ||
      query_devices(static_cast<EGLint>(all.device.size()), all.device.data(), &count) == EGL_FALSE)
    return all;
  all.count = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < all.count; ++i) {
    const char* const extensions = query_string == nullptr ? nullptr : query_string(all.device[i], EGL_EXTENSIONS);
    all.is_software[i] = extensions != nullptr && std::strstr(extensions, "EGL_MESA_device_software") != nullptr;
  }
  return all;
}

}  // namespace

Result<GlContext> GlContext::create() {
  GlContext made;
  const auto try_display = [&](EGLDisplay display) {
    GlContext candidate;
    candidate.context_ = context_of(display);
    candidate.display_ = display;
    if (candidate.context_ == EGL_NO_CONTEXT || !CurrentContext(candidate)) return false;
    made = std::move(candidate);
    return true;
  };
  const auto platform_display = entry_point<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (platform_display != nullptr) {
    const Devices devices = all_devices();
    for (std::size_t i = 0; i < devices.count; ++i)  // hardware first
      if (!devices.is_software[i] && try_display(platform_display(EGL_PLATFORM_DEVICE_EXT, devices.device[i], nullptr)))
        return made;
    if (try_display(platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr))) return made;
    for (std::size_t i = 0; i < devices.count; ++i)
      if (devices.is_software[i] && try_display(platform_display(EGL_PLATFORM_DEVICE_EXT, devices.device[i], nullptr)))
        return made;
  }
  if (try_display(eglGetDisplay(EGL_DEFAULT_DISPLAY))) return made;
  return fail(
      "cannot render pictures: no OpenGL ES 3 driver answers through EGL (tried devices, surfaceless, default "
      "display); "
      "a software one comes with: apt-get install libegl1 libgl1-mesa-dri");
}

GlContext::~GlContext() {
  if (context_ != nullptr) eglDestroyContext(display_, context_);
}

CurrentContext::CurrentContext(const GlContext& context)
    : display_(context.display_),
      before_display_(eglGetCurrentDisplay()),
      before_context_(eglGetCurrentContext()),
      before_draw_(eglGetCurrentSurface(EGL_DRAW)),
      before_read_(eglGetCurrentSurface(EGL_READ)),
      current_(eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_) != EGL_FALSE) {}

CurrentContext::~CurrentContext() {
  if (!current_) return;
  if (before_context_ == EGL_NO_CONTEXT) {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  } else {
    eglMakeCurrent(before_display_, before_draw_, before_read_, before_context_);
  }
}

}  // namespace mobil::inline v0_3
