#include <mobil/renderer.h>

#include <GLES3/gl3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <mobil/systems/render/shaders.h>
#include <mobil/view.h>
#include "systems/render/gl_context.h"
#include "systems/render/mesh_store.h"
#include "systems/render/render_targets.h"
#include "systems/render/shader_program.h"

namespace mobil::inline v0_3 {
using namespace capture_math;
using namespace geometry;
namespace {

constexpr int largest_picture = 8192;

/// Columns of a placement's 4×3 matrix.
using PlacementColumns = std::array<Vec3<float>, 4>;

PlacementColumns columns(const Placement& p) {
  const auto axis = geometry::columns(p.rotation);
  return {p.scale.x * axis[0], p.scale.y * axis[1], p.scale.z * axis[2], p.position};
}

/// Converts an sRGB colour to linear light, approximately.
Colour linear(Colour encoded) {
  const auto light = [](float value) { return std::pow(std::clamp(value, 0.0F, 1.0F), 2.2F); };
  return {light(encoded.red), light(encoded.green), light(encoded.blue)};
}

/// A mesh with its copies: first those with unchanged winding, then the mirrored ones.
struct MeshDraw {
  StoredMesh mesh;
  const DrawMesh* asked;
  std::size_t first_placement;
  int upright, mirrored;
};

const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);  // NOLINT: as OpenGL wants it
}

/// Reads an attribute from the bound buffer; integers become 0 to 1.
void attribute(unsigned location, int size, std::size_t stride, std::size_t at, unsigned divisor,
               GLenum type = GL_FLOAT) {
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, size, type, GL_TRUE, static_cast<GLsizei>(stride), offset(at));
  glVertexAttribDivisor(location, divisor);
}

void set_albedo(const ShaderProgram& program, Colour colour, float wetness) {
  const Colour light = linear(colour);
  glUniform4f(program.albedo, light.red, light.green, light.blue, std::clamp(wetness, 0.0F, 1.0F));
}

}  // namespace

struct Renderer::Device {
  int width = 0, height = 0;
  std::string driver;
  GlContext context;
  ShaderProgram mesh, mesh_depth, wireframe, line, line_depth, point, point_depth, ground, background;
  RenderTargets targets;
  MeshStore store;
  GLuint vertex_array = 0, placement_buffer = 0, mark_buffer = 0;
  std::array<GLuint, 2> frame_buffer{};  // the camera's block and the lamp's
  std::vector<PlacementColumns> placements;
  std::vector<Vec3<float>> marks;  // ends of lines, then centres of points
  std::vector<MeshDraw> draws;
  Box casters;

  Result<void> prepare();
  Result<void> collect(const Scene& scene);
  void draw_mesh(const MeshDraw& draw, const ShaderProgram& program) const;
  void draw_meshes(bool depth_only) const;
  void draw_marks(const Scene& scene, bool depth_only) const;
  void draw_shadows(const Scene& scene) const;
  void draw_picture(const Scene& scene) const;
  void read(Image& image) const;
};

Result<void> Renderer::Device::prepare() {
  const struct {
    ShaderProgram& program;
    const char* name;
    std::string vertex, fragment;
  } programs[] = {
      {mesh, "mesh", mesh_vertex_source(), mesh_fragment_source()},
      {mesh_depth, "mesh shadow", mesh_vertex_source(), depth_fragment_source()},
      {wireframe, "wireframe", mesh_vertex_source(), wireframe_fragment_source()},
      {line, "line", line_vertex_source(), line_fragment_source()},
      {line_depth, "line shadow", line_vertex_source(), depth_fragment_source()},
      {point, "point", point_vertex_source(), point_fragment_source()},
      {point_depth, "point shadow", point_vertex_source(), depth_fragment_source()},
      {ground, "ground", ground_vertex_source(), ground_fragment_source()},
      {background, "background", background_vertex_source(), background_fragment_source()},
  };
  for (const auto& [program, name, vertex, fragment] : programs) {
    auto made = make_program(name, vertex, fragment);
    if (!made) return tl::unexpected(made.error());
    program = *made;
  }
  auto made = make_render_targets(width, height);
  if (!made) return tl::unexpected(made.error());
  targets = *made;
  store.create_buffers();
  glGenVertexArrays(1, &vertex_array);
  glGenBuffers(1, &placement_buffer);
  glGenBuffers(1, &mark_buffer);
  glGenBuffers(static_cast<GLsizei>(frame_buffer.size()), frame_buffer.data());
  return {};
}

