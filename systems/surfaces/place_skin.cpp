#include <mobil/systems/surfaces/place_skin.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <numbers>

#include <mobil/components/segments.h>
#include "engine/fused-inl.h"
#include "systems/surfaces/vertex_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

using FourTag = hn::CappedTag<float, 4>;
using FourVector = hn::Vec<FourTag>;
using IntTag = hn::RebindToSigned<EightTag>;
using IntVector = hn::Vec<IntTag>;

/// Inputs of a group of vertices; the last group has copies.
struct SkinGroup {
  const SkinVertex* vertex;
  const LegPlace* leg;
  const FatPlace* fat;
  const Vec3<float>*rest, *normal;
};

/// By region, x y z z.
struct FatRows {
  alignas(16) float row[fat_regions][4];
};

struct SkinPoints {
  EightVector x, y, z;
};
HWY_INLINE SkinPoints load_points(const Vec3<float>* p) {
  SkinPoints r;
  hn::LoadInterleaved3(eight, &p->x, r.x, r.y, r.z);
  return r;
}

/// Returns one of two numbers in each lane, according to its side.
HWY_INLINE EightVector by_side(const hn::Mask<EightTag>& is_left, float right, float left) {
  return hn::IfThenElse(is_left, hn::Set(eight, left), hn::Set(eight, right));
}

/// Lifts vertices at rest away from their legs' lines. Normals tilt with the slope of the lift.
HWY_INLINE void lift(const LegLines& lines, const SkinCover& cover, const SkinGroup& group, Vec3<float>* places,
                     Vec3<float>* normals) {
  static_assert(std::has_single_bit(leg_angles), "angles are wrapped by a mask");
  constexpr IntTag whole;
  constexpr auto round = static_cast<std::int32_t>(leg_angles);
  const auto all = [](float s) HWY_ATTR { return hn::Set(eight, s); };
  SkinPoints rest = load_points(group.rest), normal = load_points(group.normal);
  EightVector along, angle, amount;
  hn::LoadInterleaved3(eight, &group.leg->along, along, angle, amount);
  const auto is_left = hn::Gt(rest.x, hn::Zero(eight));
  const IntVector station =
      hn::Min(hn::ConvertTo(whole, along), hn::Set(whole, static_cast<std::int32_t>(leg_stations) - 2));
  const IntVector turn = hn::ConvertTo(whole, angle);
  const EightVector u = hn::Sub(along, hn::ConvertTo(eight, station)), v = hn::Sub(angle, hn::ConvertTo(eight, turn));
  const IntVector last = hn::Set(whole, round - 1);
  const IntVector of_side =
      hn::IfThenElseZero(hn::RebindMask(whole, is_left), hn::Set(whole, static_cast<std::int32_t>(leg_grid_points)));
  const IntVector row = hn::Add(of_side, hn::Mul(station, hn::Set(whole, round))),
                  next = hn::Add(row, hn::Set(whole, round));
  const IntVector j = hn::And(turn, last), k = hn::And(hn::Add(turn, hn::Set(whole, 1)), last);
  const float* const grid = cover.lift_m[0].data();
  const auto at = [&](const IntVector& a, const IntVector& b)
                      HWY_ATTR { return hn::GatherIndex(eight, grid, hn::Add(a, b)); };
  const EightVector here = at(row, j), beyond = at(row, k), below = at(next, j), aslant = at(next, k);
  const EightVector across = hn::Sub(beyond, here), across_below = hn::Sub(aslant, below);
  const EightVector upper = mul_add(v, across, here), slope = hn::Sub(mul_add(v, across_below, below), upper);
  const EightVector by = hn::Mul(amount, mul_add(u, slope, upper));
  const EightVector an_angle = hn::Mul(amount, mul_add(u, hn::Sub(across_below, across), across));

  const EightVector x = hn::Sub(rest.x, by_side(is_left, lines.hip[0].x, lines.hip[1].x)),
                    z = hn::Sub(rest.z, by_side(is_left, lines.hip[0].z, lines.hip[1].z));
  const EightVector away = hn::Sqrt(mul_add(z, z, hn::Mul(x, x)));
  const auto lifted = hn::And(hn::Gt(amount, hn::Zero(eight)), hn::Ge(away, all(0.01F)));
  const EightVector knee = by_side(is_left, lines.knee_y[0], lines.knee_y[1]);
  const auto is_thigh = hn::Gt(rest.y, knee);
  const EightVector length = hn::IfThenElse(is_thigh, hn::Sub(by_side(is_left, lines.hip[0].y, lines.hip[1].y), knee),
                                            hn::Sub(knee, by_side(is_left, lines.ankle_y[0], lines.ankle_y[1])));
  constexpr float stations = (leg_stations - 1) / static_cast<float>(last_leg_s - first_leg_s);
  const EightVector one = hn::Div(all(1), away), out_x = hn::Mul(x, one), out_z = hn::Mul(z, one);
  // Angles grow towards the inner side.
  const EightVector tilt = hn::Mul(hn::Mul(an_angle, one), by_side(is_left, round / (2 * std::numbers::pi_v<float>),
                                                                   -round / (2 * std::numbers::pi_v<float>)));
  const EightVector a_metre = hn::Div(hn::Mul(hn::Mul(amount, slope), all(stations)), length);
  const auto put = [&](EightVector& number, const EightVector& moved)
                       HWY_ATTR { number = hn::IfThenElse(lifted, moved, number); };
  put(rest.x, mul_add(by, out_x, rest.x));
  put(rest.z, mul_add(by, out_z, rest.z));
  put(normal.x, neg_mul_add(tilt, out_z, normal.x));
  put(normal.y, hn::Add(normal.y, a_metre));
  put(normal.z, mul_add(tilt, out_x, normal.z));
  hn::StoreInterleaved3(rest.x, rest.y, rest.z, eight, &places->x);
  hn::StoreInterleaved3(normal.x, normal.y, normal.z, eight, &normals->x);
}

