// MJCF of a walk, read back: masses, names, joints in their places, keyframe, velocities.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/export/root_motion.h>
#include <mobil/mujoco_writer.h>
#include <mobil/pose_writer.h>
#include <mobil/systems/poses/roots.h>
#include "assets/export/model_muscles.h"
#include "tests/files/formats_fixture.h"
#include "tests/files/xml_elements.h"
#include "tests/refused.h"

namespace mobil::mujoco_file_test {
using Eigen::Quaterniond;
using Eigen::Vector3d;
using formats_test::widened;
using xml::elements_of;
using xml::numbers;
using xml::vector3;
using xml::XmlElement;
namespace fs = std::filesystem;

constexpr double exact_m = 1e-5;

struct Place {
  Vector3d position = Vector3d::Zero();
  Quaterniond rotation = Quaterniond::Identity();
};

/// Poses the bodies of the file as MuJoCo does, by its own order of joints.
std::map<std::string, Place> posed(const std::vector<XmlElement>& file, const std::vector<double>& qpos) {
  std::map<std::string, Place> by_name;
  std::map<std::size_t, Place> places;
  std::size_t q = 0;
  const auto quaternion = [&] {
    q += 4;
    return Quaterniond(qpos.at(q - 4), qpos.at(q - 3), qpos.at(q - 2), qpos.at(q - 1));
  };
  for (std::size_t i = 0; i < file.size(); ++i) {
    const XmlElement& e = file[i];
    if (e.tag == "body") {
      const Place from = places[e.parent];
      places[i] = {from.position + from.rotation * vector3(e.attribute.at("pos")), from.rotation};
    }
    if (file[e.parent].tag == "body" && (e.tag == "joint" || e.tag == "freejoint")) {
      Place& place = places[e.parent];
      if (e.tag == "freejoint") {
        place.position = {qpos.at(0), qpos.at(1), qpos.at(2)};
        q = 3;
        place.rotation = quaternion();
      } else if (e.attribute.at("type") == "ball") {
        place.rotation = place.rotation * quaternion();
      } else {
        const Vector3d anchor = e.attribute.contains("pos") ? vector3(e.attribute.at("pos")) : Vector3d::Zero();
        const Vector3d at = place.position + place.rotation * anchor;
        place.rotation = place.rotation * Eigen::AngleAxisd(qpos.at(q++), vector3(e.attribute.at("axis")));
        place.position = at - place.rotation * anchor;
      }
    }
    if (e.tag == "body") continue;
    if (file[e.parent].tag == "body") by_name[file[e.parent].attribute.at("name")] = places[e.parent];
  }
  EXPECT_EQ(q, qpos.size());
  return by_name;
}

void expect_pose(const std::vector<XmlElement>& file, const std::vector<double>& qpos, const Pose<float>& pose) {
  const auto places = posed(file, qpos);
  ASSERT_EQ(places.size(), segment_count);
  for (std::size_t s = 0; s < segment_count; ++s) {
    const Place& place = places.at(std::string(segment_name[s]));
    EXPECT_LT((place.position - widened(pose.position_m[s])).norm(), exact_m) << segment_name[s];
    EXPECT_LT(place.rotation.angularDistance(widened(pose.rotation[s]).normalized()), 1e-4) << segment_name[s];
  }
}

/// A simulated walk, which turns, with the poses around each tick.
struct Walked {
  Body body;
  WalkRecording recording;
};
Walked walked(float height_m, float mass_kg, std::size_t ticks) {
  Simulation simulation;
  const Entity person = *simulation.spawn({.height_m = height_m, .mass_kg = mass_kg}, {});
  EXPECT_TRUE(simulation.enable(person, Feature::forces));
  simulation.tick(20);
  EXPECT_TRUE(simulation.turn_to(person, 1.0F));
  Walked made{simulation.person(person)->body, {}};
  made.recording.frame_s = simulation.tick_s();
  made.recording.start_s = simulation.time_s() + simulation.tick_s();
  PoseWriter writer;
  for (std::size_t t = 0; t < ticks; ++t) {
    auto& around = made.recording.around.emplace_back();
    for (std::size_t i = 0; i < 2; ++i) {
      std::vector<float> written(7 * segment_count);
      const double ahead_s = simulation.tick_s() + (i == 0 ? -1 : 1) * static_cast<double>(motion_difference_s);
      EXPECT_TRUE(
          writer.write(simulation.world(), {&person, 1}, ahead_s, {}, {std::as_writable_bytes(std::span(written))}));
      for (std::size_t s = 0; s < segment_count; ++s) {
        const float* const v = &written[7 * s];
        around[i].position_m[s] = {v[0], v[1], v[2]};
        around[i].rotation[s] = {v[3], v[4], v[5], v[6]};
      }
    }
    simulation.tick();
    made.recording.frames.push_back(*simulation.get<Pose>(person));
    made.recording.ground.push_back(*simulation.get<GroundReaction>(person));
    Root root;
    EXPECT_TRUE(simulation.roots({&person, 1}, {&root, 1}));
    made.recording.root.push_back({root.x_m, root.z_m, root.heading_rad});
  }
  return made;
}

/// A table of numbers, by column.
struct MotionRows {
  std::map<std::string, std::vector<double>> column;
  std::size_t rows = 0;

