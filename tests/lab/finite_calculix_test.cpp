// A real belly at finite strain compared with CalculiX: neo-Hookean quadratic elements (C3D20R) on the same geometry,
// without fibres or fascia. Eight-node elements lock at this bulk modulus.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <mobil/muscle_table.h>
#include "assets/fem/muscle_template.h"
#include "assets/finite/finite_belly.h"
#include "assets/finite/shape_tables.h"
#include "systems/deformation/finite.h"

namespace mobil::finite_calculix_test {
namespace {

constexpr Cells cells = {2, 2, 8};
constexpr std::uint32_t cuts = 3;  // elements along each edge of a CalculiX element

/// Returns a point in the mesh's trilinear cells, given in cells.
Vec3<double> place(const HexahedralMesh& mesh, double x, double y, double z) {
  const auto cell = [](double at, std::uint32_t count) { return std::min(static_cast<std::uint32_t>(at), count - 1); };
  const std::uint32_t i = cell(x, cells[0]), j = cell(y, cells[1]), k = cell(z, cells[2]);
  Vec3<double> sum{0, 0, 0};
  for (std::uint32_t c = 0; c < 8; ++c) {
    const std::uint32_t a = c & 1U, b = c >> 1U & 1U, d = c >> 2U;
    const double weight = (a ? x - i : 1 - x + i) * (b ? y - j : 1 - y + j) * (d ? z - k : 1 - z + k);
    const Vec3<double>& node = mesh.node[node_index(cells, i + a, j + b, k + d)];
    sum = {sum.x + weight * node.x, sum.y + weight * node.y, sum.z + weight * node.z};
  }
  return sum;
}

using Outline = std::vector<std::array<double, 2>>;

double area(const Outline& outline) {
  double sum = 0;
  for (std::size_t p = 0; p < outline.size(); ++p) {
    const auto &a = outline[p], &b = outline[(p + 1) % outline.size()];
    sum += 0.5 * (a[0] * b[1] - b[0] * a[1]);
  }
  return sum;
}

/// Returns the outline of a section in half cells.
std::vector<std::array<std::uint32_t, 2>> round_section() {
  std::vector<std::array<std::uint32_t, 2>> way;
  for (std::uint32_t i = 0; i < 4; ++i) way.push_back({i, 0});
  for (std::uint32_t j = 0; j < 4; ++j) way.push_back({4, j});
  for (std::uint32_t i = 4; i > 0; --i) way.push_back({i, 4});
  for (std::uint32_t j = 4; j > 0; --j) way.push_back({0, j});
  return way;
}

/// Returns the middle section's outline from CalculiX.
Outline calculix(const HexahedralMesh& mesh, const FiniteTissue& tissue, double shortening) {
  std::map<std::array<std::uint32_t, 3>, int> number;  // by half cells
  const auto at = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return number.try_emplace({x, y, z}, static_cast<int>(number.size()) + 1).first->second;
  };
  constexpr std::array<std::array<std::uint32_t, 3>, 20> of = {
      {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}, {1, 0, 0}, {2, 1, 0},
       {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2}, {1, 2, 2}, {0, 1, 2}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}}};
  std::string elements = "*ELEMENT,TYPE=C3D20R,ELSET=E\n";
  int element = 0;
  for (std::uint32_t k = 0; k < cells[2]; ++k) {
    for (std::uint32_t j = 0; j < cells[1]; ++j) {
      for (std::uint32_t i = 0; i < cells[0]; ++i) {
        elements += fmt::format("{}", ++element);
        for (std::size_t n = 0; n < of.size(); ++n)
          elements +=
              fmt::format(",{}{}", n == 10 ? "\n" : "", at(2 * i + of[n][0], 2 * j + of[n][1], 2 * k + of[n][2]));
        elements += '\n';
      }
    }
  }
  std::string nodes = "*NODE,NSET=ALL\n", origin = "*NSET,NSET=ORIGIN\n", far = "*NSET,NSET=FAR\n",
              middle = "*NSET,NSET=MIDDLE\n";
  for (const auto& [half, n] : number) {
    const Vec3<double> p = place(mesh, half[0] / 2.0, half[1] / 2.0, half[2] / 2.0);
    nodes += fmt::format("{},{:.10g},{:.10g},{:.10g}\n", n, p.x, p.y, p.z);
    if (half[2] == 0) origin += fmt::format("{},\n", n);
    if (half[2] == 2 * cells[2]) far += fmt::format("{},\n", n);
    if (half[2] == cells[2]) middle += fmt::format("{},\n", n);
  }
  const double length = mesh.node.back().z - mesh.node.front().z;
  const double bulk_pa = tissue.bulk_over_shear * tissue.shear_pa;
  const std::string deck =
      nodes + elements + origin + far + middle +
      fmt::format(
          "*MATERIAL,NAME=M\n*HYPERELASTIC,NEO HOOKE\n{:.10g},{:.10g}\n*SOLID SECTION,ELSET=E,MATERIAL=M\n"
          "*STEP,NLGEOM,INC=200\n*STATIC\n0.1,1.\n*BOUNDARY\nORIGIN,1,3\nFAR,1,2\nFAR,3,3,{:.10g}\n"
          "*NODE PRINT,NSET=MIDDLE,FREQUENCY=1000\nU\n*END STEP\n",
          tissue.shear_pa / 2, 2 / bulk_pa, -shortening * length);
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("mobil_finite_{}", getpid());
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "belly.inp") << deck;
  Outline outline;
  const std::string command = "cd '" + folder.string() + "' && ccx belly >log 2>&1";
  if (std::system(command.c_str()) == 0) {
    std::map<int, std::array<double, 2>> moved;
    std::ifstream in(folder / "belly.dat");
    for (std::string line; std::getline(in, line);) {
      std::istringstream words(line);
      int n = 0;
      double x = 0, y = 0, z = 0;
      if (words >> n >> x >> y >> z) moved[n] = {x, y};
    }
    for (const auto& [i, j] : round_section()) {
      const Vec3<double> p = place(mesh, i / 2.0, j / 2.0, cells[2] / 2.0);
      const auto& u = moved[number.at({i, j, cells[2]})];
      outline.push_back({p.x + u[0], p.y + u[1]});
    }
  }
  std::filesystem::remove_all(folder);
  return outline;
}

