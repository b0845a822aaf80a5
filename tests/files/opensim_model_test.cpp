// OpenSim's model of a body, read back: masses, references, and joints and muscles moved by a walk's .mot.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/opensim_writer.h>
#include "assets/export/model_muscles.h"
#include "tests/files/formats_fixture.h"
#include "tests/files/opensim_table.h"
#include "tests/files/xml_elements.h"

namespace mobil::opensim_model_test {
using Eigen::Vector3d;
using formats_test::widened;
using xml::numbers;
using xml::vector3;
using xml::XmlElement;

constexpr double degree = formats_test::pi / 180;

/// The model as OpenSim reads it.
class Model {
 public:
  explicit Model(const Body& body) {
    const auto path = folder_.path / "walk.osim";
    EXPECT_TRUE(write_opensim_model(path, body));
    all = xml::elements_of(path);
  }

  std::vector<std::size_t> inside(std::size_t in, const std::string& tag) const {
    std::vector<std::size_t> found;
    for (std::size_t i = in + 1; i < all.size(); ++i)
      if (all[i].tag == tag && has_ancestor(i, in)) found.push_back(i);
    return found;
  }
  std::vector<std::size_t> all_of(const std::string& tag) const { return inside(0, tag); }
  std::string text(std::size_t in, const std::string& tag) const { return all.at(inside(in, tag).at(0)).text; }
  std::string name(std::size_t i) const { return all[i].attribute.at("name"); }

  /// Places bodies for values of coordinates (rad and m; missing ones are 0).
  std::map<std::string, Eigen::Isometry3d> posed(const std::map<std::string, double>& value) const {
    std::map<std::string, Eigen::Isometry3d> place{{"/ground", Eigen::Isometry3d::Identity()}};
    for (const std::size_t joint : all_of("CustomJoint")) {
      const auto frames = inside(joint, "PhysicalOffsetFrame");
      EXPECT_EQ(name(frames.at(0)), text(joint, "socket_parent_frame"));
      EXPECT_EQ(name(frames.at(1)), text(joint, "socket_child_frame"));
      EXPECT_EQ(vector3(text(frames[1], "translation")).norm(), 0);
      Eigen::Isometry3d now = place.at(text(frames[0], "socket_parent"));
      now.translate(vector3(text(frames[0], "translation")));
      Vector3d slide = Vector3d::Zero();
      Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
      for (const std::size_t axis : inside(joint, "TransformAxis")) {
        const auto found = value.find(text(axis, "coordinates"));
        const double by = found == value.end() ? 0 : found->second;
        if (name(axis).starts_with("translation"))
          slide += by * vector3(text(axis, "axis"));
        else
          turn = turn * Eigen::AngleAxisd(by, vector3(text(axis, "axis")));
      }
      now.translate(slide);
      now.rotate(turn);
      place[text(frames[1], "socket_parent")] = now;
    }
    return place;
  }

  std::vector<XmlElement> all;