  explicit MotionRows(const fs::path& file) {
    std::istringstream lines(read_bytes(file));
    std::string line, cell;
    std::getline(lines, line);
    std::vector<std::string> names;
    for (std::istringstream in(line); std::getline(in, cell, ',');) names.push_back(cell);
    for (; std::getline(lines, line); ++rows) {
      std::istringstream in(line);
      for (const auto& name : names) {
        EXPECT_TRUE(std::getline(in, cell, ',')) << line;
        column[name].push_back(std::stod(cell));
      }
    }
  }
  bool has(const std::string& name) const { return column.contains(name); }
  double number(std::size_t row, const std::string& name) const { return column.at(name).at(row); }
};

struct Files {
  TemporaryFolder folder;
  std::vector<XmlElement> model;
  std::unique_ptr<MotionRows> motion;

  explicit Files(const Walked& walk) {
    const auto model_file = folder.path / "walk.xml", motion_file = folder.path / "walk_motion.csv";
    const auto written = write_mujoco_model(model_file, walk.body, walk.recording);
    EXPECT_TRUE(written) << written.error().message;
    EXPECT_TRUE(write_mujoco_motion(motion_file, walk.body, walk.recording));
    model = elements_of(model_file);
    motion = std::make_unique<MotionRows>(motion_file);
  }
  std::vector<double> values(std::size_t row, const std::string& name) const {
    std::vector<double> found;
    while (motion->has(fmt::format("{}_{}", name, found.size())))
      found.push_back(motion->number(row, fmt::format("{}_{}", name, found.size())));
    return found;
  }
};

const float bodies[][2] = {{1.8F, 80}, {1.5F, 48}, {1.65F, 95}};

TEST(Mujoco, MassesAndInertiasAreTheBodys) {
  for (const auto& [height_m, mass_kg] : bodies) {
    const Walked walk = walked(height_m, mass_kg, 1);
    const Files files(walk);
    double sum_kg = 0;
    for (const XmlElement& e : files.model) {
      if (e.tag != "inertial") continue;
      const auto* const name = std::ranges::find(segment_name, files.model[e.parent].attribute.at("name"));
      const auto segment = static_cast<std::size_t>(name - segment_name.begin());
      const double mass = std::stod(e.attribute.at("mass"));
      EXPECT_NEAR(mass, walk.body.mass_kg[segment], 1e-6 * mass);
      const Vector3d inertia = vector3(e.attribute.at("diaginertia"));
      const Vec3<double> own = segment_inertia_kg_m2(walk.body, static_cast<Segment>(segment));
      EXPECT_LT((inertia - Vector3d(own.x, own.y, own.z)).norm(), 1e-6 * inertia.norm());
      for (int axis = 0; axis < 3; ++axis) EXPECT_LE(inertia[axis], 0.5 * inertia.sum()) << *name;
      EXPECT_LT((vector3(e.attribute.at("pos")) - widened(walk.body.centre_of_mass_m[segment])).norm(), 1e-7);
      sum_kg += mass;
    }
    EXPECT_NEAR(sum_kg, mass_kg, 1e-4);
  }
}

TEST(Mujoco, NamesAreUniqueAndReferencesExist) {
  const Files files(walked(1.8F, 80, 1));
  std::map<std::string, std::set<std::string>> names;
  const auto kind = [&](const XmlElement& e) {
    const std::string& in = files.model[e.parent].tag;
    return in == "tendon" || in == "actuator" || in == "sensor" || in == "equality" ? in : e.tag;
  };
  for (const XmlElement& e : files.model) {
    const auto name = e.attribute.find("name");
    if (name != e.attribute.end()) {
      EXPECT_TRUE(names[kind(e)].insert(name->second).second) << kind(e) << " " << name->second;
    }
  }
  EXPECT_EQ(names["body"].size(), segment_count);
  EXPECT_EQ(names["tendon"].size(), 2 * member_muscles().size());
  EXPECT_EQ(names["actuator"], names["tendon"]);
  EXPECT_EQ(names["sensor"].size(), 4U);
  for (const XmlElement& e : files.model) {
    const auto refers = [&](const char* attribute, const char* to) {
      const auto found = e.attribute.find(attribute);
      if (found == e.attribute.end()) return;
      EXPECT_TRUE(names[to].contains(found->second)) << e.tag << " " << found->second;
    };
    refers("site", "site");
    refers("sidesite", "site");
    refers("geom", "geom");
    refers("tendon", "tendon");
    refers("joint1", "joint");
    refers("joint2", "joint");
  }
}

TEST(Mujoco, MusclesHaveTheSimulationsFibresAndTendons) {
  for (const auto& [height_m, mass_kg] : bodies) {
    const Walked walk = walked(height_m, mass_kg, 1);
    const Files files(walk);
    const auto members = member_muscles();
    std::size_t count = 0;
    for (const XmlElement& e : files.model) {
      if (e.tag != "muscle" || !e.attribute.contains("tendon")) continue;
      const std::string& name = e.attribute.at("name");
      const auto member = std::ranges::find(members, name.substr(0, name.rfind('_')), &MemberMuscle::name);
      ASSERT_NE(member, members.end()) << name;
      const HillMuscle own = hill_muscle(walk.body, *member);
      const auto length = numbers(e.attribute.at("lengthrange")), range = numbers(e.attribute.at("range"));
      const double fibre = (length.at(1) - length.at(0)) / (range.at(1) - range.at(0));  // MuJoCo's formula
      EXPECT_NEAR(fibre, own.fibre_m, 1e-5) << name;
      EXPECT_NEAR(length[0] - range[0] * fibre, own.tendon_m, 2e-5) << name;
      EXPECT_NEAR(std::stod(e.attribute.at("force")), own.force_n * std::cos(own.pennation_rad), 0.01) << name;
      ++count;
    }
    EXPECT_EQ(count, 2 * members.size());
  }
}

TEST(Mujoco, JointsOfEveryFrameAreWithinAHundredthOfAMillimetre) {
  for (const auto& [height_m, mass_kg] : bodies) {
    const Walked walk = walked(height_m, mass_kg, 90);
    const Files files(walk);
    ASSERT_EQ(files.motion->rows, walk.recording.frames.size());
    for (std::size_t f = 0; f < walk.recording.frames.size(); ++f)
      expect_pose(files.model, files.values(f, "qpos"), walk.recording.frames[f]);
    const auto key = std::ranges::find(files.model, "key", &XmlElement::tag);
    ASSERT_NE(key, files.model.end());
    expect_pose(files.model, numbers(key->attribute.at("qpos")), walk.recording.frames[0]);
    const auto qvel = numbers(key->attribute.at("qvel")), own = files.values(0, "qvel");
    ASSERT_EQ(qvel.size(), own.size());
    for (std::size_t i = 0; i < qvel.size(); ++i) EXPECT_NEAR(qvel[i], own[i], 1e-5);
    EXPECT_NEAR(std::stod(key->attribute.at("time")), walk.recording.start_s, 1e-6);
  }
}

TEST(Mujoco, VelocitiesAndAccelerationsLeadToThePosesAround) {
  const Walked walk = walked(1.8F, 80, 60);
  const Files files(walk);
  for (std::size_t f = 0; f < walk.recording.frames.size(); ++f) {
    const auto qpos = files.values(f, "qpos"), qvel = files.values(f, "qvel"), qacc = files.values(f, "qacc");
    ASSERT_EQ(qvel.size(), qacc.size());
    for (const std::size_t i : {0U, 1U}) {
      const double s = (i == 0 ? -1 : 1) * static_cast<double>(motion_difference_s);
      auto moved = qpos;
      std::size_t q = 0, v = 0;
      const auto step = [&] {
        ++v;
        return s * qvel.at(v - 1) + 0.5 * s * s * qacc.at(v - 1);
      };
      const auto turn = [&] {
        const double x = step(), y = step(), z = step();
        const Vector3d by(x, y, z);
        const Quaterniond now(qpos.at(q), qpos.at(q + 1), qpos.at(q + 2), qpos.at(q + 3));
        const Quaterniond then = now * Eigen::AngleAxisd(by.norm(), by.stableNormalized());
        for (const double part : {then.w(), then.x(), then.y(), then.z()}) moved.at(q++) = part;
      };
      for (const XmlElement& e : files.model) {
        if (e.tag == "freejoint") {
          for (; q < 3; ++q) moved.at(q) += step();
          turn();
        } else if (e.tag == "joint" && files.model[e.parent].tag == "body") {
          if (e.attribute.at("type") == "ball")
            turn();
          else
            moved.at(q++) += step();
        }
      }
      ASSERT_EQ(v, qvel.size());
      expect_pose(files.model, moved, walk.recording.around[f][i]);
    }
  }
}

TEST(Mujoco, GroundColumnsAreTheForcesAndAbsentWithoutThem) {
  Walked walk = walked(1.8F, 80, 3);
  const Files files(walk);
  for (std::size_t f = 0; f < 3; ++f) {
    const GroundReaction<float>& ground = walk.recording.ground[f];
    for (const std::size_t side : {0U, 1U}) {
      const std::string name = side == 0 ? "right" : "left";
      EXPECT_FLOAT_EQ(static_cast<float>(files.motion->number(f, "ground_force_y_" + name + "_n")),
                      ground.force_n[side].y);
      EXPECT_FLOAT_EQ(static_cast<float>(files.motion->number(f, "centre_of_pressure_z_" + name + "_m")),
                      ground.centre_m[side].z);
      EXPECT_NEAR(files.motion->number(f, "free_moment_" + name + "_nm"), ground.free_moment_nm[side], 1e-5);
    }
  }
  walk.recording.ground.clear();
  EXPECT_FALSE(Files(walk).motion->has("ground_force_y_right_n"));
}

TEST(Mujoco, AClosedCycleKeepsItsVelocitiesAndForces) {
  Walked walk = walked(1.8F, 80, 30);
  const Files before(walk);
  const RecordedRoot first = walk.recording.root.front();
  close_cycle(walk.recording);
  const Files after(walk);
  for (std::size_t f = 0; f + 1 < walk.recording.frames.size(); ++f) {
    const auto a = before.values(f, "qvel"), b = after.values(f, "qvel");
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 2e-3) << f << " " << i;
    for (const std::string side : {"right", "left"}) {
      if (before.motion->number(f, "ground_force_y_" + side + "_n") == 0) continue;
      const std::string column = "centre_of_pressure_z_" + side + "_m";
      EXPECT_NEAR(after.motion->number(f, column) - before.motion->number(f, column), -first.z_m, 1e-5);
    }
  }
}