/// A vertex and its normal (x y z z), moved by its frames.
struct Carried {
  FourVector position, normal;
};
HWY_INLINE Carried carried(const SkinVertex& vertex, const FrameMap* maps, const Vec3<float>& r, const Vec3<float>& n,
                           const FatPlace& place, const FatRows* fat) {
  constexpr FourTag four;
  const FrameMap& first = maps[vertex.frame[0]];
  FourVector x = hn::Load(four, first.column[0]), y = hn::Load(four, first.column[1]),
             z = hn::Load(four, first.column[2]), from = hn::Load(four, first.column[3]);
  if (vertex.weight[1] != 0) {
    const FourVector part = hn::Set(four, vertex.weight[0]);
    x = hn::Mul(part, x), y = hn::Mul(part, y), z = hn::Mul(part, z), from = hn::Mul(part, from);
    for (std::size_t k = 1; k < SkinVertex::max_frames && vertex.weight[k] != 0; ++k) {
      const FrameMap& other = maps[vertex.frame[k]];
      const FourVector more = hn::Set(four, vertex.weight[k]);
      x = mul_add(more, hn::Load(four, other.column[0]), x);
      y = mul_add(more, hn::Load(four, other.column[1]), y);
      z = mul_add(more, hn::Load(four, other.column[2]), z);
      from = mul_add(more, hn::Load(four, other.column[3]), from);
    }
  }
  const auto all = [](float s) HWY_ATTR { return hn::Set(FourTag{}, s); };
  for (std::size_t k = 0; fat != nullptr && k < place.part.size() && place.part[k] != 0; ++k)
    from = mul_add(all(place.part[k]), hn::Load(four, fat->row[place.region[k]]), from);
  return {mul_add(all(r.z), z, mul_add(all(r.y), y, mul_add(all(r.x), x, from))),
          mul_add(all(n.z), z, mul_add(all(n.y), y, hn::Mul(all(n.x), x)))};
}

/// Returns a row of two vertices. Only eight lanes use the second.
template <class Tag>
HWY_INLINE hn::Vec<Tag> of_two(Tag of, const FourVector& first, [[maybe_unused]] const FourVector& second) {
  if constexpr (hn::MaxLanes(Tag{}) == 8) {
    return hn::Combine(of, second, first);
  } else {
    return first;
  }
}

