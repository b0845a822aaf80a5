// Reads poses at any instant, and rows as floats.

#include <array>

#include <mobil/components/activation.h>
#include <mobil/forces.h>
#include <mobil/muscle_table.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "systems/c/c_call.h"

namespace {

using namespace mobil;
using namespace mobil::c;

/// Writes floats one after the other.
struct FloatWriter {
  const HostAxes& axes;
  float* at;

  void put(float value) { *at++ = value; }
  template <std::size_t n>
  void put(const float (&values)[n]) {
    for (const float value : values) put(value);
  }
  void place(const Vec3<float>& place) {
    axes.place_to(place, at);
    at += 3;
  }
  void direction(const Vec3<float>& direction) {
    axes.direction_to(direction, at);
    at += 3;
  }
};

void put(const JointAngles<float>& a, FloatWriter& to) {
  for (const float angle : {a.pelvis_rotation, a.pelvis_list, a.pelvis_tilt}) to.put(angle);
  for (const auto* pair :
       {&a.hip_flexion, &a.knee_flexion, &a.ankle_dorsiflexion, &a.shoulder_flexion, &a.elbow_flexion}) {
    to.put(*pair);
  }
}
void put(const Feet<float>& feet, FloatWriter& to) {
  for (const auto* points : {&feet.heel_m, &feet.toe_m, &feet.tip_m})
    for (const Vec3<float>& point : *points) to.place(point);
  to.put(feet.phase);
}
void put(const CentreOfMass<float>& centre, FloatWriter& to) {
  to.place(centre.position_m);
}
void put(const GaitState<float>& state, FloatWriter& to) {
  to.put(static_cast<float>(state.steps));
  to.put(static_cast<float>(state.stance_side));
  to.put(state.time_s);
}
void put(const GroundReaction<float>& ground, FloatWriter& to) {
  for (const Vec3<float>& force : ground.force_n) to.direction(force);
  for (const Vec3<float>& centre : ground.centre_m) to.place(centre);
}
void put(const JointMoments<float>& moments, FloatWriter& to) {
  to.put(moments.hip_nm);
  to.put(moments.knee_nm);
  to.put(moments.ankle_nm);
}
/// The parts of a ground reaction and of moments that rows of interface 4 added.
void put_free_moments(const GroundReaction<float>& ground, FloatWriter& to) {
  to.put(ground.free_moment_nm);
}
void put_hip(const JointMoments<float>& moments, FloatWriter& to) {
  to.put(moments.hip_abduction_nm);
  to.put(moments.hip_rotation_nm);
}
void put(const LineOfAction<float>& line, FloatWriter& to) {
  for (const float value : {line.length_m, line.rest_length_m, line.stiffness_n_per_m, line.force_n}) to.put(value);
}
void put(const LineMotion<float>& motion, FloatWriter& to) {
  for (const float value :
       {motion.speed_m_s, motion.hip_flexion_arm_m, motion.knee_flexion_arm_m, motion.ankle_dorsiflexion_arm_m}) {
    to.put(value);
  }
}
void put(const BellyReport<float>& r, FloatWriter& to) {
  for (const float value : {r.elongation_m, r.reaction_n, r.volume_ratio, r.kinetic_energy_j, r.strain_energy_j})
    to.put(value);
}
void put(const Activation<float>& a, FloatWriter& to) {
  to.put(a.excitation);
  to.put(a.activation);
}
void put(const Musculotendon<float>& m, FloatWriter& to) {
  for (const float value : {m.fibre_m, m.tendon_m, m.pennation_rad, m.force_n, m.belly_m}) to.put(value);
}

/// A kind of row: its number of floats, and the function that writes an entity's row.
struct RowKind {
  int floats;
  Result<void> (*read)(const Simulation&, Entity, FloatWriter&);
};
template <template <class> class C, void (*write)(const C<float>&, FloatWriter&) = put>
constexpr RowKind row_kind(int floats) {
  return {floats, [](const Simulation& world, Entity entity, FloatWriter& to) -> Result<void> {
            const auto row = world.get<C>(entity);
            if (!row) return tl::unexpected(row.error());
            write(*row, to);
            return {};
          }};
}
// In the order of the enumerations from MOBIL_JOINTS and MOBIL_LINE.
constexpr std::array<RowKind, MOBIL_ROWS> row_kinds = {row_kind<JointAngles>(13),    row_kind<Feet>(20),
                                                       row_kind<CentreOfMass>(3),    row_kind<GaitState>(3),
                                                       row_kind<GroundReaction>(12), row_kind<JointMoments>(6),
                                                       row_kind<GroundReaction, put_free_moments>(2),
                                                       row_kind<JointMoments, put_hip>(4)};
constexpr std::array<RowKind, MOBIL_NODES> muscle_row_kinds = {row_kind<LineOfAction>(4), row_kind<LineMotion>(4),
                                                               row_kind<BellyReport>(5), row_kind<Activation>(2),
                                                               row_kind<Musculotendon>(5)};

/// Copies the rows in `s.row` to the caller.
int hand_over(mobil_sim& s, std::size_t count, std::size_t floats, float* out, std::size_t stride) {
  const std::size_t close = floats * sizeof(float);
  if (stride != 0 && stride < close)
    return s.line.refuse(MOBIL_ROOM, fmt::format("rows lie {} bytes apart and are {} long", stride, close));
  for (std::size_t i = 0; i < count; ++i) std::memcpy(row_at(out, i, stride, close), &s.row[i * floats], close);
  return MOBIL_OK;
}

int read_rows(mobil_sim& s, const RowKind& kind, std::size_t count, float* out, std::size_t stride) {
  const auto floats = static_cast<std::size_t>(kind.floats);
  s.row.resize(count * floats);
  FloatWriter to{s.axes, s.row.data()};
  for (std::size_t i = 0; i < count; ++i) {
    const auto done = kind.read(s.world(), s.people[i], to);
    if (!done) return s.line.refuse(done.error(), person_number(i));
  }
  return hand_over(s, count, floats, out, stride);
}

int read_nodes(mobil_sim& s, std::size_t count, float* out, std::size_t stride) {
  std::size_t floats = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const NodalView nodes = nodal_displacement(s.world().world(), s.people[i]);
    if (nodes.first == nullptr)
      return s.line.refuse(MOBIL_MISSING, fmt::format("person {}: this muscle has no control points", i));
    if (i == 0) {
      floats = std::size_t{3} * nodes.nodes;
      s.row.resize(count * floats);
    }
    if (floats != std::size_t{3} * nodes.nodes)
      return s.line.refuse(
          MOBIL_REFUSED,
          fmt::format("person {} has {} nodes, those before {}; read them by themselves", i, nodes.nodes, floats / 3));
    for (std::size_t f = 0; f < floats; ++f) s.row[i * floats + f] = nodes.first[f * lane_count];
  }
  return hand_over(s, count, floats, out, stride);
}

