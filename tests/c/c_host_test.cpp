// Host settings of the C interface: axes, memory that runs out, jobs.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "engine/eigen.h"
#include "tests/c/c_fixture.h"
#include "tests/labels.h"

MOBIL_TEST_LABELS("long");

namespace mobil::c_test {
namespace {

using Matrix = Eigen::Matrix3d;
using Vector = Eigen::Vector3d;

/// The host's axes in the library's axes: ahead, up and left, as the header specifies them, not as the code implements
/// them.
struct Host {
  const char* name;
  int axes;
  float units_per_m;
  Vector ahead, up, left;  // in the host's coordinates

  /// The library's axes are x left, y up, z ahead.
  Matrix from_ours() const {
    Matrix m;
    m << left, up, ahead;
    return m;
  }
};

const Host hosts[] = {{"glTF", MOBIL_AXES_Y_UP, 1, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}},
                      {"Unity", MOBIL_AXES_UNITY, 1, {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
                      {"Unreal", MOBIL_AXES_UNREAL, 100, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                      {"Godot", MOBIL_AXES_GODOT, 1, {0, 0, -1}, {0, 1, 0}, {-1, 0, 0}},
                      {"ROS", MOBIL_AXES_Z_UP, 1, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}}};

mobil_options options_of(const Host& host) {
  auto options = filled<mobil_options>(MOBIL_OPTIONS);
  options.axes = host.axes;
  options.units_per_m = host.units_per_m;
  return options;
}

Vector vector(const float* at) {
  return {at[0], at[1], at[2]};
}

/// Spawns a walker 3 m to the left of the origin and 5 m ahead, heading 0.7 rad to the left.
mobil_id walker(const Sim& sim, const Host& host) {
  auto person = filled<mobil_person>(MOBIL_PERSON);
  const Vector place = host.units_per_m * (3 * host.left + 5 * host.ahead);
  for (int i = 0; i < 3; ++i) person.place[i] = static_cast<float>(place[i]);
  person.heading_rad = 0.7F;
  mobil_id id{};
  auto muscles = filled<mobil_muscles>(MOBIL_MUSCLES);
  muscles.method = MOBIL_MODAL;
  EXPECT_EQ(mobil_spawn(sim, &person, 0, 1, &muscles, &id), MOBIL_OK) << sim.message();
  EXPECT_EQ(mobil_enable(sim, &id, 1, MOBIL_FORCES, 1), MOBIL_OK);
  EXPECT_EQ(mobil_tick(sim, 50), MOBIL_OK);
  return id;
}

Matrix rotation(const float* q) {
  return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
}

TEST(CHost, AllValuesAreInTheHostsAxes) {
  const Sim plain;
  const mobil_id us = walker(plain, hosts[0]);
  std::vector<float> our_pose(48 * 7), our_ground(12);
  ASSERT_EQ(mobil_poses(plain, &us, 1, nullptr, our_pose.data(), 0), MOBIL_OK);
  ASSERT_EQ(mobil_read(plain, MOBIL_GROUND, &us, 1, our_ground.data(), 0), MOBIL_OK);
  for (const Host& host : hosts) {
    SCOPED_TRACE(host.name);
    const Sim sim(options_of(host));
    const mobil_id id = walker(sim, host);
    EXPECT_EQ(sim.hash(), plain.hash());  // the world is the same in any axes
    const Matrix m = host.from_ours();
    std::vector<float> pose(48 * 7), ground(12), feet(20);
    ASSERT_EQ(mobil_poses(sim, &id, 1, nullptr, pose.data(), 0), MOBIL_OK);
    ASSERT_EQ(mobil_read(sim, MOBIL_GROUND, &id, 1, ground.data(), 0), MOBIL_OK);
    ASSERT_EQ(mobil_read(sim, MOBIL_FEET, &id, 1, feet.data(), 0), MOBIL_OK);
    for (std::size_t s = 0; s < 48; ++s) {
      const Vector place = host.units_per_m * (m * vector(&our_pose[7 * s]));
      EXPECT_LT((place - vector(&pose[7 * s])).norm(), 1e-5 * place.norm());
      const Matrix turned = m * rotation(&our_pose[7 * s + 3]) * m.transpose();
      EXPECT_LT((turned - rotation(&pose[7 * s + 3])).norm(), 1e-5);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LT((m * vector(&our_ground[3 * i]) - vector(&ground[3 * i])).norm(), 0.01);  // N
      EXPECT_LT((host.units_per_m * (m * vector(&our_ground[6 + 3 * i])) - vector(&ground[6 + 3 * i])).norm(),
                1e-4 * host.units_per_m);
    }
    // Heels are near the ground and the pelvis is at hip height. The person faces ahead.
    const double height = host.up.dot(vector(&pose[0])) / host.units_per_m;
    EXPECT_GT(height, 0.8);
    EXPECT_LT(height, 1.1);
    EXPECT_LT(std::fabs(host.up.dot(vector(&feet[0]))) / host.units_per_m, 0.2);
    const Vector looks = std::cos(0.7) * host.ahead + std::sin(0.7) * host.left;
    const Vector toes = vector(&feet[12]) - vector(&feet[0]);  // from the right heel
    EXPECT_GT(toes.normalized().dot(looks), 0.8);
    auto person = filled<mobil_person>(MOBIL_PERSON);
    ASSERT_EQ(mobil_get_person(sim, id, &person), MOBIL_OK);
    EXPECT_NEAR(person.heading_rad, 0.7, 1e-5);
    EXPECT_NEAR(host.up.dot(vector(person.place)), 0, 1e-6);
  }
}

TEST(CHost, WrittenPosesCanBePassedBack) {
  for (const Host& host : hosts) {
    SCOPED_TRACE(host.name);
    const Sim sim(options_of(host));
    const mobil_id id = walker(sim, host);
    auto doll = filled<mobil_person>(MOBIL_PERSON);
    doll.posed = 1;
    mobil_id posed{};
    ASSERT_EQ(mobil_spawn(sim, &doll, 0, 1, nullptr, &posed), MOBIL_OK);
    std::vector<float> out(48 * 7), back(48 * 7);
    ASSERT_EQ(mobil_poses(sim, &id, 1, nullptr, out.data(), 0), MOBIL_OK);
    ASSERT_EQ(mobil_set_poses(sim, &posed, 1, out.data(), 0, 1), MOBIL_OK) << sim.message();
    ASSERT_EQ(mobil_poses(sim, &posed, 1, nullptr, back.data(), 0), MOBIL_OK);
    for (std::size_t i = 0; i < out.size(); ++i) EXPECT_NEAR(out[i], back[i], 1e-6 * std::fabs(out[i]) + 1e-7);
    float joints[13], theirs[13];
    ASSERT_EQ(mobil_read(sim, MOBIL_JOINTS, &id, 1, joints, 0), MOBIL_OK);
    ASSERT_EQ(mobil_read(sim, MOBIL_JOINTS, &posed, 1, theirs, 0), MOBIL_OK);
    for (int i = 3; i < 9; ++i) EXPECT_NEAR(joints[i], theirs[i], 5e-3) << i;  // leg joints, measured on the pose
  }
}

TEST(CHost, SurfacesAreWoundOutwardsInTheHostsAxes) {
  for (const Host& host : hosts) {
    SCOPED_TRACE(host.name);
    const Sim sim(options_of(host));
    const mobil_id id = walker(sim, host);
    auto choice = filled<mobil_surface_choice>(MOBIL_SURFACE_CHOICE);
    choice.textured = 1;
    mobil_surfaces* surfaces = nullptr;
    ASSERT_EQ(mobil_bind_surfaces(sim, id, &choice, &surfaces), MOBIL_OK) << sim.message();
    const std::size_t vertices = mobil_vertex_count(surfaces);
    std::vector<unsigned int> index(mobil_index_count(surfaces));
    ASSERT_EQ(mobil_indices(surfaces, index.data(), index.size()), MOBIL_OK);
    EXPECT_EQ(mobil_indices(surfaces, index.data(), index.size() - 1), MOBIL_ROOM);
    struct Vertex {
      float position[3], normal[3], tangent[4];
    };
    std::vector<Vertex> vertex(vertices);
    auto target = filled<mobil_surface_target>(MOBIL_SURFACE_TARGET);
    target.id = id;
    target.surfaces = surfaces;
    target.positions = vertex[0].position;
    target.normals = vertex[0].normal;
    target.tangents = vertex[0].tangent;
    target.position_stride = target.normal_stride = target.tangent_stride = sizeof(Vertex);
    target.position_bytes = vertices * sizeof(Vertex);
    target.normal_bytes = target.position_bytes - sizeof vertex[0].position;
    target.tangent_bytes = target.normal_bytes - sizeof vertex[0].normal;
    ASSERT_EQ(mobil_write_surfaces(sim, &target, 0, 1), MOBIL_OK) << sim.message();
    // Cross products of two edges point outside in every host's axes: triangles are counter-clockwise in right-handed
    // axes and clockwise in left-handed ones, as renderers expect. A closed surface's volume is then positive.
    mobil_part part;
    std::size_t with_tangents = 0;
    double all = 0;
    for (int p = 0; mobil_surface_part(surfaces, p, &part) == MOBIL_OK; ++p) {
      double volume = 0, outward = 0;
      for (unsigned int t = part.first_index; t < part.first_index + part.indices; t += 3) {
        const Vertex &a = vertex[index[t]], &b = vertex[index[t + 1]], &c = vertex[index[t + 2]];
        const Vector normal = (vector(b.position) - vector(a.position)).cross(vector(c.position) - vector(a.position));
        const Vector origin = vector(vertex[index[part.first_index]].position);
        volume += (vector(a.position) - origin).dot(normal) / 6;
        outward += normal.dot(vector(a.normal) + vector(b.normal) + vector(c.normal));
      }
      EXPECT_GT(volume, 0) << part.name;
      EXPECT_GT(outward, 0) << part.name;  // normals point outside in any axes
      all += volume / std::pow(host.units_per_m, 3);
      for (unsigned int v = part.first_vertex; v < part.first_vertex + part.vertices; ++v) {
        EXPECT_NEAR(vector(vertex[v].normal).norm(), 1, 1e-3);
        with_tangents += std::fabs(vector(vertex[v].tangent).dot(vector(vertex[v].normal))) < 1e-3 ? 1 : 0;
      }
    }
    EXPECT_GT(all, 0.005);  // m³ of bones and thigh and calf muscles
    EXPECT_LT(all, 0.04);
    EXPECT_GT(with_tangents, vertices * 9 / 10);
    std::vector<float> texture(2 * vertices);
    EXPECT_EQ(mobil_texture_places(surfaces, texture.data(), texture.size()), MOBIL_OK);
    std::vector<unsigned char> tissue(4 * vertices + 1, 7);
    EXPECT_EQ(mobil_surface_tissue(surfaces, tissue.data(), 4 * vertices - 1), MOBIL_ROOM);
    EXPECT_EQ(mobil_surface_tissue(nullptr, tissue.data(), tissue.size()), MOBIL_REFUSED);
    ASSERT_EQ(mobil_surface_tissue(surfaces, tissue.data(), tissue.size()), MOBIL_OK);
    EXPECT_EQ(tissue.back(), 7);
    for (int p = 0; mobil_surface_part(surfaces, p, &part) == MOBIL_OK; ++p) {
      const bool all_tendon = std::string(part.name).find("ligament") != std::string::npos;
      for (unsigned int v = part.first_vertex; v < part.first_vertex + part.vertices; ++v) {
        if (part.muscle < 0) {
          EXPECT_EQ(tissue[4 * v] + tissue[4 * v + 1] + tissue[4 * v + 2] + tissue[4 * v + 3], 0) << part.name;
        } else {
          EXPECT_NEAR(tissue[4 * v] / 255.0, texture[2 * v], 0.003) << part.name;
          EXPECT_NEAR(tissue[4 * v + 1] / 255.0, texture[2 * v + 1], 0.003) << part.name;
          EXPECT_TRUE(!all_tendon || tissue[4 * v + 2] == 255) << part.name;
        }
      }
    }
    mobil_drop_surfaces(surfaces);
  }
}

/// Memory that refuses the n-th allocation.
struct Scarce {
  long asked = 0, fails_at = -1, held = 0;
  std::map<void*, std::size_t> pieces;

  static void* allocate(void* user, std::size_t bytes, std::size_t alignment) {
    EXPECT_GT(bytes, 0U);
    auto& self = *static_cast<Scarce*>(user);
    if (++self.asked == self.fails_at) return nullptr;
#if defined(_WIN32)
    void* const memory = _aligned_malloc(bytes, alignment);
#else
    void* const memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
#endif
    self.pieces[memory] = bytes;
    return memory;
  }
  static void release(void* user, void* memory, std::size_t bytes, std::size_t) {
    auto& self = *static_cast<Scarce*>(user);
    const auto piece = self.pieces.find(memory);
    EXPECT_TRUE(piece != self.pieces.end() && piece->second == bytes);
    if (piece != self.pieces.end()) self.pieces.erase(piece);
#if defined(_WIN32)
    _aligned_free(memory);
#else
    std::free(memory);
#endif
  }
};

TEST(CHost, AnyFailedAllocationChangesNothing) {
  Scarce memory;
  {
    auto options = filled<mobil_options>(MOBIL_OPTIONS);
    options.memory = {&memory, &Scarce::allocate, &Scarce::release};
    const Sim sim(options);
    const auto muscles = modal_muscles();
    std::vector<mobil_id> ids(40);
    const auto people = some_people(ids.size());
    std::size_t refusals = 0;
    // Tries each request with the first allocation refused, then the second, until it succeeds.
    const auto until_done = [&](const char* what, const std::function<int()>& request) {
      const auto before = sim.hash();
      std::vector<unsigned char> state(mobil_snapshot_bytes(sim));
      ASSERT_EQ(mobil_save(sim, state.data(), state.size(), nullptr), MOBIL_OK);
      for (long n = 1;; ++n) {
        ASSERT_LT(n, 10000) << what;
        memory.asked = 0;
        memory.fails_at = n;
        const int code = request();
        memory.fails_at = -1;
        if (code == MOBIL_OK) {
          if (memory.asked < n) return;
          // The request succeeded without that allocation. Restores the state and tries the next one.
          ASSERT_EQ(mobil_restore(sim, state.data(), state.size()), MOBIL_OK) << what;
          continue;
        }
        ASSERT_EQ(code, MOBIL_MEMORY) << what << ": " << sim.message();
        ASSERT_EQ(sim.hash(), before) << what << ", piece " << n;
        ++refusals;
      }
    };
    until_done("spawn", [&] { return mobil_spawn(sim, people.data(), 0, ids.size(), &muscles, ids.data()); });
    ASSERT_EQ(mobil_tick(sim, 30), MOBIL_OK);
    auto unseen = muscles;
    unseen.control_points = 0;
    for (std::size_t i = 0; i < 20; ++i)
      until_done("set_muscles", [&] { return mobil_set_muscles(sim, &ids[i], 1, &unseen); });
    const auto absent = [&] {
      until_done("compact", [&] { return mobil_set_state(sim, ids.data(), 20, MOBIL_COMPACT, 0, nullptr); });
      until_done("sleep", [&] { return mobil_set_state(sim, &ids[20], 20, MOBIL_ASLEEP, 0, nullptr); });
    };
    for (const auto& [name, ask] :
         {std::pair{"avoid", &mobil_avoidance_manage}, std::pair{"ground", &mobil_terrain_manage}}) {
      absent();
      until_done(name, [&, asked = ask] { return asked(sim, ids.data(), ids.size(), 1); });
      until_done(name, [&, asked = ask] { return asked(sim, ids.data(), ids.size(), 0); });
    }
    absent();
    const auto choosing = filled<mobil_lod_options>(MOBIL_LOD_OPTIONS);
    ASSERT_EQ(mobil_lod_set_options(sim, &choosing, &muscles), MOBIL_OK);
    until_done("manage", [&] { return mobil_lod_manage(sim, ids.data(), ids.size(), nullptr); });
    ASSERT_EQ(mobil_lod_release(sim, ids.data(), ids.size()), MOBIL_OK);
    absent();
    until_done("expand", [&] { return mobil_set_state(sim, ids.data(), 20, MOBIL_FULL, 0.005F, nullptr); });
    until_done("wake", [&] { return mobil_set_state(sim, &ids[20], 20, MOBIL_FULL, 0.005F, nullptr); });
    absent();
    for (const int on : {1, 0}) until_done("forces", [&] { return mobil_enable(sim, &ids[15], 10, MOBIL_FORCES, on); });
    until_done("sleep of the compact", [&] { return mobil_set_state(sim, ids.data(), 15, MOBIL_ASLEEP, 0, nullptr); });
    ASSERT_EQ(mobil_set_state(sim, ids.data(), ids.size(), MOBIL_FULL, 0.005F, nullptr), MOBIL_OK);
    auto moments = muscles;
    moments.activation = MOBIL_BY_MOMENTS;
    ASSERT_EQ(mobil_enable(sim, ids.data(), 5, MOBIL_FORCES, 1), MOBIL_OK);
    ASSERT_EQ(mobil_set_muscles(sim, ids.data(), 5, &moments), MOBIL_OK) << sim.message();
    until_done("no forces", [&] { return mobil_enable(sim, ids.data(), 5, MOBIL_FORCES, 0); });
    until_done("fat", [&] { return mobil_enable(sim, ids.data(), 5, MOBIL_FAT, 1); });
    std::vector<std::byte> bytes(mobil_snapshot_bytes(sim));
    std::size_t used = 0;
    ASSERT_EQ(mobil_save(sim, bytes.data(), bytes.size(), &used), MOBIL_OK);
    ASSERT_EQ(mobil_despawn(sim, ids.data(), ids.size()), MOBIL_OK);
    until_done("restore", [&] { return mobil_restore(sim, bytes.data(), used); });
    EXPECT_GT(refusals, 20U);
  }
  EXPECT_TRUE(memory.pieces.empty());
}

/// A world whose next tick avoids, queries terrain, reports step events and, on request, runs level of detail.
struct Busy {
  Busy(const mobil_options& options, bool lod, const std::vector<std::byte>& baked) : sim(options) {
    if (!baked.empty()) {
      EXPECT_EQ(mobil_load_baked(sim, baked.data(), baked.size()), MOBIL_OK);
    }
    const auto ids = spawn(sim, 30);
    EXPECT_EQ(mobil_avoidance_manage(sim, &ids[5], 20, 1), MOBIL_OK) << sim.message();
    EXPECT_EQ(mobil_terrain_manage(sim, &ids[10], 20, 1), MOBIL_OK) << sim.message();
    EXPECT_EQ(mobil_enable(sim, ids.data(), 10, MOBIL_STEP_EVENTS, 1), MOBIL_OK);
    const auto waves = [](void*, const float* places, const mobil_id*, size_t count, float* ground) {
      for (size_t i = 0; i < count; ++i) ground[4 * i] = 0.02F * std::sin(places[3 * i + 2]);
      return 0;
    };
    EXPECT_EQ(mobil_terrain_set_heights(sim, waves, nullptr), MOBIL_OK);
    if (!lod) return;
    auto choosing = filled<mobil_lod_options>(MOBIL_LOD_OPTIONS);
    choosing.machine_factor = 1;
    const auto muscles = modal_muscles();
    auto scene = filled<mobil_scene>(MOBIL_SCENE);
    scene.muscles = muscles.muscles;
    scene.has_camera = 1;
    scene.eye[2] = -4;
    scene.gaze[2] = 1;
    scene.asleep_beyond_m = 10;
    scene.compact_unseen = 1;
    EXPECT_EQ(mobil_lod_set_options(sim, &choosing, &muscles), MOBIL_OK);
    EXPECT_EQ(mobil_lod_set_scene(sim, &scene), MOBIL_OK) << sim.message();
    EXPECT_EQ(mobil_lod_manage(sim, ids.data(), ids.size(), nullptr), MOBIL_OK) << sim.message();
  }

  Sim sim;
};

/// A tick that lacks memory does not count. The next one continues with the phase that lacked it.
TEST(CHost, TickWithoutMemoryIsRepeated) {
  const auto usual = filled<mobil_options>(MOBIL_OPTIONS);
  std::vector<std::byte> baked;
  {
    const Busy first(usual, true, {});
    ASSERT_EQ(mobil_tick(first.sim, 5), MOBIL_OK);
    std::size_t bytes = 0;
    ASSERT_EQ(mobil_bake(first.sim, nullptr, 0, &bytes), MOBIL_OK);
    baked.resize(bytes);
    ASSERT_EQ(mobil_bake(first.sim, baked.data(), bytes, nullptr), MOBIL_OK);
  }
  for (const bool lod : {false, true}) {
    const Busy plain(usual, lod, baked);
    ASSERT_EQ(mobil_tick(plain.sim, 30), MOBIL_OK);
    int refusals = 0;
    for (long n = 1;; ++n) {
      Scarce memory;
      auto options = usual;
      options.memory = {&memory, &Scarce::allocate, &Scarce::release};
      const Busy busy(options, lod, baked);
      memory.asked = 0;
      memory.fails_at = n;
      const int code = mobil_tick(busy.sim, 1);
      memory.fails_at = -1;
      if (memory.asked < n) break;
      if (code != MOBIL_OK) {
        ASSERT_EQ(code, MOBIL_MEMORY) << busy.sim.message();
        ASSERT_EQ(mobil_time_s(busy.sim), 0);
        ASSERT_EQ(mobil_tick(busy.sim, 1), MOBIL_OK) << busy.sim.message();
        ++refusals;
      }
      ASSERT_EQ(mobil_tick(busy.sim, 29), MOBIL_OK) << busy.sim.message();
      ASSERT_NEAR(mobil_time_s(busy.sim), 0.5, 1e-9);
      // By then level of detail has looked at another quarter of the people.
      if (!lod) {
        ASSERT_EQ(busy.sim.hash(), plain.sim.hash()) << "piece " << n;
      }
    }
    EXPECT_GT(refusals, 5);
  }
}

TEST(CHost, HostJobsDoTheWork) {
  struct Counted {
    std::size_t calls = 0, parts = 0;
  } counted;
  auto options = filled<mobil_options>(MOBIL_OPTIONS);
  options.jobs = {&counted,
                  [](void* user, std::size_t count, mobil_work work, void* context) {
                    auto& c = *static_cast<Counted*>(user);
                    ++c.calls;
                    for (std::size_t i = count; i-- > 0;) {  // backwards, one by one
                      ++c.parts;
                      work(context, i, i + 1);
                    }
                  },
                  4};
  const Sim sim(options), plain;
  const auto muscles = modal_muscles();
  spawn(sim, 100, &muscles);
  spawn(plain, 100, &muscles);
  ASSERT_EQ(mobil_tick(sim, 20), MOBIL_OK);
  ASSERT_EQ(mobil_tick(plain, 20), MOBIL_OK);
  EXPECT_EQ(sim.hash(), plain.hash());
  EXPECT_GT(counted.parts, counted.calls);
}

TEST(CHost, OptionsOutOfRangeAreNamed) {
  const auto refused = [](const char* names, const std::function<void(mobil_options&)>& change) {
    auto options = filled<mobil_options>(MOBIL_OPTIONS);
    change(options);
    mobil_sim* sim = nullptr;
    char line[256] = "";
    EXPECT_EQ(mobil_create(&options, &sim, line, sizeof line), MOBIL_REFUSED) << names;
    EXPECT_NE(std::string(line).find(names), std::string::npos) << line;
    EXPECT_EQ(sim, nullptr);
  };
  refused("tick", [](mobil_options& o) { o.tick_s = 0; });
  refused("axes", [](mobil_options& o) { o.axes = 5; });
  refused("units_per_m", [](mobil_options& o) { o.units_per_m = 0; });
  refused("threads", [](mobil_options& o) { o.threads = -1; });
  refused("release", [](mobil_options& o) { o.memory.allocate = &Scarce::allocate; });
}

}  // namespace
}  // namespace mobil::c_test
