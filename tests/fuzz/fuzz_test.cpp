// Runs all fuzz targets on their seed inputs, on inputs that once failed, and on random mutations of both, in every
// build of the tests. A failure ends the process.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/anatomy_target.h"
#include "tests/fuzz/calls_target.h"
#include "tests/fuzz/command_target.h"
#include "tests/fuzz/gltf_target.h"
#include "tests/fuzz/mesh_target.h"
#include "tests/fuzz/script_target.h"
#include "tests/fuzz/snapshot_target.h"
#include "tests/fuzz/table_target.h"
#include "tests/labels.h"
#include "tests/program/program.h"

MOBIL_TEST_LABELS("long");

namespace mobil::fuzz {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

std::vector<Bytes> first_inputs(const std::string& target) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(MOBIL_SOURCE_DIR) / "tests/fuzz/corpus" / target)) {
    files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<Bytes> inputs;
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return inputs;
}

/// Returns a mutated input: bytes are changed, removed, repeated or cut off in a few places; sometimes two are joined.
Bytes changed(const std::vector<Bytes>& inputs, std::mt19937_64& random) {
  Bytes made = inputs[random() % inputs.size()];
  for (std::uint64_t edits = 1 + random() % 6; edits > 0; --edits) {
    const std::size_t at = made.empty() ? 0 : random() % made.size();
    const std::size_t length = made.empty() ? 0 : std::min<std::size_t>(1 + random() % 16, made.size() - at);
    const auto from = made.begin() + static_cast<std::ptrdiff_t>(at);
    switch (random() % 7) {
      case 0:
        if (!made.empty()) made[at] = static_cast<std::uint8_t>(random());
        break;
      case 1:
        if (!made.empty()) made[at] = static_cast<std::uint8_t>("0123456789-+.e,; \n\r\"'x"[random() % 22]);
        break;
      case 2:
        made.erase(from, from + static_cast<std::ptrdiff_t>(length));
        break;
      case 3: {
        const Bytes twice(from, from + static_cast<std::ptrdiff_t>(length));
        made.insert(from, twice.begin(), twice.end());
        break;
      }
      case 4:
        made.resize(at);
        break;
      case 5:
        made.insert(from, static_cast<std::uint8_t>(random()));
        break;
      default: {
        const Bytes& other = inputs[random() % inputs.size()];
        if (!other.empty())
          made.insert(made.end(), other.begin() + static_cast<std::ptrdiff_t>(random() % other.size()), other.end());
      }
    }
  }
  return made;
}

/// Time for random mutations of each target, s.
constexpr double shaken_s = sanitized ? 5 : 2;

void shake(const std::string& target, void (*run)(Input)) {
  const auto inputs = first_inputs(target);
  ASSERT_FALSE(inputs.empty()) << target;
  for (const Bytes& input : inputs) run(input);
  std::mt19937_64 random(20);
  const auto start = std::chrono::steady_clock::now();
  std::size_t tried = 0;
  for (; std::chrono::steady_clock::now() - start < std::chrono::duration<double>(shaken_s) && tried < 20000; ++tried) {
    const Bytes input = changed(inputs, random);
    const auto before = std::chrono::steady_clock::now();
    run(input);
    EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(20)) << "an input of " << target;
  }
  EXPECT_GT(tried, 0U);
  testing::Test::RecordProperty("tried", std::to_string(tried));
}

TEST(Fuzz, Mesh) {
  shake("mesh", &fuzz_mesh);
}
TEST(Fuzz, Gltf) {
  shake("gltf", &fuzz_gltf);
}
TEST(Fuzz, Anatomy) {
  shake("anatomy", &fuzz_anatomy);
}
TEST(Fuzz, Table) {
  shake("table", &fuzz_table);
}
TEST(Fuzz, Script) {
  shake("script", &fuzz_script);
}
TEST(Fuzz, Command) {
  shake("command", &fuzz_command);
}
TEST(Fuzz, Snapshot) {
  shake("snapshot", &fuzz_snapshot);
}
TEST(Fuzz, Calls) {
  shake("calls", &fuzz_calls);
}

}  // namespace
}  // namespace mobil::fuzz
