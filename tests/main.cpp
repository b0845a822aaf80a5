// A test program: all tests of a folder. CTest runs it once for each file of tests.
//   FOLDER_test                     all tests, or those of --gtest_filter
//   FOLDER_test --file=NAME_test    tests of that file; --gtest_filter (or GTEST_FILTER) can exclude some of them
//   FOLDER_test --ctest OUT FOLDER    writes the list of files for CTest: a test FOLDER/NAME each

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>

#include "tests/labels.h"

namespace mobil::tests {
namespace {

/// Returns "kinematics_test" for "…/tests/gait/kinematics_test.cpp".
std::string stem(const char* file) {
  return std::filesystem::path(file).stem().string();
}

std::map<std::string, std::string>& labels_by_file() {
  static std::map<std::string, std::string> labels;
  return labels;
}

/// Returns the names of all tests by file, in the form of --gtest_filter.
std::map<std::string, std::string> filter_by_file() {
  std::map<std::string, std::string> filters;
  const auto& all = *testing::UnitTest::GetInstance();
  for (int s = 0; s < all.total_test_suite_count(); ++s) {
    const auto& suite = *all.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const auto& test = *suite.GetTestInfo(t);
      filters[stem(test.file())] += std::string(suite.name()) + "." + test.name() + ":";
    }
  }
  return filters;
}

bool is_long(const std::string& labels) {
  return labels.find("long") != labels.npos || labels.find("slow") != labels.npos;
}

/// Returns the tests to run. Under ThreadSanitizer (MOBIL_QUICK=threads) a long file runs only its thread tests.
std::string chosen(const std::string& file, const std::string& filter) {
  const char* quick = std::getenv("MOBIL_QUICK");
  if (quick == nullptr || std::string_view(quick) != "threads" ||
      labels_by_file()[file].find("long") == std::string::npos)
    return filter;
  std::istringstream names(filter);
  std::string some, name;
  while (std::getline(names, name, ':'))
    if (name.find("Thread") != name.npos || name.find("AtOnce") != name.npos) some += name + ":";
  return some;
}

bool write_list(const std::string& to, const std::string& program, const std::string& folder) {
  std::ofstream out(to);
  for (const auto& [file, filter] : filter_by_file()) {
    const std::string name = folder + "/" + file.substr(0, file.rfind("_test")), labels = labels_by_file()[file];
    out << "add_test(" << name << " \"" << program << "\" --file=" << file << ")\nset_tests_properties(" << name
        << " PROPERTIES LABELS \"" << folder << ";" << labels << "\" COST " << (is_long(labels))
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
    GTEST_FLAG_SET(filter, chosen(found->first, found->second) + (minus == asked.npos ? "" : asked.substr(minus)));
    argc = 1;
  }
  if (argc > 1) {
    std::cerr << "there is no argument " << argv[1] << "\n";
    return 2;
  }
  return RUN_ALL_TESTS();
}
