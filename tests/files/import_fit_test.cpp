// A real leg's anatomy fitted to bodies of any height: bones meet at the body's joints, feet are on the ground, muscles
// stay on their bones. Skipped without the meshes.
// The tests share the meshes, so they run in one process.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/files/csv_table.h>
#include <mobil/fit_anatomy.h>
#include <mobil/mesh_file.h>
#include "assets/import/bone_maps.h"
#include "assets/surfaces/surface_mesh.h"
#include "engine/eigen.h"
#include "tests/files/reference_data.h"

namespace mobil::import_fit_test {
namespace fs = std::filesystem;
using Eigen::Vector3d;

Body body_of(float height_m) {
  BodyRequest request;
  request.height_m = height_m;
  return make_body(request).value();
}

class RealLeg : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = test::anatomy_folder().value_or("").string();
    if (!folder.empty()) anatomy = load_anatomy(folder);
  }
  void SetUp() override {
    if (folder.empty()) GTEST_SKIP() << test::no_anatomy;
    ASSERT_TRUE(anatomy.has_value()) << anatomy.error().message;
  }

  static inline std::string folder;
  static inline Result<Anatomy> anatomy = fail("not loaded");
};

const BoneSurface& bone(const FittedAnatomy& fitted, const std::string& name) {
  for (const auto& surface : fitted.bones) {
    if (surface.mesh.name == name) return surface;
  }
  throw std::runtime_error("no " + name);
}

/// Returns the vertex farthest along `direction` among those less than `band` above the lowest.
Vector3d farthest_low_point(const SurfaceMesh& mesh, double band, const Vector3d& direction) {
  double lowest = 1e9;
  for (const auto& p : mesh.position) lowest = std::min<double>(lowest, p.y);
  Vector3d best = Vector3d::Constant(0);
  double far = -1e9;
  for (const auto& p : mesh.position) {
    if (p.y > lowest + band || eigen(p).dot(direction) < far) continue;
    far = eigen(p).dot(direction);
    best = eigen(p);
  }
  return best;
}

/// Fits a sphere by least squares: |p|² = 2 c·p + (r² − |c|²).
Vector3d sphere_centre(const std::vector<Vector3d>& points) {
  Eigen::MatrixXd a(static_cast<Eigen::Index>(points.size()), 4);
  Eigen::VectorXd b(static_cast<Eigen::Index>(points.size()));
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const Vector3d& p = points[static_cast<std::size_t>(i)];
    a.row(i) << 2 * p.transpose(), 1;
    b(i) = p.squaredNorm();
  }
  return a.colPivHouseholderQr().solve(b).head<3>();
}

TEST_F(RealLeg, JointCentresOfFittedBonesMatchTheBody) {
  EXPECT_TRUE(rc::check([&] {
    const Body body = body_of(static_cast<float>(*rc::gen::inRange(120, 221)) / 100.0F);
    const auto fitted = fit_anatomy(*anatomy, body).value();
    const double size = bone_maps(*anatomy, body)->size;

    // In the thigh's frame the hip is the origin and the knee is the thigh's length below; the same holds for the
    // shank.
    const auto& femur = bone(fitted, "femur_right").mesh;
    std::vector<Vector3d> head;
    for (const auto& p : femur.position) {
      const Vector3d v = eigen(p);
      if (std::abs(v.norm() - 0.0229 * size) < 0.0015 * size && v.y() > -0.005 * size) head.push_back(v);
    }
    RC_ASSERT(head.size() > 30U);
    RC_ASSERT(sphere_centre(head).norm() < 0.001 * size);

    const Vector3d knee = (farthest_low_point(femur, 0.045 * size, Vector3d::UnitX()) +
                           farthest_low_point(femur, 0.045 * size, -Vector3d::UnitX())) /
                          2;
    RC_ASSERT((knee - Vector3d(0, -body.thigh_length_m, 0)).norm() < 0.004 * size);
    const Vector3d ankle = (farthest_low_point(bone(fitted, "tibia_right").mesh, 0.025 * size, Vector3d::UnitX()) +
                            farthest_low_point(bone(fitted, "fibula_right").mesh, 0.035 * size, -Vector3d::UnitX())) /
                           2;
    RC_ASSERT((ankle - Vector3d(0, -body.shank_length_m, 0)).norm() < 0.006 * size);
  }));
}

