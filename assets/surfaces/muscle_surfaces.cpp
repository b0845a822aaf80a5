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
#include "assets/surfaces/leg_station.h"
#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr int muscle_rings = 36, muscle_segments = 18;

constexpr std::size_t no_muscle = static_cast<std::size_t>(-1);

/// A member as drawn on the right leg, from its origin (first section) to its insertion (last), or the calcaneal
/// tendon. It covers the shape `lies_on` and ends at the shape `cut_back_to`. `ends_in` is the tendon that continues
/// it.
struct MuscleShape {
  std::string_view name;
  Muscle group, muscle;
  Segment origin, insertion;
  std::vector<LegSection> sections;
  SectionPlanes planes;
  double volume_m3 = 0;
  std::size_t lies_on = no_muscle, cut_back_to = no_muscle, ends_in = no_muscle;
};

/// Returns the single muscles in the order of member_muscles(), then the calcaneal tendon.
std::vector<MuscleShape> muscle_shapes(const Body& body, const LegFrame& leg) {
  std::vector<MuscleShape> all;
  std::vector<const MemberMuscle*> row;
  for (const MemberMuscle& m : member_muscles()) {
    if (m.sections.empty()) continue;  // a further line of a muscle
    const Muscle own = muscle_of_line(m);
    MuscleShape shape{muscle_name(own), m.group, own, m.origin, m.insertion, {}, section_planes(leg, m.across)};
    for (const MemberMuscle& line : members_of(own)) shape.volume_m3 += member_volume_m3(body, line);
    auto& to = shape.sections;
    to.insert(to.end(), m.drawn_above.begin(), m.drawn_above.end());
    to.insert(to.end(), m.sections.begin(), m.sections.end() - m.not_drawn);
    to.insert(to.end(), m.drawn_below.begin(), m.drawn_below.end());
    row.push_back(&m);
    all.push_back(std::move(shape));
  }
  for (std::size_t i = 0; i < row.size(); ++i) {
    const auto number_of = [&](std::string_view name) {
      const auto found = std::ranges::find(all, name, &MuscleShape::name);
      return found == all.end() ? no_muscle : static_cast<std::size_t>(found - all.begin());
    };
    all[i].lies_on = number_of(row[i]->lies_on);
    all[i].cut_back_to = number_of(row[i]->cut_back_to.empty() ? row[i]->lies_on : row[i]->cut_back_to);
    if (row[i]->in_calcaneal_tendon) all[i].ends_in = row.size();
  }
  const auto tendon = calcaneal_tendon();
  all.push_back({"calcaneal_tendon",
                 Muscle::triceps_surae,
                 Muscle::triceps_surae,
                 Segment::shank_right,
                 Segment::foot_right,
                 {tendon.begin(), tendon.end()},
                 section_planes(leg, std::nullopt)});
  return all;
}

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

/// Fits a muscle's sections to this body, in mm of the measured man. Multiplies the girth of the belly, moves it out of
/// the way of the muscle beneath, and leads the quadriceps to this body's kneecap. Published volumes are larger than
/// the measured man's, so sections grow. The parts in the bone, in the muscle beneath or outside of the skin are cut
/// off, and the rest grows until the volume is met.
struct Fitting {
  const LegFrame& leg;
  const LegProfile* skin;  // muscles stay inside it, widened by `wider`; null: each alone
  double wider;
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
    Point moved{static_cast<double>(s.lateral) + shift * away.l, static_cast<double>(s.anterior) + shift * away.a};
    if (shape.group == Muscle::quadriceps) {
      const double w = smoothstep(0.45, measured_patella_top, level);
      moved.l += w * (f.patella.l - measured_patella_lateral);
      moved.a += w * (f.patella.a - measured_patella_anterior);
      s.level = static_cast<float>(level + w * f.patella_shift);
    }
    s.lateral = static_cast<float>(moved.l);
    s.anterior = static_cast<float>(moved.a);
    s.semi_1 *= static_cast<float>(factor);
    s.semi_2 *= static_cast<float>(factor);
    s.bow *= static_cast<float>(factor);
  }
  return out;
}

