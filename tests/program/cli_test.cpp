// Bad input through the program itself: exit status 2, one line that says what is wrong and how to mend it, nothing
// written. Help tells of what there is.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "components/gait_style.h"
#include "tests/program/program.h"

namespace mobil::cli_test {
namespace fs = std::filesystem;

/// Everything in a folder: names, and what files hold.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    found[entry.path().string()] = entry.is_regular_file() ? read_bytes(entry.path()) : "folder";
  }
  return found;
}

/// One refused command line; `pieces` must all be in the message, and what lies in the folder stays as it is.
void expect_refused(const fs::path& folder, const std::string& arguments, const std::vector<std::string>& pieces) {
  SCOPED_TRACE("mobil " + arguments);
  const auto before = contents(folder);
  const Ran ran = run_mobil(arguments, folder);
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << ran.err;
  EXPECT_TRUE(ran.err.ends_with('\n')) << ran.err;
  EXPECT_TRUE(ran.err.starts_with("mobil")) << ran.err;
  EXPECT_LT(ran.err.size(), 400U) << ran.err;
  EXPECT_EQ(ran.out, "");
  for (const auto& piece : pieces) {
    EXPECT_NE(ran.err.find(piece), std::string::npos) << "no '" << piece << "' in: " << ran.err;
  }
  EXPECT_TRUE(contents(folder) == before) << "something was written";
}

void expect_refused(const std::string& arguments, const std::vector<std::string>& pieces) {
  const TemporaryFolder folder;
  expect_refused(folder.path, arguments, pieces);
}

TEST(Usage, UnknownNamesAreNamedAndTheNearestSuggested) {
  expect_refused("", {"subcommand is missing", "walk", "muscle", "mobil --help"});
  expect_refused("walj", {"'walj'", "walk, muscle", "mobil --help"});
  expect_refused("walj --height 1.8", {"'walj'", "did you mean walk?", "mobil --help"});
  expect_refused("somersault", {"'somersault'", "walk, muscle"});
  expect_refused("walk --hight 1.8 --out out", {"mobil walk:", "--hight", "did you mean --height?"});
  expect_refused("walk --hight=1.8 --out out", {"--hight ", "did you mean --height?"});
  expect_refused("walk --out 1.8 --hight 1.8", {"--hight", "did you mean --height?"});
  expect_refused("walk --steplength 0.7", {"--steplength", "did you mean --step-length?"});
  expect_refused("walk --zzzzzzzz", {"there is no option --zzzzzzzz", "mobil walk --help"});
  expect_refused("muscle --cell 2x2x8", {"mobil muscle:", "--cell ", "did you mean --cells?"});
  expect_refused("walk extra", {"'extra'", "mobil walk --help"});
  expect_refused("--height 1.8 walk", {"--height goes after the subcommand"});
}

TEST(Usage, AValueIsMissing) {
  expect_refused("walk --out out --height", {"--height needs one value"});
  expect_refused("muscle --load", {"--load needs one value"});
  for (const std::string option :
       {"height", "mass", "biotype", "speed", "step-length", "seconds", "anatomy", "view", "out"}) {
    expect_refused(fmt::format("walk --{} ''", option), {"--" + option, "empty"});
  }
}

/// The names of subcommands in a help text: those of blocks that begin with "Subcommands:" or "Subcommands of …:".
std::set<std::string> listed(const std::string& help) {
  std::set<std::string> names;
  std::istringstream lines(help);
  std::string line;
  for (bool inside = false; std::getline(lines, line);) {
    if (!line.starts_with("  ")) {
      inside = line.starts_with("Subcommands");
    } else if (inside && line[2] != ' ') {
      names.insert(line.substr(2, line.find(' ', 2) - 2));
    }
  }
  return names;
}

