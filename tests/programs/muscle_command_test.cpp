// `mobil muscle` as users and scripts run it: every method, its output, and its refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/program/program.h"

namespace mobil::muscle_command_test {
const std::string push = "time_s,force_x_n,force_y_n,force_z_n\n0,0.001,0.0005,0.01\n0.1,0.002,0,0.01\n0.1,0,0,0\n";

/// Runs in a folder that contains load.csv. Returns the table.
Csv displacement(const TemporaryFolder& folder, const std::string& options) {
  std::ofstream(folder.path / "load.csv") << push;
  const Ran ran = run_mobil("muscle " + options, folder.path);
  EXPECT_EQ(ran.status, 0) << options << ": " << ran.err;
  return Csv(folder.path / "disp.csv");
}

double distance(const Csv& a, const Csv& b) {
  EXPECT_EQ(a.rows.size(), b.rows.size());
  double error = 0, norm = 0;
  for (std::size_t r = 0; r < std::min(a.rows.size(), b.rows.size()); ++r) {
    for (const std::string column : {"u_x_m", "u_y_m", "u_z_m"}) {
      error += std::pow(a.number(r, column) - b.number(r, column), 2);
      norm += std::pow(b.number(r, column), 2);
    }
  }
  return std::sqrt(error / norm);
}

void expect_refused(const std::string& options, const std::vector<std::string>& parts) {
  const TemporaryFolder folder;
  const Ran ran = run_mobil("muscle " + options, folder.path);
  EXPECT_EQ(ran.status, 2) << options;
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  for (const auto& part : parts) EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err << " lacks " << part;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path)) << options;
}

TEST(MuscleCommand, SingleAndDoublePrecisionAgreeInEveryMethodUnderEveryLoad) {
  const TemporaryFolder folder;
  for (const std::string method :
       {"static", "explicit-central", "implicit-central", "newmark", "newmark --mass lumped"}) {
    for (const std::string more :
         {"", "--damping 5 --stiffness-damping 0.5ms --foundation 5Hz --gravity 0,-1,0.5",
          "--element bbar --poisson 0.45", "--element one-point --gravity 0.1,0,0 --grading 2,0.5"}) {
      const std::string options = fmt::format("--load load.csv --dt 0.4ms --seconds 0.3 --method {} {}", method, more);
      const Csv single = displacement(folder, options);
      EXPECT_LT(distance(single, displacement(folder, options + " --precision double")), 5e-5) << options;
    }
  }
}

TEST(MuscleCommand, EveryRowIsTheStateAtItsTime) {
  const TemporaryFolder folder;
  for (const std::string method : {"explicit-central", "implicit-central", "newmark"}) {
    const Csv csv = displacement(folder, "--load load.csv --dt 0.5ms --seconds 0.05 --method " + method);
    ASSERT_EQ(csv.rows.size(), 101U);
    EXPECT_EQ(csv.columns, (std::vector<std::string>{"time_s", "u_x_m", "u_y_m", "u_z_m"}));
    for (std::size_t r = 0; r < csv.rows.size(); ++r) {
      ASSERT_NEAR(csv.number(r, "time_s"), 0.0005 * static_cast<double>(r), 1e-9);
    }
    EXPECT_EQ(csv.number(0, "u_z_m"), 0);
    // the force acts from t = 0: uniform acceleration at first, four times the distance at twice the time
    EXPECT_NEAR(csv.number(2, "u_z_m") / csv.number(1, "u_z_m"), 4, method == "newmark" ? 0.6 : 0.3) << method;
  }
}

TEST(MuscleCommand, DefaultMassFollowsTheMethodAndIsReported) {
  const TemporaryFolder folder;
  const auto says = [&](const std::string& options, const std::string& part) {
    const Ran ran = run_mobil("muscle --seconds 0.02 " + options, folder.path);
    EXPECT_NE(ran.out.find(part), std::string::npos) << ran.out << ran.err;
    EXPECT_EQ(ran.err, "");
  };
  says("", "explicit-central: explicit central differences, lumped mass, full elements, single precision");
  says("--method implicit-central", "implicit-central: implicit central differences, consistent mass");
  says("--method newmark --element bbar", "newmark: constant average acceleration, consistent mass, bbar elements");
  says("--method newmark --mass lumped --precision double", "lumped mass, full elements, double precision");
  says("--method static", "static solution, full elements");
  says("--method newmark", "critical step  none, stable at any");
  says("--method implicit-central", "critical step  0.001629 s");
}