/// Sends the scene's meshes, copies, lines and points, and computes the box of shadow casters.
Result<void> Renderer::Device::collect(const Scene& scene) {
  store.begin_frame();
  placements.clear();
  marks.clear();
  draws.clear();
  casters = {};
  constexpr Placement here;
  for (const DrawMesh& asked : scene.meshes) {
    const auto stored = store.place(asked);
    if (!stored) return tl::unexpected(stored.error());
    if (stored->count == 0) continue;
    const auto copies = asked.placement.empty() ? std::span<const Placement>(&here, 1) : asked.placement;
    MeshDraw draw{*stored, &asked, placements.size(), 0, 0};
    for (const bool mirrored : {false, true}) {
      for (const Placement& copy : copies) {
        if ((copy.scale.x * copy.scale.y * copy.scale.z < 0) != mirrored) continue;
        ++(mirrored ? draw.mirrored : draw.upright);
        const PlacementColumns& m = placements.emplace_back(columns(copy));
        if (asked.wireframe) continue;
        for (unsigned i = 0; i < 8; ++i) {
          const Vec3<float> p = stored->box.corner(i);
          casters.add(p.x * m[0] + p.y * m[1] + p.z * m[2] + m[3]);
        }
      }
    }
    draws.push_back(draw);
  }
  for (const DrawLines& lines : scene.lines) {
    if (lines.position.size() % 2 != 0) {
      return fail(fmt::format("lines to draw have {} ends; give two for each line", lines.position.size()));
    }
    marks.insert(marks.end(), lines.position.begin(), lines.position.end());
    for (const auto& p : lines.position) casters.add(p, 0.02F);
  }
  for (const DrawPoints& points : scene.points) {
    marks.insert(marks.end(), points.position.begin(), points.position.end());
    for (const auto& p : points.position) casters.add(p, points.radius_m);
  }
  store.send_stream();
  glBindBuffer(GL_ARRAY_BUFFER, placement_buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(placements.size() * sizeof(PlacementColumns)),
               placements.data(), GL_STREAM_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, mark_buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(marks.size() * sizeof(Vec3<float>)), marks.data(),
               GL_STREAM_DRAW);
  return {};
}