 private:
  bool has_ancestor(std::size_t i, std::size_t ancestor) const {
    while (i != 0 && i != ancestor) i = all[i].parent;
    return i == ancestor;
  }
  TemporaryFolder folder_;
};

Vector3d in_opensim(const Vector3d& v) {
  return {v.z(), v.y(), -v.x()};
}

const BodyRequest bodies[] = {{.height_m = 1.8F, .mass_kg = 80}, {.height_m = 1.55F, .mass_kg = 60}};

TEST(OpensimModel, MassesAddUpAndReferencesExist) {
  for (const BodyRequest& request : bodies) {
    const Body body = *make_body(request);
    const Model model(body);
    double mass = 0;
    Vector3d moment = Vector3d::Zero(), own = Vector3d::Zero();
    const auto places = model.posed({});
    std::set<std::string> names = {"/ground"}, all_names;
    for (const std::size_t i : model.all_of("Body")) {
      const double m = std::stod(model.text(i, "mass"));
      mass += m;
      names.insert("/bodyset/" + model.name(i));
      moment += m * (places.at("/bodyset/" + model.name(i)) * vector3(model.text(i, "mass_center")));
      const auto inertia = numbers(model.text(i, "inertia"));
      for (std::size_t a = 0; a < 3; ++a) EXPECT_LE(2 * inertia.at(a), inertia[0] + inertia[1] + inertia[2]);
    }
    EXPECT_NEAR(mass, body.request.mass_kg, 1e-4);
    const Pose<float> standing = standing_pose(body);
    for (std::size_t s = 0; s < segment_count; ++s)
      own += body.mass_kg[s] * (widened(standing.position_m[s]) + widened(body.centre_of_mass_m[s]));
    // the model's pelvis is at the ground's origin
    const Vector3d hips = 0.5 * (widened(standing.position_m[index(Segment::thigh_right)]) +
                                 widened(standing.position_m[index(Segment::thigh_left)]));
    const Vector3d from_hips = in_opensim(own / mass - hips);
    const auto femurs =
        0.5 * (places.at("/bodyset/femur_r").translation() + places.at("/bodyset/femur_l").translation());
    EXPECT_LT((moment / mass - femurs - from_hips).norm(), 1e-5);
    EXPECT_EQ(names.size(), 11U);
    for (const char* tag : {"socket_parent", "socket_parent_frame"}) {
      for (const std::size_t i : model.all_of(tag)) {
        const std::string& to = model.all[i].text;
        EXPECT_TRUE(names.contains(to) || to.ends_with("_offset")) << to;
      }
    }
    for (const char* tag : {"Body", "CustomJoint", "Coordinate", "Thelen2003Muscle", "PathPoint"})
      for (const std::size_t i : model.all_of(tag))
        EXPECT_TRUE(all_names.insert(model.name(i)).second) << model.name(i);
    EXPECT_EQ(model.all_of("Thelen2003Muscle").size(), 2 * member_muscles().size());
  }
}

TEST(OpensimModel, MotionOfAWalkMovesItsJointsToTheirPlaces) {
  for (const BodyRequest& request : bodies) {
    Simulation simulation;
    const Entity person = *simulation.spawn(request, {});
    const Body body = simulation.person(person)->body;
    WalkRecording walk;
    for (int t = 0; t < 90; ++t) {
      simulation.tick();
      walk.frames.push_back(*simulation.get<Pose>(person));
    }
    const TemporaryFolder folder;
    ASSERT_TRUE(write_opensim_motion(folder.path / "walk.mot", walk));
    const OpensimTable table(folder.path / "walk.mot");
    const Model model(body);
    std::set<std::string> coordinates;
    for (const std::size_t i : model.all_of("Coordinate")) coordinates.insert(model.name(i));
    EXPECT_EQ(coordinates, std::set<std::string>(table.names.begin() + 1, table.names.end()));
    const struct {
      const char* body;
      Segment segment;
      double within_m;
    } joints[] = {{"femur_r", Segment::thigh_right, 1e-5},
                  {"femur_l", Segment::thigh_left, 1e-5},
                  {"tibia_r", Segment::shank_right, 1e-5},
                  {"tibia_l", Segment::shank_left, 1e-5},
                  {"calcn_r", Segment::foot_right, 1e-5},
                  {"calcn_l", Segment::foot_left, 1e-5},
                  {"torso", Segment::L5, 1e-5},
                  {"toes_r", Segment::toes_right, 0.03},
                  {"toes_l", Segment::toes_left, 0.03}};
    for (std::size_t f = 0; f < walk.frames.size(); ++f) {
      std::map<std::string, double> value;
      for (const auto& name : coordinates)
        value[name] = table.at(name, f) * (name.starts_with("pelvis_t") && name != "pelvis_tilt" ? 1 : degree);
      const auto places = model.posed(value);
      for (const auto& joint : joints) {
        const Vector3d place = in_opensim(widened(walk.frames[f].position_m[index(joint.segment)]));
        EXPECT_LT((places.at(std::string("/bodyset/") + joint.body).translation() - place).norm(), joint.within_m)
            << joint.body << " at " << f;
      }
    }
  }
}

/// Natural cubic spline, as SimmSpline is: of second derivatives that vanish at both ends.
double spline_at(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  const auto h = [&](Eigen::Index i) { return x[static_cast<std::size_t>(i + 1)] - x[static_cast<std::size_t>(i)]; };
  const auto slope = [&](Eigen::Index i) {
    return (y[static_cast<std::size_t>(i + 1)] - y[static_cast<std::size_t>(i)]) / h(i);
  };
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    rows.row(i).segment(i - 1, 3) << h(i - 1), 2 * (h(i - 1) + h(i)), h(i);
    right[i] = 6 * (slope(i) - slope(i - 1));
  }
  const Eigen::VectorXd m = rows.partialPivLu().solve(right);
  Eigen::Index k = 0;
  while (k + 2 < n && x[static_cast<std::size_t>(k + 1)] < at) ++k;
  const double t = at - x[static_cast<std::size_t>(k)], step = h(k);
  return y[static_cast<std::size_t>(k)] + t * (slope(k) - step * (2 * m[k] + m[k + 1]) / 6) + t * t * m[k] / 2 +
         t * t * t * (m[k + 1] - m[k]) / (6 * step);
}

