// `mobil bench`: figures have their documented names and are positive and finite; bad input is refused before
// measuring. Run times are not tested.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/program/program.h"

namespace mobil::bench_test {
namespace fs = std::filesystem;

struct Figure {
  double value = 0;
  std::string unit;
};

/// Runs the named benchmarks with 64 people. Figures are stored by name; each name occurs once.
struct Bench {
  explicit Bench(const std::string& names) {
    ran = run_mobil("bench " + names + " --people 64 --quiet --json bench.json", folder.path);
    if (ran.status != 0) return;
    json = nlohmann::json::parse(read_bytes(folder.path / "bench.json"));
    for (const auto& result : json.at("results")) {
      const std::string name = result.at("name").get<std::string>();
      EXPECT_FALSE(figures.contains(name)) << name;
      figures[name] = {result.at("value").get<double>(), result.at("unit").get<std::string>()};
      for (const auto* also : {"median", "cpu"}) {
        if (result.contains(also)) {
          EXPECT_GT(result.at(also).get<double>(), 0) << name;
        }
      }
    }
  }

  TemporaryFolder folder;
  Ran ran;
  nlohmann::json json;
  std::map<std::string, Figure> figures;
};

constexpr auto measures_for_long = "under a sanitizer these benches measure for ten minutes what other tests have run";

TEST(Bench, PromisedNamesArePositiveAndFinite) {
  if (sanitized) GTEST_SKIP() << measures_for_long;
  const Bench bench("machine gait kinematics lines skinning skin");
  ASSERT_EQ(bench.ran.status, 0) << bench.ran.err;
  EXPECT_EQ(bench.ran.err, "");
  const std::map<std::string, std::string> promised = {
      {"machine.fma_peak_gflops", "Gflop/s"},  {"machine.bandwidth_gbps", "GB/s"}, {"gait.us_per_person_tick", "us"},
      {"kinematics.us_per_person_tick", "us"}, {"lines.us_per_muscle_tick", "us"}, {"skinning.ns_per_vertex", "ns"},
  };
  for (const auto& [name, unit] : promised) {
    ASSERT_TRUE(bench.figures.contains(name)) << name;
    EXPECT_EQ(bench.figures.at(name).unit, unit) << name;
    EXPECT_NE(bench.ran.out.find(name), std::string::npos) << name;
  }
  for (const auto& [name, figure] : bench.figures) {
    EXPECT_TRUE(std::isfinite(figure.value) && figure.value > 0) << name << " is " << figure.value;
  }
  // solved steps are counted where a walk can change; elsewhere the output states that they are not
  EXPECT_NE(bench.ran.out.find("gait.us_per_resolve"), std::string::npos);

  const auto& machine = bench.json.at("machine");
  for (const auto* text : {"cpu", "target", "compiler", "flags"}) {
    EXPECT_FALSE(machine.at(text).get<std::string>().empty()) << text;
  }
  EXPECT_GE(machine.at("cores").get<int>(), 1);
  EXPECT_EQ(bench.json.at("crowd").at("people"), 64);
  EXPECT_EQ(std::distance(fs::directory_iterator(bench.folder.path), fs::directory_iterator()), 1);
}

TEST(Bench, MeasuresNamedBenchmarksAndTheMachine) {
  if (sanitized) GTEST_SKIP() << measures_for_long;
  const Bench bench("skinning");
  ASSERT_EQ(bench.ran.status, 0) << bench.ran.err;
  EXPECT_TRUE(bench.figures.contains("machine.fma_peak_gflops"));
  EXPECT_TRUE(bench.figures.contains("skinning.ns_per_vertex"));
  for (const auto& [name, figure] : bench.figures) {
    EXPECT_TRUE(name.starts_with("machine.") || name.starts_with("skinning.")) << name;
  }
  // a fraction of a limit is the figure divided by that limit; bytes and operations a vertex are integers
  const double ns = bench.figures.at("skinning.ns_per_vertex").value;
  const double bytes =
      bench.figures.at("skinning.bandwidth_fraction").value * ns * bench.figures.at("machine.bandwidth_gbps").value;
  const double operations =
      bench.figures.at("skinning.peak_fraction").value * ns * bench.figures.at("machine.fma_peak_gflops").value;
  EXPECT_NEAR(bytes, std::round(bytes), 1e-6);
  EXPECT_NEAR(operations, std::round(operations), 1e-6);
}

TEST(Bench, FiniteElementFiguresAreCompleteAndConsistent) {
  const Bench bench("fem --quick");
  ASSERT_EQ(bench.ran.status, 0) << bench.ran.err;
  EXPECT_EQ(bench.ran.err, "");
  std::vector<std::string> promised = {"fem.explicit81.individual_over_shared",
                                       "fem.static81.shared.us_per_solve",
                                       "fem.static81.individual.us_per_solve",
                                       "fem.explicit81.time_error",
                                       "fem.newmark81.time_error",
                                       "fem.newmark81.60hz.time_error"};
  for (const std::string whose : {".shared", ".individual"}) {
    promised.push_back("fem.explicit81" + whose + ".us_per_step");
    promised.push_back("fem.explicit81" + whose + ".peak_fraction");
  }
  for (const std::string stem : {"newmark81", "newmark81.60hz", "implicit81"}) {
    for (const std::string whose : {".shared", ".individual"})
      promised.push_back("fem." + stem + whose + ".us_per_step");
  }
  const bool rivals = bench.figures.contains("fem.rivals.eigen.us_per_step");
  if (rivals) {
    for (const std::string ratio : {"ratio_to_eigen", "ratio_to_eigen_batched", "individual.ratio_to_eigen"}) {
      promised.push_back("fem.explicit81." + ratio);
    }
    EXPECT_EQ(bench.ran.out.find("TOO FAR OFF"), std::string::npos) << bench.ran.out;
  } else {
    EXPECT_NE(bench.ran.out.find("build the CMake target mobil_rivals"), std::string::npos);
  }
  for (const std::string& name : promised) {
    ASSERT_TRUE(bench.figures.contains(name)) << name;
    EXPECT_TRUE(std::isfinite(bench.figures.at(name).value) && bench.figures.at(name).value > 0) << name;
    EXPECT_EQ(bench.figures.at(name).unit, name.find(".us_per_") != std::string::npos ? "us" : "1") << name;
  }
  EXPECT_NE(bench.ran.out.find("fem.threads2_speedup"), std::string::npos);
  EXPECT_NE(bench.ran.out.find("fem.explicit81.ratio_to_"), std::string::npos);  // measured, or the reason why not

  // useful work divided by its time and by the peak
  const double us = bench.figures.at("fem.explicit81.shared.us_per_step").value;
  const double flops = bench.figures.at("fem.explicit81.shared.peak_fraction").value * us * 1e3 *
                       bench.figures.at("machine.fma_peak_gflops").value;
  EXPECT_NEAR(flops, 2 * 9702, 1e-6 * flops);
}

TEST(Bench, PaperFiguresRefuseUnstableSteps) {
  const Bench bench("paper_figures --quick");
  ASSERT_EQ(bench.ran.status, 0) << bench.ran.err;
  for (const std::string name : {"figure18.explicit81.2.0ms", "figure18.explicit81.3.0ms", "figure18.newmark81.4.0ms",
                                 "figure18.newmark525.4.0ms", "figure18.implicit81.1.0ms", "figure20.explicit81.1.0ms",
                                 "figure20.explicit525.1.0ms"}) {
    EXPECT_TRUE(bench.figures.contains(name + ".us_per_simulated_s")) << name;
  }
  for (const std::string name :
       {"figure18.explicit81.4.0ms", "figure18.explicit525.2.0ms", "figure20.explicit3321.1.0ms"}) {
    EXPECT_FALSE(bench.figures.contains(name + ".us_per_simulated_s")) << name;
  }
  EXPECT_TRUE(bench.figures.contains("figure20.four_groups_at_3ms_over_three_at_2ms"));
  EXPECT_NE(bench.ran.out.find("above the limit 3.48 ms"), std::string::npos);
  // a coarse mesh is less accurate than a fine one
  EXPECT_LT(bench.figures.at("figure19.newmark525_to_converged").value,
            bench.figures.at("figure19.explicit81_2ms_to_converged").value);
  EXPECT_NEAR(bench.figures.at("figure19.explicit81_to_newmark525").value, 0.0107, 0.0003);
}

TEST(Bench, BadInputIsOneLineAndNothingIsWritten) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path / "taken");
  const std::map<std::string, std::vector<std::string>> refused = {
      {"gaiit --json bench.json",
       {"'gaiit'", "did you mean gait?",
        "machine, gait, kinematics, lines, activation, skinning, skin, avoidance, table1, fem, modal, "
        "paper_figures"}},
      {"gait somersault", {"'somersault'", "machine, gait"}},
      {"gait --people 0", {"--people '0'", "1 to 200000"}},
      {"gait --people -5", {"--people '-5'", "1 to 200000"}},
      {"gait --people many", {"--people 'many'", "1 to 200000"}},
      {"gait --people 200001", {"--people '200001'", "1 to 200000"}},
      {"gait --people 99999999999999999999", {"1 to 200000"}},
      {"gait --json", {"--json needs one value"}},
      {"gait --json ''", {"--json", "empty"}},
      {"gait --json nowhere/bench.json", {"--json nowhere/bench.json", "folder"}},
      {"gait --json taken", {"--json taken", "folder"}},
      {"gait --jsn bench.json", {"--jsn", "did you mean --json?"}},
  };
  expect_refused("bench", refused, folder.path);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()), 1);
}

}  // namespace mobil::bench_test
