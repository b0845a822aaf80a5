#include <mobil/assets/muscles/leg_sections.h>

#include <array>
#include <cmath>
#include <numbers>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr std::array<LegSection, 17> femur = {{{0.040F, 44, -9, 22, 15, 100},
                                               {0.075F, 40, -9, 26, 19, 100},
                                               {0.108F, 33, -7.6F, 25, 18, 100},
                                               {0.153F, 28.7F, -6.9F, 20.9F, 17.2F, 84},
                                               {0.199F, 28.9F, -2.2F, 18.9F, 15.4F, 68},
                                               {0.246F, 28.6F, 3.1F, 15.6F, 13.4F, 110},
                                               {0.338F, 25.8F, 9.9F, 14.6F, 13.3F, 111},
                                               {0.429F, 22.4F, 14.6F, 13.7F, 13.4F, 73},
                                               {0.520F, 19.1F, 17.3F, 13.9F, 13.3F, 29},
                                               {0.611F, 16.7F, 18.9F, 14.4F, 13.7F, 0},
                                               {0.702F, 13.8F, 19.8F, 15.3F, 14.6F, 104},
                                               {0.793F, 11.1F, 19.3F, 18.2F, 15, 99},
                                               {0.838F, 9.6F, 18.8F, 20, 15.4F, 97},
                                               {0.883F, 7.7F, 17.9F, 22.1F, 15.9F, 94},
                                               {0.928F, 5.4F, 15.6F, 27.2F, 16.9F, 91},
                                               {0.973F, 2.8F, 10.1F, 38.3F, 20, 94},
                                               {1.000F, 1, 6, 42, 22, 88}}};

constexpr std::array<LegSection, 14> tibia = {{{1.082F, 2, 1, 37, 23, 92},
                                               {1.105F, 2, 3, 38, 25, 95},
                                               {1.131F, 0.4F, 4.6F, 37.2F, 26.4F, 64},
                                               {1.168F, 0.9F, 9.8F, 32.4F, 20.6F, 45},
                                               {1.205F, 2.6F, 14.6F, 24.8F, 17.8F, 38},
                                               {1.242F, 4, 16.7F, 21.8F, 16, 30},
                                               {1.317F, 5.7F, 18, 18.5F, 12.6F, 19},
                                               {1.428F, 5.6F, 18.3F, 15.5F, 10.9F, 19},
                                               {1.539F, 4.6F, 17.7F, 13.3F, 10.2F, 25},
                                               {1.650F, 2.6F, 15.2F, 12.7F, 9.8F, 34},
                                               {1.761F, 0.9F, 11.8F, 12.8F, 10.8F, 34},
                                               {1.872F, -2, 9, 14.5F, 14.1F, 105},
                                               {1.920F, -3.6F, 7.5F, 20, 17.5F, 115},
                                               {1.958F, -4.7F, 6.6F, 24, 20, 94}}};

constexpr std::array<LegSection, 11> fibula = {{{1.132F, 38.1F, -9.8F, 9.2F, 7, 91},
                                                {1.170F, 37.5F, -5.7F, 12, 10.8F, 73},
                                                {1.208F, 35.5F, -8, 8.2F, 7.7F, 150},
                                                {1.283F, 35.5F, -8.8F, 7.3F, 5.4F, 152},
                                                {1.433F, 34.3F, -6.5F, 8.1F, 5.2F, 174},
                                                {1.583F, 31.3F, -6.2F, 6.5F, 5.7F, 175},
                                                {1.733F, 27, -5.6F, 6.9F, 4.9F, 150},
                                                {1.883F, 23.8F, -4.4F, 8.4F, 4.9F, 19},
                                                {1.959F, 21.6F, -3.6F, 9.9F, 7.3F, 20},
                                                {1.996F, 24, -2.8F, 12.8F, 9.1F, 6},
                                                {2.034F, 25.1F, -3.8F, 10.7F, 5.3F, 164}}};

LegEllipse ellipse(const LegSection& s) {
  const double a = static_cast<double>(s.angle_deg) * std::numbers::pi / 180, c = exact::cos(a), n = exact::sin(a);
  const auto p = static_cast<double>(s.semi_1), q = static_cast<double>(s.semi_2);
  return {static_cast<double>(s.lateral), static_cast<double>(s.anterior), p * c * c + q * n * n, (p - q) * c * n,
          p * n * n + q * c * c};
}

}  // namespace

