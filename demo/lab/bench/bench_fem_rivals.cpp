#include "demo/lab/bench/bench_fem_rivals.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "demo/measure/measure.h"

namespace mobil {
namespace {

namespace fs = std::filesystem;

fs::path program() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored).parent_path() / "mobil_rivals";
}

/// As one word of the shell.
std::string quoted(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

}  // namespace

bool rivals_found() {
  return access(program().c_str(), X_OK) == 0;
}

Result<RivalTime> measure_rival(const std::string& name, bool quick) {
  const std::string command = quoted(program().string()) + (quick ? " --quick " : " ") + quoted(name) + " 2>&1";
  const auto close = [](FILE* f) { return pclose(f); };
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return fail("mobil_rivals could not be started");
  std::string said;
  std::array<char, 4096> part{};
  for (std::size_t got = 0; (got = std::fread(part.data(), 1, part.size(), pipe)) > 0;) said.append(part.data(), got);
  const int status = close(pipe);
  const auto json = nlohmann::json::parse(said, nullptr, false);
  if (status != 0 || !json.is_object()) {
    return fail(fmt::format("mobil_rivals {}: {}", name, said.substr(0, said.find('\n'))));
  }
  RivalTime time;
  try {
    time.us_per_step = json.at("us_per_step").get<double>();
    time.median_us = json.at("median_us_per_step").get<double>();
    time.dt_s = json.at("dt_s").get<double>();
    time.far_z_m = json.at("far_z_m").get<double>();
    time.variant = json.at("variant").get<std::string>();
    time.check = fmt::format("{}: {:.1e}", json.at("check").get<std::string>(), json.at("check_error").get<double>());
    time.holds = json.at("holds").get<bool>();
  } catch (const nlohmann::json::exception& error) {
    return fail(fmt::format("mobil_rivals {}: {}; build it again with mobil", name, error.what()));
  }
  return time;
}

Result<void> RivalRounds::add(const std::vector<std::string>& names, bool quick) {
  for (const std::string& name : names) {
    const auto time = measure_rival(name, quick);
    if (!time) return tl::unexpected(time.error());
    const std::string stem = name.substr(0, name.find('@'));
    auto& medians = medians_[stem];
    medians.push_back(time->median_us);
    auto [known, is_new] = best_.try_emplace(stem, *time);
    if (!is_new && time->us_per_step < known->second.us_per_step) known->second = *time;
    known->second.median_us = median(medians);
  }
  return {};
}

const RivalTime* RivalRounds::find(const std::string& name) const {
  const auto known = best_.find(name);
  return known == best_.end() ? nullptr : &known->second;
}

}  // namespace mobil
