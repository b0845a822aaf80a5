#include "demo/program/subcommands.h"

#include <algorithm>

namespace mobil {
namespace {

constexpr std::string_view crowd = "mobil-crowd", lab = "mobil-lab";
constexpr SubcommandRow subcommands[] = {
    {"walk", "mobil", "Walk one person: motion.csv, muscles.csv, summary.json, walk.glb, pictures"},
    {"crowd", crowd, "Simulate a crowd that walks, turns, arrives and leaves, and measure its ticks"},
    {"city", crowd, "Simulate a million people, most of them asleep, under a flying camera"},
    {"town", crowd, "Simulate people in a small town with kerbs, stairs and a ramp, who avoid each other"},
    {"view", crowd, "Open a window with a person, a crowd, and sliders for all parameters"},
    {"bake", crowd, "Precompute the shared muscle data of usual bodies, to be loaded in milliseconds"},
    {"schedule", crowd, "Show the systems of a tick in order, with their reads and writes"},
    {"anatomy", crowd, "List the meshes of a folder, the repairs made to them, and every fault"},
    {"body", lab, "Compute a body from height, mass and build: body.json and a picture"},
    {"muscle", lab, "Simulate a finite-element block under a traction, or a real muscle that contracts"},
    {"bench", lab, "Measure kernels and compare them with the machine's own limits"},
    {"compare", lab, "Walk at the speeds of measured people and compare with their data"},
    {"robustness", lab, "Run hard cases and report the guarantee and the result of each", "stress"},
    {"paper", lab, "Make the paper's figures 14 to 17 and answer its four questions"},
    {"frontier", lab, "Measure error and time of every way to deform a muscle"},
    {"effects", lab, "List the effects that can be simulated, and measure the cost of each"},
    {"fit-gait", lab, "Fit the table of steps to measured walking, and write it as source code"},
    {"fit-run", lab, "Fit the table of running steps to measured running, and write it as source code"},
    {"fit-accuracy", lab, "Measure the errors and costs used to choose methods, and write them as source code"},
    {"fit-shapes", lab, "Solve muscle shapes at finite strain, and write them as source code"},
    {"completion", lab, "Print a completion script for a shell"},
    {"man", lab, "Print manual pages, or write them to a folder"},
};

}  // namespace

std::span<const SubcommandRow> subcommand_rows() {
  return subcommands;
}

const SubcommandRow* find_subcommand(std::string_view name) {
  const auto* row = std::ranges::find_if(
      subcommands, [&](const SubcommandRow& r) { return r.name == name || (!name.empty() && r.former == name); });
  return row == std::end(subcommands) ? nullptr : row;
}

}  // namespace mobil