TEST(Usage, HelpAtEveryLevelListsWhatThereIs) {
  const TemporaryFolder folder;
  const Ran top = run_mobil("--help", folder.path);
  EXPECT_EQ(top.status, 0);
  EXPECT_EQ(top.err, "");
  const auto names = listed(top.out);
  EXPECT_TRUE(names.contains("walk") && names.contains("muscle")) << top.out;
  for (const auto& name : names) {
    const Ran help = run_mobil(name + " --help", folder.path);
    EXPECT_EQ(help.status, 0) << name;
    EXPECT_EQ(help.err, "") << name;
    EXPECT_NE(help.out.find("--help"), std::string::npos) << name;
  }
  // and what it does not list is not there
  const Ran none = run_mobil("somersault", folder.path);
  for (const std::string planned : {"body", "effects", "frontier", "crowd", "bench", "robustness"}) {
    const bool there = none.err.find(planned) != std::string::npos;
    EXPECT_EQ(names.contains(planned), there) << planned;
    EXPECT_EQ(run_mobil(planned + " --help", folder.path).status, there ? 0 : 2) << planned;
  }
  EXPECT_EQ(run_mobil("--version", folder.path).status, 0);
  EXPECT_TRUE(contents(folder.path).empty());
}

TEST(BadBody, NamesValueRangeAndUnit) {
  expect_refused("walk --height 0 --out out", {"--height 0", "1.2 to 2.2 m"});
  expect_refused("walk --height nan --out out", {"--height 'nan'", "finite", "cm"});
  expect_refused("walk --height inf --out out", {"--height 'inf'", "finite"});
  expect_refused("walk --height 1e999 --out out", {"--height '1e999'", "finite"});
  expect_refused("walk --height -3 --out out", {"--height -3", "1.2 to 2.2 m"});
  expect_refused("walk --height 12m --out out", {"--height 12m", "1.2 to 2.2 m"});
  expect_refused("walk --height 1.80s --out out", {"1.80s", "unit", "cm"});
  expect_refused("walk --height tall --out out", {"'tall'", "m, cm, mm"});
  expect_refused("walk --mass 5 --out out", {"--mass 5", "30 to 200 kg"});
  expect_refused("walk --biotype 2-5 --out out", {"'2-5'", "0.1 to 12"});
  expect_refused("walk --biotype 2-5-99 --out out", {"'2-5-99'", "0.1 to 12"});
  expect_refused("walk --constitution burly --out out", {"'burly'", "thin, average, athletic, heavy"});
}

TEST(BadGait, NamesWhatTheCallerAsked) {
  expect_refused("walk --speed 9m/s --out out", {"speed of 9 m/s", "–", "m/s", "1.75 m"});
  expect_refused("walk --speed 0 --step-length 0.7 --out out", {"speed", "positive", "0 to stand"});
  expect_refused("walk --speed -1 --out out", {"--speed -1", "m/s"});
  expect_refused("walk --speed 5m --out out", {"'5m'", "km/h"});
  expect_refused("walk --step-length 3m --out out", {"step length of 3 m", "m for a height of"});
  expect_refused("walk --step-length 40 --out out", {"--step-length 40", " m;"});
  expect_refused("walk --step-frequency 9 --out out", {"step frequency of 9 Hz"});
  expect_refused("walk --speed 1.4 --step-length 0.7 --step-frequency 3 --out out",
                 {"1.4 m/s", "0.7 m", "3 Hz", "leave one of the three out"});
  expect_refused("walk --speed 0.5 --step-length 1 --out out", {"step", "Hz"});
  expect_refused("walk --seconds 0 --out out", {"--seconds 0", "0.1 to 60 s"});
  expect_refused("walk --drive elastic --out out", {"'elastic'", "displacement, force"});
  expect_refused("walk --view xray --out out", {"'xray'", "stick, wireframe, surface"});
}

