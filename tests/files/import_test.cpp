// Anatomy folders: accepted files, refusals with their line, and fit of a real leg's bones to a body's joints.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include <mobil/fit_anatomy.h>
#include <mobil/mesh_file.h>
#include <mobil/muscle_table.h>
#include "assets/import/bone_maps.h"
#include "assets/import/simplify_surface.h"
#include "assets/surfaces/surface_mesh.h"
#include "engine/eigen.h"
#include "tests/files/temporary_folder.h"
#include "tests/refused.h"

namespace mobil::import_test {
namespace fs = std::filesystem;
using Eigen::Vector3d;

// ---------------------------------------------------------------------------------------------- synthetic folders

struct Cube {
  Vector3d centre;  // mm, anatomy's axes
  double half = 20;
};

const std::array<std::array<int, 4>, 6> cube_face = {
    {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};

std::array<Vector3d, 8> corners(const Cube& cube, double unit) {
  std::array<Vector3d, 8> corner;
  for (unsigned i = 0; i < 8; ++i) {
    const Vector3d sign((i & 1U) != 0 ? 1 : -1, (i & 2U) != 0 ? 1 : -1, (i & 4U) != 0 ? 1 : -1);
    corner[i] = unit * (cube.centre + cube.half * sign);
  }
  return corner;
}

std::string obj(const Cube& cube, double unit = 1) {
  std::string text;
  for (const auto& c : corners(cube, unit)) text += fmt::format("v {} {} {}\n", c.x(), c.y(), c.z());
  for (const auto& f : cube_face) text += fmt::format("f {} {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1, f[3] + 1);
  return text;
}

using Facet = std::array<Vector3d, 3>;

const std::map<std::string, Cube> leg = {
    {"bones/hip_bone_right", {{-60, -90, 860}, 40}},     {"bones/femur_right", {{-80, -90, 620}, 30}},
    {"bones/tibia_right", {{-78, -60, 250}, 30}},        {"bones/calcaneus_right", {{-75, -30, 20}, 20}},
    {"bones/metatarsal_1_right", {{-75, -160, 10}, 10}}, {"bones/phalanx_proximal_1_right", {{-75, -190, 5}, 5}},
    {"muscles/soleus_right", {{-80, -40, 250}, 40}},     {"muscles/rectus_femoris_right", {{-85, -120, 640}, 40}},
};

/// A temporary folder of cubes that loads; removed with its owner.
class Folder : public TemporaryFolder {
 public:
  explicit Folder(double unit = 1) {
    fs::create_directories(path / "bones");
    fs::create_directories(path / "muscles");
    const auto row = [&](const char* name, const char* side, double x, double y, double z) {
      return fmt::format("{},{},{},{},{},made up\n", name, side, x * unit, y * unit, z * unit);
    };
    write("landmarks.csv", "name,side,x,y,z,method\n" + row("hip_joint_centre", "right", -82, -93, 820) +
                               row("knee_joint_centre", "right", -74, -65, 434) +
                               row("ankle_joint_centre", "right", -80, -54, 60) +
                               row("hip_joint_centre", "left", 82, -93, 820));
    for (const auto& [name, cube] : leg) write(name + ".obj", obj(cube, unit));
    write("manifest.csv", manifest());
  }
  static std::string manifest(const std::string& extension = ".obj") {
    std::string text = "file,name,side,kind,group,triangles,watertight,origin_bone,insertion_bone\n";
    for (const auto& [name, cube] : leg) {
      const bool bone = name.starts_with("bones");
      text += fmt::format("{}{},\"{}, made up\",right,{},12,yes,{}\n", name, extension, name,
                          bone                                       ? "bone,"
                          : name.find("soleus") != std::string::npos ? "muscle,triceps_surae"
                                                                     : "muscle,quadriceps",
                          bone                                       ? ","
                          : name.find("soleus") != std::string::npos ? "fibula+tibia,calcaneus"
                                                                     : "hip_bone,patella");
    }
    return text;
  }
  [[nodiscard]] Result<Anatomy> load() const { return load_anatomy(path.string()); }
};

/// Expects one line that contains every given piece.
void expect_refused(const Folder& folder, const std::vector<std::string>& pieces) {
  const auto anatomy = folder.load();
  ASSERT_FALSE(anatomy.has_value());
  const std::string& line = anatomy.error().message;
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  for (const auto& piece : pieces)
    EXPECT_NE(line.find(piece), std::string::npos) << "no '" << piece << "' in: " << line;
  if (std::getenv("MOBIL_SHOW_ERRORS") != nullptr) fmt::print("{}\n", line);
}

TEST(AnatomyFolder, LoadsCubesClosedAndOutwards) {
  const Folder folder;
  const auto anatomy = folder.load();
  ASSERT_TRUE(anatomy.has_value()) << anatomy.error().message;
  ASSERT_EQ(anatomy->part.size(), leg.size());
  for (const auto& part : anatomy->part) {
    const bool bone = part.kind == AnatomyKind::bone;
    const double half = leg.at((bone ? "bones/" : "muscles/") + part.mesh.name).half / 1000;
    EXPECT_EQ(part.mesh.position.size(), 8U);
    EXPECT_EQ(count_edges(part.mesh).border, 0U);
    EXPECT_NEAR(enclosed_volume(part.mesh), 8 * half * half * half, 1e-9) << part.mesh.name;
    EXPECT_EQ(part.group.has_value(), !bone);
  }
}

TEST(AnatomyFolder, MuscleFollowsFromNameOrFile) {
  const Folder folder;
  const auto muscle = [&](const std::string& name, const std::string& file, const std::string& group,
                          const char* place = "muscles/soleus_right") {
    folder.write("muscles/" + file + ".obj", obj(leg.at(place)));
    folder.write("manifest.csv", "file,name,side,kind,group\nbones/femur_right.obj,Femur,right,bone,\nmuscles/" + file +
                                     ".obj," + name + ",right,muscle," + group + "\n");
    const auto anatomy = folder.load();
    EXPECT_TRUE(anatomy.has_value()) << anatomy.error().message;
    const AnatomyPart* part = anatomy.has_value() && anatomy->part.size() == 2 ? &anatomy->part[1] : nullptr;
    if (part == nullptr || !part->group) return std::string("none");
    return std::string(muscle_name(*part->group)) + "/" +
           (part->muscle ? std::string(muscle_name(*part->muscle)) : "?");
  };
  EXPECT_EQ(muscle("Right rectus femoris", "a", "quadriceps"), "quadriceps/rectus_femoris");
  EXPECT_EQ(muscle("Long head of right biceps femoris", "b", "hamstrings"), "hamstrings/biceps_femoris_long_head");
  EXPECT_EQ(muscle("m. 12", "Gastrocnemius-Lateral_head_right", "triceps_surae"),
            "triceps_surae/gastrocnemius_lateral");
  EXPECT_EQ(muscle("Right tibialis anterior", "c", ""), "tibialis_anterior/tibialis_anterior");
  EXPECT_EQ(muscle("Right quadriceps", "d", "quadriceps"), "quadriceps/?");
  EXPECT_EQ(muscle("Right soleus", "e", "hamstrings"), "hamstrings/?");  // the written group counts
  const char* const thigh = "muscles/rectus_femoris_right";
  EXPECT_EQ(muscle("Right sartorius", "f", ""), "sartorius/sartorius");
  EXPECT_EQ(muscle("Right gluteus medius", "g", "", thigh), "hip_abductors/gluteus_medius");
  EXPECT_EQ(muscle("m. 13", "fibularis_longus_right", ""), "peroneals/peroneus_longus");
  EXPECT_EQ(muscle("m. 14", "h", "gracilis"), "gracilis/gracilis");
  EXPECT_EQ(muscle("m. 15", "i", "iliopsoas", thigh), "iliopsoas/?");
  EXPECT_EQ(muscle("Right psoas major", "j", "iliopsoas", thigh), "iliopsoas/psoas");
  EXPECT_EQ(muscle("Right psoas minor", "k", ""), "none");
  EXPECT_EQ(muscle("Right gluteus maximus", "l", "of the hip"), "none");
}

TEST(AnatomyFolder, FilesAreFoundInAnotherCaseAndWithBackslashes) {
  const Folder folder;
  const auto loads = [&](const std::string& file) {
    folder.write("manifest.csv", "file;name;side;kind;group\r" + file + ";Femur;right;bone;\r;;;;\r");
    return folder.load();
  };
  for (const std::string file :
       {"bones/femur_right.obj", "bones\\femur_right.obj", "Bones/Femur_Right.OBJ", "./BONES\\FEMUR_RIGHT.Obj"}) {
    const auto anatomy = loads(file);
    ASSERT_TRUE(anatomy.has_value()) << anatomy.error().message;
    EXPECT_EQ(anatomy->part[0].mesh.name, "femur_right");
    EXPECT_EQ(anatomy->part[0].origin, Segment::thigh_right);
  }
  folder.write("Calcaneus.OBJ", obj(leg.at("bones/calcaneus_right")));
  EXPECT_EQ(loads("calcaneus.obj")->part[0].origin, Segment::foot_right);
  EXPECT_TRUE(is_refused(loads("bones\\..\\..\\femur_right.obj"), "manifest.csv line 2: file", "leads out"));
  EXPECT_TRUE(is_refused(loads("bones/femur.obj"), "bones/femur.obj: no such file"));
  folder.write("FEMUR.obj", obj(leg.at("bones/femur_right")));
  folder.write("Femur.obj", obj(leg.at("bones/femur_right")));
  EXPECT_TRUE(is_refused(loads("femur.obj"), "manifest.csv line 2: file 'femur.obj' fits 'FEMUR.obj' and 'Femur.obj'"));
}

TEST(AnatomyFolder, FaceThatCrossesItselfIsReported) {
  const Folder folder;
  folder.write("femur.obj", obj(leg.at("bones/femur_right")) + "f 1 8 2 7\n");
  folder.write("manifest.csv", "file,name,side,kind,group\nfemur.obj,Femur,right,bone,\n");
  const auto anatomy = folder.load();
  ASSERT_FALSE(anatomy.has_value());  // its edges are used twice, too
  folder.write("femur.obj", "v -90 -90 600\nv -60 -60 620\nv -60 -90 600\nv -90 -60 620\nf 1 2 3 4\n");
  const auto bow = folder.load();
  ASSERT_TRUE(bow.has_value()) << bow.error().message;
  ASSERT_FALSE(bow->part[0].report.said.empty());
  EXPECT_EQ(bow->part[0].report.said[0], "the face of line 5 crosses itself; cut from its first corner");
}

TEST(AnatomyFolder, ThreadCountChangesNothing) {
  const Folder folder;
  const auto one = load_anatomy(folder.path.string(), {.threads = 1}),
             four = load_anatomy(folder.path.string(), {.threads = 4});
  ASSERT_TRUE(one.has_value() && four.has_value());
  for (std::size_t i = 0; i < one->part.size(); ++i) {
    EXPECT_EQ(one->part[i].mesh.triangle, four->part[i].mesh.triangle);
    EXPECT_EQ(one->part[i].mesh.name, four->part[i].mesh.name);
  }
}

TEST(BadAnatomy, MissingFolder) {
  EXPECT_TRUE(is_refused(load_anatomy("/nowhere/at/all"), "/nowhere/at/all"));
}

TEST(BadAnatomy, Manifest) {
  const Folder folder;
  const auto refused = [&](const std::string& text, const std::vector<std::string>& pieces) {
    folder.write("manifest.csv", text + "\n");
    expect_refused(folder, pieces);
  };
  const std::string head = "file,name,side,kind,group\n";
  refused("file,name,side,kind\nbones/femur_right.obj,Femur,right,bone", {"manifest.csv", "'group'"});
  refused(head + "bones/femur_right.obj,Femur,right,bone", {"manifest.csv line 2", "4 cells", "5"});
  refused(head + "bones/femur_right.obj,Femur,right,stone,", {"line 2", "'stone'", "bone, muscle, tendon, skin"});
  refused(head + "bones/femur_right.obj,Femur,upper,bone,", {"line 2", "'upper'", "right, left, mid"});
  refused(head + "bones/skull.obj,Skull,mid,bone,", {"line 2", "skull", "femur"});
  fs::remove(folder.path / "bones/femur_right.obj");
  refused(Folder::manifest(), {"bones/femur_right.obj", "manifest.csv line", "no such file"});
  fs::remove(folder.path / "manifest.csv");
  expect_refused(folder, {"manifest.csv", "cannot be read"});
  fs::remove_all(folder.path);
  fs::create_directories(folder.path);
  expect_refused(folder, {folder.path.string(), ".csv", "cannot be read"});
}

/// Cut after any byte: the remainder can be a valid file of its format, but never the one that the manifest describes.
TEST(BadAnatomy, TruncatedMesh) {
  const std::string whole = obj(leg.at("bones/femur_right"));
  const Folder folder;
  for (std::size_t kept = 0; kept + 1 < whole.size(); kept += 7) {
    folder.write("bones/femur_right.obj", whole.substr(0, kept));
    expect_refused(folder, {"bones/femur_right.obj", "manifest.csv line"});
  }
}

TEST(BadAnatomy, EdgesOfMoreThanTwoTriangles) {
  const Folder folder;
  folder.write("manifest.csv", "file,name,side,kind,group\nbones/femur_right.obj,Femur,right,bone,\n");
  folder.write("bones/femur_right.obj", obj(leg.at("bones/femur_right")) + "v -80 -90 700\nf 1 2 9\nf 5 6 9\n");
  expect_refused(folder, {"bones/femur_right.obj", "2 edges", "more than two triangles", "mesh editor"});
}

TEST(BadAnatomy, OpenMeshCalledWatertight) {
  const Folder folder;
  std::string text = obj(leg.at("bones/femur_right"));
  text.resize(text.rfind("f "));
  folder.write("bones/femur_right.obj", text);
  folder.write("manifest.csv", "file,name,side,kind,group,watertight\nbones/femur_right.obj,Femur,right,bone,,yes\n");
  expect_refused(folder, {"bones/femur_right.obj", "4 open edges", "watertight"});
}

TEST(AnatomyFolder, WatertightIsAYesOrNoOfASpreadsheet) {
  const Folder folder;
  std::string text = obj(leg.at("bones/femur_right"));
  text.resize(text.rfind("f "));
  folder.write("bones/femur_right.obj", text);
  const auto load = [&](const std::string& word) {
    folder.write("manifest.csv",
                 "file,name,side,kind,group,watertight\nbones/femur_right.obj,Femur,right,bone,," + word + "\n");
    return folder.load();
  };
  for (const std::string word : {"yes", "Yes", "y", "TRUE", "True", "1", "WAHR", "ja", "VRAI", "Oui"})
    EXPECT_TRUE(is_refused(load(word), "bones/femur_right.obj", "4 open edges")) << word;
  for (const std::string word : {"no", "No", "N", "FALSE", "0", "FALSCH", "nein", "FAUX", "non", ""})
    EXPECT_TRUE(load(word).has_value()) << word;
  for (const std::string word : {"perhaps", "2", "yess", "-"})
    EXPECT_TRUE(is_refused(load(word), "manifest.csv line 2: watertight '" + word + "'", "yes, no")) << word;
}

TEST(AnatomyFolder, TrianglesAreAWholeNumberInTheTablesSpelling) {
  const Folder folder;
  const auto load = [&](const std::string& count) {
    folder.write("manifest.csv", "file;name;side;kind;group;triangles\nbones/femur_right.obj;;right;bone;;" + count);
    return folder.load();
  };
  for (const std::string count : {"12", "12.0", "12,0", "1.2E+01", "1,2e1", ""}) EXPECT_TRUE(load(count)) << count;
  for (const std::string count : {"12.7", "12,7", "0", "-12", "12,", "many"})
    EXPECT_TRUE(is_refused(load(count), "manifest.csv line 2: triangles", "whole number")) << count;
}

TEST(AnatomyFolder, FileNamesKeepTheirCommas) {
  const Folder folder;
  folder.write("1,5 soleus.obj", obj(leg.at("muscles/soleus_right")));
  for (const std::string file : {"1,5 soleus.obj", "\"1,5 soleus.obj\""}) {
    folder.write("manifest.csv", "file;name;side;kind;group;origin_x;origin_y;origin_z\n" + file +
                                     ";1,5 soleus;right;muscle;triceps_surae;-80,5;-40,0;290\n");
    const auto anatomy = folder.load();
    ASSERT_TRUE(anatomy.has_value()) << anatomy.error().message;
    EXPECT_EQ(anatomy->part[0].mesh.name, "1,5 soleus");
    ASSERT_TRUE(anatomy->part[0].origin_m.has_value());
    EXPECT_FLOAT_EQ(anatomy->part[0].origin_m->x, -0.0805F);
  }
}

TEST(BadAnatomy, Landmarks) {
  const Folder folder;
  const std::string head = "name,side,x,y,z\n", hip = "hip_joint_centre,right,-82,-93,820\n",
                    knee = "knee_joint_centre,right,-74,-65,434\n", ankle = "ankle_joint_centre,right,-80,-54,60\n";
  folder.write("landmarks.csv", head + hip + ankle);
  expect_refused(folder, {"landmarks.csv", "knee_joint_centre"});
  folder.write("landmarks.csv", head + hip + knee + "ankle_joint_centre,right,-80,nan,60\n");
  expect_refused(folder, {"landmarks.csv line 4", "ankle_joint_centre"});
  folder.write("landmarks.csv", head + hip + knee + "ankle_joint_centre,right,-80,-90,800\n");
  expect_refused(folder, {"landmarks.csv", "0.4 to 1.3"});
  folder.write("landmarks.csv", head +
                                    "hip_joint_centre,right,820,-82,93\nknee_joint_centre,right,434,-74,65\nankle_"
                                    "joint_centre,right,60,-80,54\n");
  expect_refused(folder, {"landmarks.csv", "axes"});
  folder.write("landmarks.csv", "name,x,y,z\nhip,0,0,0\n");
  expect_refused(folder, {"landmarks.csv", "'side'"});
}

TEST(BadAnatomy, BodyWithoutLengths) {
  const auto anatomy = Folder().load();
  ASSERT_TRUE(anatomy.has_value());
  EXPECT_TRUE(is_refused(fit_anatomy(*anatomy, Body{}), "thigh length"));
}

// ------------------------------------------------------------------------------------------------ simplification

TEST(Simplify, RemovesSpecksAndKeepsTheMainPiece) {
  SurfaceMesh mesh;
  const auto fan = [&](std::uint32_t triangles, float at) {
    const auto first = static_cast<std::uint32_t>(mesh.position.size());
    for (std::uint32_t i = 0; i < triangles + 2; ++i)
      mesh.position.push_back({at, std::sin(0.01F * static_cast<float>(i)), std::cos(0.01F * static_cast<float>(i))});
    for (std::uint32_t i = 0; i < triangles; ++i)
      mesh.triangle.insert(mesh.triangle.end(), {first, first + i + 1, first + i + 2});
  };
  fan(1, 0);
  fan(300, 1);
  fan(2, 2);
  EXPECT_EQ(remove_specks(mesh, 0.01), 2U);
  EXPECT_EQ(mesh.triangle.size(), 900U);
  EXPECT_EQ(mesh.position.size(), 302U);
  for (const auto& p : mesh.position) EXPECT_EQ(p.x, 1.0F);
}

RC_GTEST_PROP(Simplify, ClustersMoveVerticesByLessThanACellAndKeepVolume, ()) {
  const double cell = *rc::gen::inRange(5, 80) / 1000.0;
  SurfaceMesh ball;  // radius 0.5
  constexpr std::uint32_t rings = 40, sectors = 60;
  for (std::uint32_t r = 0; r <= rings; ++r) {
    for (std::uint32_t s = 0; s < sectors; ++s) {
      const double a = M_PI * r / rings, b = 2 * M_PI * s / sectors;
      ball.position.push_back({static_cast<float>(0.5 * std::sin(a) * std::sin(b)),
                               static_cast<float>(0.5 * std::cos(a)),
                               static_cast<float>(0.5 * std::sin(a) * std::cos(b))});
    }
  }
  for (std::uint32_t r = 0; r < rings; ++r) {
    for (std::uint32_t s = 0; s < sectors; ++s) {
      const std::uint32_t a = r * sectors + s, b = r * sectors + (s + 1) % sectors;
      ball.triangle.insert(ball.triangle.end(), {a, a + sectors, b, b, a + sectors, b + sectors});
    }
  }
  const SurfaceMesh light = clustered(ball, cell);
  RC_ASSERT(light.triangle.size() <= ball.triangle.size());
  RC_ASSERT(light.triangle.size() > 0U);
  for (const auto& p : light.position) RC_ASSERT(std::abs(eigen(p).norm() - 0.5) < cell);
  RC_ASSERT(std::abs(enclosed_volume(light) / enclosed_volume(ball) - 1) < 2 * cell);
  RC_ASSERT(enclosed_volume(light) > 0);
  RC_ASSERT(clustered(ball, cell).triangle == light.triangle);
}

}  // namespace mobil::import_test
