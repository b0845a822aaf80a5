#include <mobil/assets/surfaces/muscle_surfaces.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <mobil/assets/body/between.h>
#include <mobil/assets/body/leg_profile.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/engine/geometry.h>
#include <mobil/muscle_table.h>
#include "assets/surfaces/leg_bones.h"
#include "assets/surfaces/leg_station.h"
#include "assets/surfaces/muscle_ends.h"
#include "assets/surfaces/muscle_room.h"
#include "assets/surfaces/muscle_shapes.h"
#include "assets/surfaces/surface_mesh.h"
#include "assets/surfaces/tissue.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr TubeLayout layout{36, 18, 2};
/// Gaps of a muscle from the skin, from bones and from the muscle beneath.
constexpr double cover_m = 0.002, sheet_cover_m = 0.0004, bone_gap_m = 0.0012, beneath_gap_m = 0.0005;

/// Kneecap of the measured man: level of its upper edge, and its centre in mm from the knee's.
constexpr double measured_patella_top = 0.992, measured_patella_lateral = 12, measured_patella_anterior = 40;

/// A bone that muscles must not enter: the femur with its condyles, the tibia or the fibula.
struct Bone {
  std::vector<LegSection> sections;
};

std::array<Bone, 3> hard_bones() {
  std::array<Bone, 3> bones;
  bones[0].sections.assign(femur_sections().begin(), femur_sections().end());
  bones[0].sections.push_back({1.020F, 0.5F, 4, 41, 26, 86});
  bones[0].sections.push_back({1.050F, 0, 0, 38, 21, 86});
  bones[1].sections.assign(tibia_sections().begin(), tibia_sections().end());
  bones[2].sections.assign(fibula_sections().begin(), fibula_sections().end());
  return bones;
}

/// A point of a section, mm.
struct Point {
  double l, a;
};

double reach(const LegSection& s, Point direction) {
  const double t = static_cast<double>(s.angle_deg) * std::numbers::pi / 180;
  const double p = static_cast<double>(s.semi_1) * (std::cos(t) * direction.a + std::sin(t) * direction.l);
  const double q = static_cast<double>(s.semi_2) * (std::cos(t) * direction.l - std::sin(t) * direction.a);
  return std::hypot(p, q);
}

double area(const LegSection& s) {
  return static_cast<double>(s.semi_1) * static_cast<double>(s.semi_2);
}

/// Returns the belly's share of a section: 0 in the tendon, 1 where it is thick.
double belly(const LegSection& s, double largest_area) {
  return smoothstep(0.08, 0.45, area(s) / largest_area);
}

/// Returns the area of a muscle's section at a level over that of its largest; `placed` has the sections' levels.
double relative_area(std::span<const LegSection> sections, std::span<const LegSection> placed, double level) {
  double largest = 0;
  for (const LegSection& s : sections) largest = std::max(largest, area(s));
  const auto [i, w] =
      form::between(sections.size(), level, [&](std::size_t k) { return static_cast<double>(placed[k].level); });
  return ((1 - w) * area(sections[i]) + w * area(sections[i + 1])) / largest;
}

/// Returns the centre of the bone from which a muscle grows away at a level.
Point bone_centre(const std::array<Bone, 3>& bones, double level) {
  const auto& sections = bones[level < 1.06 ? 0 : 1].sections;
  const double low = static_cast<double>(sections.front().level), high = static_cast<double>(sections.back().level);
  const LegEllipse e = *leg_ellipse(sections, std::clamp(level, low, high));
  return {e.lateral, e.anterior};
}

/// Skin and bones that muscles are cut back to.
struct Surroundings {
  SkinRoom skin;
  LegBones bones;
};

/// Fits a muscle's sections to this body, in mm of the measured man. Multiplies the girth of the belly, moves it out of
/// the way of the muscle beneath, and leads the quadriceps to this body's kneecap. Published volumes are larger than
/// the measured man's, so sections grow. The parts in the bone, in the muscle beneath or outside of the skin are cut
/// off, and the rest grows until the volume is met.
struct Fitting {
  const LegFrame& leg;
  const Surroundings* around;  // null: each alone
  const std::array<Bone, 3>& bones;
  Point patella;         // the kneecap's centre, mm
  double patella_shift;  // of its upper edge's level from the measured man's
};