TEST(BadParameter, NamesTheNearestTheRangeAndTheList) {
  expect_refused("walk --set toe_out=3 --out out", {"--set toe_out", "did you mean toe_out_deg?", "--list-parameters"});
  expect_refused("walk --set step_widht_h=0.1 --out out", {"did you mean step_width_h?", "--list-parameters"});
  expect_refused("walk --set zzz=3 --out out", {"--set zzz", "--list-parameters"});
  expect_refused("walk --set toe_out_deg --out out", {"'toe_out_deg'", "NAME=VALUE"});
  expect_refused("walk --set toe_out_deg=10 --set toe_out_deg=40 --out out", {"toe_out_deg 40", "-15 to 30 deg"});
  expect_refused("walk --set toe_out_deg=10kg --out out", {"'kg'", "deg"});
  expect_refused("walk --set toe_out_deg= --out out", {"toe_out_deg ''", "number"});
  expect_refused("walk --set toe_out_deg=1 toe_clearance_m=0 --out out", {"'toe_clearance_m=0' was not expected"});
}

TEST(BadScript, NamesFileAndLine) {
  const TemporaryFolder folder;
  const std::map<std::string, std::pair<std::string, std::string>> bad = {
      {"empty", {"", "no rows"}},
      {"header", {"time,parameter,value\n0,speed,1\n", "no column 'time_s'"}},
      {"backwards", {"time_s,parameter,value\n1,speed,1\n0.5,speed,1\n", "line 3: time 0.5 s comes before 1 s"}},
      {"unknown", {"time_s,parameter,value\n1,steplength,1\n", "line 2: there is no parameter 'steplength'"}},
      {"short", {"time_s,parameter,value\n1,stop\n", "line 2: 2 cells"}},
      {"beyond", {"time_s,parameter,value\n\n1,toe_out_deg,31\n", "line 3: toe_out_deg 31: outside"}},
      {"body", {"time_s,parameter,value\n1,speed,9km/h\n", "line 2: gait: a speed of 2.5 m/s"}},  // for 1.75 m
  };
  for (const auto& [name, text] : bad) {
    std::ofstream(folder.path / (name + ".csv")) << text.first;
    expect_refused(folder.path, fmt::format("walk --seconds 0.1 --script {}.csv --out out", name),
                   {"--script", name + ".csv", text.second});
  }
  expect_refused(folder.path, "walk --script nowhere.csv --out out", {"nowhere.csv", "time_s, parameter, value"});
}

TEST(Listing, GaitParametersAndNothingElse) {
  const TemporaryFolder folder;
  const Ran ran = run_mobil("walk --list-parameters", folder.path);
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.err, "");
  for (const GaitParameter& p : gait_parameters)
    EXPECT_NE(ran.out.find(fmt::format("\n  {} ", p.name)), std::string::npos);
  EXPECT_TRUE(contents(folder.path).empty());
}

TEST(BadOutput, StandardOutputIsFull) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  for (const std::string arguments : {"--help", "--version", "walk --help", "walk --list-parameters",
                                      "walk --seconds 0.1 --out out", "muscle --seconds 0.01"}) {
    for (const std::string sink : {">/dev/full", ">&-"}) {
      const TemporaryFolder folder;
      const Ran ran = run_shell("{ '" MOBIL_PROGRAM "' " + arguments + " " + sink + "; }", folder.path);
      EXPECT_EQ(ran.status, 1) << arguments << sink;
      EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << ran.err;
      EXPECT_TRUE(ran.err.starts_with("mobil")) << ran.err;
    }
  }
}

TEST(BadOutput, AFileIsInTheWay) {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "taken") << "mine";
  expect_refused(folder.path, "walk --seconds 0.1 --out taken", {"taken", "--out"});
  expect_refused(folder.path, "walk --seconds 0.1 --out taken/below", {"taken/below", "--out"});
  expect_refused(folder.path, "muscle --seconds 0.01 --out taken/disp.csv", {"taken/disp.csv", "--out"});
  fs::create_directories(folder.path / "folder");
  expect_refused(folder.path, "muscle --seconds 0.01 --out folder", {"folder", "--out"});
  expect_refused(folder.path, "muscle --seconds 0.01 --out nowhere/disp.csv", {"nowhere/disp.csv", "folder"});
}