std::span<const LegSection> femur_sections() {
  return femur;
}
std::span<const LegSection> tibia_sections() {
  return tibia;
}
std::span<const LegSection> fibula_sections() {
  return fibula;
}

LegFrame leg_frame(const Body& body) {
  const Vec pelvis = to_double(body.joint_offset_m[index(Segment::pelvis)]);
  const Vec hip = pelvis + to_double(body.joint_offset_m[index(Segment::thigh_right)]);
  const auto size = static_cast<double>(body.size.leg_scale_m), thigh = static_cast<double>(body.thigh_length_m);
  const double above = has_own_limbs(body.request) ? fraction::thigh * size : thigh;
  return {hip, thigh, static_cast<double>(body.shank_length_m), above, size / reference_height_mm};
}

Vec3<double> leg_point(const LegFrame& leg, double level, double lateral_mm, double anterior_mm) {
  const double down = level < 0   ? level * leg.above
                      : level < 1 ? level * leg.thigh_length
                                  : leg.thigh_length + (level - 1) * leg.shank_length;
  return leg.hip + Vec{-lateral_mm * leg.unit, -down, anterior_mm * leg.unit};
}

SectionPlanes section_planes(const LegFrame& leg, const std::optional<SectionAxis>& across) {
  if (!across) return {true, {}, {}, {0, -1, 0}, {0, 0, 1}, {-1, 0, 0}};
  const auto end = [&](const SectionAxis::End& e) {
    return leg_point(leg, static_cast<double>(e.level), static_cast<double>(e.lateral),
                     static_cast<double>(e.anterior));
  };
  const Vec from = end(across->from), along = end(across->to) - from, z = normalised(along);
  // The smallest rotation from straight down to the axis.
  const Vec down{0, -1, 0}, axis = cross(down, z);
  const double w = 1 + dot(down, z), norm = std::sqrt(dot(axis, axis) + w * w);
  const Quat<double> swing{axis.x / norm, axis.y / norm, axis.z / norm, w / norm};
  return {false, from, along, z, rotated(swing, {0, 0, 1}), rotated(swing, {-1, 0, 0})};
}

Vec3<double> section_centre(const LegFrame& leg, const SectionPlanes& planes, double level, double lateral_mm,
                            double anterior_mm) {
  if (planes.horizontal) return leg_point(leg, level, lateral_mm, anterior_mm);
  return planes.origin + level * planes.along +
         leg.unit * (lateral_mm * planes.lateral + anterior_mm * planes.anterior);
}

double section_level(const LegFrame& leg, const SectionPlanes& planes, const Vec3<double>& at) {
  if (planes.horizontal) return leg_level(leg, at.y);
  return dot(at - planes.origin, planes.along) / dot(planes.along, planes.along);
}

double leg_level(const LegFrame& leg, double height_m) {
  const double down = leg.hip.y - height_m;
  if (down < 0) return down / leg.above;
  return down < leg.thigh_length ? down / leg.thigh_length : 1 + (down - leg.thigh_length) / leg.shank_length;
}

std::optional<LegEllipse> leg_ellipse(std::span<const LegSection> sections, double level) {
  if (level < static_cast<double>(sections.front().level) || level > static_cast<double>(sections.back().level)) {
    return std::nullopt;
  }
  std::size_t i = 0;
  while (i + 2 < sections.size() && level > static_cast<double>(sections[i + 1].level)) ++i;
  const auto from = static_cast<double>(sections[i].level), to = static_cast<double>(sections[i + 1].level);
  const double w = (level - from) / (to - from);
  const LegEllipse a = ellipse(sections[i]), b = ellipse(sections[i + 1]);
  const auto mix = [w](double p, double q) { return p + w * (q - p); };
  return LegEllipse{mix(a.lateral, b.lateral), mix(a.anterior, b.anterior), mix(a.aa, b.aa), mix(a.al, b.al),
                    mix(a.ll, b.ll)};
}

}  // namespace mobil::inline v0_3