double growth(const MuscleShape& shape, double girth, double level, Point direction) {
  std::size_t i = 0;
  while (i + 2 < shape.sections.size() && level > static_cast<double>(shape.sections[i + 1].level)) ++i;
  const LegSection &a = shape.sections[i], &b = shape.sections[i + 1];
  if (level < static_cast<double>(a.level) || level > static_cast<double>(b.level)) return 0;
  const double w = (level - static_cast<double>(a.level)) / static_cast<double>(b.level - a.level);
  double largest = 0;
  for (const auto& s : shape.sections) largest = std::max(largest, area(s));
  const auto at = [&](const LegSection& s) { return reach(s, direction) * (girth - 1) * belly(s, largest); };
  return (1 - w) * at(a) + w * at(b);
}

/// Returns false for muscles of the hip and across an axis. They grow about their own middle.
bool grows_from_bone(const MuscleShape& shape) {
  const LegSection& thickest = *std::ranges::max_element(shape.sections, {}, area);
  return shape.planes.horizontal && thickest.level > 0.15F;
}

/// `beneath` is the muscle under it, or null.
std::vector<LegSection> fitted(const Fitting& f, const MuscleShape& shape, double girth, const MuscleShape* beneath,
                               double girth_beneath) {
  double largest = 0;
  for (const auto& s : shape.sections) largest = std::max(largest, area(s));
  std::vector<LegSection> out(shape.sections.begin(), shape.sections.end());
  for (LegSection& s : out) {
    const auto level = static_cast<double>(s.level);
    const Point bone = bone_centre(f.bones, level);
    Point away{static_cast<double>(s.lateral) - bone.l, static_cast<double>(s.anterior) - bone.a};
    const double distance = std::max(std::hypot(away.l, away.a), 1e-6);
    away = {away.l / distance, away.a / distance};
    const double thick = belly(s, largest);
    double shift = grows_from_bone(shape) ? reach(s, away) * (girth - 1) * thick : 0;
    if (beneath != nullptr) shift += 2 * growth(*beneath, girth_beneath, level, away) * thick;
    const double factor = 1 + (girth - 1) * thick;
    // Flat muscles of the hip become thicker rather than wider.
    const double flatness = f.around != nullptr && !grows_from_bone(shape)
                                ? static_cast<double>((s.semi_1 - s.semi_2) / (s.semi_1 + s.semi_2))
                                : 0;
    Point moved{static_cast<double>(s.lateral) + shift * away.l, static_cast<double>(s.anterior) + shift * away.a};
    if (shape.group == Muscle::quadriceps) {
      const double w = smoothstep(0.45, measured_patella_top, level);
      moved.l += w * (f.patella.l - measured_patella_lateral);
      moved.a += w * (f.patella.a - measured_patella_anterior);
      s.level = static_cast<float>(level + w * f.patella_shift);
    }
    s.lateral = static_cast<float>(moved.l);
    s.anterior = static_cast<float>(moved.a);
    s.semi_1 *= static_cast<float>(flatness == 0 ? factor : std::pow(factor, 1 - flatness));
    s.semi_2 *= static_cast<float>(flatness == 0 ? factor : std::pow(factor, 1 + flatness));
    s.bow *= static_cast<float>(factor);
  }
  return out;
}

/// Returns false where a muscle ends in the calcaneal tendon, and where that tendon begins.
bool ends_on_bone(const MuscleShape& shape, TubeEnd end) {
  return end == TubeEnd::origin ? shape.volume_m3 > 0 : shape.ends_in == no_muscle;
}

/// Evens out the rings from `first` to before `last` along the muscle.
void smooth_along(SurfaceMesh& mesh, std::size_t first, std::size_t last) {
  for (int round = 0; round < 3; ++round) {
    const std::vector<Vec3<float>> was = mesh.position;
    for (std::size_t v = layout.vertex(first + 1); v + layout.segments < layout.vertex(last); ++v)
      mesh.position[v] = 0.5F * was[v] + 0.25F * (was[v - layout.segments] + was[v + layout.segments]);
  }
}

/// The muscle under another one, if any: the sections of one of the same group, or the drawn rings, from above, of one
/// of another group. The latter is covered whole, also by a tendon: by the iliotibial tract.
struct Beneath {
  std::vector<LegSection> sections = {};
  std::vector<std::vector<Vec3<float>>> rings = {};
};

