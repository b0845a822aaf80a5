// Every subcommand with standard streams that are closed, full or without a reader, and under a limit of file size:
// exit status and results files as with ordinary streams.

#include <gtest/gtest.h>

#include <cctype>
#include <map>
#include <string>
#include <vector>

#include "tests/labels.h"
#include "tests/program/program.h"

MOBIL_TEST_LABELS("long");

namespace mobil {
namespace {

namespace fs = std::filesystem;

enum class Product {
  files,   // text on stdout accompanies files
  output,  // text on stdout is the requested result
  none,    // refused
};

struct Row {
  std::string command;
  Product product;
};
void PrintTo(const Row& row, std::ostream* out) {
  *out << row.command;
}

const std::vector<Row> rows = {
    {"walk --seconds 0.2 --no-forces --method none --out out", Product::files},
    {"walk --set step_asymmetry=-0.4 --speed 1.8 --seconds 0.2 --no-forces --method none --out out", Product::files},
    {"walk --list-parameters", Product::output},
    {"walk --speed 99", Product::none},
    {"walk --humans 3", Product::none},
    {"crowd --people 4 --seconds 0.1", Product::output},
    {"crowd --people 0", Product::none},
    {"city --people 100 --seconds 0.1", Product::output},
    {"city --people 1", Product::none},
    {"town --people 4 --seconds 0.1", Product::output},
    {"town --people 0", Product::none},
    {"view --nothing", Product::none},
    {"bake --nothing", Product::none},
    {"schedule", Product::output},
    {"schedule --svg schedule.svg", Product::files},
    {"anatomy nowhere", Product::none},
    {"body --json", Product::output},
    {"body --height 9", Product::none},
    {"muscle --seconds 0.2 --out muscle.csv", Product::files},
    {"muscle --method nothing", Product::none},
    {"bench nothing", Product::none},
    {"compare --reference nowhere", Product::none},
    {"robustness --list", Product::output},
    {"robustness denormals", Product::output},
    {"paper nothing", Product::none},
    {"frontier --short --long", Product::none},
    {"effects --people 0", Product::none},
    {"fit-gait --styles --without 1", Product::none},
    {"fit-run --nothing", Product::none},
    {"fit-accuracy --nothing", Product::none},
    {"fit-shapes --nothing", Product::none},
    {"completion bash", Product::output},
    {"man walk", Product::output},
    {"--help", Product::output},
    {"--version", Product::output},
};

struct Streams {
  std::string name, before, after;  // around the command, in bash
  bool output_lost = false;         // stdout cannot be written, which is an error for requested output
};

const std::vector<Streams> streams = {
    {"stderr closed", "", "2>&-"},
    {"stderr full", "", "2>/dev/full"},
    {"stderr without reader", "(sleep 0.05; exec ", ") 2>&1 >/dev/null | true; exit ${PIPESTATUS[0]}"},
    {"stdout closed", "", ">&-", true},
    {"stdout full", "", ">/dev/full", true},
    {"stdout without reader", "(sleep 0.05; exec ", ") | true; exit ${PIPESTATUS[0]}"},
    {"all closed", "", "<&- >&- 2>&-", true},
};

using Files = std::map<std::string, std::uintmax_t>;

/// Returns names and sizes of all files, hidden ones too. summary.json contains times, so its size varies.
Files files_in(const fs::path& folder) {
  Files found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const bool sized = entry.is_regular_file() && entry.path().filename() != "summary.json";
    found[entry.path().lexically_relative(folder)] = sized ? entry.file_size() : 0;
  }
  return found;
}

Ran run_in_bash(const std::string& line, const fs::path& in) {
  std::ofstream(in.parent_path() / "line.sh") << line << '\n';
  return run_shell("bash ../line.sh", in);
}

std::string mobil(const Row& row) {
  return "'" MOBIL_PROGRAM "' " + row.command;
}

class WithStreams : public testing::TestWithParam<Row> {};

TEST_P(WithStreams, StatusAndFilesDoNotDependOnStreams) {
  const Row& row = GetParam();
  const TemporaryFolder folder;
  const fs::path plain = folder.path / "plain";
  fs::create_directory(plain);
  const int status = run_in_bash(mobil(row), plain).status;
  EXPECT_EQ(status, row.product == Product::none ? 2 : 0);
  const Files files = files_in(plain);
  EXPECT_EQ(files.empty(), row.product != Product::files);

  for (const Streams& with : streams) {
    if (row.product == Product::none && with.name.starts_with("stdout")) continue;  // nothing is written there
    SCOPED_TRACE(with.name);
    const fs::path in = folder.path / with.name;
    fs::create_directory(in);
    const Ran ran = run_in_bash(with.before + mobil(row) + " " + with.after, in);
    const bool lost = with.output_lost && row.product == Product::output;
    EXPECT_EQ(ran.status, lost ? 1 : status) << ran.err;
    if (lost && with.after.find("2>") == std::string::npos) {
      EXPECT_NE(ran.err.find("standard output cannot be written"), std::string::npos) << ran.err;
    }
    EXPECT_EQ(files_in(in), files);
  }
}

TEST_P(WithStreams, FileSizeLimitLeavesAllOrNothing) {
  const Row& row = GetParam();
  const TemporaryFolder folder;
  const fs::path in = folder.path / "limited";
  fs::create_directory(in);
  const Ran ran = run_in_bash("ulimit -f 1; " + mobil(row) + " >/dev/null", in);
  if (row.product == Product::files) {
    EXPECT_EQ(ran.status, 2) << ran.err;
    EXPECT_NE(ran.err.find("File too large"), std::string::npos) << ran.err;
  } else {
    EXPECT_EQ(ran.status, row.product == Product::none ? 2 : 0) << ran.err;
  }
  EXPECT_TRUE(files_in(in).empty());
}

INSTANTIATE_TEST_SUITE_P(Subcommand, WithStreams, testing::ValuesIn(rows), [](const auto& row) {
  std::string name = row.param.command.substr(0, row.param.command.find(" --seconds"));
  std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return name + std::to_string(row.index);
});

}  // namespace
}  // namespace mobil
