// The C interface compared with the C++ interface: same bits, all-or-none batches, structs of other versions.

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>

#include <mobil/components/activation.h>
#include <mobil/engine/world.h>
#include <mobil/forces.h>
#include <mobil/lod.h>
#include <mobil/simulation.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "tests/c/c_fixture.h"
#include "tests/interfaces.h"

namespace mobil::c_test {
namespace {

std::vector<Entity> spawn_in(Simulation& simulation, std::vector<SpawnRequest> requests) {
  std::vector<Entity> people(requests.size());
  EXPECT_TRUE(simulation.spawn(requests, people));
  return people;
}

LegMuscles modal_choice() {
  LegMuscles choice;
  choice.method = Method::modal;
  choice.muscles = MuscleSet(0b101);
  choice.modal.modes = 4;
  return choice;
}

TEST(CInterface, DefaultStructsMatchCppDefaults) {
  const Sim sim;
  const auto muscles = filled<mobil_muscles>(MOBIL_MUSCLES);
  auto person = filled<mobil_person>(MOBIL_PERSON);
  mobil_id id;
  ASSERT_EQ(mobil_spawn(sim, &person, 0, 1, &muscles, &id), MOBIL_OK) << sim.message();
  Simulation simulation;
  const Entity twin = *simulation.spawn(BodyRequest{});
  ASSERT_TRUE(simulation.set_muscles(twin));
  ASSERT_EQ(mobil_tick(sim, 40), MOBIL_OK);
  for (int i = 0; i < 40; ++i) simulation.tick();
  EXPECT_EQ(sim.hash(), simulation.state_hash());
}

TEST(CInterface, SessionHasTheBitsOfCpp) {
  const Sim sim;
  const auto muscles = modal_muscles();
  const auto ids = spawn(sim, 20, &muscles);
  Simulation simulation;
  auto requests = as_requests(some_people(20));
  for (auto& request : requests) request.muscles = modal_choice();
  const auto people = spawn_in(simulation, requests);
  const auto both = [&](int ticks) {
    ASSERT_EQ(mobil_tick(sim, static_cast<unsigned>(ticks)), MOBIL_OK);
    for (int i = 0; i < ticks; ++i) simulation.tick();
    ASSERT_EQ(sim.hash(), simulation.state_hash());
  };
  both(10);

  auto walk = filled<mobil_walk>(MOBIL_WALK);
  walk.given = MOBIL_SPEED | MOBIL_HEADING | MOBIL_STYLE;
  walk.speed_m_s = 1.5F;
  walk.heading_rad = 1;
  std::array<float, 2> style{};
  for (int i = 0; i < 2; ++i) {
    mobil_style_number number;
    ASSERT_EQ(mobil_style(i, &number), MOBIL_OK);
    style[static_cast<std::size_t>(i)] = number.usual + 1;
  }
  walk.style = style.data();
  walk.style_count = style.size();
  ASSERT_EQ(mobil_change_walk(sim, ids.data(), 8, &walk), MOBIL_OK) << sim.message();
  GaitStyle as;
  as.pelvis_rotation_deg += 1;
  as.pelvis_list_deg += 1;
  for (std::size_t i = 0; i < 8; ++i) {
    ASSERT_TRUE(simulation.change_gait(people[i], {.speed_m_s = 1.5F, .style = as}));
    ASSERT_TRUE(simulation.turn_to(people[i], 1));
  }
  both(25);

  auto method = filled<mobil_method>(MOBIL_METHOD);
  method.method = MOBIL_STATIC;
  ASSERT_EQ(mobil_set_method(sim, ids.data(), 3, MOBIL_HAMSTRINGS, &method), MOBIL_OK) << sim.message();
  for (std::size_t i = 0; i < 3; ++i)
    ASSERT_TRUE(simulation.set_method(people[i], Muscle::hamstrings, {.method = Method::statics}));
  ASSERT_EQ(mobil_get_method(sim, ids[0], MOBIL_HAMSTRINGS, &method), MOBIL_OK);
  EXPECT_EQ(method.method, MOBIL_STATIC);
  const float place[3] = {50, 0, -20};
  ASSERT_EQ(mobil_place(sim, ids[4], place, 2), MOBIL_OK) << sim.message();
  ASSERT_TRUE(simulation.place(people[4], 50, -20, 2));
  ASSERT_EQ(mobil_enable(sim, &ids[5], 2, MOBIL_FORCES, 1), MOBIL_OK);
  for (const std::size_t i : {5U, 6U}) ASSERT_TRUE(simulation.enable(people[i], Feature::forces));
  ASSERT_EQ(mobil_enable(sim, &ids[6], 3, MOBIL_FAT, 1), MOBIL_OK);
  ASSERT_TRUE(simulation.enable(std::span(people).subspan(6, 3), Feature::fat));
  both(12);

  std::size_t slept = 0, compacted = 0;
  ASSERT_EQ(mobil_set_state(sim, &ids[10], 4, MOBIL_ASLEEP, 0, &slept), MOBIL_OK);
  EXPECT_EQ(*simulation.set_state(std::span(people).subspan(10, 4), PersonState::asleep), slept);
  auto unseen = modal_muscles();
  unseen.control_points = 0;
  auto choice = modal_choice();
  choice.modal.control_points = false;
  ASSERT_EQ(mobil_set_muscles(sim, &ids[14], 4, &unseen), MOBIL_OK) << sim.message();
  for (std::size_t i = 14; i < 18; ++i) ASSERT_TRUE(simulation.set_muscles(people[i], choice));
  both(30);
  ASSERT_EQ(mobil_set_state(sim, &ids[14], 4, MOBIL_COMPACT, 0, &compacted), MOBIL_OK);
  EXPECT_EQ(*simulation.set_state(std::span(people).subspan(14, 4), PersonState::compact), compacted);
  EXPECT_EQ(compacted, 4U);
  both(10);
  EXPECT_EQ(bits_of(sim, ids[14]), MOBIL_COMPACT | MOBIL_HAS_MUSCLES);
  EXPECT_NE(bits_of(sim, ids[7]) & MOBIL_HAS_FAT, 0);
  EXPECT_EQ(bits_of(sim, ids[10]) & MOBIL_ASLEEP, slept > 0 ? MOBIL_ASLEEP : 0);
  ASSERT_EQ(mobil_set_state(sim, &ids[10], 4, MOBIL_FULL, 0.005F, nullptr), MOBIL_OK);
  ASSERT_TRUE(simulation.set_state(std::span(people).subspan(10, 4), PersonState::full));
  ASSERT_EQ(mobil_set_state(sim, &ids[14], 4, MOBIL_FULL, 0.005F, nullptr), MOBIL_OK);
  ASSERT_TRUE(simulation.set_state(std::span(people).subspan(14, 4), PersonState::full));
  const float origin[3] = {64, 0, 0};
  ASSERT_EQ(mobil_shift_origin(sim, origin), MOBIL_OK);
  ASSERT_TRUE(simulation.shift_origin(64, 0));
  ASSERT_EQ(mobil_set_muscles(sim, ids.data(), 2, nullptr), MOBIL_OK);
  for (std::size_t i = 0; i < 2; ++i) ASSERT_TRUE(simulation.set_muscles(people[i], std::nullopt));
  ASSERT_EQ(mobil_despawn(sim, &ids[18], 2), MOBIL_OK);
  ASSERT_TRUE(simulation.despawn(std::span(people).subspan(18, 2)));
  both(10);
}

TEST(CInterface, LevelOfDetailMatchesCpp) {
  const Sim sim;
  const auto ids = spawn(sim, 30);
  auto options = filled<mobil_lod_options>(MOBIL_LOD_OPTIONS);
  options.machine_factor = 1;
  auto scene = filled<mobil_scene>(MOBIL_SCENE);
  scene.has_camera = 1;
  scene.eye[1] = 1.7F;
  scene.eye[2] = -6;
  scene.gaze[2] = 1;
  scene.compact_unseen = 1;
  ASSERT_EQ(mobil_lod_set_options(sim, &options, nullptr), MOBIL_OK) << sim.message();
  ASSERT_EQ(mobil_lod_set_scene(sim, &scene), MOBIL_OK) << sim.message();
  ASSERT_EQ(mobil_lod_manage(sim, ids.data(), ids.size(), nullptr), MOBIL_OK) << sim.message();

  Simulation simulation;
  Lod lod = simulation.lod();
  ASSERT_TRUE(lod.set_options({.machine_factor = 1}));
  LodScene needs;
  needs.camera = Viewpoint{.position_m = {0, 1.7F, -6}};
  needs.compact_unseen = true;
  ASSERT_TRUE(lod.set_scene(needs));
  const auto people = spawn_in(simulation, as_requests(some_people(30)));
  for (const Entity person : people) ASSERT_TRUE(lod.manage(person));
  std::size_t switched = 0;
  for (int frame = 0; frame < 30; ++frame) {
    auto did = filled<mobil_lod_counts>(MOBIL_LOD_COUNTS);
    ASSERT_EQ(mobil_tick(sim, 2), MOBIL_OK);
    simulation.tick(2);
    ASSERT_EQ(mobil_lod_report(sim, &did), MOBIL_OK);
    EXPECT_EQ(did.switched, lod.report().switched);
    EXPECT_EQ(did.looked_at, lod.report().evaluated);
    switched += did.switched;
  }
  EXPECT_GT(switched, 0U);
  EXPECT_EQ(sim.hash(), simulation.state_hash());
  char line[256];
  float error_m = -1;
  double cost_us = -1;
  ASSERT_EQ(mobil_lod_why(sim, ids[0], MOBIL_QUADRICEPS, line, sizeof line, &error_m, &cost_us), MOBIL_OK);
  EXPECT_EQ(line, lod.why(people[0], Muscle::quadriceps)->text);
  EXPECT_EQ(error_m, lod.why(people[0], Muscle::quadriceps)->predicted_error_m);
  ASSERT_EQ(mobil_lod_release(sim, ids.data(), 3), MOBIL_OK);
  EXPECT_EQ(mobil_lod_release(sim, ids.data(), 1), MOBIL_MISSING);
}

TEST(CInterface, RowsMatchComponents) {
  const Sim sim;
  auto muscles = filled<mobil_muscles>(MOBIL_MUSCLES);
  muscles.muscles = 1U << MOBIL_TRICEPS_SURAE;
  muscles.line_motion = 1;
  muscles.activation = MOBIL_BY_HOST;
  muscles.method = MOBIL_MODAL;
  const auto ids = spawn(sim, 3, &muscles);
  ASSERT_EQ(mobil_enable(sim, ids.data(), 3, MOBIL_FORCES, 1), MOBIL_OK);
  Simulation simulation;
  auto requests = as_requests(some_people(3));
  LegMuscles choice;
  choice.muscles = MuscleSet(0b100);
  choice.line_motion = true;
  choice.activation = ExcitationSource::host;
  choice.method = Method::modal;
  for (auto& request : requests) request.muscles = choice;
  const auto people = spawn_in(simulation, requests);
  for (const Entity person : people) ASSERT_TRUE(simulation.enable(person, Feature::forces));
  const float pull[3] = {0.2F, 0.5F, 1};
  ASSERT_EQ(mobil_set_excitation(sim, ids.data(), 3, MOBIL_TRICEPS_SURAE, MOBIL_LEFT, pull, 0), MOBIL_OK)
      << sim.message();
  for (std::size_t i = 0; i < 3; ++i)
    ASSERT_TRUE(simulation.set_excitation(people[i], Muscle::triceps_surae, Side::left, pull[i]));
  ASSERT_EQ(mobil_tick(sim, 33), MOBIL_OK);
  for (int i = 0; i < 33; ++i) simulation.tick();

  const auto rows = [&](int what) {
    const int floats = mobil_row_floats(what);
    std::vector<float> all(static_cast<std::size_t>(floats) * 3);
    EXPECT_EQ(mobil_read(sim, what, ids.data(), 3, all.data(), 0), MOBIL_OK) << sim.message();
    return std::vector<float>(all.end() - floats, all.end());  // of the last row
  };
  const Entity last = people[2];
  const auto joints = rows(MOBIL_JOINTS);
  const auto angles = *simulation.get<JointAngles>(last);
  EXPECT_EQ(joints[0], angles.pelvis_rotation);
  EXPECT_EQ(joints[5], angles.knee_flexion[0]);
  EXPECT_EQ(joints[12], angles.elbow_flexion[1]);
  const auto feet = *simulation.get<Feet>(last);
  const auto soles = rows(MOBIL_FEET);
  EXPECT_EQ(soles[2], feet.heel_m[0].z);
  EXPECT_EQ(soles[9], feet.toe_m[1].x);
  EXPECT_EQ(soles[19], feet.phase[1]);
  EXPECT_EQ(rows(MOBIL_CENTRE)[1], simulation.get<CentreOfMass>(last)->position_m.y);
  EXPECT_EQ(rows(MOBIL_STEP)[2], simulation.get<GaitState>(last)->time_s);
  EXPECT_EQ(rows(MOBIL_GROUND)[4], simulation.get<GroundReaction>(last)->force_n[1].y);
  EXPECT_EQ(rows(MOBIL_MOMENTS)[5], simulation.get<JointMoments>(last)->ankle_nm[1]);

  const Entity calf = simulation.muscle(last, Muscle::triceps_surae, Side::left);
  const auto muscle_rows = [&](int what) {
    const int floats = mobil_muscle_row_floats(sim, what, ids[2], MOBIL_TRICEPS_SURAE, MOBIL_LEFT);
    EXPECT_GT(floats, 0) << sim.message();
    std::vector<float> all(static_cast<std::size_t>(floats) * 3);
    EXPECT_EQ(mobil_read_muscles(sim, what, ids.data(), 3, MOBIL_TRICEPS_SURAE, MOBIL_LEFT, all.data(), 0), MOBIL_OK)
        << sim.message();
    return std::vector<float>(all.end() - floats, all.end());
  };
  EXPECT_EQ(muscle_rows(MOBIL_LINE)[3], simulation.get<LineOfAction>(calf)->force_n);
  EXPECT_EQ(muscle_rows(MOBIL_LINE_MOTION)[3], simulation.get<LineMotion>(calf)->ankle_dorsiflexion_arm_m);
  EXPECT_EQ(muscle_rows(MOBIL_REPORT)[2], simulation.get<BellyReport>(calf)->volume_ratio);
  EXPECT_EQ(muscle_rows(MOBIL_ACTIVATION)[1], simulation.get<Activation>(calf)->activation);
  EXPECT_EQ(muscle_rows(MOBIL_TENDON)[3], simulation.get<Musculotendon>(calf)->force_n);
  const auto nodes = muscle_rows(MOBIL_NODES);
  const NodalView view = nodal_displacement(simulation.world(), calf);
  ASSERT_EQ(nodes.size(), 3U * view.nodes);
  for (std::size_t f = 0; f < nodes.size(); ++f) EXPECT_EQ(nodes[f], view.first[f * lane_count]);

  auto known = filled<mobil_person>(MOBIL_PERSON);
  ASSERT_EQ(mobil_get_person(sim, ids[2], &known), MOBIL_OK);
  EXPECT_EQ(known.height_m, requests[2].body.height_m);
  EXPECT_FLOAT_EQ(known.speed_m_s, *requests[2].gait.speed_m_s);
  EXPECT_EQ(known.place[0], simulation.get<GaitState>(last)->line_x_m);
  std::vector<float> style(gait_parameters.size());
  ASSERT_EQ(mobil_get_style(sim, ids[2], style.data(), style.size()), MOBIL_OK) << sim.message();
  for (std::size_t i = 0; i < style.size(); ++i)
    EXPECT_EQ(style[i], simulation.gait_request(last)->style.*gait_parameters[i].value);
  EXPECT_EQ(mobil_get_style(sim, ids[2], style.data(), 3), MOBIL_ROOM);
}

TEST(CInterface, SnapshotsAreInterchangeableWithCpp) {
  const Sim sim;
  const auto muscles = modal_muscles();
  spawn(sim, 9, &muscles);
  ASSERT_EQ(mobil_tick(sim, 20), MOBIL_OK);
  std::vector<std::byte> bytes(mobil_snapshot_bytes(sim));
  std::size_t used = 0;
  EXPECT_EQ(mobil_save(sim, bytes.data(), bytes.size() - 1, &used), MOBIL_ROOM);
  EXPECT_EQ(used, bytes.size());
  ASSERT_EQ(mobil_save(sim, bytes.data(), bytes.size(), &used), MOBIL_OK);
  Simulation simulation;
  ASSERT_TRUE(simulation.restore(std::span(bytes).first(used)));
  EXPECT_EQ(simulation.state_hash(), sim.hash());
  const auto before = sim.hash();
  ASSERT_EQ(mobil_tick(sim, 5), MOBIL_OK);
  bytes[used / 2] ^= std::byte{1};
  EXPECT_EQ(mobil_restore(sim, bytes.data(), used), MOBIL_REFUSED);
  bytes[used / 2] ^= std::byte{1};
  auto limits = filled<mobil_limits>(MOBIL_LIMITS);
  limits.rows = 1;
  EXPECT_EQ(mobil_restore_within(sim, bytes.data(), used, &limits), MOBIL_REFUSED);
  EXPECT_NE(std::string(mobil_message(sim)).find("at most 1"), std::string::npos);
  limits.rows = 1000;
  limits.resources = 0;
  EXPECT_EQ(mobil_restore_within(sim, bytes.data(), used, &limits), MOBIL_REFUSED);
  EXPECT_NE(std::string(mobil_message(sim)).find("at most 0"), std::string::npos);
  limits.resources = 1000;
  limits.steps = 1000;
  limits.size = offsetof(mobil_limits, resources);  // of an older host
  EXPECT_EQ(mobil_restore_within(sim, bytes.data(), used, nullptr), MOBIL_REFUSED);
  ASSERT_EQ(mobil_restore_within(sim, bytes.data(), used, &limits), MOBIL_OK);
  ASSERT_EQ(mobil_restore(sim, bytes.data(), used), MOBIL_OK);
  EXPECT_EQ(sim.hash(), before);

  std::size_t size = 0;
  ASSERT_EQ(mobil_bake(sim, nullptr, 0, &size), MOBIL_OK);
  std::vector<std::byte> baked(size);
  ASSERT_EQ(mobil_bake(sim, baked.data(), size, nullptr), MOBIL_OK);
  EXPECT_EQ(mobil_load_baked(Sim(), baked.data(), size), MOBIL_OK);
  baked[size / 2] ^= std::byte{1};
  EXPECT_EQ(mobil_load_baked(Sim(), baked.data(), size), MOBIL_REFUSED);
}

TEST(CInterface, OneRefusalChangesNoPerson) {
  const Sim sim;
  const auto muscles = modal_muscles();
  auto ids = spawn(sim, 5, &muscles);
  ASSERT_EQ(mobil_tick(sim, 7), MOBIL_OK);
  auto posed = filled<mobil_person>(MOBIL_PERSON);
  posed.posed = 1;
  std::array<mobil_id, 2> dolls;
  const std::array both_posed = {posed, posed};
  ASSERT_EQ(mobil_spawn(sim, both_posed.data(), 0, 2, nullptr, dolls.data()), MOBIL_OK) << sim.message();
  const auto before = sim.hash();
  // `what` starts with the call's name.
  const auto refused = [&](const std::string& what, int expected, const std::function<int()>& request) {
    EXPECT_EQ(request(), expected) << what << ": " << sim.message();
    EXPECT_EQ(sim.message().find("mobil_" + what.substr(0, what.find(' ')) + ":"), 0U) << sim.message();
    EXPECT_EQ(sim.message().find('\n'), std::string::npos) << what;
    EXPECT_EQ(sim.hash(), before) << what;
  };
  const mobil_id gone = {7777, 1};
  std::vector<mobil_id> with_gone = ids, with_posed = ids, twice = ids;
  with_gone.back() = gone;
  with_posed.back() = dolls[0];
  twice.back() = ids[0];
  const std::size_t n = ids.size();

  refused("spawn", MOBIL_REFUSED, [&] {
    auto people = some_people(4);
    people[3].mass_kg = 31;
    std::array<mobil_id, 4> out;
    return mobil_spawn(sim, people.data(), 0, 4, nullptr, out.data());
  });
  refused("spawn of both kinds", MOBIL_REFUSED, [&] {
    auto people = some_people(2);
    people[1].posed = 1;
    std::array<mobil_id, 2> out;
    return mobil_spawn(sim, people.data(), 0, 2, nullptr, out.data());
  });
  refused("spawn of posed people", MOBIL_REFUSED, [&] {
    auto people = std::vector(3, posed);
    people[2].height_m = 3;
    std::array<mobil_id, 3> out;
    return mobil_spawn(sim, people.data(), 0, 3, &muscles, out.data());
  });
  refused("despawn", MOBIL_STALE, [&] { return mobil_despawn(sim, with_gone.data(), n); });
  refused("despawn twice", MOBIL_STALE, [&] { return mobil_despawn(sim, twice.data(), n); });
  auto walk = filled<mobil_walk>(MOBIL_WALK);
  walk.given = MOBIL_SPEED;
  walk.speed_m_s = 1.4F;
  refused("change_walk", MOBIL_STALE, [&] { return mobil_change_walk(sim, with_gone.data(), n, &walk); });
  refused("change_walk (posed)", MOBIL_MISSING, [&] { return mobil_change_walk(sim, with_posed.data(), n, &walk); });
  refused("change_walks", MOBIL_REFUSED, [&] {
    std::vector walks(n, walk);
    walks.back().speed_m_s = 40;
    return mobil_change_walks(sim, ids.data(), n, walks.data(), 0);
  });
  refused("change_walks of no heading", MOBIL_REFUSED, [&] {
    std::vector walks(n, walk);
    walks.back().given = MOBIL_HEADING;
    walks.back().heading_rad = std::numeric_limits<float>::quiet_NaN();
    return mobil_change_walks(sim, ids.data(), n, walks.data(), 0);
  });
  refused("set_poses", MOBIL_REFUSED, [&] {
    std::vector<float> poses(2 * 48 * 7);
    for (std::size_t s = 0; s < 2 * 48; ++s) poses[7 * s + 6] = s < 95 ? 1.0F : 2.0F;
    return mobil_set_poses(sim, dolls.data(), 2, poses.data(), 0, 0);
  });
  auto fixed = muscles;
  fixed.method = MOBIL_EXPLICIT_CENTRAL;
  fixed.dt_s = 0.009;
  refused("set_muscles", MOBIL_REFUSED, [&] { return mobil_set_muscles(sim, ids.data(), n, &fixed); });
  refused("set_muscles (stale)", MOBIL_STALE, [&] { return mobil_set_muscles(sim, with_gone.data(), n, nullptr); });
  auto moments = muscles;
  moments.activation = MOBIL_BY_MOMENTS;
  refused("set_muscles by moments", MOBIL_MISSING, [&] { return mobil_set_muscles(sim, ids.data(), n, &moments); });
  auto method = filled<mobil_method>(MOBIL_METHOD);
  method.method = MOBIL_MODAL;
  method.modes = 99;
  refused("set_method", MOBIL_REFUSED, [&] { return mobil_set_method(sim, ids.data(), n, MOBIL_HAMSTRINGS, &method); });
  method.modes = 8;
  refused("set_method of none", MOBIL_MISSING,
          [&] { return mobil_set_method(sim, with_posed.data(), n, MOBIL_HAMSTRINGS, &method); });
  refused("set_excitation", MOBIL_MISSING, [&] {
    const std::vector<float> pull(n, 0.5F);
    return mobil_set_excitation(sim, ids.data(), n, MOBIL_HAMSTRINGS, MOBIL_RIGHT, pull.data(), 0);
  });
  refused("enable forces", MOBIL_STALE, [&] { return mobil_enable(sim, with_gone.data(), n, MOBIL_FORCES, 1); });
  refused("enable fat", MOBIL_STALE, [&] { return mobil_enable(sim, with_gone.data(), n, MOBIL_FAT, 1); });
  refused("set_state", MOBIL_STALE,
          [&] { return mobil_set_state(sim, with_gone.data(), n, MOBIL_ASLEEP, 0, nullptr); });
  refused("set_state of one twice", MOBIL_STALE,
          [&] { return mobil_set_state(sim, twice.data(), n, MOBIL_ASLEEP, 0, nullptr); });
  refused("set_state to be posed", MOBIL_REFUSED,
          [&] { return mobil_set_state(sim, ids.data(), n, MOBIL_POSED, 0, nullptr); });
  refused("set_state of no kind", MOBIL_REFUSED, [&] { return mobil_set_state(sim, ids.data(), n, 3, 0, nullptr); });
  refused("enable of no kind", MOBIL_REFUSED, [&] { return mobil_enable(sim, ids.data(), n, 3, 1); });
  refused("poses of a stale one", MOBIL_STALE, [&] {
    std::vector<float> poses(n * 48 * 7, 5);
    const int code = mobil_poses(sim, with_gone.data(), n, nullptr, poses.data(), 0);
    EXPECT_EQ(poses, std::vector<float>(poses.size(), 5));
    return code;
  });
  refused("read", MOBIL_MISSING, [&] {
    std::vector<float> out(n * 12, 5);
    const int code = mobil_read(sim, MOBIL_GROUND, ids.data(), n, out.data(), 0);
    EXPECT_EQ(out, std::vector<float>(out.size(), 5));
    return code;
  });
}

TEST(CInterface, StructsOfOtherVersionsKeepTheirMeaning) {
  const Sim sim;
  // An older program: its struct ends where speed begins. Bytes after that are not read.
  struct Older {
    mobil_person person;
  } older{};
  std::memset(&older, 0xff, sizeof older);
  const std::size_t known = offsetof(mobil_person, given);
  ASSERT_EQ(mobil_defaults(MOBIL_PERSON, &older, known), MOBIL_OK);
  older.person.height_m = 1.9F;
  mobil_id id;
  ASSERT_EQ(mobil_spawn(sim, &older.person, 0, 1, nullptr, &id), MOBIL_OK) << sim.message();
  auto back = filled<mobil_person>(MOBIL_PERSON);
  ASSERT_EQ(mobil_get_person(sim, id, &back), MOBIL_OK);
  EXPECT_EQ(back.height_m, 1.9F);
  EXPECT_NEAR(back.speed_m_s, 5 / 3.6, 1e-3);
  // Two of them, packed as in that program.
  std::vector<unsigned char> rows(2 * known);
  for (std::size_t i = 0; i < 2; ++i) std::memcpy(&rows[i * known], &older, known);
  std::array<mobil_id, 2> ids;
  EXPECT_EQ(mobil_spawn(sim, reinterpret_cast<const mobil_person*>(rows.data()), 0, 2, nullptr, ids.data()), MOBIL_OK)
      << sim.message();
  // Output is no longer than that struct.
  struct Out {
    mobil_person person;
    unsigned char behind;
  } out{};
  std::memset(&out, 0xee, sizeof out);
  out.person.size = known;
  ASSERT_EQ(mobil_get_person(sim, id, &out.person), MOBIL_OK);
  EXPECT_EQ(out.person.size, known);
  EXPECT_EQ(reinterpret_cast<const unsigned char*>(&out)[known], 0xee);

  // A newer program: additional fields are zero as long as no new feature is requested.
  struct Newer {
    mobil_person person;
    double something;
  } newer{};
  ASSERT_EQ(mobil_defaults(MOBIL_PERSON, &newer, sizeof newer), MOBIL_OK);
  EXPECT_EQ(newer.person.size, sizeof newer);
  EXPECT_EQ(newer.something, 0);
  EXPECT_EQ(mobil_spawn(sim, &newer.person, 0, 1, nullptr, &id), MOBIL_OK) << sim.message();
  newer.something = 1;
  EXPECT_EQ(mobil_spawn(sim, &newer.person, 0, 1, nullptr, &id), MOBIL_STRUCT);
  // A struct that was never filled.
  mobil_person unfilled{};
  EXPECT_EQ(mobil_spawn(sim, &unfilled, 0, 1, nullptr, &id), MOBIL_STRUCT);
  EXPECT_NE(sim.message().find("mobil_defaults"), std::string::npos) << sim.message();
}

TEST(CInterface, NullPointersAreRefused) {
  EXPECT_EQ(mobil_tick(nullptr, 1), MOBIL_REFUSED);
  EXPECT_EQ(mobil_spawn(nullptr, nullptr, 0, 1, nullptr, nullptr), MOBIL_REFUSED);
  EXPECT_EQ(mobil_create(nullptr, nullptr, nullptr, 0), MOBIL_REFUSED);
  mobil_sim* none;
  char line[16];
  EXPECT_EQ(mobil_create(nullptr, &none, line, sizeof line), MOBIL_REFUSED);
  EXPECT_EQ(std::string(line).size(), sizeof line - 1);  // as much as fits
  EXPECT_EQ(none, nullptr);
  mobil_destroy(nullptr);
  mobil_drop_surfaces(nullptr);
  EXPECT_EQ(mobil_muscle_name(-1), nullptr);
  EXPECT_EQ(mobil_muscle_name(1000), nullptr);
  EXPECT_EQ(mobil_find_muscle(nullptr), MOBIL_MISSING);
  EXPECT_EQ(mobil_find_muscle("soleus"), mobil_find_muscle(mobil_muscle_name(mobil_find_muscle("soleus"))));
  EXPECT_EQ(mobil_segment_name(48), nullptr);
  EXPECT_EQ(mobil_segment_parent(mobil_find_segment("foot_left")), mobil_find_segment("shank_left"));
  const Sim sim;
  const mobil_id id{};
  auto person = filled<mobil_person>(MOBIL_PERSON);
  EXPECT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, nullptr), MOBIL_REFUSED);
  EXPECT_EQ(mobil_spawn(sim, nullptr, 0, 1, nullptr, nullptr), MOBIL_REFUSED);
  EXPECT_EQ(mobil_despawn(sim, nullptr, 1), MOBIL_REFUSED);
  EXPECT_EQ(mobil_despawn(sim, nullptr, 0), MOBIL_OK);
  EXPECT_EQ(mobil_poses(sim, &id, 1, nullptr, nullptr, 0), MOBIL_REFUSED);
  EXPECT_EQ(mobil_read(sim, MOBIL_JOINTS, &id, 1, nullptr, 0), MOBIL_REFUSED);
  EXPECT_EQ(mobil_restore(sim, nullptr, 10), MOBIL_REFUSED);
  EXPECT_EQ(mobil_advance(sim, std::nan(""), nullptr), MOBIL_REFUSED);
  EXPECT_EQ(mobil_indices(nullptr, nullptr, 0), MOBIL_REFUSED);
  EXPECT_EQ(mobil_defaults(99, &person, sizeof person), MOBIL_REFUSED);
}

}  // namespace
}  // namespace mobil::c_test