/// Builds a muscle's mesh. A muscle alone is cut back only to the measured bones.
SurfaceMesh build(const Fitting& f, const MuscleShape& shape, std::span<const LegSection> sections,
                  const Beneath& beneath) {
  std::vector<TubeStation> stations;
  for (const auto& s : sections) stations.push_back(leg_station(f.leg, shape.planes, s));
  SurfaceMesh mesh = loft(stations, {.reference = shape.planes.anterior,
                                     .normal = shape.planes.normal,
                                     .rings = static_cast<int>(layout.rings),
                                     .segments = static_cast<int>(layout.segments),
                                     .cap = 0.5});
  const auto ring = [&](std::size_t r) { return std::span(mesh.position).subspan(layout.vertex(r), layout.segments); };
  if (f.around == nullptr) {
    if (!shape.planes.horizontal) return mesh;
    for (const auto& bone : f.bones) {
      for (std::size_t r = 0; r < layout.all_rings(); ++r) keep_off(f.leg, bone.sections, ring(r));
      keep_off(f.leg, bone.sections, std::span(mesh.position).first(1));
      keep_off(f.leg, bone.sections, std::span(mesh.position).last(1));
    }
    return mesh;
  }
  const auto& [skin, bones] = *f.around;
  for (auto& p : mesh.position) p.x = std::min(p.x, 0.0F);  // both glutei meet in the middle
  if (ends_on_bone(shape, TubeEnd::origin)) spread_end(bones, shape.origin, TubeEnd::origin, layout, mesh);
  if (ends_on_bone(shape, TubeEnd::insertion)) spread_end(bones, shape.insertion, TubeEnd::insertion, layout, mesh);
  const std::size_t first = ends_on_bone(shape, TubeEnd::origin) ? layout.cap + 1 : 0,
                    last = layout.all_rings() - (ends_on_bone(shape, TubeEnd::insertion) ? layout.cap + 1 : 0);
  for (std::size_t r = first; r < last; ++r) {
    keep_in(skin, beneath.rings.empty() ? cover_m : sheet_cover_m, ring(r));
    if (!beneath.rings.empty()) {
      keep_off(beneath.rings, beneath_gap_m, ring(r));
    } else if (shape.planes.horizontal && !beneath.sections.empty()) {
      // Tendons are not cut: they continue to the end of the muscle beneath.
      const double level = leg_level(f.leg, static_cast<double>(ring(r)[0].y));
      const auto thick = static_cast<float>(smoothstep(0.3, 0.7, relative_area(sections, sections, level)));
      const std::vector<Vec3<float>> uncut(ring(r).begin(), ring(r).end());
      keep_off(f.leg, beneath.sections, ring(r));
      for (std::size_t i = 0; i < uncut.size(); ++i) ring(r)[i] = uncut[i] + thick * (ring(r)[i] - uncut[i]);
    }
  }
  smooth_along(mesh, first, last);
  for (std::size_t r = first; r < last; ++r) keep_out(bones, bone_gap_m, ring(r));
  return mesh;
}

/// Returns 0 in the belly and 1 in the tendons, by the area of the measured section at each vertex's level.
std::vector<float> tendon_shares(const LegFrame& leg, const MuscleShape& shape,
                                 std::span<const LegSection> fitted_sections, const SurfaceMesh& mesh) {
  const std::span<const LegSection> measured = shape.sections;
  std::vector<float> share;
  for (const auto& p : mesh.position) {
    const double level = section_level(leg, shape.planes, to_double(p));
    share.push_back(static_cast<float>(tendon_share(relative_area(measured, fitted_sections, level))));
  }
  return share;
}

/// Returns the factor that widens the skin if muscles of `volume_m3` are more than usual in a leg.
double given_way(const LegFrame& leg, const LegProfile& skin, double volume_m3) {
  constexpr double usual_share = 0.38, step = 0.01;  // share of the volume within the skin
  double enclosed_m3 = 0;
  for (double s = LegProfile::first_s; s < LegProfile::last_s; s += step) {
    const double girth = skin.girth(s);
    enclosed_m3 += step * (s < 1 ? leg.thigh_length : leg.shank_length) * girth * girth / (4 * std::numbers::pi);
  }
  return std::sqrt(std::max(1.0, volume_m3 / (usual_share * enclosed_m3)));
}

