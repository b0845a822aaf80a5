#include "assets/surfaces/leg_station.h"

#include <numbers>

namespace mobil::inline v0_3 {

TubeStation leg_station(const LegFrame& leg, const LegSection& s) {
  return {leg_point(leg, static_cast<double>(s.level), static_cast<double>(s.lateral), static_cast<double>(s.anterior)),
          static_cast<double>(s.semi_1) * leg.unit, static_cast<double>(s.semi_2) * leg.unit,
          static_cast<double>(s.angle_deg) * std::numbers::pi / 180};
}

}  // namespace mobil::inline v0_3
