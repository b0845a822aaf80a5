// `mobil anatomy` continues after a bad mesh, lists every fault, reports repairs, and draws the usable meshes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/files/capsule.h"
#include "tests/program/program.h"

namespace mobil::anatomy_command_test {
namespace fs = std::filesystem;
using Json = nlohmann::json;

void write(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

/// Writes a shin bone, a soleus with one reversed triangle, and the given rows.
void write_folder(const fs::path& folder, const std::string& rows) {
  fs::create_directories(folder);
  write(folder / "landmarks.csv",
        "name,side,x,y,z\nhip_joint_centre,right,-82,-93,820\nknee_joint_centre,right,-74,-65,434\n"
        "ankle_joint_centre,right,-80,-54,60\n");
  write(
      folder / "manifest.csv",
      "file,name,side,kind,group\ntibia.obj,Tibia,right,bone,\nsoleus.obj,Soleus,right,muscle,triceps_surae\n" + rows);
  write(folder / "tibia.obj", test::obj_text(test::capsule({-78, -60, 250}, 15, 360, 8, 8)));
  auto belly = test::capsule({-80, -40, 250}, 35, 300);
  std::swap(belly.triangle[100][1], belly.triangle[100][2]);
  write(folder / "soleus.obj", test::obj_text(belly));
}

TEST(AnatomyCommand, ReportsRepairsAndDraws) {
  const TemporaryFolder folder;
  write_folder(folder.path / "leg", "");
  const Ran ran = run_mobil("anatomy leg --out leg.png", folder.path);
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("1 triangle turned"), std::string::npos) << ran.out;
  EXPECT_GT(fs::file_size(folder.path / "leg.png"), 10'000U);
  const Json json = Json::parse(run_mobil("anatomy leg --json", folder.path).out);
  ASSERT_EQ(json.at("meshes").size(), 2U);
  EXPECT_EQ(json.at("meshes")[1].at("muscle"), "soleus");
  EXPECT_EQ(json.at("meshes")[1].at("triangles"), 960);
  EXPECT_TRUE(json.at("faults").empty());

  const Ran walked = run_mobil("walk --anatomy leg --seconds 0.1 --method none --out out", folder.path);
  EXPECT_EQ(walked.status, 0) << walked.err;
  EXPECT_NE(walked.out.find("1 triangle turned"), std::string::npos) << walked.out;
  const Json summary = Json::parse(read_bytes(folder.path / "out/summary.json"));
  EXPECT_EQ(summary.at("anatomy_said").size(), 1U);
}

TEST(AnatomyCommand, ContinuesAfterEveryFault) {
  const TemporaryFolder folder;
  write_folder(folder.path / "leg",
               "a.off,A,right,bone,\nfemur.obj,Femur,right,bone,\n../b.obj,B,right,bone,\npatella.ply,P,right,bone,\n");
  write(folder.path / "leg/patella.ply", "PLY\nformat ascii 1.0\n");
  const Ran ran = run_mobil("anatomy leg --json", folder.path);
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  const Json json = Json::parse(ran.out);
  EXPECT_EQ(json.at("faults").size(), 4U) << ran.out;
  const Ran table = run_mobil("anatomy leg", folder.path);
  EXPECT_EQ(table.status, 2);
  for (const auto* piece : {"leg/femur.obj", "leg/patella.ply", "'../b.obj'", "a.off", "fault: "}) {
    EXPECT_NE(table.out.find(piece), std::string::npos) << piece;
  }
  EXPECT_EQ(run_mobil("anatomy", folder.path).status, 2);
  EXPECT_EQ(run_mobil("anatomy nowhere", folder.path).status, 2);
}

}  // namespace mobil::anatomy_command_test
