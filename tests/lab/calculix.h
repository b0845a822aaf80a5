#pragma once
// Blocks of muscle in CalculiX: input decks of C3D8 elements, runs, and printed histories. CalculiX refuses numbers
// longer than twenty characters, and ALPHA, its numerical damping, is −0.05 unless it is set to 0.

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/muscle.h>
#include "demo/lab/muscle/force_history.h"
#include "tests/program/program.h"

namespace mobil::calculix {

struct Block {
  Cells cells;
  double cell_size_m;
  Material material;
  double mass_damping_1_s = 0, stiffness_damping_s = 0;
};

enum class Procedure { statics, explicit_dynamics, implicit_dynamics };

/// Mean displacement of a face's middle nodes, m, after each increment.
using History = std::vector<std::array<double, 3>>;

inline bool available() {
  return std::system("command -v ccx >/dev/null 2>&1") == 0;
}

/// Returns the step's procedure card. An explicit run must not be DIRECT: its increment is the largest allowed, as long
/// as that is below CalculiX's own estimate of the stable one.
inline std::string procedure_card(Procedure procedure, double dt_s, double seconds) {
  switch (procedure) {
    case Procedure::statics:
      return fmt::format("*STATIC,DIRECT\n{:.12g},{:.12g}\n", dt_s, seconds);
    case Procedure::explicit_dynamics:
      return fmt::format("*DYNAMIC,EXPLICIT,ALPHA=0\n{0:.12g},{1:.12g},,{0:.12g}\n", dt_s, seconds);
    case Procedure::implicit_dynamics:
      return fmt::format("*DYNAMIC,DIRECT,ALPHA=0\n{:.12g},{:.12g}\n", dt_s, seconds);
  }
  throw std::runtime_error("no such procedure");
}

/// Returns the block with its face z = 0 fixed and the force spread evenly over the far face, at rest at t = 0.
inline std::string deck(const Block& block, const ForceHistory& load, Procedure procedure, double dt_s,
                        double seconds) {
  const auto mesh = make_block(block.cells, block.cell_size_m).value();
  std::string text = "*NODE\n";
  for (std::size_t n = 0; n < mesh.node.size(); ++n) {
    const auto& p = mesh.node[n];
    text += fmt::format("{},{:.12g},{:.12g},{:.12g}\n", n + 1, p.x, p.y, p.z);
  }
  text += "*ELEMENT,TYPE=C3D8,ELSET=BLOCK\n";
  for (std::uint32_t e = 0; e < element_count(block.cells); ++e) {
    text += fmt::format("{}", e + 1);
    for (const auto n : element_nodes(block.cells, e)) text += fmt::format(",{}", n + 1);
    text += '\n';
  }
  text += "*NSET,NSET=FIXED\n";
  for (std::uint32_t n = 0; n < plane_nodes(block.cells); ++n) text += fmt::format("{},\n", n + 1);
  text += "*NSET,NSET=CENTRE\n";
  for (const auto n : insertion_centre(block.cells)) text += fmt::format("{},\n", n + 1);
  text += fmt::format("*MATERIAL,NAME=TISSUE\n*ELASTIC\n{:.12g},{:.12g}\n*DENSITY\n{:.12g}\n", block.material.young_pa,
                      block.material.poisson, block.material.density_kg_m3);
  if (block.mass_damping_1_s > 0 || block.stiffness_damping_s > 0) {
    text += fmt::format("*DAMPING,ALPHA={:.12g},BETA={:.12g}\n", block.mass_damping_1_s, block.stiffness_damping_s);
  }
  text += "*SOLID SECTION,ELSET=BLOCK,MATERIAL=TISSUE\n*BOUNDARY\nFIXED,1,3\n";
  static constexpr std::array<const char*, 3> axis_name = {"X", "Y", "Z"};
  const auto component = [](const Vec3<double>& f, std::size_t axis) {
    return axis == 0 ? f.x : axis == 1 ? f.y : f.z;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    text += fmt::format("*AMPLITUDE,NAME={}\n", axis_name[axis]);
    for (const auto& row : load.row) text += fmt::format("{:.12g},{:.12g}\n", row.time_s, component(row.force_n, axis));
  }
  text += fmt::format("*STEP,INC=10000000\n{}", procedure_card(procedure, dt_s, seconds));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    text += fmt::format("*CLOAD,AMPLITUDE={}\n", axis_name[axis]);
    const Cells& c = block.cells;
    for (std::uint32_t j = 0; j <= c[1]; ++j) {
      for (std::uint32_t i = 0; i <= c[0]; ++i) {
        const double share = (i == 0 || i == c[0] ? 0.5 : 1) * (j == 0 || j == c[1] ? 0.5 : 1) / (c[0] * c[1]);
        text += fmt::format("{},{},{:.12g}\n", node_index(c, i, j, c[2]) + 1, axis + 1, share);
      }
    }
  }
  return text + "*NODE PRINT,NSET=CENTRE,FREQUENCY=1\nU\n*END STEP\n";
}

/// Reads a table written by *NODE PRINT.
inline History read_history(const std::filesystem::path& file, std::size_t nodes) {
  std::istringstream lines(read_bytes(file));
  History history;
  std::size_t read = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::size_t node = 0;
    std::array<double, 3> u{};
    if (!(cells >> node >> u[0] >> u[1] >> u[2])) continue;
    if (read++ % nodes == 0) history.push_back({});
    for (std::size_t axis = 0; axis < 3; ++axis) history.back()[axis] += u[axis] / static_cast<double>(nodes);
  }
  return history;
}

/// Runs a deck in a temporary folder. Throws with the end of CalculiX's output if it printed no history.
inline History run(const Block& block, const ForceHistory& load, Procedure procedure, double dt_s, double seconds) {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "block.inp") << deck(block, load, procedure, dt_s, seconds);
  const Ran ran = run_shell("OMP_NUM_THREADS=1 ccx block", folder.path);
  auto history = read_history(folder.path / "block.dat", insertion_centre(block.cells).size());
  if (history.empty())
    throw std::runtime_error(ran.out.substr(ran.out.size() - std::min<std::size_t>(600, ran.out.size())));
  return history;
}

}  // namespace mobil::calculix