TEST(Mujoco, RefusalsNameTheFrameAndTheSegment) {
  const TemporaryFolder folder;
  const auto file = folder.path / "walk.xml";
  const Walked walk = walked(1.8F, 80, 2);
  WalkRecording bad = walk.recording;
  bad.around.clear();
  EXPECT_TRUE(is_refused(write_mujoco_model(file, walk.body, bad), "poses around 0 frames"));
  EXPECT_TRUE(is_refused(write_mujoco_motion(file, walk.body, bad), "poses around 0 frames"));
  const Body other = *make_body({.height_m = 1.7F, .mass_kg = 80});
  EXPECT_TRUE(is_refused(write_mujoco_model(file, other, walk.recording), "from its place in the body"));
  bad = walk.recording;
  const std::size_t shank = index(Segment::shank_left);
  const Quaterniond twisted = widened(bad.frames[1].rotation[shank]) * Eigen::AngleAxisd(0.1, Vector3d::UnitY());
  bad.frames[1].rotation[shank] = {static_cast<float>(twisted.x()), static_cast<float>(twisted.y()),
                                   static_cast<float>(twisted.z()), static_cast<float>(twisted.w())};
  EXPECT_TRUE(is_refused(write_mujoco_model(file, walk.body, bad), "frame 1: shank_left turns by"));
  EXPECT_FALSE(fs::exists(file));
}

}  // namespace mobil::mujoco_file_test