/// Writes the first `count` vertices of a group.
HWY_INLINE void place_group(const LegLines& lines, const SkinCover* cover, const FatRows* fat, SkinGroup group,
                            const FrameMap* maps, std::size_t first, std::size_t count, bool packed,
                            const VertexTarget& out) {
  Vec3<float> places[group_vertices], normals[group_vertices];
  if (cover != nullptr &&
      std::any_of(group.leg, group.leg + group_vertices, [](const LegPlace& leg) { return leg.amount > 0; })) {
    lift(lines, *cover, group, places, normals);
    group.rest = places;
    group.normal = normals;
  }
  Rows position, normal;
  for (std::size_t v = 0; v < 4; ++v) {
    const auto own = [&](std::size_t i) HWY_ATTR {
      return carried(group.vertex[i], maps, group.rest[i], group.normal[i], group.fat[i], fat);
    };
    const Carried low = own(v), high = group_vertices == 8 ? own(v + 4) : low;
    position.row[v] = of_two(eight, low.position, high.position);
    normal.row[v] = hn::Shuffle2103(of_two(eight, low.normal, high.normal));
  }
  if (out.normal == nullptr) return put_positions(position, first, count, out);
  normalise(1, normal);
  put(position, normal, first, count, packed, out, [](std::size_t) { return RigidAlong{}; });
}

void place_mesh(const SkinMesh& mesh, const BodySkin& skin, const LegLines& lines, const FrameMap* maps,
                const SkinCover* cover, const FatBeside* beside, const VertexTarget& out) {
  FatRows rows;
  for (std::size_t r = 0; beside != nullptr && r < fat_regions; ++r) {
    const auto& [x, y, z] = (*beside)[r];
    rows.row[r][0] = x, rows.row[r][1] = y, rows.row[r][2] = rows.row[r][3] = z;
  }
  const FatRows* const fat = beside == nullptr ? nullptr : &rows;
  const bool packed = is_packed(out);
  const std::size_t vertices = mesh.vertex.size();
  std::size_t first = 0;
  for (; first + group_vertices <= vertices; first += group_vertices) {
    place_group(lines, cover, fat,
                {&mesh.vertex[first], &mesh.leg[first], &mesh.fat[first], &skin.rest[first], &skin.normal[first]}, maps,
                first, group_vertices, packed, out);
  }
  if (first == vertices) return;
  SkinVertex vertex[group_vertices];
  LegPlace leg[group_vertices];
  FatPlace fats[group_vertices];
  Vec3<float> rest[group_vertices], normal[group_vertices];
  for (std::size_t i = 0; i < group_vertices; ++i) {
    const std::size_t v = std::min(first + i, vertices - 1);
    vertex[i] = mesh.vertex[v], leg[i] = mesh.leg[v], fats[i] = mesh.fat[v], rest[i] = skin.rest[v],
    normal[i] = skin.normal[v];
  }
  place_group(lines, cover, fat, {vertex, leg, fats, rest, normal}, maps, first, vertices - first, packed, out);
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(place_mesh);
}

void place_skin(const SkinMesh& mesh, const BodySkin& skin, std::span<const FrameMap> maps, const SkinCover* cover,
                const FatBeside* fat, const VertexTarget& out) {
  LegLines lines{};
  for (const Side side : {Side::right, Side::left}) {
    const auto at = [&](Segment s) { return skin.standing.position_m[index(on_side(s, side))]; };
    lines.hip[side] = at(Segment::thigh_right);
    lines.knee_y[side] = at(Segment::shank_right).y;
    lines.ankle_y[side] = at(Segment::foot_right).y;
  }
  HWY_DYNAMIC_DISPATCH(place_mesh)(mesh, skin, lines, maps.data(), cover, fat, out);
}

void pose_skin(const BodySkin& skin, const Pose<float>& pose, float lengths, const Vec3<float>& origin_m,
               const std::array<std::span<const Vec3<float>>, 2>& muscles, const SkinTable* table, const FatBeside* fat,
               std::span<FrameMap> maps, const VertexTarget& out) {
  const SkinMesh& mesh = skin_mesh(skin.sex, skin.detail);
  frame_maps(mesh, skin, pose, lengths, origin_m, maps);
  SkinCover cover;
  bool covers = false;
  for (const Side side : {Side::right, Side::left}) {
    if (muscles[side].empty() && table == nullptr) continue;
    covers = true;
    if (muscles[side].empty()) {
      cover_by_table(*table, leg_angles_of(pose, side), cover.lift_m[side]);
    } else {
      cover_muscles(skin, pose, lengths, side, muscles[side], cover.lift_m[side]);
    }
  }
  place_skin(mesh, skin, maps, covers ? &cover : nullptr, fat, out);
}

}  // namespace mobil::inline v0_3
#endif
