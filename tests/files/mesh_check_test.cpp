// Checks of anatomical surfaces on damaged closed capsules: repaired to the same volume, or refused. Also position,
// units and axes, and the figures of the real leg if its meshes are available.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <mobil/assets/files/csv_table.h>
#include <mobil/assets/import/anatomy_folder.h>
#include "assets/import/mend_mesh.h"
#include "assets/import/mesh_place.h"
#include "assets/import/triangle_cuts.h"
#include "engine/eigen.h"
#include "tests/files/capsule.h"
#include "tests/files/reference_data.h"
#include "tests/files/temporary_folder.h"

namespace mobil::mesh_check_test {
namespace fs = std::filesystem;
using Eigen::Vector3f;
using test::TestMesh;

/// A temporary folder with a shin bone and a soleus, mm, z up, the right side at x < 0; removed with its owner:
///
///     z 820   + hip            + left hip
///       434   + knee    _
///             | |      ( )     tibia: z 70 to 430, radius 15 at (-78, -60)
///             | |      ( )     soleus, as of belly(): z 100 to 400, radius 35 at (-80, -40)
///        60   + ankle   -
class Shin : public TemporaryFolder {
 public:
  Shin() {
    fs::create_directories(path / "in");
    landmarks("name,side,x,y,z\n", 1, false);
    write("tibia.obj", obj_text(test::capsule({-78, -60, 250}, 15, 360, 8, 8)));
    manifest("in/soleus.obj,Soleus,right,muscle,triceps_surae");
  }
  void landmarks(const std::string& head, float per_mm, bool y_up, const std::string& more = "") const {
    std::string text = head;
    const auto row = [&](const char* name, const char* side, float x, float y, float z) {
      const std::array<float, 3> p = y_up ? std::array{x, z, -y} : std::array{x, y, z};
      text += fmt::format("{},{},{},{},{}{}\n", name, side, p[0] * per_mm, p[1] * per_mm, p[2] * per_mm, more);
    };
    row("hip_joint_centre", "right", -82, -93, 820);
    row("knee_joint_centre", "right", -74, -65, 434);
    row("ankle_joint_centre", "right", -80, -54, 60);
    row("hip_joint_centre", "left", 82, -93, 820);
    write("landmarks.csv", text);
  }
  void manifest(const std::string& row, const std::string& columns = "", const std::string& tibia = "") const {
    write("manifest.csv",
          "file,name,side,kind,group" + columns + "\ntibia.obj,Tibia,right,bone," + tibia + "\n" + row + "\n");
  }
  [[nodiscard]] SurveyedMesh soleus(const TestMesh& mesh) const {
    write("in/soleus.obj", obj_text(mesh));
    return soleus();
  }
  [[nodiscard]] SurveyedMesh soleus() const {
    auto survey = survey_anatomy(path.string(), {.other_muscles = true, .muscle_cell_m = 0});
    for (const auto& fault : survey.faults) ADD_FAILURE() << fault;
    if (survey.mesh.size() != 2) return {};
    return std::move(survey.mesh[1]);
  }
};

TestMesh belly() {
  return test::capsule({-80, -40, 250}, 35, 300);
}

void add(TestMesh& mesh, const TestMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  mesh.position.insert(mesh.position.end(), other.position.begin(), other.position.end());
  for (const auto& t : other.triangle) mesh.triangle.push_back({t[0] + first, t[1] + first, t[2] + first});
}

std::string all_said(const SurveyedMesh& mesh) {
  std::string text;
  for (const auto& line : mesh.part.report.said) text += line + "; ";
  return text;
}

void expect_mended(const SurveyedMesh& mesh, double volume_mm3, const std::string& said) {
  ASSERT_FALSE(mesh.fault.has_value()) << mesh.fault->message;
  EXPECT_NEAR(mesh.part.report.volume_cm3 / (volume_mm3 / 1000), 1, 0.01);
  EXPECT_NE(all_said(mesh).find(said), std::string::npos) << "no '" << said << "' in: " << all_said(mesh);
}

void expect_refused(const SurveyedMesh& mesh, const std::vector<std::string>& pieces) {
  ASSERT_TRUE(mesh.fault.has_value()) << all_said(mesh);
  const std::string& line = mesh.fault->message;
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_NE(line.find("soleus.obj"), std::string::npos) << line;
  for (const auto& piece : pieces)
    EXPECT_NE(line.find(piece), std::string::npos) << "no '" << piece << "' in: " << line;
}

TEST(MeshCheck, SoundMeshIsAcceptedWithoutNotes) {
  const auto taken = Shin().soleus(belly());
  expect_mended(taken, volume(belly()), "");
  EXPECT_TRUE(taken.part.report.said.empty()) << all_said(taken);
  EXPECT_EQ(taken.part.report.triangles, belly().triangle.size());
  EXPECT_EQ(taken.part.report.pieces, 1U);
  EXPECT_EQ(taken.part.report.open_edges + taken.part.report.overused_edges + taken.part.report.self_intersections, 0U);
}

RC_GTEST_PROP(MeshCheck, ReversedTrianglesAreTurnedBack, ()) {
  TestMesh mesh = belly();
  std::size_t turned = 0;
  const int one_in = *rc::gen::inRange(1, 12), seed = *rc::gen::inRange(0, 1000);
  std::mt19937 random(static_cast<unsigned>(seed));
  for (auto& t : mesh.triangle) {
    if (random() % static_cast<unsigned>(one_in) != 0) continue;
    std::swap(t[1], t[2]);
    ++turned;
  }
  const auto taken = Shin().soleus(mesh);
  RC_ASSERT(!taken.fault.has_value());
  RC_ASSERT(std::abs(taken.part.report.volume_cm3 / (volume(belly()) / 1000) - 1) < 1e-4);
  RC_ASSERT(turned == 0 || all_said(taken).find("turned") != std::string::npos);
}

TEST(MeshCheck, PinchedVerticesAreSplit) {
  TestMesh mesh = test::capsule({-80, -40, 175}, 30, 150);
  add(mesh, test::capsule({-80, -40, 325}, 30, 150));  // touching at their tips
  const auto taken = Shin().soleus(mesh);
  expect_mended(taken, volume(mesh), "1 pinched vertex split");
  EXPECT_EQ(taken.part.report.pieces, 2U);
}

TEST(MeshCheck, DuplicateTrianglesAreRemoved) {
  TestMesh mesh = belly();
  for (std::size_t t = 0; t < 100; ++t) mesh.triangle.push_back(mesh.triangle[3 * t]);
  const auto taken = Shin().soleus(mesh);
  expect_mended(taken, volume(belly()), "100 doubled triangles");
  EXPECT_GT(taken.part.report.overused_edges, 0U);
}

RC_GTEST_PROP(MeshCheck, SmallHolesAreClosedAndOthersRefused, ()) {
  TestMesh mesh = belly();
  const auto holes = *rc::gen::inRange<std::size_t>(1, 12);
  for (std::size_t i = 0; i < holes; ++i) mesh.triangle.erase(mesh.triangle.begin() + static_cast<long>(70 * i));
  const Shin shin;
  const auto taken = shin.soleus(mesh);
  RC_ASSERT(!taken.fault.has_value());
  RC_ASSERT(std::abs(taken.part.report.volume_cm3 / (volume(belly()) / 1000) - 1) < 0.01);
  RC_ASSERT(taken.part.report.open_edges == 3 * holes);
  RC_ASSERT(all_said(taken).find("closed") != std::string::npos);
}

TEST(MeshCheck, OpenMusclesAreRefusedAndOpenSkinsReported) {
  TestMesh mesh = belly();
  std::erase_if(mesh.triangle, [&](const auto& t) { return mesh.position[t[0]].z() > 340; });
  const Shin shin;
  expect_refused(shin.soleus(mesh), {"open edges", "1 hole is too large"});
  shin.manifest("in/soleus.obj,Soleus,right,skin,");
  auto survey = survey_anatomy(shin.path.string(), {.skin = true});
  ASSERT_EQ(survey.mesh.size(), 2U);
  ASSERT_FALSE(survey.mesh[1].fault.has_value()) << survey.mesh[1].fault->message;
  EXPECT_NE(all_said(survey.mesh[1]).find("open: 20 open edges"), std::string::npos) << all_said(survey.mesh[1]);
}

TEST(MeshCheck, TriangleSoupIsRefused) {
  TestMesh mesh, whole = belly();
  for (const auto& t : whole.triangle) {
    for (const auto v : t) {
      mesh.position.push_back(whole.position[v] + 0.01F * Vector3f::Random());
    }
    const auto n = static_cast<std::uint32_t>(mesh.position.size());
    mesh.triangle.push_back({n - 3, n - 2, n - 1});
  }
  expect_refused(Shin().soleus(mesh), {"open edges"});
}

TEST(MeshCheck, FlatOverlappingOrSelfIntersectingMeshIsRefused) {
  const Shin shin;
  TestMesh flat = belly();
  for (auto& p : flat.position) p.y() = -40 + 0.004F * (p.y() + 40);
  expect_refused(shin.soleus(flat), {"is flat"});
  for (auto& p : flat.position) p.y() = -40;
  expect_refused(shin.soleus(flat), {});  // both sides coincide

  TestMesh copies = belly(), copy = belly();
  for (auto& p : copy.position) p += Vector3f(7, 3, 11);
  add(copies, copy);
  expect_refused(shin.soleus(copies), {"two pieces overlap"});
  TestMesh nested = belly();
  add(nested, test::capsule({-80, -40, 250}, 28, 240));
  expect_refused(shin.soleus(nested), {"inside another"});

  TestMesh crumpled = belly();
  for (auto& p : crumpled.position) p += 9 * Vector3f::Random();
  expect_refused(shin.soleus(crumpled), {"cuts itself"});
}

TEST(MeshCheck, HollowIsKept) {
  TestMesh mesh = belly(), hollow = test::capsule({-80, -40, 250}, 20, 200);
  for (auto& t : hollow.triangle) std::swap(t[1], t[2]);
  add(mesh, hollow);
  expect_mended(Shin().soleus(mesh), volume(mesh), "");
}

TEST(MeshCheck, OneSidedSurfaceIsRefused) {
  TestMesh strip;
  constexpr std::uint32_t steps = 40;
  for (std::uint32_t i = 0; i < steps; ++i) {
    const float a = 2 * static_cast<float>(M_PI) * static_cast<float>(i) / steps;
    for (const float across : {-20.0F, 20.0F}) {
      const float r = 60 + across * std::cos(a / 2);
      strip.position.push_back({-80 + r * std::cos(a), -40 + r * std::sin(a), 250 + across * std::sin(a / 2)});
    }
  }
  for (std::uint32_t i = 0; i < steps; ++i) {
    const bool last = i + 1 == steps;
    const std::uint32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    strip.triangle.push_back({a, b, c});
    strip.triangle.push_back({b, d, c});
  }
  expect_refused(Shin().soleus(strip), {"one side only"});
}

TEST(MeshCheck, SpecksAndTheOtherSideAreRemoved) {
  const Shin shin;
  TestMesh mesh = belly();
  add(mesh, test::capsule({-80, -90, 300}, 1, 3, 1, 3));
  expect_mended(shin.soleus(mesh), volume(belly()), "1 speck of 6 triangles");
  mesh = belly();
  add(mesh, test::capsule({80, -40, 250}, 35, 300));
  expect_mended(shin.soleus(mesh), volume(belly()), "1 piece on the left side taken away");
  expect_refused(shin.soleus(test::capsule({80, -40, 250}, 35, 300)), {"mm off the line"});
  expect_refused(shin.soleus(test::capsule({-20, -40, 250}, 110, 300)), {"left of the middle plane"});
}

/// Returns the mesh in a file of other units and axes.
TestMesh in_frame(TestMesh mesh, float per_mm, bool y_up) {
  for (auto& p : mesh.position) p = per_mm * (y_up ? Vector3f(p.x(), p.z(), -p.y()) : p);
  return mesh;
}

TEST(MeshPlace, RowUnitAndAxesAreUsedOrSuggestedWhenMissing) {
  for (const auto& [unit, per_mm] :
       std::map<std::string, float>{{"m", 0.001F}, {"cm", 0.1F}, {"in", 1 / 25.4F}, {"mm", 1}}) {
    for (const bool y_up : {false, true}) {
      const Shin shin;
      const TestMesh mesh = in_frame(belly(), per_mm, y_up);
      if (unit != "mm" || y_up) {
        expect_refused(shin.soleus(mesh), {fmt::format("unit {}, up {}", unit, y_up ? "y" : "z")});
      }
      shin.manifest(fmt::format("in/soleus.obj,Soleus,right,muscle,triceps_surae,{},{}", unit, y_up ? "y" : "z"),
                    ",unit,up", ",,");
      const auto taken = shin.soleus(mesh);
      expect_mended(taken, volume(belly()), "");
      float top = 0;
      for (const auto& p : taken.part.mesh.position) top = std::max(top, p.y);
      EXPECT_NEAR(top, 0.4F, 1e-4F);
    }
  }
}

TEST(MeshPlace, FolderFrameFollowsFromLandmarksOrColumns) {
  for (const auto& [unit, per_mm] :
       std::map<std::string, float>{{"m", 0.001F}, {"cm", 0.1F}, {"in", 1 / 25.4F}, {"mm", 1}}) {
    for (const bool y_up : {false, true}) {
      for (const bool told : {false, true}) {
        if (unit == "in" && !told) continue;
        const Shin shin;
        shin.landmarks(told ? "name,side,x,y,z,unit,up\n" : "name,side,x,y,z\n", per_mm, y_up,
                       told ? fmt::format(",{},{}", unit, y_up ? "y" : "z") : "");
        shin.write("tibia.obj", obj_text(in_frame(test::capsule({-78, -60, 250}, 15, 360, 8, 8), per_mm, y_up)));
        shin.write("in/soleus.obj", obj_text(in_frame(belly(), per_mm, y_up)));
        const auto loaded = load_anatomy(shin.path.string());
        ASSERT_TRUE(loaded.has_value()) << loaded.error().message;
        EXPECT_NEAR(loaded->part[1].report.volume_cm3, volume(belly()) / 1000, 1);
        EXPECT_EQ(loaded->said.empty(), told || (!y_up && unit != "cm"));
      }
    }
  }
}

TEST(MeshPlace, ContradictoryFramesAreRefused) {
  const Shin shin;
  const auto refused = [&](const std::string& piece) {
    const auto loaded = load_anatomy(shin.path.string());
    ASSERT_FALSE(loaded.has_value());
    EXPECT_NE(loaded.error().message.find(piece), std::string::npos) << loaded.error().message;
    EXPECT_TRUE(loaded.error().message.starts_with(shin.path.string())) << loaded.error().message;
  };
  shin.write("in/soleus.obj", obj_text(belly()));
  shin.landmarks("name,side,x,y,z,unit\n", 1, false, ",cm");
  refused("0.4 to 1.3 m");
  shin.landmarks("name,side,x,y,z,unit\n", 1, false, ",ell");
  refused("m, cm, mm, in");
  shin.landmarks("name,side,x,y,z,up\n", 1, false, ",y");
  refused("axes");
  shin.landmarks("name,side,x,y,z,up\n", 1, false, ",x");
  refused("up 'x'");
}

TEST(MeshPlace, MuscleMustBeNearTheBonesOfItsSegments) {
  const AnatomyLandmarks landmarks{{-0.08F, 0.82F, 0.09F}, {-0.075F, 0.434F, 0.065F}, {-0.08F, 0.06F, 0.054F}, 0};
  AnatomyPart part;
  part.kind = AnatomyKind::muscle;
  part.origin = Segment::shank_right;
  part.insertion = Segment::foot_right;
  const MeshBox box{{-0.1F, 0.1F, 0.0F}, {-0.05F, 0.3F, 0.05F}};
  const PlacedBone shin{Segment::shank_right, {{-0.2F, 0.1F, 0.02F}, {-0.16F, 0.4F, 0.05F}}};  // 60 mm to the right
  const PlacedBone heel{Segment::foot_right, {{-0.1F, 0, 0}, {-0.05F, 0.03F, 0.1F}}};          // 70 mm below
  EXPECT_FALSE(misplaced(box, part, landmarks, {}).has_value());
  EXPECT_FALSE(misplaced(box, part, landmarks, {shin}).has_value());
  EXPECT_EQ(misplaced(box, part, landmarks, {shin, heel}).value_or("").substr(0, 21), "lies 60 mm away from ");
  part.origin = Segment::foot_right;
  EXPECT_TRUE(misplaced(box, part, landmarks, {heel}).has_value());
}

TEST(MeshPlace, NoFileLeadsOutOfTheFolder) {
  const Shin shin;
  shin.write("in/soleus.obj", obj_text(belly()));
  const fs::path inner = shin.path / "in";
  fs::create_symlink(shin.path / "tibia.obj", inner / "out_of_in.obj");
  fs::create_symlink("soleus.obj", inner / "stays.obj");
  fs::create_symlink("loop.obj", inner / "loop.obj");
  fs::copy(shin.path / "landmarks.csv", inner / "landmarks.csv");
  const auto load = [&](const std::string& file) {
    std::ofstream(inner / "manifest.csv") << "file,name,side,kind,group\n"
                                          << file << ",Soleus,right,muscle,triceps_surae\n";
    return load_anatomy(inner.string());
  };
  EXPECT_TRUE(load("soleus.obj").has_value());
  EXPECT_TRUE(load("./stays.obj").has_value());
  for (const std::string& file :
       {std::string("../in/soleus.obj"), std::string("../tibia.obj"), (inner / "soleus.obj").string(),
        std::string("out_of_in.obj"), std::string("loop.obj"), std::string("a\x1b[31m.obj")}) {
    const auto loaded = load(file);
    ASSERT_FALSE(loaded.has_value()) << file;
    EXPECT_NE(loaded.error().message.find("manifest.csv line 2: file"), std::string::npos) << loaded.error().message;
    EXPECT_EQ(loaded.error().message.find('\x1b'), std::string::npos);
  }
}

/// Returns true if two triangles intersect, from the point where each edge meets the other's plane.
bool cut(const std::array<Eigen::Vector3d, 3>& a, const std::array<Eigen::Vector3d, 3>& b) {
  const auto pierces = [](const auto& triangle, const auto& edges) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d p = edges[i], q = edges[(i + 1) % 3];
      Eigen::Matrix3d m;
      m << triangle[1] - triangle[0], triangle[2] - triangle[0], p - q;
      const Eigen::Vector3d uvt = m.inverse() * (p - triangle[0]);
      if (uvt.x() > 0 && uvt.y() > 0 && uvt.x() + uvt.y() < 1 && uvt.z() > 0 && uvt.z() < 1) return true;
    }
    return false;
  };
  return pierces(a, b) || pierces(b, a);
}