TEST(BadOutput, AFolderHasTheNameOfAResult) {
  for (const std::string name : {"motion.csv", "muscles.csv", "walk.glb", "summary.json"}) {
    const TemporaryFolder folder;
    fs::create_directories(folder.path / "out" / name / "inside");
    const Ran ran = run_mobil("walk --seconds 0.1 --out out", folder.path);
    EXPECT_EQ(ran.status, 2) << name;
    EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << ran.err;
    EXPECT_NE(ran.err.find(name), std::string::npos) << ran.err;
    for (const auto& entry : fs::directory_iterator(folder.path / "out")) {  // nothing under a passing name
      const std::set<std::string> final_names = {"motion.csv", "muscles.csv", "walk.glb", "summary.json"};
      EXPECT_TRUE(final_names.contains(entry.path().filename().string())) << entry.path();
    }
  }
}

TEST(BadOutput, WithoutFfmpegOrADriverNothingIsWritten) {
  const TemporaryFolder folder;
  for (const std::string refused :
       {"PATH=/nowhere '" MOBIL_PROGRAM "' walk --seconds 0.1 --video --out out",
        "__EGL_VENDOR_LIBRARY_DIRS=/nowhere '" MOBIL_PROGRAM "' walk --seconds 0.1 --frames --out out"}) {
    const Ran ran = run_shell(refused, folder.path);
    if (ran.status == 0 && refused.find("EGL") != std::string::npos) GTEST_SKIP() << "this driver cannot be hidden";
    EXPECT_EQ(ran.status, 2) << refused;
    EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << ran.err;
    EXPECT_NE(ran.err.find("apt-get install"), std::string::npos) << ran.err;
    EXPECT_TRUE(contents(folder.path).empty()) << refused;
  }
}

TEST(BadWalk, NamesTheMethodsAndElements) {
  expect_refused("walk --method magic", {"--method", "'magic'", "static, ecd, icd, caa"});
  expect_refused("walk --element cube", {"--element", "'cube'", "full, bbar, one-point"});
}

TEST(BadMuscle, NamesTheLimit) {
  expect_refused("muscle --dt 0.0037", {"0.0037", "critical step 0.003483 s", "0.00313 s"});
  expect_refused("muscle --poisson 0.5", {"0.5", "-0.99 to 0.4999"});
  expect_refused("muscle --poisson nan", {"--poisson", "'nan'"});
  expect_refused("muscle --young 0", {"oung", "0"});
  expect_refused("muscle --density -1", {"ensity", "-1"});
  expect_refused("muscle --cells 2x2", {"'2x2'", "2x2x8"});
  expect_refused("muscle --cells 0x2x2", {"0x2x2", "1 to 256"});
  expect_refused("muscle --cell-size 0", {"--cell-size 0", "0.0001 to 1 m"});
  expect_refused("muscle --method magic", {"'magic'", "ecd"});
  expect_refused("muscle --seconds 1e9", {"--seconds 1e9", "3600 s"});
}

TEST(BadMuscle, LoadsThatAreNoHistories) {
  const TemporaryFolder folder;
  const std::map<std::string, std::string> bad = {
      {"empty", ""},
      {"header", "time,force\n0,1\n"},
      {"rowless", "time_s,force_x_n,force_y_n,force_z_n\n"},
      {"short", "time_s,force_x_n,force_y_n,force_z_n\n0,0,0\n"},
      {"word", "time_s,force_x_n,force_y_n,force_z_n\n0,0,much,1\n"},
      {"nan", "time_s,force_x_n,force_y_n,force_z_n\n0,0,nan,1\n"},
      {"backwards", "time_s,force_x_n,force_y_n,force_z_n\n1,0,0,1\n0,0,0,1\n"},
  };
  for (const auto& [name, text] : bad) {
    std::ofstream(folder.path / (name + ".csv")) << text;
    expect_refused(folder.path, fmt::format("muscle --load {}.csv", name), {name + ".csv"});
  }
  expect_refused(folder.path, "muscle --load nowhere.csv", {"nowhere.csv", "time_s"});
  expect_refused(folder.path, "muscle --load .", {"--load"});
}