/// Stores the muscles of people, of that number and side, in `s.people`.
int name_muscles(mobil_sim& s, const mobil_id* ids, std::size_t count, int muscle, int side) {
  if (const int code = s.name_people(ids, count)) return code;
  Muscle of{};
  if (const int code = muscle_number(s.line, muscle, of)) return code;
  Side on{};
  if (const int code = one_of(s.line, side, Side::left, "side", on)) return code;
  for (std::size_t i = 0; i < count; ++i) {
    const Entity person = s.people[i];
    if (!s.world().is_person(person)) return s.line.refuse(Error{{}, Status::stale_entity}, person_number(i));
    s.people[i] = s.world().muscle(person, of, on);
    if (!s.world().world().alive(s.people[i]))
      return s.line.refuse(MOBIL_MISSING, fmt::format("person {} has no {} now", i, muscle_name(of)));
  }
  return MOBIL_OK;
}

int layout_of(mobil_sim& s, const mobil_pose_layout* given, std::vector<Segment>& segments, PoseLayout& to,
              std::size_t& segment_stride, double& ahead_s) {
  auto layout = usual<mobil_pose_layout>();
  if (given != nullptr) {
    if (const int code = read_struct(s.line, given, "layout", layout)) return code;
  }
  if (const int code = one_of(s.line, layout.form, PoseForm::dual_quaternion, "form", to.form)) return code;
  to.axes = s.axes.axes;
  to.units_per_m = s.axes.units_per_m;
  to.to_parent = layout.to_parent != 0;
  if (layout.segments == nullptr && layout.segment_count > 0) return s.line.refuse_null("segments");
  if (layout.segments != nullptr && layout.segment_count == 0)
    return s.line.refuse(MOBIL_REFUSED, "segment_count is 0; name some segments, or leave segments null for all");
  for (std::size_t i = 0; i < layout.segment_count; ++i) {
    Segment segment{};
    if (const int code = one_of(s.line, layout.segments[i], Segment::thumb_left, "segment", segment)) return code;
    segments.push_back(segment);
  }
  to.segments = segments;
  segment_stride = layout.segment_stride;
  ahead_s = layout.ahead_s;
  return MOBIL_OK;
}

}  // namespace