TEST_F(RealLeg, BothBonesOfAJointMapToTheBodysCentre) {
  EXPECT_TRUE(rc::check([&] {
    const Body body = body_of(static_cast<float>(*rc::gen::inRange(120, 221)) / 100.0F);
    const auto maps = bone_maps(*anatomy, body).value();
    const Vector3d hip(body.joint_offset_m[index(Segment::thigh_right)].x, body.hip_height_m, 0);
    const Vector3d knee = hip - Vector3d(0, body.thigh_length_m, 0), ankle = knee - Vector3d(0, body.shank_length_m, 0);
    for (const auto* map : {&maps.pelvis, &maps.thigh}) RC_ASSERT(((*map)(maps.hip) - hip).norm() < 1e-6);
    for (const auto* map : {&maps.thigh, &maps.shank}) RC_ASSERT(((*map)(maps.knee) - knee).norm() < 1e-6);
    for (const auto* map : {&maps.shank, &maps.foot}) RC_ASSERT(((*map)(maps.ankle) - ankle).norm() < 1e-6);
  }));
}

TEST_F(RealLeg, FeetStandOnTheGroundWithHeelAndBallNearTheBodys) {
  EXPECT_TRUE(rc::check([&] {
    const Body body = body_of(static_cast<float>(*rc::gen::inRange(120, 221)) / 100.0F);
    const auto fitted = fit_anatomy(*anatomy, body).value();
    const Vector3d ankle = leg_joints(body).ankle, ball = leg_joints(body).ball;
    double lowest = 1e9, back = 1e9, tip = -1e9;
    for (const auto& surface : fitted.bones) {
      if (surface.segment != Segment::foot_right && surface.segment != Segment::toes_right) continue;
      for (const auto& p : surface.mesh.position) {
        const Vector3d world = eigen(p) + (surface.segment == Segment::foot_right ? ankle : ball);
        lowest = std::min(lowest, world.y());
        back = std::min(back, world.z());
        tip = std::max(tip, world.z());
      }
    }
    RC_ASSERT(std::abs(lowest) < 0.005);
    RC_ASSERT(std::abs(back - static_cast<double>(body.heel_m.z)) < 0.012);
    const double toe_tip = static_cast<double>(body.ball_m.z + body.tip_m[index(Segment::toes_right)].z);
    RC_ASSERT(std::abs(tip - toe_tip) < 0.02);
  }));
}

TEST_F(RealLeg, LeftBonesMirrorTheRightAndAllFaceOutwards) {
  const auto fitted = fit_anatomy(*anatomy, body_of(1.8F)).value();
  std::size_t pairs = 0;
  for (const auto& right : fitted.bones) {
    EXPECT_GT(enclosed_volume(right.mesh), 0) << right.mesh.name;
    if (!right.mesh.name.ends_with("_right")) continue;
    ++pairs;
    const auto& left = bone(fitted, right.mesh.name.substr(0, right.mesh.name.size() - 6) + "_left");
    EXPECT_EQ(left.segment, right.segment == Segment::pelvis ? Segment::pelvis : on_side(right.segment, 1));
    ASSERT_EQ(left.mesh.position.size(), right.mesh.position.size());
    for (std::size_t v = 0; v < right.mesh.position.size(); ++v) {
      const auto &l = left.mesh.position[v], &r = right.mesh.position[v];
      EXPECT_TRUE(l.x == -r.x && l.y == r.y && l.z == r.z);
    }
    EXPECT_NEAR(enclosed_volume(left.mesh), enclosed_volume(right.mesh), 1e-9);
  }
  EXPECT_GE(pairs, 32U);
}

bool is_thin(Muscle muscle) {
  return muscle == Muscle::peroneus_tertius || muscle == Muscle::obturator_internus;
}