// ---------------------------------------------------------------------------------------------------- anatomy

/// A cube of half edge `half` about (x, y, z), mm, as an OBJ file.
std::string cube(double x, double y, double z, double half) {
  static constexpr std::array<std::array<int, 4>, 6> faces = {
      {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}}};
  std::string text;
  for (unsigned i = 0; i < 8; ++i) {
    text += fmt::format("v {} {} {}\n", x + ((i & 1U) != 0 ? half : -half), y + ((i & 2U) != 0 ? half : -half),
                        z + ((i & 4U) != 0 ? half : -half));
  }
  for (const auto& f : faces) text += fmt::format("f {} {} {} {}\n", f[0], f[1], f[2], f[3]);
  return text;
}

/// The smallest folder that would do, in which `femur` is the thigh's mesh.
void write_anatomy(const fs::path& folder, const std::string& femur, int triangles = 12) {
  fs::create_directories(folder / "bones");
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
  };
  write("landmarks.csv",
        "name,side,x,y,z,method\nhip_joint_centre,right,-82,-93,820,made up\nknee_joint_centre,right,-74,-65,434,made "
        "up\nankle_joint_centre,right,-80,-54,60,made up\n");
  const std::string head = "file,name,side,kind,group,triangles,watertight,origin_bone,insertion_bone\n";
  write("manifest.csv", head + fmt::format("bones/femur_right.obj,Femur,right,bone,,{},yes,,\n", triangles) +
                            "bones/tibia_right.obj,Tibia,right,bone,,12,yes,,\n");
  write("bones/tibia_right.obj", cube(-78, -60, 250, 30));
  write("bones/femur_right.obj", femur);
}

TEST(BadAnatomy, NamesTheFileAndTheMend) {
  const std::string good = cube(-80, -90, 620, 30);
  std::string not_a_number = good;
  not_a_number.replace(2, not_a_number.find(' ', 2) - 2, "nan");
  const std::map<std::string, std::pair<std::string, std::string>> bad = {
      {"truncated", {good.substr(0, good.size() / 2), "bones/femur_right.obj"}},
      {"blank", {"", "bones/femur_right.obj"}},
      {"rubbish", {std::string(1000, '\x07'), "bones/femur_right.obj"}},
      {"not_finite", {not_a_number, "bones/femur_right.obj"}},
      {"not_manifold", {good + "v -80 -90 700\nf 1 2 9\nf 5 6 9\n", "more than two triangles"}},
  };
  const TemporaryFolder folder;
  for (const auto& [name, text] : bad) {
    write_anatomy(folder.path / name, text.first, name == "not_manifold" ? 14 : 12);
    expect_refused(folder.path, fmt::format("walk --seconds 0.1 --anatomy {} --out out", name),
                   {"bones/femur_right.obj", text.second});
  }
  fs::create_directories(folder.path / "void");
  expect_refused(folder.path, "walk --seconds 0.1 --anatomy void --out out", {"void/", ".csv", "cannot be read"});
  expect_refused(folder.path, "walk --seconds 0.1 --anatomy nowhere --out out", {"nowhere"});
  std::ofstream(folder.path / "file") << "no folder";
  expect_refused(folder.path, "walk --seconds 0.1 --anatomy file --out out", {"file"});
}

TEST(GoodAnatomy, TheSameFolderUnspoilt) {
  const TemporaryFolder folder;
  write_anatomy(folder.path / "anatomy", cube(-80, -90, 620, 30));
  const Ran ran = run_mobil("walk --seconds 0.1 --anatomy anatomy --out out", folder.path);
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(ran.err, "");
  EXPECT_TRUE(fs::exists(folder.path / "out" / "walk.glb"));
}

}  // namespace mobil::cli_test