const char* mobil_segment_name(int segment) {
  return segment < 0 || segment >= MOBIL_SEGMENTS ? nullptr : segment_name[static_cast<std::size_t>(segment)].data();
}

int mobil_segment_parent(int segment) {
  if (segment < 0 || segment >= MOBIL_SEGMENTS) return MOBIL_MISSING;
  return static_cast<int>(segment_parent[static_cast<std::size_t>(segment)]);
}

int mobil_find_segment(const char* name) {
  if (name == nullptr) return MOBIL_MISSING;
  const auto at = std::ranges::find(segment_name, std::string_view(name));
  return at == segment_name.end() ? int{MOBIL_MISSING} : static_cast<int>(at - segment_name.begin());
}

int mobil_poses(mobil_sim* sim, const mobil_id* ids, size_t count, const mobil_pose_layout* layout, void* out,
                size_t stride) {
  return call(sim, "mobil_poses", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    if (count == 0) return int{MOBIL_OK};
    if (out == nullptr) return s.line.refuse_null("out");
    PoseLayout as;
    std::vector<Segment> segments;
    std::size_t segment_stride = 0;
    double ahead_s = 0;
    if (const int code = layout_of(s, layout, segments, as, segment_stride, ahead_s)) return code;
    constexpr std::array<std::size_t, 3> form_bytes = {28, 48, 32};
    const std::size_t one = form_bytes[static_cast<std::size_t>(as.form)];
    const std::size_t number = segments.empty() ? segment_count : segments.size();
    // Bytes of one person, from the first segment to the end of the last one.
    const std::size_t person = (number - 1) * (segment_stride == 0 ? one : segment_stride) + one;
    const std::size_t apart = stride == 0 ? person : stride;
    const std::span bytes(static_cast<std::byte*>(out), (count - 1) * apart + person);
    const auto done = s.poses->write(s.world().world(), s.people, ahead_s, as, {bytes, apart, segment_stride}, s.jobs);
    return done ? int{MOBIL_OK} : s.line.refuse(done.error());
  });
}

int mobil_row_floats(int what) {
  return what < 0 || what >= MOBIL_ROWS ? int{MOBIL_MISSING} : row_kinds[static_cast<std::size_t>(what)].floats;
}

int mobil_read(mobil_sim* sim, int what, const mobil_id* ids, size_t count, float* out, size_t stride) {
  return call(sim, "mobil_read", [&](mobil_sim& s) {
    if (const int code = s.name_people(ids, count)) return code;
    if (out == nullptr && count > 0) return s.line.refuse_null("out");
    if (what < 0 || what >= MOBIL_ROWS)
      return s.line.refuse(MOBIL_REFUSED, fmt::format("{} is none of MOBIL_JOINTS, …", what));
    return read_rows(s, row_kinds[static_cast<std::size_t>(what)], count, out, stride);
  });
}

int mobil_muscle_row_floats(mobil_sim* sim, int what, mobil_id id, int muscle, int side) {
  int floats = MOBIL_MISSING;
  const int code = call(sim, "mobil_muscle_row_floats", [&](mobil_sim& s) {
    if (what < 0 || what >= MOBIL_MUSCLE_ROWS)
      return s.line.refuse(MOBIL_REFUSED, fmt::format("{} is none of MOBIL_LINE, …", what));
    if (const int failed = name_muscles(s, &id, 1, muscle, side)) return failed;
    if (what < MOBIL_NODES) {
      floats = muscle_row_kinds[static_cast<std::size_t>(what)].floats;
      return int{MOBIL_OK};
    }
    const NodalView nodes = nodal_displacement(s.world().world(), s.people[0]);
    if (nodes.first == nullptr) return s.line.refuse(MOBIL_MISSING, "this muscle has no control points");
    floats = static_cast<int>(3 * nodes.nodes);
    return int{MOBIL_OK};
  });
  return code == MOBIL_OK ? floats : code;
}

int mobil_read_muscles(mobil_sim* sim, int what, const mobil_id* ids, size_t count, int muscle, int side, float* out,
                       size_t stride) {
  return call(sim, "mobil_read_muscles", [&](mobil_sim& s) {
    if (out == nullptr && count > 0) return s.line.refuse_null("out");
    if (what < 0 || what >= MOBIL_MUSCLE_ROWS)
      return s.line.refuse(MOBIL_REFUSED, fmt::format("{} is none of MOBIL_LINE, …", what));
    if (const int code = name_muscles(s, ids, count, muscle, side)) return code;
    if (what == MOBIL_NODES) return read_nodes(s, count, out, stride);
    return read_rows(s, muscle_row_kinds[static_cast<std::size_t>(what)], count, out, stride);
  });
}