/// The quadriceps' aponeurosis over the kneecap and the ligament from there to the tibia.
GroupSurface patellar_ligament(const Body& body, const Fitting& f) {
  constexpr TubeLayout own{16, 12, 2};
  const double unit = f.leg.unit;
  const Vec patella = f.leg.hip + to_double(body.joint_offset_m[index(Segment::patella_right)]);
  const Vec tip = patella + unit * Vec{0, -21, 3}, bottom = leg_point(f.leg, 1.185, 5, 40);
  const auto over = [&](double y, double z, double half_width, double bow) {
    return TubeStation{patella + unit * Vec{0, y, z}, half_width * unit, 1.8 * unit, 0, bow * unit};
  };
  const auto below = [&](double t, double half_width, double half_depth) {
    return TubeStation{tip + t * (bottom - tip), half_width * unit, half_depth * unit};
  };
  const std::array<TubeStation, 7> line = {over(18, 5, 14, 1.5), over(9, 8, 16, 2),    over(-3, 8.5, 15, 2),
                                           over(-13, 7, 13, 1),  below(0.05, 12, 2.6), below(0.5, 12, 2.6),
                                           below(1, 9, 3)};
  GroupSurface s{Muscle::quadriceps, Muscle::quadriceps, {}, {}, {to_float(tip), to_float(bottom)}, true};
  SurfaceMesh& mesh = s.surface.mesh;
  mesh = loft(line, {.reference = {1, 0, 0},
                     .normal = Vec{0, -1, 0},
                     .rings = static_cast<int>(own.rings),
                     .segments = static_cast<int>(own.segments),
                     .cap = 0.6});
  mesh.name = "patellar_ligament_right";
  s.surface.origin = Segment::patella_right;
  s.surface.insertion = Segment::shank_right;
  if (f.around != nullptr) spread_end(f.around->bones, Segment::shank_right, TubeEnd::insertion, own, mesh);
  s.tendon.assign(mesh.position.size(), 1.0F);
  return s;
}

}  // namespace

std::optional<Muscle> driving_muscle(const MuscleSet& simulated, Muscle group, Muscle muscle) {
  const auto has = [&](Muscle m) { return simulated[static_cast<std::size_t>(m)]; };
  if (has(muscle)) return muscle;
  if (has(group)) return group;
  if (muscle != group) return std::nullopt;
  std::optional<Muscle> largest;
  double most = 0;
  for (const MemberMuscle& m : members_of(group)) {
    const double volume = handsfield_volume_cm3(m, reference_body_height_m, reference_body_mass_kg);
    const Muscle own = muscle_of_line(m);
    if (!has(own) || volume <= most) continue;
    largest = own;
    most = volume;
  }
  return largest;
}

