// Surfaces of people as a host receives them: positions and normals, in its own buffers, in any layout.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <mobil/assets/surfaces/muscle_surfaces.h>
#include <mobil/components/fade.h>
#include <mobil/engine/world.h>
#include <mobil/muscle_table.h>
#include <mobil/simulation.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "assets/surfaces/surface_mesh.h"
#include "tests/engine/counting_malloc.h"
#include "tests/engine/instruction_sets.h"
#include "tests/engine/wilful_pool.h"
#include "tests/labels.h"
#include "tests/refused.h"
#include "tests/simulation/people.h"
#include "tests/surfaces/skinned.h"

MOBIL_TEST_LABELS("threads;long");

namespace mobil::surface_writer_test {
using namespace geometry;

struct Vertex {
  Vec3<float> position, normal;
};

struct Shown {
  Entity person;
  Person subject;
  std::vector<SurfaceMuscle> muscles;
  BodySurfaces surfaces;
  std::vector<Vertex> out;

  SurfaceRequest request() {
    const auto bytes = std::as_writable_bytes(std::span(out));
    return {person, muscles, &surfaces, {bytes, sizeof(Vertex)}, {bytes.subspan(12), sizeof(Vertex)}};
  }
  std::vector<Vec3<float>> positions(const SurfacePart& part) const {
    std::vector<Vec3<float>> p;
    for (std::uint32_t v = 0; v < part.vertices; ++v) p.push_back(out[part.first_vertex + v].position);
    return p;
  }
  std::vector<std::uint32_t> triangles(const SurfacePart& part) const {
    std::vector<std::uint32_t> t;
    for (std::uint32_t i = 0; i < part.indices; ++i)
      t.push_back(surfaces.index[part.first_index + i] - part.first_vertex);
    return t;
  }
};

SurfaceChoice choice_of(const LegMuscles& muscles, bool bones) {
  SurfaceChoice choice;
  choice.bones = bones;
  choice.simulated = muscles.muscles;
  choice.cells = muscles.cells;
  choice.clear_of_bones = false;  // the formulas are those of one vertex
  return choice;
}

Shown show(Simulation& simulation, const BodyRequest& body, const LegMuscles& muscles = {}, bool bones = true) {
  Shown shown;
  shown.person = simulation.spawn(body).value();
  EXPECT_TRUE(simulation.set_muscles(shown.person, muscles));
  shown.subject = *simulation.person(shown.person);
  for (const PersonMuscle& own : shown.subject.muscles) shown.muscles.push_back({own.plan.muscle, own.entity});
  shown.surfaces = bind_surfaces(shown.subject.body, choice_of(muscles, bones)).value();
  shown.out.resize(shown.surfaces.vertices);
  return shown;
}

void write(const Simulation& simulation, Shown& shown, const Jobs& jobs = {}) {
  SurfaceWriter writer;
  const SurfaceRequest request = shown.request();
  const auto done = writer.write(simulation.world(), {&request, 1}, jobs);
  ASSERT_TRUE(done) << done.error().message;
}

bool same(const Vec3<float>& a, const Vec3<float>& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Expects every muscle's vertices to have the bits of the formula, with the displayed control points.
void expect_formula(const Simulation& simulation, const Shown& shown, const LegMuscles& muscles) {
  const auto drawn = draw_surfaces(shown.subject.body, choice_of(muscles, false)).value();
  const Pose<float> pose = *simulation.get<Pose>(shown.person);
  std::size_t next = shown.surfaces.part.size() - 2 * drawn.muscles.size();
  for (const DrivenSurface& muscle : drawn.muscles) {
    for (const Side side : {Side::right, Side::left}) {
      const SurfacePart& part = shown.surfaces.part[next++];
      const Entity entity = simulation.muscle(shown.person, muscle.driver, side);
      const auto u = displacements(nodal_displacement(simulation.world(), entity));
      ASSERT_FALSE(u.empty());
      const auto expected =
          skinned_one_by_one(muscle.surface, side, shown.subject.body, pose, *simulation.get<LineOfAction>(entity), u);
      const auto is = shown.positions(part);
      ASSERT_EQ(is.size(), expected.size());
      std::size_t others = 0;
      for (std::size_t v = 0; v < is.size(); ++v) others += same(is[v], expected[v]) ? 0 : 1;
      EXPECT_EQ(others, 0U) << part.name;
    }
  }
}

const std::vector<BodyRequest>& bodies() {
  static const std::vector<BodyRequest> all = [] {
    BodyRequest small{.height_m = 1.50F, .mass_kg = 45}, large{.height_m = 2.0F, .mass_kg = 110}, athletic;
    athletic.height_m = 1.80F;
    athletic.mass_kg = 85;
    athletic.constitution = Constitution::athletic;
    return std::vector<BodyRequest>{small, large, athletic};
  }();
  return all;
}

TEST(SurfaceWriter, PositionsAreTheFormulasWithEveryMethodAndMesh) {
  for (const Method method : {Method::statics, Method::explicit_central, Method::implicit_central, Method::newmark,
                              Method::modal, Method::finite}) {
    Simulation simulation(sharing());
    LegMuscles muscles;
    muscles.method = method;
    if (method == Method::statics) muscles.cells = {3, 3, 9};
    if (method == Method::modal) muscles.muscles = muscle_members();
    Shown shown = show(simulation, {}, muscles, false);
    simulation.advance(0.1);
    write(simulation, shown);
    expect_formula(simulation, shown, muscles);
  }
}

TEST(SurfaceWriter, ShowsWhatFadesAfterAChangeOfMethod) {
  Simulation simulation(sharing());
  Shown shown = show(simulation, {}, {}, false);
  simulation.advance(0.2);
  ASSERT_TRUE(simulation.set_method(shown.person, Muscle::hamstrings, {.method = Method::statics}));
  simulation.tick();
  const Entity muscle = simulation.muscle(shown.person, Muscle::hamstrings, Side::right);
  ASSERT_TRUE(simulation.world().has<ShownDisplacement>(muscle));
  write(simulation, shown);
  expect_formula(simulation, shown, {});
}

TEST(SurfaceWriter, PositionsAreTheFormulasAndNormalsTheTrianglesOnEveryBody) {
  for (const BodyRequest& body : bodies()) {
    Simulation simulation(sharing());
    Shown shown = show(simulation, body);
    simulation.advance(0.3);
    write(simulation, shown);
    expect_formula(simulation, shown, {});
    for (const SurfacePart& part : shown.surfaces.part) {
      const auto position = shown.positions(part);
      const auto expected = triangle_normals(position, shown.triangles(part));
      for (std::size_t v = 0; v < position.size(); ++v) {
        const Vec n = to_double(shown.out[part.first_vertex + v].normal);
        ASSERT_NEAR(length(n), 1, 2e-6) << part.name << ' ' << v;
        ASSERT_LT(length(n - expected[v]), part.driver ? 1e-4 : 1e-3) << part.name << ' ' << v;
      }
    }
  }
}

TEST(SurfaceWriter, LayoutsHoldTheSameFloatsAndNoOtherBytes) {
  Simulation simulation(sharing());
  Shown shown = show(simulation, {});
  simulation.advance(0.1);
  write(simulation, shown);
  struct Layout {
    std::size_t stride, position, normal;
  };
  SurfaceWriter writer;
  for (const Layout& at : {Layout{24, 0, 12}, Layout{24, 12, 0}, Layout{28, 0, 12}, Layout{32, 4, 16},
                           Layout{32, 0, 20}, Layout{33, 5, 18}, Layout{64, 40, 0}}) {
    constexpr std::size_t guard = 64;
    std::vector<std::byte> memory(at.stride * shown.surfaces.vertices + 2 * guard, std::byte{0xA5});
    const auto inner = std::span(memory).subspan(guard, at.stride * shown.surfaces.vertices);
    SurfaceRequest request = shown.request();
    request.positions = {inner.subspan(at.position), at.stride};
    request.normals = {inner.subspan(at.normal), at.stride};
    ASSERT_TRUE(writer.write(simulation.world(), {&request, 1}));
    for (std::size_t v = 0; v < shown.surfaces.vertices; ++v) {
      std::byte* vertex = inner.data() + v * at.stride;
      ASSERT_EQ(std::memcmp(vertex + at.position, &shown.out[v].position, 12), 0) << at.stride << ' ' << v;
      ASSERT_EQ(std::memcmp(vertex + at.normal, &shown.out[v].normal, 12), 0) << at.stride << ' ' << v;
      std::memset(vertex + at.position, 0xA5, 12);
      std::memset(vertex + at.normal, 0xA5, 12);
    }
    EXPECT_TRUE(std::ranges::all_of(memory, [](std::byte b) { return b == std::byte{0xA5}; })) << at.stride;
  }
  std::vector<float> position(3 * shown.surfaces.vertices + 1, -5), normal(position);
  SurfaceRequest apart = shown.request();
  apart.positions = {std::as_writable_bytes(std::span(position)), 12};
  apart.normals = {std::as_writable_bytes(std::span(normal)), 12};
  ASSERT_TRUE(writer.write(simulation.world(), {&apart, 1}));
  std::vector<float> alone(position.size(), -5);
  apart.positions.bytes = std::as_writable_bytes(std::span(alone));
  apart.normals = {};
  ASSERT_TRUE(writer.write(simulation.world(), {&apart, 1}));
  for (std::size_t v = 0; v < shown.surfaces.vertices; ++v) {
    ASSERT_EQ(std::memcmp(&position[3 * v], &shown.out[v].position, 12), 0);
    ASSERT_EQ(std::memcmp(&normal[3 * v], &shown.out[v].normal, 12), 0);
  }
  EXPECT_EQ(alone, position);
  EXPECT_EQ(position.back(), -5);
  EXPECT_EQ(normal.back(), -5);
}

TEST(SurfaceWriter, ThreadsAndInstructionSetsDoNotMatter) {
  Simulation simulation(sharing());
  std::vector<Shown> people;
  for (const BodyRequest& body : bodies()) people.push_back(show(simulation, body));
  people.push_back(people.front());  // shares a body's surfaces and muscles
  simulation.advance(0.2);
  SurfaceWriter writer;
  const auto all = [&](const Jobs& jobs) {
    std::vector<SurfaceRequest> requests;
    std::vector<std::vector<Vertex>> out;
    for (Shown& shown : people) {
      shown.out.assign(shown.surfaces.vertices, Vertex{});
      requests.push_back(shown.request());
    }
    EXPECT_TRUE(writer.write(simulation.world(), requests, jobs));
    for (const Shown& shown : people) out.push_back(shown.out);
    return out;
  };
  const auto same_bytes = [](const std::vector<std::vector<Vertex>>& a, const std::vector<std::vector<Vertex>>& b) {
    return std::ranges::equal(a, b, [](const auto& x, const auto& y) {
      return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(Vertex)) == 0;
    });
  };
  const auto reference = all({});
  EXPECT_FALSE(same_bytes(reference, {}));
  EXPECT_TRUE(same_bytes(all(Threads(2).jobs()), reference));
  EXPECT_TRUE(same_bytes(all(backwards()), reference));
  WilfulPool more_than_promised(4, 2);
  EXPECT_TRUE(same_bytes(all(more_than_promised.jobs(1)), reference));
  for_each_fused_instruction_set([&] { EXPECT_TRUE(same_bytes(all({}), reference)); });
}

TEST(SurfaceWriter, MuscleWithoutControlPointsHasItsLinesLength) {
  Simulation simulation(sharing());
  LegMuscles muscles;
  Shown shown = show(simulation, {}, muscles, false);
  for (const Muscle m : {Muscle::hamstrings, Muscle::quadriceps})
    ASSERT_TRUE(simulation.set_method(shown.person, m, {.method = Method::none}));
  simulation.advance(0.5);
  write(simulation, shown);
  const auto drawn = draw_surfaces(shown.subject.body, choice_of(muscles, false)).value();
  std::size_t next = 0;
  int seen = 0;
  for (const DrivenSurface& muscle : drawn.muscles) {
    for (const Side side : {Side::right, Side::left}) {
      const SurfacePart& part = shown.surfaces.part[next++];
      const Entity entity = simulation.muscle(shown.person, muscle.driver, side);
      if (nodal_displacement(simulation.world(), entity).first != nullptr) continue;
      ++seen;
      const auto line = *simulation.get<LineOfAction>(entity);
      const auto node = rest_mesh(shown.subject.body, muscle.driver, muscles.cells)->lattice.node;
      std::vector<float> u;
      for (const auto& n : node) {
        const double longer = static_cast<double>(line.length_m) - static_cast<double>(line.rest_length_m);
        u.insert(u.end(), {0, 0, static_cast<float>(longer * n.z / node.back().z)});
      }
      const auto expected =
          skinned_one_by_one(muscle.surface, side, shown.subject.body, *simulation.get<Pose>(shown.person), line, u);
      const auto is = shown.positions(part);
      for (std::size_t v = 0; v < is.size(); ++v)
        ASSERT_LT(length(to_double(is[v]) - to_double(expected[v])), 1e-6) << part.name;
    }
  }
  EXPECT_GE(seen, 16);
}

TEST(SurfaceWriter, AnOriginIsSubtracted) {
  Simulation simulation(sharing());
  Shown shown = show(simulation, {});
  simulation.advance(0.5);
  write(simulation, shown);
  const auto world = shown.out;
  SurfaceRequest request = shown.request();
  request.origin_m = {0.5F, 1, 0.25F};
  SurfaceWriter writer;
  ASSERT_TRUE(writer.write(simulation.world(), {&request, 1}));
  for (std::size_t v = 0; v < world.size(); ++v) {
    ASSERT_LT(length(to_double(shown.out[v].position) + to_double(request.origin_m) - to_double(world[v].position)),
              2e-6);
  }
}

TEST(SurfaceWriter, SidesAndBonesCanBeChosen) {
  Simulation simulation(sharing());
  Shown shown = show(simulation, {});
  simulation.advance(0.1);
  write(simulation, shown);
  const Shown whole = shown;
  SurfaceChoice choice;
  choice.sides = {false, true};
  choice.clear_of_bones = false;
  shown.surfaces = bind_surfaces(shown.subject.body, choice).value();
  shown.out.assign(shown.surfaces.vertices, Vertex{});
  for (SurfaceMuscle& m : shown.muscles) m.entity[Side::right] = {};  // not displayed
  write(simulation, shown);
  std::size_t middle = 0;
  for (const SurfacePart& part : shown.surfaces.part) {
    EXPECT_FALSE(part.name.ends_with("_right")) << part.name;
    middle += part.name.ends_with("_left") ? 0 : 1;
    const auto in_whole = std::ranges::find(whole.surfaces.part, part.name, &SurfacePart::name);
    ASSERT_NE(in_whole, whole.surfaces.part.end());
    EXPECT_EQ(shown.triangles(part), whole.triangles(*in_whole));
    EXPECT_EQ(
        std::memcmp(&shown.out[part.first_vertex], &whole.out[in_whole->first_vertex], part.vertices * sizeof(Vertex)),
        0)
        << part.name;
  }
  EXPECT_GT(middle, 20U);
}

TEST(SurfaceWriter, ErrorsNameTheMistakeAndNothingIsWritten) {
  Simulation simulation(sharing());
  Shown shown = show(simulation, {}), other = show(simulation, {}), gone = show(simulation, {});
  ASSERT_EQ(simulation.despawn(gone.person), Status::ok);
  SurfaceWriter writer;
  const auto refused = [&](const SurfaceRequest& request, const std::string& what) {
    const SurfaceRequest requests[2] = {other.request(), request};
    EXPECT_TRUE(is_refused(writer.write(simulation.world(), requests), what, "request 1")) << what;
    EXPECT_TRUE(std::ranges::all_of(other.out, [](const Vertex& v) { return same(v.normal, {}); }));
  };
  refused(gone.request(), "stale");
  Shown asleep = show(simulation, bodies()[0]);
  for (int i = 0; i < 900; ++i) simulation.tick();
  ASSERT_TRUE(simulation.set_state({&asleep.person, 1}, PersonState::asleep));
  refused(asleep.request(), "no pose");
  const auto no_pose = writer.write(simulation.world(), std::array{asleep.request()});
  EXPECT_EQ(no_pose.error().status, Status::missing);
  SurfaceRequest request = shown.request();
  request.surfaces = nullptr;
  refused(request, "bind_surfaces");
  request = shown.request();
  request.positions.bytes = request.positions.bytes.first(24 * (shown.surfaces.vertices - 1) + 11);
  refused(request, "are needed");
  request.positions.bytes = std::as_writable_bytes(std::span(shown.out)).first(24 * shown.surfaces.vertices - 12);
  EXPECT_TRUE(writer.write(simulation.world(), {&request, 1}));  // just enough
  request = shown.request();
  request.normals.stride = 8;
  refused(request, "at least 12");
  request = shown.request();
  request.normals.bytes = request.positions.bytes;
  refused(request, "over positions");
  request = shown.request();
  request.muscles = other.muscles;
  refused(request, "another person");
  request.muscles = request.muscles.first(1);
  refused(request, "another person");
  request.muscles = {};
  refused(request, "not among");
  std::vector<SurfaceMuscle> swapped = shown.muscles;
  std::swap(swapped[0].entity[Side::right], swapped[0].entity[Side::left]);
  request.muscles = swapped;
  refused(request, "other side");
  LegMuscles finer;
  finer.cells = {3, 3, 9};
  ASSERT_TRUE(simulation.set_muscles(shown.person, finer));
  refused(shown.request(), "nodes");
  ASSERT_EQ(simulation.set_muscles(shown.person, std::nullopt), Status::ok);
  refused(shown.request(), "stale");
  EXPECT_FALSE(bind_surfaces(shown.subject.body, choice_of({.cells = {0, 2, 8}}, false)));
}

TEST(SurfaceWriter, SteadyCallAllocatesNothing) {
  if (!counts_malloc) GTEST_SKIP() << "malloc is not counted in this build";
  Simulation simulation(sharing());
  std::vector<Shown> people;
  for (const BodyRequest& body : bodies()) people.push_back(show(simulation, body));
  std::vector<SurfaceRequest> requests;
  for (Shown& shown : people) requests.push_back(shown.request());
  SurfaceWriter writer;
  const Threads threads(2);
  for (int i = 0; i < 20; ++i) {
    simulation.tick();
    ASSERT_TRUE(writer.write(simulation.world(), requests, threads.jobs()));
  }
  const std::size_t before = malloc_requests;
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(writer.write(simulation.world(), requests));
    ASSERT_TRUE(writer.write(simulation.world(), {requests.data(), 1}));
  }
  EXPECT_EQ(malloc_requests, before);
}

}  // namespace mobil::surface_writer_test
