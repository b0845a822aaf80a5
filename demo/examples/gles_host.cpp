// A host with its own OpenGL ES renderer (gles_host.h). A near person has muscles and bones, with fibres along the
// tangents; far people are figures posed by the vertex shader. With a FILE it writes the last picture (PPM).

#include "demo/examples/gles_host.h"

#include <mobil/engine/world.h>
#include <mobil/far_figure.h>
#include <mobil/pose_writer.h>
#include <mobil/simulation.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>

namespace {

const char* const lit = R"(in vec3 normal, base; out vec4 colour; void main() {
  colour = vec4(base * (0.35 + 0.65 * max(dot(normalize(normal), normalize(vec3(0.5, 0.8, -0.6))), 0.0)), 1); })";
const char* const near_shader = R"(layout(location = 0) in vec3 at; layout(location = 1) in vec3 n;
layout(location = 2) in vec4 t; layout(location = 3) in vec2 place; uniform bool muscle; out vec3 normal, base; void main() {
  normal = muscle ? n + 0.6 * cos(90.0 * place.y) * t.w * cross(n, t.xyz) : n;
  base = muscle ? vec3(0.66, 0.25, 0.22) : vec3(0.85, 0.80, 0.68); gl_Position = seen(at); })";
const char* const far_shader = R"(layout(location = 0) in vec3 at; layout(location = 1) in vec3 n;
layout(location = 2) in vec2 part; uniform sampler2D poses; uniform vec3 size[40]; out vec3 normal, base; void main() {
  vec4 row[3]; vec4 p = vec4(at * size[gl_InstanceID], 1);
  for (int r = 0; r < 3; ++r) row[r] = texelFetch(poses, ivec2(3 * int(part.x) + r, gl_InstanceID), 0);
  normal = vec3(dot(row[0].xyz, n), dot(row[1].xyz, n), dot(row[2].xyz, n));
  base = vec3[4](vec3(0.8, 0.62, 0.5), vec3(0.4, 0.48, 0.56), vec3(0.25, 0.28, 0.35), vec3(0.2))[int(part.y)];
  gl_Position = seen(vec3(dot(row[0], p), dot(row[1], p), dot(row[2], p))); })";

struct NearVertex {
  mobil::Vec3<float> position, normal;
  float tangent[4];
  mobil::TexturePlace place;
};
struct FarInput {
  mobil::Vec3<float> position, normal;
  float segment, part;
};

template <class T>
T need(mobil::Result<T> result) {
  if (!result) own::give_up(result.error().message.c_str());
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

}  // namespace

int main(int arguments, char** argument) {
  mobil::Simulation simulation;
  std::vector<mobil::SpawnRequest> crowd(41);  // one near, with muscles, and forty behind
  crowd[0].muscles.emplace();
  std::vector<mobil::Vec3<float>> size;
  for (std::size_t i = 1; i < crowd.size(); ++i) {
    crowd[i].body = {.height_m = 1.6F + 0.006F * static_cast<float>(i), .mass_kg = static_cast<float>(55 + 7 * i % 40)};
    const std::size_t column = (i - 1) % 8, row = (i - 1) / 8;
    crowd[i].x_m = static_cast<float>(column) - 4;
    crowd[i].z_m = static_cast<float>(row) * 2 + 2;
    size.push_back(mobil::far_scale(crowd[i].body.height_m, crowd[i].body.mass_kg));
  }
  std::vector<mobil::Entity> people(crowd.size());
  need(simulation.spawn(crowd, people));
  const std::span far = std::span(people).subspan(1);

  // Uploaded once.
  own::open_context();
  const mobil::Person person = *simulation.person(people[0]);
  std::vector<mobil::SurfaceMuscle> muscles;
  for (const mobil::PersonMuscle& own : person.muscles) muscles.push_back({own.plan.muscle, own.entity});
  const mobil::BodySurfaces surfaces = need(mobil::bind_surfaces(person.body, {.textured = true}));
  own::Mesh body(own::make_program(near_shader, lit), {3, 3, 4, 2}, surfaces.vertices, nullptr, surfaces.index);
  const mobil::FarFigure figure = mobil::far_figure();
  std::vector<FarInput> input;
  for (const mobil::FarVertex& v : figure.vertex)
    input.push_back({v.position, v.normal, static_cast<float>(v.segment), static_cast<float>(v.part)});
  const own::Mesh figures(own::make_program(far_shader, lit), {3, 3, 2}, input.size(), input.data(), figure.index);
  constexpr std::size_t columns = 3 * mobil::segment_count;
  std::vector<float> matrices(4 * columns * far.size());
  own::make_table(columns, far.size());

  mobil::SurfaceWriter surface_writer;
  mobil::PoseWriter pose_writer;
  for (int frame = 0; frame < 20; ++frame) {
    const double ahead_s = simulation.advance(1.0 / 45).alpha * simulation.tick_s();
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);

    const std::span<std::byte> out = body.map();  // vertices are written directly into it
    const auto stream = [&](std::size_t offset) {
      return mobil::VertexStream{out.subspan(offset), sizeof(NearVertex)};
    };
    mobil::SurfaceRequest request{people[0], muscles, &surfaces, stream(0), stream(offsetof(NearVertex, normal))};
    request.tangents = stream(offsetof(NearVertex, tangent));
    need(surface_writer.write(simulation.world(), {&request, 1}));
    for (std::size_t v = 0; v < surfaces.vertices; ++v)
      reinterpret_cast<NearVertex*>(out.data())[v].place = surfaces.texture[v];
    body.unmap();
    body.use();
    for (const mobil::SurfacePart& part : surfaces.part) {
      glUniform1i(body.uniform("muscle"), part.driver ? 1 : 0);
      own::Mesh::draw(part.first_index, part.indices);
    }

    need(pose_writer.write(simulation.world(), far, ahead_s, {.form = mobil::PoseForm::matrix},
                           {std::as_writable_bytes(std::span(matrices))}));
    own::fill_table(columns, far.size(), matrices.data());
    figures.use();
    glUniform3fv(figures.uniform("size"), static_cast<GLsizei>(size.size()), &size[0].x);
    figures.draw_copies(far.size());
  }
  const double drawn = own::save_picture(arguments > 1 ? argument[1] : nullptr);
  std::printf("%u vertices near, %zu figures of %zu vertices far, %.0f %% of the picture\n", surfaces.vertices,
              far.size(), figure.vertex.size(), 100 * drawn);
  return drawn > 0.1 && glGetError() == GL_NO_ERROR ? 0 : 1;
}
