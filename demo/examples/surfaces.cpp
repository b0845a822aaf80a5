// People's surfaces in a host's own vertex buffer: two people of unlike bodies walk, who share what was bound once, and
// every frame writes their bones and muscles, positions and normals side by side, as a mapped GPU buffer would take
// them.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <mobil/simulation.h>
#include <mobil/surfaces.h>

namespace {

struct Vertex {
  float position[3], normal[3], texture[2];
};

int failed(const mobil::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 2;
}

}  // namespace

int main() {
  mobil::Simulation simulation;
  const mobil::Jobs jobs{};  // the host's own parallel_for goes here

  mobil::SpawnRequest asked;
  asked.body.height_m = 1.80F;
  asked.body.mass_kg = 80;
  asked.muscles.emplace();
  std::vector<mobil::SpawnRequest> crowd(2, asked);
  crowd[1].x_m = 1;
  crowd[1].body.height_m = 1.65F;
  crowd[1].body.mass_kg = 60;
  std::vector<mobil::Entity> people(crowd.size());
  if (const auto done = simulation.spawn(crowd, people); !done) return failed(done.error());

  // Once: triangles and how many vertices there are. Both people share it, each with a fit of a few numbers.
  mobil::SurfaceChoice choice;
  choice.simulated = asked.muscles->muscles;
  choice.cells = asked.muscles->cells;
  const auto bound = mobil::bind_surfaces(simulation.human(people[0])->body, choice);
  if (!bound) return failed(bound.error());
  std::printf("%u vertices, %zu triangles, %zu parts a person\n", bound->vertices, bound->index.size() / 3,
              bound->part.size());

  // Once a person: which muscles are theirs, and where their vertices go.
  std::vector<Vertex> buffer(people.size() * bound->vertices);
  std::vector<std::vector<mobil::SurfaceMuscle>> muscles(people.size());
  std::vector<mobil::SurfaceFit> fits(people.size());
  std::vector<mobil::SurfaceRequest> requests;
  for (std::size_t i = 0; i < people.size(); ++i) {
    const mobil::Human human = *simulation.human(people[i]);
    for (const auto& own : human.muscles) muscles[i].push_back({own.plan.muscle, own.entity});
    fits[i] = mobil::fit_surfaces(*bound, human.body);
    const auto bytes = std::as_writable_bytes(std::span(buffer).subspan(i * bound->vertices, bound->vertices));
    requests.push_back({.person = people[i],
                        .muscles = muscles[i],
                        .surfaces = &*bound,
                        .positions = {bytes, sizeof(Vertex)},
                        .normals = {bytes.subspan(offsetof(Vertex, normal)), sizeof(Vertex)},
                        .fit = &fits[i]});
  }

  mobil::SurfaceWriter writer;
  for (int frame = 0; frame < 30; ++frame) {
    simulation.advance(1.0 / 30);
    if (const auto done = writer.write(simulation.world(), requests, jobs); !done) return failed(done.error());
  }

  float low[3] = {1e9F, 1e9F, 1e9F}, high[3] = {-1e9F, -1e9F, -1e9F};
  double checksum = 0;
  for (const Vertex& v : buffer) {
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], v.position[c]);
      high[c] = std::max(high[c], v.position[c]);
      checksum += static_cast<double>(v.position[c]) + static_cast<double>(v.normal[c]);
    }
  }
  std::printf("x %.2f to %.2f m, y %.2f to %.2f m, z %.2f to %.2f m, sum of all %.3f\n", static_cast<double>(low[0]),
              static_cast<double>(high[0]), static_cast<double>(low[1]), static_cast<double>(high[1]),
              static_cast<double>(low[2]), static_cast<double>(high[2]), checksum);
  return high[1] > 1.5F && high[1] < 2 ? 0 : 1;  // as tall as they are
}