RC_GTEST_PROP(TriangleCuts, MatchPairwiseComparison, ()) {
  std::mt19937 random(static_cast<unsigned>(*rc::gen::inRange(0, 100000)));
  std::uniform_real_distribution<float> place(-1, 1), size(-0.3F, 0.3F);
  SurfaceMesh mesh;
  const auto count = static_cast<std::uint32_t>(*rc::gen::inRange(1, 120));
  for (std::uint32_t t = 0; t < count; ++t) {
    const Vec3<float> p{place(random), place(random), place(random)};
    for (int c = 0; c < 3; ++c) {
      mesh.triangle.push_back(static_cast<std::uint32_t>(mesh.position.size()));
      mesh.position.push_back({p.x + size(random), p.y + size(random), p.z + size(random)});
    }
  }
  const auto corners = [&](std::uint32_t t) {
    std::array<Eigen::Vector3d, 3> c;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& p = mesh.position[3 * t + i];
      c[i] = Eigen::Vector3f(p.x, p.y, p.z).cast<double>();
    }
    return c;
  };
  std::size_t wanted = 0;
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a + 1; b < count; ++b) wanted += cut(corners(a), corners(b)) ? 1 : 0;
  }
  const auto pieces = label_pieces(mesh);
  RC_ASSERT(pieces.count == count);
  const CutCount counted = count_cuts(mesh, pieces.of);
  RC_ASSERT(counted.pairs == wanted);
  RC_ASSERT(counted.between_pieces == wanted);
  RC_ASSERT(counted.complete);
}

