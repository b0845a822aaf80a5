#include "systems/render/shader_program.h"

#include <GLES3/gl3.h>
#include <fmt/format.h>

#include <array>
#include <string_view>

namespace mobil::inline v0_3 {
namespace {

tl::unexpected<Error> refused(const char* name, const char* step, const char* log) {
  const std::string_view said(log);
  return fail(
      fmt::format("the graphics driver refuses to {} the {} program: {}; a newer driver may help "
                  "(apt-get install libgl1-mesa-dri)",
                  step, name, said.substr(0, said.find('\n'))));
}

Result<GLuint> compile(const char* name, GLenum stage, const std::string& source) {
  const GLuint shader = glCreateShader(stage);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint done = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (done == GL_TRUE) return shader;
  std::array<char, 1024> log{};
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  glDeleteShader(shader);
  return refused(name, "compile", log.data());
}

}  // namespace

Result<ShaderProgram> make_program(const char* name, const std::string& vertex_source,
                                   const std::string& fragment_source) {
  const auto vertex = compile(name, GL_VERTEX_SHADER, vertex_source);
  if (!vertex) return tl::unexpected(vertex.error());
  const auto fragment = compile(name, GL_FRAGMENT_SHADER, fragment_source);
  if (!fragment) return tl::unexpected(fragment.error());
  ShaderProgram program;
  program.id = glCreateProgram();
  glAttachShader(program.id, *vertex);
  glAttachShader(program.id, *fragment);
  glLinkProgram(program.id);
  glDeleteShader(*vertex);
  glDeleteShader(*fragment);
  GLint done = GL_FALSE;
  glGetProgramiv(program.id, GL_LINK_STATUS, &done);
  if (done != GL_TRUE) {
    std::array<char, 1024> log{};
    glGetProgramInfoLog(program.id, static_cast<GLsizei>(log.size()), nullptr, log.data());
    return refused(name, "link", log.data());
  }
  glUseProgram(program.id);
  const GLuint block = glGetUniformBlockIndex(program.id, "Frame");
  if (block != GL_INVALID_INDEX) glUniformBlockBinding(program.id, block, 0);
  const GLint shadow_map = glGetUniformLocation(program.id, "shadow_map");
  if (shadow_map >= 0) glUniform1i(shadow_map, 0);
  program.albedo = glGetUniformLocation(program.id, "albedo");
  program.tendon_albedo = glGetUniformLocation(program.id, "tendon_albedo");
  program.fibres = glGetUniformLocation(program.id, "fibres");
  program.outward = glGetUniformLocation(program.id, "outward");
  program.opacity = glGetUniformLocation(program.id, "opacity");
  program.width = glGetUniformLocation(program.id, "width");
  program.radius = glGetUniformLocation(program.id, "radius");
  return program;
}

}  // namespace mobil::inline v0_3
