#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include <mobil/muscle_table.h>
#include "assets/surfaces/draw_cage.h"

namespace mobil {
namespace {

constexpr float CageStation::*fields[] = {&CageStation::t,        &CageStation::offset_x_m, &CageStation::offset_y_m,
                                          &CageStation::semi_x_m, &CageStation::semi_y_m,   &CageStation::shear_x_m,
                                          &CageStation::shear_y_m};

/// As the table has it.
std::string row_of(Muscle muscle, const CageStations& cage) {
  std::string text = fmt::format("    // {}\n    {{{{", muscle_name(muscle));
  for (const CageStation& station : cage) {
    text += "{";
    for (const auto field : fields) text += fmt::format("{:#.9g}F, ", station.*field);
    text += "},\n      ";
  }
  return text + "}},\n";
}

TEST(MuscleCage, IsWhatTheSurfacesGive) {
  ASSERT_EQ(caged_muscles, muscles().size());
  std::string drawn;
  bool same = true;
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    const auto muscle = static_cast<Muscle>(m);
    const CageStations fresh = draw_cage(muscle);
    drawn += row_of(muscle, fresh);
    for (std::size_t i = 0; i < cage_station_count; ++i) {
      for (const auto field : fields) same = same && fresh[i].*field == muscle_cage(muscle)[i].*field;
    }
  }
  EXPECT_TRUE(same) << "the table of assets/surfaces/muscle_cage.cpp is no longer what the surfaces give; put this in\n"
                    << drawn;
}

}  // namespace
}  // namespace mobil
