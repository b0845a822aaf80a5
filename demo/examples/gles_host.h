#pragma once
// A host's renderer, independent of mobil: a context, shader programs, buffers, and a picture of 960 by 540 pixels.

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace own {

constexpr int wide = 960, high = 540;

[[noreturn]] inline void give_up(const char* why) {
  std::fprintf(stderr, "%s\n", why);
  std::exit(2);
}

/// Opens an OpenGL ES 3 context without a window, which draws into its own picture.
inline void open_context() {
  const auto of_platform =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (of_platform == nullptr) give_up("EGL cannot choose a platform");
  const EGLDisplay display = of_platform(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint found = 0;
  if (eglInitialize(display, nullptr, nullptr) == EGL_FALSE ||
      eglChooseConfig(display, wanted, &config, 1, &found) == EGL_FALSE || found == 0)
    give_up("no OpenGL ES 3 driver; install one: apt-get install libegl1 libgl1-mesa-dri");
  eglBindAPI(EGL_OPENGL_ES_API);
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
  if (context == EGL_NO_CONTEXT || eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE)
    give_up("no context");
  GLuint frame = 0, buffer[2] = {};
  glGenFramebuffers(1, &frame);
  glBindFramebuffer(GL_FRAMEBUFFER, frame);
  glGenRenderbuffers(2, buffer);
  const GLenum format[] = {GL_RGBA8, GL_DEPTH_COMPONENT24}, attachment[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
  for (int i = 0; i < 2; ++i) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer[i]);
    glRenderbufferStorage(GL_RENDERBUFFER, format[i], wide, high);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment[i], GL_RENDERBUFFER, buffer[i]);
  }
  glViewport(0, 0, wide, high);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
}

inline GLuint make_program(const std::string& vertex, const std::string& fragment) {
  const GLuint program = glCreateProgram();
  const std::string head = R"(#version 300 es
precision highp float; precision highp sampler2D;
vec4 seen(vec3 at) { vec3 from = at - vec3(0.5, 0.95, -1.9); return vec4(-1.2 * from.x, 2.1 * from.y, from.z - 0.2, from.z); }
)";
  for (const auto& [kind, body] : {std::pair{GL_VERTEX_SHADER, &vertex}, std::pair{GL_FRAGMENT_SHADER, &fragment}}) {
    const std::string text = head + *body;
    const char* source = text.c_str();
    const GLuint shader = glCreateShader(static_cast<GLenum>(kind));
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    char log[1024] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    if (compiled == GL_FALSE) give_up(log);
    glAttachShader(program, shader);
  }
  glLinkProgram(program);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked == GL_FALSE) give_up("the shaders cannot be linked");
  return program;
}

inline GLuint make_buffer(GLenum target, std::size_t bytes, const void* data) {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(bytes), data, data == nullptr ? GL_STREAM_DRAW : GL_STATIC_DRAW);
  return buffer;
}

/// Converts an offset into a buffer to the pointer that GL requires.
inline const void* at_byte(std::size_t offset) {
  return reinterpret_cast<const void*>(offset);  // NOLINT(performance-no-int-to-ptr)
}

/// Vertices with several numbers each, and triangles.
class Mesh {
 public:
  /// `inputs`: number of components of each vertex shader input, by location. `vertex`: null if vertices are written
  /// every frame.
  Mesh(GLuint program, std::vector<int> inputs, std::size_t vertices, const void* vertex,
       std::span<const std::uint32_t> index)
      : program_(program), inputs_(std::move(inputs)), indices_(static_cast<GLsizei>(index.size())) {
    for (const int count : inputs_) stride_ += static_cast<std::size_t>(count) * sizeof(float);
    bytes_ = vertices * stride_;
    vertices_ = make_buffer(GL_ARRAY_BUFFER, bytes_, vertex);
    triangles_ = make_buffer(GL_ELEMENT_ARRAY_BUFFER, index.size_bytes(), index.data());
  }
  /// Maps the vertices for writing, until `unmap`.
  std::span<std::byte> map() {
    glBindBuffer(GL_ARRAY_BUFFER, vertices_);
    void* at = glMapBufferRange(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(bytes_),
                                GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
    if (at == nullptr) give_up("no memory for the vertices");
    return {static_cast<std::byte*>(at), bytes_};
  }
  void unmap() { glUnmapBuffer(GL_ARRAY_BUFFER); }
  void use() const {
    glUseProgram(program_);
    glBindBuffer(GL_ARRAY_BUFFER, vertices_);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_);
    std::size_t offset = 0;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const auto slot = static_cast<GLuint>(i);
      glEnableVertexAttribArray(slot);
      glVertexAttribPointer(slot, inputs_[i], GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride_), at_byte(offset));
      offset += static_cast<std::size_t>(inputs_[i]) * sizeof(float);
    }
  }
  GLint uniform(const char* name) const { return glGetUniformLocation(program_, name); }
  static void draw(std::size_t first, std::size_t count) {
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count), GL_UNSIGNED_INT, at_byte(first * sizeof(std::uint32_t)));
  }
  void draw_copies(std::size_t copies) const {
    glDrawElementsInstanced(GL_TRIANGLES, indices_, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(copies));
  }

 private:
  GLuint program_, vertices_ = 0, triangles_ = 0;
  std::vector<int> inputs_;
  std::size_t stride_ = 0, bytes_ = 0;
  GLsizei indices_;
};

/// Makes a table with four numbers per cell, which the vertex shader reads.
inline void make_table(std::size_t columns, std::size_t rows) {
  GLuint table = 0;
  glGenTextures(1, &table);
  glBindTexture(GL_TEXTURE_2D, table);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, static_cast<GLsizei>(columns), static_cast<GLsizei>(rows));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}
inline void fill_table(std::size_t columns, std::size_t rows, const void* numbers) {
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, static_cast<GLsizei>(columns), static_cast<GLsizei>(rows), GL_RGBA, GL_FLOAT,
                  numbers);
}

/// Writes the picture as a PPM file if there is a path. Returns the fraction of the picture that is not background.
inline double save_picture(const char* path) {
  std::vector<unsigned char> pixel(4 * wide * high), row(3 * wide);
  glReadPixels(0, 0, wide, high, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
  std::FILE* file = path == nullptr ? nullptr : std::fopen(path, "wb");
  if (path != nullptr && file == nullptr) give_up("the picture cannot be written");
  if (file != nullptr) std::fprintf(file, "P6\n%d %d\n255\n", wide, high);
  std::size_t drawn = 0;
  for (std::size_t y = high; y-- > 0;) {
    for (std::size_t x = 0; x < wide; ++x) {
      const unsigned char* p = &pixel[4 * (y * wide + x)];
      drawn += p[3] != 0 ? 1 : 0;
      for (std::size_t c = 0; c < 3; ++c) row[3 * x + c] = p[c];
    }
    if (file != nullptr) std::fwrite(row.data(), 1, row.size(), file);
  }
  if (file != nullptr) std::fclose(file);
  return static_cast<double>(drawn) / (wide * high);
}

}  // namespace own