TEST_F(RealLeg, MuscleVolumesScaleWithTheBody) {
  const auto table = read_csv(folder + "/manifest.csv", std::array<std::string_view, 2>{"file", "volume_cm3"});
  ASSERT_TRUE(table.has_value());
  const Body body = body_of(1.7F);
  const auto fitted = fit_anatomy(*anatomy, body).value();
  const double size = bone_maps(*anatomy, body)->size;
  EXPECT_EQ(fitted.muscles.size(), 39U);
  EXPECT_EQ(fitted.others.size(), 0U);
  for (const auto& muscle : fitted.muscles) {
    for (std::size_t row = 0; row < table->row.size(); ++row) {
      if (fs::path(cell(*table, row, "file")).stem() != muscle.surface.mesh.name) continue;
      const double wanted = *number(cell(*table, row, "volume_cm3")) * 1e-6 * size * size * size;
      // The thinnest are as thin as a cell of the simplification.
      const double near = is_thin(muscle.muscle) ? 0.3 : 0.15;
      EXPECT_NEAR(enclosed_volume(muscle.surface.mesh) / wanted, 1, near) << muscle.surface.mesh.name;
    }
  }
}

TEST_F(RealLeg, MusclesStayOnTheirBonesAndAreNeitherTornNorFolded) {
  for (const float height : {1.3F, 1.8F, 2.1F}) {
    const Body body = body_of(height);
    const auto maps = bone_maps(*anatomy, body).value();
    const auto fitted = fit_anatomy(*anatomy, body).value();
    std::size_t i = 0;
    for (const auto& part : anatomy->part) {
      if (!part.group) continue;
      const auto& muscle = fitted.muscles[i++];
      ASSERT_EQ(muscle.surface.mesh.name, part.mesh.name);
      // Some are listed from the insertion to the origin.
      const auto stays = [&](const Vec3<float>& listed, Segment bone) {
        const Vector3d on_bone = maps.of(bone)(eigen(listed));
        double away = 1;
        for (const auto& end : {muscle.origin_m, muscle.insertion_m})
          if (end) away = std::min(away, (eigen(*end) - on_bone).norm());
        // Beside the hip the maps of pelvis and thigh are blended.
        const bool blended = bone == Segment::thigh_right && part.origin < Segment::thigh_right;
        EXPECT_LT(away, blended ? 0.014 : 0.003) << part.mesh.name;
      };
      const bool reversed = part.origin_m && part.insertion_m &&
                            (eigen(*muscle.origin_m) - maps.of(part.origin)(eigen(*part.origin_m))).norm() > 0.02;
      const Segment origin = reversed ? muscle.surface.insertion : part.origin,
                    insertion = reversed ? part.origin : muscle.surface.insertion;
      if (part.origin_m) stays(*part.origin_m, origin);
      if (part.insertion_m && part.insertion != Segment::patella_right) stays(*part.insertion_m, insertion);
      const auto &before = part.mesh, &after = muscle.surface.mesh;
      for (std::size_t t = 0; t < before.triangle.size(); t += 3) {
        const auto a = before.triangle[t], b = before.triangle[t + 1];
        const double stretch = (eigen(after.position[a]) - eigen(after.position[b])).norm() /
                               (eigen(before.position[a]) - eigen(before.position[b])).norm() / maps.size;
        ASSERT_GT(stretch, 0.75) << part.mesh.name;
        ASSERT_LT(stretch, 1.35) << part.mesh.name;
      }
    }
  }
}

TEST_F(RealLeg, SoleusReadsEquallyFromEveryFormat) {
  const auto reference = read_mesh(folder + "/muscles/soleus_right.obj");
  ASSERT_TRUE(reference.has_value());
  for (const auto* name :
       {"soleus_right_ascii.ply", "soleus_right_binary.ply", "soleus_right_ascii.stl", "soleus_right_binary.stl"}) {
    const auto read = read_mesh(folder + "/formats/" + name);
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_EQ(read->triangles_in_file, reference->triangles_in_file) << name;
    EXPECT_EQ(read->mesh.position.size(), reference->mesh.position.size()) << name;
    EXPECT_EQ(count_edges(read->mesh).border, 0U) << name;
    EXPECT_NEAR(enclosed_volume(read->mesh) / enclosed_volume(reference->mesh), 1, 1e-5) << name;
  }
}

}  // namespace mobil::import_fit_test