std::vector<GroupSurface> make_muscle_surfaces(const Body& body, const MuscleSet& simulated, MuscleRoom room) {
  const LegFrame leg = leg_frame(body);
  const auto bones = hard_bones();
  const Vec patella = to_double(body.joint_offset_m[index(Segment::patella_right)]);
  const double top_mm = 18;  // from the kneecap's centre to its upper edge
  const auto shapes = muscle_shapes(body, leg, room == MuscleRoom::together);
  double usual_m3 = 0;
  for (const MuscleShape& shape : shapes) {
    if (usual_muscles()[static_cast<std::size_t>(shape.group)]) usual_m3 += shape.volume_m3;
  }
  std::optional<Surroundings> around;
  if (room == MuscleRoom::together) {
    around.emplace(Surroundings{SkinRoom(body, leg), LegBones(body)});
    around->skin.widen(given_way(leg, around->skin.profile(), usual_m3));
  }
  const Fitting f{leg,
                  around ? &*around : nullptr,
                  bones,
                  {-patella.x / leg.unit, patella.z / leg.unit},
                  -(patella.y + top_mm * leg.unit) / leg.thigh_length - measured_patella_top};

  std::vector<double> girth(shapes.size(), 1.0);
  const auto sections_of = [&](std::size_t m, double g) {
    const std::size_t n = shapes[m].lies_on;
    return n == no_muscle ? fitted(f, shapes[m], g, nullptr, 1) : fitted(f, shapes[m], g, &shapes[n], girth[n]);
  };
  std::vector<SurfaceMesh> filled(shapes.size());
  const auto beneath = [&](std::size_t m) {
    Beneath under;
    const std::size_t n = around ? shapes[m].cut_back_to : no_muscle;
    if (n == no_muscle) return under;
    if (shapes[n].group == shapes[m].group) {
      under.sections = sections_of(n, girth[n]);
      return under;
    }
    for (std::size_t r = layout.cap; r < layout.cap + layout.rings; ++r) {
      const auto ring = std::span(filled[n].position).subspan(layout.vertex(r), layout.segments);
      under.rings.emplace_back(ring.begin(), ring.end());
    }
    return under;
  };
  const auto is_drawn = [&](std::size_t m) {
    return driving_muscle(simulated, shapes[m].group, shapes[m].muscle).has_value();
  };
  // Muscles under others first.
  std::vector<bool> needed(shapes.size());
  for (std::size_t m = 0; m < shapes.size(); ++m) needed[m] = is_drawn(m);
  for (int layer = 0; layer < 2; ++layer) {
    for (std::size_t m = 0; m < shapes.size(); ++m) {
      for (const std::size_t n : {shapes[m].lies_on, shapes[m].cut_back_to})
        if (needed[m] && n != no_muscle) needed[n] = true;
    }
  }
  for (const bool covering : {false, true}) {
    for (std::size_t m = 0; m < shapes.size(); ++m) {
      if (!needed[m] || shapes[m].volume_m3 == 0 || (shapes[m].cut_back_to != no_muscle) != covering) continue;
      const Beneath under = beneath(m);
      const auto filling = [&](double low, double high) {
        for (int i = 0; i < 14; ++i) {
          const double middle = 0.5 * (low + high);
          const SurfaceMesh mesh = build(f, shapes[m], sections_of(m, middle), under);
          (enclosed_volume(mesh) < shapes[m].volume_m3 ? low : high) = middle;
        }
        return 0.5 * (low + high);
      };
      constexpr double usual = 2.5, most = 8;  // the measured man's thinnest muscles are threads
      girth[m] = filling(0.25, usual);
      if (girth[m] > 0.99 * usual) girth[m] = filling(usual, most);
      filled[m] = build(f, shapes[m], sections_of(m, girth[m]), under);
    }
  }
  std::vector<GroupSurface> all;
  std::optional<Vec3<float>> tendon_end;  // of the calcaneal tendon, in which several muscles end
  for (std::size_t m = 0; m < shapes.size(); ++m) {
    if (!is_drawn(m)) continue;
    const auto sections = sections_of(m, girth[m]);
    GroupSurface s{shapes[m].group, shapes[m].muscle, {}, {}, {}, false};
    s.surface.mesh = shapes[m].volume_m3 > 0 ? filled[m] : build(f, shapes[m], sections, beneath(m));
    s.surface.mesh.name = std::string(shapes[m].name) + "_right";
    s.surface.origin = shapes[m].origin;
    s.surface.insertion = shapes[m].insertion;
    s.tendon = tendon_shares(leg, shapes[m], sections, s.surface.mesh);
    if (shapes[m].volume_m3 == 0) s.tendon.assign(s.tendon.size(), 1.0F);
    s.attachments = {s.surface.mesh.position.front(), s.surface.mesh.position.back()};
    if (around && ends_on_bone(shapes[m], TubeEnd::origin))
      s.surface.origin_held = held_shares(TubeEnd::origin, layout, s.surface.mesh.position.size());
    if (around && ends_on_bone(shapes[m], TubeEnd::insertion))
      s.surface.insertion_held = held_shares(TubeEnd::insertion, layout, s.surface.mesh.position.size());
    if (shapes[m].sheet) {
      // It moves with the muscles that it covers, or with its bones if those are not simulated.
      const Muscle beneath_it = shapes[shapes[m].cut_back_to].group;
      s.ligament = !driving_muscle(simulated, beneath_it, beneath_it).has_value();
      if (!s.ligament) s.group = s.muscle = beneath_it;
    }
    if (const std::size_t n = shapes[m].ends_in; n != no_muscle && !shapes[n].sheet) {
      if (!tendon_end) tendon_end = build(f, shapes[n], sections_of(n, 1), {}).position.back();
      s.attachments.insertion_m = *tendon_end;
    }
    all.push_back(std::move(s));
  }
  if (driving_muscle(simulated, Muscle::quadriceps, Muscle::quadriceps)) all.push_back(patellar_ligament(body, f));
  return all;
}

}  // namespace mobil::inline v0_3