/// Returns the mesh with each of CalculiX's elements divided `times` times along each edge.
HexahedralMesh cut_mesh(const HexahedralMesh& mesh, std::uint32_t times) {
  HexahedralMesh cut;
  cut.cells = {times * cells[0], times * cells[1], times * cells[2]};
  const double part = 1.0 / times;
  for (std::uint32_t k = 0; k <= cut.cells[2]; ++k) {
    for (std::uint32_t j = 0; j <= cut.cells[1]; ++j) {
      for (std::uint32_t i = 0; i <= cut.cells[0]; ++i) cut.node.push_back(place(mesh, part * i, part * j, part * k));
    }
  }
  return cut;
}

Outline ours(const HexahedralMesh& mesh, const FiniteTissue& tissue, double shortening) {
  const HexahedralMesh cut = cut_mesh(mesh, cuts);
  Outline outline;
  const auto belly = make_finite_belly(cut, tissue, 0);
  if (!belly) return outline;
  FiniteScratch scratch = make_scratch(*belly);
  FiniteState state = state_at_rest(*belly);
  if (!settle(*belly, scratch, state, shortening, 0)) return outline;
  // Odd cuts have no nodes at half cells, so only corners of cells are compared.
  for (const auto& [i, j] : round_section()) {
    if (i % 2 + j % 2 != 0) continue;
    const std::uint32_t n = node_index(cut.cells, cuts * i / 2, cuts * j / 2, cuts * cells[2] / 2);
    outline.push_back({cut.node[n].x + state.displacement_m[3 * n], cut.node[n].y + state.displacement_m[3 * n + 1]});
  }
  return outline;
}