/// Cuts a ring of vertices back to the bone or muscle beneath, each along its ray from the ring's middle. The middle is
/// moved out first if it is within.
void keep_out(const Fitting& f, std::span<const LegSection> beneath, std::span<Vec3<float>> ring) {
  constexpr double skin_mm = 1.5, middle_outside = 1.12;
  const double level = leg_level(f.leg, static_cast<double>(ring[0].y));
  const auto e = beneath.empty() ? std::nullopt : leg_ellipse(beneath, level);
  if (!e) return;
  const double aa = e->aa + skin_mm, ll = e->ll + skin_mm, al = e->al, det = aa * ll - al * al;
  const Vec axis = leg_point(f.leg, level, 0, 0);
  // to the circle whose image is the section beneath, and back
  const auto inward = [&](double l, double a) { return Point{(aa * l - al * a) / det, (ll * a - al * l) / det}; };
  const auto outward = [&](Point p) { return Point{al * p.a + ll * p.l, aa * p.a + al * p.l}; };
  const auto local = [&](const Vec3<float>& p) {
    return inward((axis.x - static_cast<double>(p.x)) / f.leg.unit - e->lateral,
                  (static_cast<double>(p.z) - axis.z) / f.leg.unit - e->anterior);
  };
  Point middle{0, 0};
  std::vector<Point> points;
  for (const auto& p : ring) {
    points.push_back(local(p));
    middle.l += points.back().l / static_cast<double>(ring.size());
    middle.a += points.back().a / static_cast<double>(ring.size());
  }
  const double distance = std::hypot(middle.l, middle.a);
  Point moved = middle;
  if (distance < middle_outside) {
    const double factor = middle_outside / std::max(distance, 1e-6);
    moved = {middle.l * factor, middle.a * factor};
  }
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point d{points[i].l - middle.l, points[i].a - middle.a};
    const double dd = d.l * d.l + d.a * d.a, md = moved.l * d.l + moved.a * d.a;
    const double mm = moved.l * moved.l + moved.a * moved.a - 1, root = md * md - dd * mm;
    double s = 1;
    if (md < 0 && root > 0) s = std::min(1.0, (-md - std::sqrt(root)) / dd);
    const Point q = outward({moved.l + s * d.l, moved.a + s * d.a});
    ring[i].x = static_cast<float>(axis.x - (q.l + e->lateral) * f.leg.unit);
    ring[i].z = static_cast<float>(axis.z + (q.a + e->anterior) * f.leg.unit);
  }
}

/// Cuts a ring of vertices back to the inside of the leg's skin, each along its ray from the ring's middle. The middle
/// is moved in first if it is outside.
void keep_in(const Fitting& f, std::span<Vec3<float>> ring) {
  constexpr double cover_mm = 2, middle_inside = 0.9;
  const double level = leg_level(f.leg, static_cast<double>(ring[0].y));
  if (f.skin == nullptr || level < LegProfile::first_s || level > LegProfile::last_s) return;
  const Vec axis = leg_point(f.leg, level, 0, 0);
  const auto room = [&](Point p) {
    const double turn = std::atan2(-p.l, p.a);
    return f.wider * f.skin->radius(level, turn < 0 ? turn + 2 * std::numbers::pi : turn) / f.leg.unit - cover_mm;
  };
  const auto is_in = [&](Point p) { return std::hypot(p.l, p.a) <= room(p); };
  Point middle{0, 0};
  std::vector<Point> points;
  for (const auto& p : ring) {
    points.push_back(
        {(axis.x - static_cast<double>(p.x)) / f.leg.unit, (static_cast<double>(p.z) - axis.z) / f.leg.unit});
    middle.l += points.back().l / static_cast<double>(ring.size());
    middle.a += points.back().a / static_cast<double>(ring.size());
  }
  Point moved = middle;
  if (const double far = std::hypot(middle.l, middle.a), most = middle_inside * room(middle); far > most)
    moved = {middle.l * most / far, middle.a * most / far};
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point d{points[i].l - middle.l, points[i].a - middle.a};
    const auto at = [&](double s) { return Point{moved.l + s * d.l, moved.a + s * d.a}; };
    double low = 0, high = 1;
    if (is_in(at(1))) low = 1;
    for (int round = 0; round < 16 && low < 1; ++round) {
      const double s = 0.5 * (low + high);
      (is_in(at(s)) ? low : high) = s;
    }
    const Point q = at(low);
    ring[i].x = static_cast<float>(axis.x - q.l * f.leg.unit);
    ring[i].z = static_cast<float>(axis.z + q.a * f.leg.unit);
  }
}

