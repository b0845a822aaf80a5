#include "systems/render/render_targets.h"

#include <GLES3/gl3.h>
#include <fmt/format.h>

#include <algorithm>

namespace mobil::inline v0_3 {
namespace {

GLuint renderbuffer(GLenum format, int samples, int width, int height, GLenum attachment) {
  GLuint buffer = 0;
  glGenRenderbuffers(1, &buffer);
  glBindRenderbuffer(GL_RENDERBUFFER, buffer);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
  return buffer;
}

GLuint framebuffer() {
  GLuint made = 0;
  glGenFramebuffers(1, &made);
  glBindFramebuffer(GL_FRAMEBUFFER, made);
  return made;
}

bool complete() {
  return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

}  // namespace

Result<RenderTargets> make_render_targets(int width, int height) {
  GLint max_samples = 0;
  glGetIntegerv(GL_MAX_SAMPLES, &max_samples);
  const int samples = std::min(4, static_cast<int>(max_samples));
  RenderTargets targets;
  targets.multisampled = framebuffer();
  renderbuffer(GL_RGBA8, samples, width, height, GL_COLOR_ATTACHMENT0);
  renderbuffer(GL_DEPTH_COMPONENT24, samples, width, height, GL_DEPTH_ATTACHMENT);
  bool whole = complete();

  targets.resolved = framebuffer();
  renderbuffer(GL_RGBA8, 0, width, height, GL_COLOR_ATTACHMENT0);
  whole = whole && complete();

  targets.shadow = framebuffer();
  glGenTextures(1, &targets.shadow_texture);
  glBindTexture(GL_TEXTURE_2D, targets.shadow_texture);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_DEPTH_COMPONENT24, shadow_map_size, shadow_map_size);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, targets.shadow_texture, 0);
  constexpr GLenum none = GL_NONE;
  glDrawBuffers(1, &none);
  glReadBuffer(GL_NONE);
  whole = whole && complete();
  if (!whole || glGetError() != GL_NO_ERROR) {
    return fail(fmt::format("the graphics driver cannot hold a picture of {} x {} pixels; ask for a smaller one", width,
                            height));
  }
  return targets;
}

}  // namespace mobil::inline v0_3