/// Returns the nodes round the middle section from damped steps of Method::finite.
Outline stepped(const HexahedralMesh& mesh, double shortening) {
  constexpr float tick_s = 1.0F / 60;
  MuscleOptions options{FarEnd::held, 60, 1, 1};
  options.strain = Strain::finite;
  const HexahedralMesh cut = cut_mesh(mesh, 2);
  auto muscle = make_muscle_template(cut, Material{}, options).value();
  muscle.finite.tissue.active_pa = muscle.finite.tissue.passive_pa = 0;
  const std::uint32_t steps = substeps_within(critical_step(muscle.critical_steps, 1, 1).value(), double{tick_s});
  std::vector<Lanes<float>> u(nodal_width(cut.cells)), v(u.size()),
      scratch(scratch_floats(muscle, Method::finite) / lane_count);
  BellyScale<Lanes<float>> scale{};
  for (std::size_t l = 0; l < lane_count; ++l) scale.across[l] = scale.along[l] = 1;
  BellyReport<Lanes<float>> report{};
  EndDrive<Lanes<float>> end{};
  for (int tick = 1; tick <= 120; ++tick) {
    end.from = end.to;
    for (float& to : end.to.lane)
      to = static_cast<float>(-shortening * muscle.finite.length_m * std::min(1.0, tick / 30.0));
    deform_finite({muscle, scale, u[0].lane, v[0].lane, report}, {FarEnd::held, end}, nullptr, steps, tick_s,
                  scratch[0].lane);
  }
  Outline outline;
  for (const auto& [i, j] : round_section()) {
    const std::uint32_t n = node_index(cut.cells, i, j, cells[2]);
    outline.push_back({cut.node[n].x + double{u[3 * n][0]}, cut.node[n].y + double{u[3 * n + 1][0]}});
  }
  return outline;
}

/// 425 nodes, one point an element, in single precision.
TEST(FiniteMethod, SettlesToTheCalculixSolution) {
  if (std::system("command -v ccx >/dev/null 2>&1") != 0) GTEST_SKIP() << "ccx is not installed";
  FiniteTissue tissue = stepped_tissue(Material{});
  tissue.passive_pa = tissue.active_pa = 0;
  const HexahedralMesh mesh = finite_mesh(*find_muscle("tibialis_anterior"), cells);
  for (const double shortening : {0.08, -0.08}) {
    const Outline theirs = calculix(mesh, tissue, shortening), own = stepped(mesh, shortening);
    ASSERT_EQ(theirs.size(), own.size());
    EXPECT_NEAR(area(own) / area(theirs), 1, 0.02) << shortening;
  }
}

TEST(FiniteBelly, MatchesCalculix) {
  if (std::system("command -v ccx >/dev/null 2>&1") != 0) GTEST_SKIP() << "ccx is not installed";
  FiniteTissue tissue;
  tissue.passive_pa = tissue.active_pa = tissue.slack_tone = 0;
  const HexahedralMesh mesh = finite_mesh(*find_muscle("tibialis_anterior"), cells);
  for (const double shortening : {0.08, -0.08}) {
    const Outline theirs = calculix(mesh, tissue, shortening), own = ours(mesh, tissue, shortening);
    ASSERT_EQ(theirs.size(), 16U);
    ASSERT_EQ(own.size(), 8U);
    Outline corners;
    for (std::size_t p = 0; p < theirs.size(); p += 2) corners.push_back(theirs[p]);
    EXPECT_NEAR(area(own) / area(corners), 1, 0.015) << shortening;
    double farthest = 0, moved = 0;
    for (std::size_t p = 0; p < own.size(); ++p) {
      const auto [i, j] = round_section()[2 * p];
      const Vec3<double> rest = place(mesh, i / 2.0, j / 2.0, cells[2] / 2.0);
      farthest = std::max(farthest, std::hypot(own[p][0] - corners[p][0], own[p][1] - corners[p][1]));
      moved = std::max(moved, std::hypot(corners[p][0] - rest.x, corners[p][1] - rest.y));
    }
    EXPECT_LT(farthest, 0.07 * moved) << shortening << ": theirs are eight elements along";
  }
}

}  // namespace
}  // namespace mobil::finite_calculix_test
