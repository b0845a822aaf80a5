#include "assets/surfaces/leg_station.h"

#include <numbers>

namespace mobil::inline v0_3 {

TubeStation leg_station(const LegFrame& leg, const SectionPlanes& planes, const LegSection& s) {
  return {section_centre(leg, planes, static_cast<double>(s.level), static_cast<double>(s.lateral),
                         static_cast<double>(s.anterior)),
          static_cast<double>(s.semi_1) * leg.unit, static_cast<double>(s.semi_2) * leg.unit,
          static_cast<double>(s.angle_deg) * std::numbers::pi / 180, static_cast<double>(s.bow) * leg.unit};
}

TubeStation leg_station(const LegFrame& leg, const LegSection& s) {
  return leg_station(leg, section_planes(leg, std::nullopt), s);
}

}  // namespace mobil::inline v0_3