TEST(OpensimModel, MusclesAreAsLongAsTheirLinesOfAction) {
  const Body body = *make_body(bodies[0]);
  const Model model(body);
  const LegScale<double> scale = leg_scale(body);
  std::map<std::string, double> largest_m;
  for (const double hip_deg : {-20.0, 0.0, 30.0}) {
    for (double knee_deg = 0; knee_deg <= 100; knee_deg += 5) {
      std::map<std::string, double> value;
      for (const std::string side : {"_r", "_l"}) {
        value["hip_flexion" + side] = hip_deg * degree;
        value["knee_angle" + side] = -knee_deg * degree;
        value["ankle_angle" + side] = 10 * degree;
      }
      const auto places = model.posed(value);
      const LegFrames<double> leg = bent_leg(body, hip_deg, knee_deg, 10);
      for (const std::size_t muscle : model.all_of("Thelen2003Muscle")) {
        const std::string name = model.name(muscle), member = name.substr(0, name.size() - 2);
        double length = 0;
        std::optional<Vector3d> before;
        const std::size_t points = model.inside(muscle, "objects").at(0);
        for (std::size_t i = points + 1; i < model.all.size(); ++i) {
          if (model.all[i].parent != points) continue;
          const std::string& kind = model.all[i].tag;
          if (kind == "ConditionalPathPoint") {
            const auto range = numbers(model.text(i, "range"));
            const bool of_hip = model.text(i, "socket_coordinate").find("hip_flexion") != std::string::npos;
            const double angle = (of_hip ? hip_deg : -knee_deg) * degree;
            if (angle < range.at(0) || angle > range.at(1)) continue;
          }
          Vector3d at;
          if (kind == "MovingPathPoint") {
            const auto splines = model.inside(i, "SimmSpline");
            for (int axis = 0; axis < 3; ++axis) {
              const std::size_t spline = splines.at(static_cast<std::size_t>(axis));
              at[axis] =
                  spline_at(numbers(model.text(spline, "x")), numbers(model.text(spline, "y")), -knee_deg * degree);
            }
          } else {
            at = vector3(model.text(i, "location"));
          }
          const Vector3d world = places.at(model.text(i, "socket_parent_frame")) * at;
          if (before) length += (world - *before).norm();
          before = world;
        }
        const auto all = member_muscles();
        const auto known = std::ranges::find(all, member, &MemberMuscle::name);
        ASSERT_NE(known, all.end()) << member;
        double& largest = largest_m[name];
        largest = std::max(largest, std::abs(length - member_length(*known, scale, leg)));
      }
    }
  }
  EXPECT_EQ(largest_m.size(), 2 * member_muscles().size());
  for (const auto& [name, largest] : largest_m) {
    EXPECT_LT(largest, 0.003) << name;
    RecordProperty(name, std::to_string(1e3 * largest));
  }
}

}  // namespace mobil::opensim_model_test