void Renderer::Device::draw_mesh(const MeshDraw& draw, const ShaderProgram& program) const {
  glBindBuffer(GL_ARRAY_BUFFER, draw.mesh.vertex_buffer);
  attribute(at_position, 3, sizeof(Vec3<float>), draw.mesh.position_at, 0);
  attribute(at_normal, 3, sizeof(Vec3<float>), draw.mesh.normal_at, 0);
  if (draw.mesh.has_tissue) {
    attribute(at_tissue, 4, sizeof(Tissue), draw.mesh.tissue_at, 0, GL_UNSIGNED_BYTE);
  } else {
    glDisableVertexAttribArray(at_tissue);
    glVertexAttrib4f(at_tissue, 0, 0, 0, 0);
  }
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, draw.mesh.index_buffer);
  glBindBuffer(GL_ARRAY_BUFFER, placement_buffer);
  const bool flip = draw.asked->flip;
  if (program.outward >= 0) glUniform1f(program.outward, flip ? -1.0F : 1.0F);
  if (program.opacity >= 0) glUniform1f(program.opacity, draw.asked->opacity);
  if (program.albedo >= 0) set_albedo(program, draw.asked->colour, draw.asked->wetness);
  const Colour tendon = linear(draw.asked->tendon_colour);
  if (program.tendon_albedo >= 0) glUniform3f(program.tendon_albedo, tendon.red, tendon.green, tendon.blue);
  const FibreScale fibres = draw.mesh.has_tissue ? draw.asked->fibres : FibreScale{};
  if (program.fibres >= 0) glUniform3f(program.fibres, fibres.length_m, 0.5F * fibres.girth_m, fibres.pennation_rad);
  std::size_t first = draw.first_placement;
  for (const bool mirrored : {false, true}) {
    const int copies = mirrored ? draw.mirrored : draw.upright;
    if (copies == 0) continue;
    for (unsigned column = 0; column < 4; ++column) {
      attribute(at_placement + column, 3, sizeof(PlacementColumns),
                first * sizeof(PlacementColumns) + column * sizeof(Vec3<float>), 1);
    }
    first += static_cast<std::size_t>(copies);
    glFrontFace(flip != mirrored ? GL_CW : GL_CCW);
    if (draw.asked->wireframe) {
      glDrawArraysInstanced(GL_TRIANGLES, 0, draw.mesh.count, copies);
    } else {
      glDrawElementsInstanced(GL_TRIANGLES, draw.mesh.count, GL_UNSIGNED_INT, offset(draw.mesh.index_at), copies);
    }
  }
}

void Renderer::Device::draw_meshes(bool depth_only) const {
  const ShaderProgram& solid = depth_only ? mesh_depth : mesh;
  glUseProgram(solid.id);
  glEnable(GL_CULL_FACE);
  for (const MeshDraw& draw : draws) {
    if (!draw.asked->wireframe && (depth_only || draw.asked->opacity >= 1)) draw_mesh(draw, solid);
  }
  if (!depth_only) {
    // Layers of equal opacity cover the same samples of a pixel, so only the nearest of them is visible.
    glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    for (const MeshDraw& draw : draws) {
      if (!draw.asked->wireframe && draw.asked->opacity < 1) draw_mesh(draw, solid);
    }
    glDisable(GL_CULL_FACE);
    glUseProgram(wireframe.id);
    for (const MeshDraw& draw : draws) {
      if (draw.asked->wireframe) draw_mesh(draw, wireframe);
    }
    glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  }
  glDisable(GL_CULL_FACE);
  for (unsigned location = 0; location < at_placement + 4; ++location) glDisableVertexAttribArray(location);
  glDisableVertexAttribArray(at_tissue);
}

void Renderer::Device::draw_marks(const Scene& scene, bool depth_only) const {
  glBindBuffer(GL_ARRAY_BUFFER, mark_buffer);
  std::size_t at = 0;
  const ShaderProgram& tube = depth_only ? line_depth : line;
  glUseProgram(tube.id);
  for (const DrawLines& lines : scene.lines) {
    attribute(at_line_from, 3, 2 * sizeof(Vec3<float>), at, 1);
    attribute(at_line_to, 3, 2 * sizeof(Vec3<float>), at + sizeof(Vec3<float>), 1);
    at += lines.position.size_bytes();
    if (tube.albedo >= 0) set_albedo(tube, lines.colour, 0);
    const bool metres = lines.unit == LineUnit::metre;
    glUniform2f(tube.width, metres ? lines.width : 0, metres ? 0 : lines.width);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, line_vertices, static_cast<GLsizei>(lines.position.size() / 2));
  }
  glDisableVertexAttribArray(at_line_from);
  glDisableVertexAttribArray(at_line_to);
  const ShaderProgram& ball = depth_only ? point_depth : point;
  glUseProgram(ball.id);
  for (const DrawPoints& points : scene.points) {
    attribute(at_centre, 3, sizeof(Vec3<float>), at, 1);
    at += points.position.size_bytes();
    if (ball.albedo >= 0) set_albedo(ball, points.colour, 0);
    glUniform1f(ball.radius, points.radius_m);
    glDrawArraysInstanced(GL_TRIANGLE_FAN, 0, point_vertices, static_cast<GLsizei>(points.position.size()));
  }
  glDisableVertexAttribArray(at_centre);
}

