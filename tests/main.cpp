// A test program: all tests of a folder. CTest runs it once for each file of tests.
//   FOLDER_test                     all tests, or those of --gtest_filter
//   FOLDER_test --file=NAME_test    those of that file; --gtest_filter (or GTEST_FILTER) leaves some of them out
//   FOLDER_test --ctest OUT FOLDER    writes the list of files for CTest: a test FOLDER/NAME each

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <string_view>

#include "tests/labels.h"

namespace mobil::tests {
namespace {

/// "kinematics_test" of "…/tests/gait/kinematics_test.cpp".
std::string stem(const char* file) {
  return std::filesystem::path(file).stem().string();
}

std::map<std::string, std::string>& labels_by_file() {
  static std::map<std::string, std::string> labels;
  return labels;
}

/// Names of all tests, by file, as --gtest_filter takes them.
std::map<std::string, std::string> filter_by_file() {
  std::map<std::string, std::string> filters;
  const auto& all = *testing::UnitTest::GetInstance();
  for (int s = 0; s < all.total_test_suite_count(); ++s) {
    const auto& suite = *all.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const auto& test = *suite.GetTestInfo(t);
      filters[stem(test.file())] += std::string(":") + suite.name() + "." + test.name();
    }
  }
  return filters;
}

bool write_list(const std::string& to, const std::string& program, const std::string& folder) {
  std::ofstream out(to);
  for (const auto& [file, filter] : filter_by_file()) {
    const std::string name = folder + "/" + file.substr(0, file.rfind("_test")), labels = labels_by_file()[file];
    out << "add_test(" << name << " \"" << program << "\" --file=" << file << ")\nset_tests_properties(" << name
        << " PROPERTIES LABELS \"" << folder << ";" << labels << "\" COST " << (labels.find("slow") != labels.npos)
        << " TIMEOUT ${hangs_after} ENVIRONMENT \"${environment}\")\n";
  }
  return static_cast<bool>(out.flush());
}

}  // namespace

int label(const char* file, const char* labels) {
  labels_by_file()[stem(file)] = labels;
  return 0;
}

}  // namespace mobil::tests

int main(int argc, char** argv) {
  using namespace mobil::tests;
  testing::InitGoogleTest(&argc, argv);
  if (argc == 4 && std::string_view(argv[1]) == "--ctest") {
    return write_list(argv[2], std::filesystem::absolute(argv[0]).string(), argv[3]) ? 0 : 1;
  }
  if (argc == 2 && std::string_view(argv[1]).starts_with("--file=")) {
    const auto filters = filter_by_file();
    const auto found = filters.find(argv[1] + 7);
    if (found == filters.end()) {
      std::cerr << "no tests of that name in it; it has";
      for (const auto& [file, filter] : filters) std::cerr << " " << file;
      std::cerr << "\n";
      return 2;
    }
    const std::string asked = GTEST_FLAG_GET(filter);
    const auto minus = asked.find('-');
    GTEST_FLAG_SET(filter, found->second.substr(1) + (minus == asked.npos ? "" : asked.substr(minus)));
    argc = 1;
  }
  if (argc > 1) {
    std::cerr << "there is no argument " << argv[1] << "\n";
    return 2;
  }
  return RUN_ALL_TESTS();
}