TEST(RealMeshes, AllAreAcceptedWithManifestFigures) {
  const auto folder = test::anatomy_folder();
  if (!folder) GTEST_SKIP() << test::no_anatomy;
  const auto table = read_csv((*folder / "manifest.csv").string(), std::array<std::string_view, 1>{"file"});
  ASSERT_TRUE(table.has_value());
  const auto survey = survey_anatomy(folder->string(), {.other_muscles = true, .skin = true});
  EXPECT_TRUE(survey.faults.empty());
  EXPECT_GT(survey.mesh.size(), 70U);
  for (const auto& mesh : survey.mesh) {
    EXPECT_FALSE(mesh.fault.has_value()) << mesh.fault->message;
    for (std::size_t row = 0; row < table->row.size(); ++row) {
      if (cell(*table, row, "file") != mesh.file) continue;
      const auto figure = [&](const char* name) { return *number(cell(*table, row, name)); };
      const auto& report = mesh.part.report;
      EXPECT_EQ(static_cast<double>(report.triangles), figure("triangles")) << mesh.file;
      EXPECT_NEAR(report.volume_cm3, figure("volume_cm3"), 0.01 + 0.002 * figure("volume_cm3")) << mesh.file;
      EXPECT_NEAR(report.area_cm2, figure("area_cm2"), 0.1 + 0.01 * figure("area_cm2")) << mesh.file;
      const double pairs = static_cast<double>(report.self_intersections), known = figure("self_intersecting_pairs");
      EXPECT_LE(pairs, known) << mesh.file;  // specks are excluded
      const bool whole = static_cast<double>(report.pieces) == figure("components");
      EXPECT_GE(pairs, whole ? known - 2 : 0) << mesh.file;
    }
  }
}

}  // namespace mobil::mesh_check_test