/// Builds a muscle's mesh. `beneath` has the sections of the muscle under it, if any.
SurfaceMesh build(const Fitting& f, const SectionPlanes& planes, std::span<const LegSection> sections,
                  std::span<const LegSection> beneath) {
  std::vector<TubeStation> stations;
  for (const auto& s : sections) stations.push_back(leg_station(f.leg, planes, s));
  SurfaceMesh mesh = loft(stations, {.reference = planes.anterior,
                                     .normal = planes.normal,
                                     .rings = muscle_rings,
                                     .segments = muscle_segments,
                                     .cap = 0.5});
  if (f.skin != nullptr) {
    for (auto& p : mesh.position) p.x = std::min(p.x, 0.0F);  // both glutei meet in the middle
  }
  if (!planes.horizontal) return mesh;  // bones and skin cut horizontal rings
  const std::size_t ring_count = (mesh.position.size() - 2) / muscle_segments;
  for (std::size_t r = 0; r < ring_count; ++r) {
    const auto ring = std::span(mesh.position).subspan(1 + r * muscle_segments, muscle_segments);
    keep_in(f, ring);
    // Tendons are not cut: they continue to the end of the muscle beneath.
    const double thick =
        smoothstep(0.3, 0.7, relative_area(sections, sections, leg_level(f.leg, static_cast<double>(ring[0].y))));
    const std::vector<Vec3<float>> uncut(ring.begin(), ring.end());
    keep_out(f, beneath, ring);
    for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = uncut[i] + static_cast<float>(thick) * (ring[i] - uncut[i]);
    for (const auto& bone : f.bones) keep_out(f, bone.sections, ring);
  }
  for (const auto& bone : f.bones) {
    keep_out(f, bone.sections, std::span(mesh.position).first(1));
    keep_out(f, bone.sections, std::span(mesh.position).last(1));
  }
  return mesh;
}

