#include "demo/program/subcommands.h"

#include <algorithm>

namespace mobil {
namespace {

constexpr std::string_view crowd = "mobil-crowd", lab = "mobil-lab";
constexpr SubcommandRow subcommands[] = {
    {"walk", "mobil", "One person walks: motion.csv, muscles.csv, summary.json, walk.glb, pictures"},
    {"crowd", crowd, "A crowd walks, turns, comes and goes; what a tick of it takes"},
    {"city", crowd, "A million people, most of whom sleep, under a camera that flies"},
    {"town", crowd, "People go about a small town with kerbs, stairs and a ramp, out of each other's way"},
    {"view", crowd, "A window: a person, a crowd, and sliders for all that can be asked"},
    {"bake", crowd, "Make what the muscles of usual bodies share, for programs to load in milliseconds"},
    {"schedule", crowd, "What a tick does: its systems in order, what they read and write"},
    {"anatomy", crowd, "What a folder of meshes holds, what is mended in it, every fault"},
    {"body", lab, "What height, mass and build make of a body: body.json and a picture"},
    {"muscle", lab, "A block of muscle by finite elements under a traction; or a real one that contracts"},
    {"bench", lab, "Kernels against the machine's own limits"},
    {"compare", lab, "Walk at the speeds of measured people and be held against them"},
    {"robustness", lab, "The hard cases: what is promised of each, and what happened", "stress"},
    {"paper", lab, "The paper's figures 14 to 17 and its four questions"},
    {"frontier", lab, "What accuracy costs: every way to deform a muscle, error and time"},
    {"effects", lab, "What can be simulated, and what each effect costs here"},
    {"fit-gait", lab, "Fit the table of steps to measured walking, and write it as source"},
    {"fit-accuracy", lab, "Measure the errors and costs by which methods are chosen, as source"},
    {"fit-shapes", lab, "Solve the shapes of muscles at finite strain, as source"},
    {"completion", lab, "A script by which a shell completes what is typed"},
    {"man", lab, "Pages of the manual, for man to read"},
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