void Renderer::Device::draw_shadows(const Scene& scene) const {
  glBindFramebuffer(GL_FRAMEBUFFER, targets.shadow);
  glViewport(0, 0, shadow_map_size, shadow_map_size);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_buffer[1]);
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5F, 4);
  draw_meshes(true);
  draw_marks(scene, true);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void Renderer::Device::draw_picture(const Scene& scene) const {
  glBindFramebuffer(GL_FRAMEBUFFER, targets.multisampled);
  glViewport(0, 0, width, height);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_buffer[0]);
  glBindTexture(GL_TEXTURE_2D, targets.shadow_texture);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
  draw_meshes(false);
  draw_marks(scene, false);
  if (scene.ground && scene.camera.eye.y > 0) {
    glUseProgram(ground.id);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  glUseProgram(background.id);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, targets.multisampled);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, targets.resolved);
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void Renderer::Device::read(Image& image) const {
  const std::size_t row = 4 * static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  image.width = width;
  image.height = height;
  image.rgba.resize(row * rows);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, targets.resolved);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  const auto begin = image.rgba.begin();
  for (std::size_t y = 0; y < rows / 2; ++y) {
    const auto top = begin + static_cast<std::ptrdiff_t>(y * row);
    std::swap_ranges(top, top + static_cast<std::ptrdiff_t>(row),
                     begin + static_cast<std::ptrdiff_t>((rows - 1 - y) * row));
  }
}

Renderer::Renderer(std::unique_ptr<Device> device) : device_(std::move(device)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Result<Renderer> Renderer::create(int width, int height) {
  if (width < 1 || height < 1 || width > largest_picture || height > largest_picture) {
    return fail(fmt::format("a picture of {} x {} pixels was asked for; each side must lie within 1-{}", width, height,
                            largest_picture));
  }
  auto device = std::make_unique<Device>();
  auto context = GlContext::create();
  if (!context) return tl::unexpected(context.error());
  device->context = std::move(*context);
  device->width = width;
  device->height = height;
  const CurrentContext current(device->context);
  if (!current) return fail("the graphics driver does not let go of its context; render on one thread at a time");
  device->driver = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (const auto prepared = device->prepare(); !prepared) return tl::unexpected(prepared.error());
  return Renderer(std::move(device));
}

Result<void> Renderer::render(const Scene& scene, Image& image) {
  Device& d = *device_;
  const CurrentContext current(d.context);
  if (!current) return fail("the renderer is in use on another thread; render on one thread at a time");
  glBindVertexArray(d.vertex_array);
  if (auto collected = d.collect(scene); !collected) return collected;
  const auto blocks = frame_blocks(scene, d.width, d.height, d.casters);
  if (!blocks) return tl::unexpected(blocks.error());
  const std::array<const FrameBlock*, 2> sources = {&blocks->camera, &blocks->lamp};
  for (std::size_t i = 0; i < sources.size(); ++i) {
    glBindBuffer(GL_UNIFORM_BUFFER, d.frame_buffer[i]);
    glBufferData(GL_UNIFORM_BUFFER, sizeof(FrameBlock), sources[i], GL_STREAM_DRAW);
  }
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  if (blocks->shadows) d.draw_shadows(scene);
  d.draw_picture(scene);
  d.read(image);
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    return fail(fmt::format("the graphics driver {} gave up on a picture (OpenGL error {:#x}); draw less at once",
                            d.driver, error));
  }
  return {};
}

Result<Image> Renderer::render(const Scene& scene) {
  Image image;
  if (const auto rendered = render(scene, image); !rendered) return tl::unexpected(rendered.error());
  return image;
}

void Renderer::forget(std::uint64_t key) {
  const CurrentContext current(device_->context);
  if (current) device_->store.forget(key);
}

const char* Renderer::driver() const {
  return device_->driver.c_str();
}

}  // namespace mobil::inline v0_3