/// Returns 0 in the belly and 1 in the tendons, by the area of the measured section at each vertex's level.
std::vector<float> tendon_shares(const LegFrame& leg, const MuscleShape& shape,
                                 std::span<const LegSection> fitted_sections, const SurfaceMesh& mesh) {
  const std::span<const LegSection> measured = shape.sections;
  std::vector<float> share;
  for (const auto& p : mesh.position) {
    const double level = section_level(leg, shape.planes, to_double(p));
    share.push_back(static_cast<float>(1 - smoothstep(0.10, 0.32, relative_area(measured, fitted_sections, level))));
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

GroupSurface patellar_ligament(const Body& body, const Fitting& f) {
  const double unit = f.leg.unit;
  const Vec patella = f.leg.hip + to_double(body.joint_offset_m[index(Segment::patella_right)]);
  const Vec top = patella + Vec{0, -16 * unit, -1 * unit}, bottom = leg_point(f.leg, 1.185, 5, 40);
  const auto at = [&](double t) { return top + t * (bottom - top); };
  const std::array<TubeStation, 4> line = {TubeStation{at(0), 3 * unit, 12 * unit},
                                           {at(0.3), 2.6 * unit, 13 * unit},
                                           {at(0.7), 2.6 * unit, 12 * unit},
                                           {at(1), 3 * unit, 9 * unit}};
  GroupSurface s{Muscle::quadriceps, Muscle::quadriceps, {}, {}, {to_float(top), to_float(bottom)}, true};
  s.surface.mesh =
      loft(line, {.reference = {0, 0, 1}, .normal = Vec{0, -1, 0}, .rings = 10, .segments = 12, .cap = 0.6});
  s.surface.mesh.name = "patellar_ligament_right";
  s.surface.origin = Segment::patella_right;
  s.surface.insertion = Segment::shank_right;
  s.tendon.assign(s.surface.mesh.position.size(), 1.0F);
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
  const LegProfile skin(body_measures(body.request));
  const auto shapes = muscle_shapes(body, leg);
  double usual_m3 = 0;
  for (const MuscleShape& shape : shapes) {
    if (usual_muscles()[static_cast<std::size_t>(shape.group)]) usual_m3 += shape.volume_m3;
  }
  const Fitting f{leg,
                  room == MuscleRoom::together ? &skin : nullptr,
                  given_way(leg, skin, usual_m3),
                  bones,
                  {-patella.x / leg.unit, patella.z / leg.unit},
                  -(patella.y + top_mm * leg.unit) / leg.thigh_length - measured_patella_top};

  std::vector<double> girth(shapes.size(), 1.0);
  const auto sections_of = [&](std::size_t m, double g) {
    const std::size_t n = shapes[m].lies_on;
    return n == no_muscle ? fitted(f, shapes[m], g, nullptr, 1) : fitted(f, shapes[m], g, &shapes[n], girth[n]);
  };
  const auto beneath = [&](std::size_t m) {
    const std::size_t n = room == MuscleRoom::together ? shapes[m].cut_back_to : no_muscle;
    return n == no_muscle ? std::vector<LegSection>{} : sections_of(n, girth[n]);
  };
  const auto is_drawn = [&](std::size_t m) {
    return driving_muscle(simulated, shapes[m].group, shapes[m].muscle).has_value();
  };
  // Muscles under others first.
  std::vector<bool> needed(shapes.size());
  for (std::size_t m = 0; m < shapes.size(); ++m) {
    if (!is_drawn(m)) continue;
    for (const std::size_t n : {m, shapes[m].lies_on, shapes[m].cut_back_to}) {
      if (n != no_muscle) needed[n] = true;
    }
  }
  for (const bool covering : {false, true}) {
    for (std::size_t m = 0; m < shapes.size(); ++m) {
      if (!needed[m] || shapes[m].volume_m3 == 0 || (shapes[m].cut_back_to != no_muscle) != covering) continue;
      const std::vector<LegSection> under = beneath(m);
      const auto filling = [&](double low, double high) {
        for (int i = 0; i < 14; ++i) {
          const double middle = 0.5 * (low + high);
          const SurfaceMesh mesh = build(f, shapes[m].planes, sections_of(m, middle), under);
          (enclosed_volume(mesh) < shapes[m].volume_m3 ? low : high) = middle;
        }
        return 0.5 * (low + high);
      };
      constexpr double usual = 2.5, most = 8;  // the measured man's thinnest muscles are threads
      girth[m] = filling(0.25, usual);
      if (girth[m] > 0.99 * usual) girth[m] = filling(usual, most);
    }
  }
  std::vector<GroupSurface> all;
  for (std::size_t m = 0; m < shapes.size(); ++m) {
    if (!is_drawn(m)) continue;
    const auto sections = sections_of(m, girth[m]);
    GroupSurface s{shapes[m].group, shapes[m].muscle, {}, {}, {}, false};
    s.surface.mesh = build(f, shapes[m].planes, sections, beneath(m));
    s.surface.mesh.name = std::string(shapes[m].name) + "_right";
    s.surface.origin = shapes[m].origin;
    s.surface.insertion = shapes[m].insertion;
    s.tendon = tendon_shares(leg, shapes[m], sections, s.surface.mesh);
    if (shapes[m].volume_m3 == 0) s.tendon.assign(s.tendon.size(), 1.0F);
    s.attachments = {s.surface.mesh.position.front(), s.surface.mesh.position.back()};
    if (shapes[m].ends_in != no_muscle) {
      const MuscleShape& last = shapes[shapes[m].ends_in];
      s.attachments.insertion_m = build(f, last.planes, sections_of(shapes[m].ends_in, 1), {}).position.back();
    }
    all.push_back(std::move(s));
  }
  if (driving_muscle(simulated, Muscle::quadriceps, Muscle::quadriceps)) all.push_back(patellar_ligament(body, f));
  return all;
}

}  // namespace mobil::inline v0_3