TEST(MuscleCommand, NewmarkAllowsStepsThatExplicitMethodsRefuse) {
  const TemporaryFolder folder;
  const Csv csv = displacement(folder, "--load load.csv --method newmark --dt 20ms --seconds 1");
  for (std::size_t r = 0; r < csv.rows.size(); ++r) EXPECT_LT(std::abs(csv.number(r, "u_x_m")), 0.1);
  expect_refused("--method implicit-central --dt 2ms",
                 {"--dt 0.002 s", "critical step 0.001629 s", "--method newmark"});
  expect_refused("--dt 3ms --stiffness-damping 2ms", {"--dt 0.003 s", "critical step"});
  expect_refused("--dt 3.4ms --element bbar --poisson 0.49", {"critical step"});
}

TEST(MuscleCommand, RefusesConflictingOptionsAndNamesValidOnes) {
  expect_refused("--method explicit-central --mass consistent", {"--method implicit-central", "--mass lumped"});
  expect_refused("--method implicit-central --mass lumped", {"--method explicit-central", "--mass consistent"});
  expect_refused("--method verlet", {"'verlet'", "static, explicit-central, implicit-central, newmark"});
  expect_refused("--mass heavy", {"'heavy'", "lumped, consistent"});
  expect_refused("--element tetrahedron", {"'tetrahedron'", "full, bbar, one-point"});
  expect_refused("--precision half", {"'half'", "single, double"});
  expect_refused("--damping -1", {"--damping", "0 to 1000"});
  expect_refused("--stiffness-damping 2", {"--stiffness-damping", "0 to 1 s"});
  expect_refused("--gravity 0,9.81", {"--gravity '0,9.81'", "0,-9.81,0"});
  expect_refused("--gravity 0,nan,0", {"--gravity"});
  expect_refused("--grading 0,1", {"--grading '0,1'", "0.01 to 100"});
}

TEST(MuscleCommand, WarnsOfTooCoarseElementsAndStillRuns) {
  const TemporaryFolder folder;
  const Ran coarse = run_mobil("muscle --cells 2x2x4 --cell-size 0.04 --seconds 0.05", folder.path);
  EXPECT_EQ(coarse.status, 0);
  EXPECT_EQ(std::count(coarse.err.begin(), coarse.err.end(), '\n'), 1) << coarse.err;
  EXPECT_NE(coarse.err.find("0.04 m"), std::string::npos) << coarse.err;
  EXPECT_NE(coarse.err.find("0.03 m"), std::string::npos) << coarse.err;
  EXPECT_EQ(run_mobil("muscle --cells 2x2x4 --cell-size 0.029 --seconds 0.05", folder.path).err, "");
}

TEST(MuscleCommand, HelpShowsMethodsAndARunnableExample) {
  const TemporaryFolder folder;
  const Ran help = run_mobil("muscle --help", folder.path);
  const std::size_t example = help.out.find("  printf 'time_s");
  ASSERT_NE(example, std::string::npos) << help.out;
  std::istringstream lines(help.out.substr(example));
  std::string line, script = "mobil() { '" MOBIL_PROGRAM "' \"$@\"; };";
  while (std::getline(lines, line) && !line.empty()) script += line + ";";
  const Ran ran = run_shell(script, folder.path);
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_TRUE(std::filesystem::exists(folder.path / "damped.csv"));
}

TEST(MuscleCommand, ContractsARealMuscle) {
  const TemporaryFolder folder;
  const Ran ran = run_mobil("muscle --activation 1 --of soleus --out calf.csv", folder.path);
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("soleus"), std::string::npos) << ran.out;
  const Csv csv(folder.path / "calf.csv");
  ASSERT_EQ(csv.rows.size(), 480U);
  EXPECT_LT(csv.number(40, "muscle_force_n"), 50);
  EXPECT_GT(csv.number(280, "muscle_force_n"), 1000);
  EXPECT_LT(csv.number(479, "activation"), 0.05);
  for (std::size_t r = 0; r < csv.rows.size(); ++r) {
    EXPECT_NEAR(csv.number(r, "volume_ratio"), 1, 0.01) << r;
    EXPECT_NEAR(csv.number(r, "line_m"), csv.number(0, "line_m"), 1e-6) << r;
  }
  EXPECT_GT(csv.number(280, "middle_section_ratio"), 1.02);
  expect_refused("--activation 1.5", {"--activation", "0 to 1"});
  expect_refused("--activation 1 --of biceps_brachii", {"--of", "'biceps_brachii'", "soleus"});
}

}  // namespace mobil::muscle_command_test
