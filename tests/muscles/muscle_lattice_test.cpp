#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include <mobil/muscle_table.h>
#include "assets/surfaces/shape_lattice.h"

namespace mobil {
namespace {

constexpr float LatticeStation::*fields[] = {
    &LatticeStation::t,        &LatticeStation::offset_x_m, &LatticeStation::offset_y_m, &LatticeStation::semi_x_m,
    &LatticeStation::semi_y_m, &LatticeStation::shear_x_m,  &LatticeStation::shear_y_m};

/// Returns a row in the table's source format.
std::string row_of(Muscle muscle, const LatticeStations& lattice) {
  std::string text = fmt::format("    // {}\n    {{{{", muscle_name(muscle));
  for (const LatticeStation& station : lattice) {
    text += "{";
    for (const auto field : fields) text += fmt::format("{:#.9g}F, ", station.*field);
    text += "},\n      ";
  }
  return text + "}},\n";
}

TEST(MuscleLattice, MatchesTheSurfaces) {
  ASSERT_EQ(lattice_muscles, muscles().size());
  std::string drawn;
  bool same = true;
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    const auto muscle = static_cast<Muscle>(m);
    const LatticeStations fresh = shape_lattice(muscle);
    drawn += row_of(muscle, fresh);
    for (std::size_t i = 0; i < lattice_station_count; ++i) {
      for (const auto field : fields) same = same && fresh[i].*field == muscle_lattice(muscle)[i].*field;
    }
  }
  EXPECT_TRUE(same)
      << "the table of assets/surfaces/muscle_lattice.cpp is no longer what the surfaces give; put this in\n"
      << drawn;
}

}  // namespace
}  // namespace mobil
