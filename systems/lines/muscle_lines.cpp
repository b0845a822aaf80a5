#include "systems/lines/muscle_lines.h"

#include <algorithm>

#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {
namespace {

using geometry::to_float;

MuscleLines::Point point(const PathPoint& p, std::size_t straight_to = 0) {
  return {p.bone, to_float(p.at_m), p.hold, straight_to};
}

MuscleLines::Track track(const KneeTrack& of) {
  const KneeSpline<double> spline = knee_spline(of);
  MuscleLines::Track t{to_float(spline.at_zero), to_float(spline.slope), {}};
  for (std::size_t k = 0; k < knee_knots; ++k) t.cubic[k] = to_float(spline.cubic[k]);
  return t;
}

MuscleLines::Member member(const MemberMuscle& muscle, double weight) {
  MuscleLines::Member m{};
  m.weight = static_cast<float>(weight);
  for (auto p = muscle.path.begin(); p != muscle.path.end(); ++p) {
    const auto next = std::find_if(p, muscle.path.end(), [](const PathPoint& q) { return q.hold == PathHold::fixed; });
    m.path.push_back(point(*p, static_cast<std::size_t>(next - muscle.path.begin())));
  }
  m.on_kneecap = muscle.kneecap.has_value();
  if (m.on_kneecap) m.kneecap = track(*muscle.kneecap);
  return m;
}

}  // namespace

MuscleLines make_single_line(const MemberMuscle& line) {
  MuscleLines lines{};
  lines.rolling = track(knee_rolling());
  lines.members.push_back(member(line, 1));
  return lines;
}

MuscleLines make_muscle_lines(Muscle muscle) {
  const MuscleRow& row = muscle_row(muscle);
  const DrawnLine& drawn = row.drawn;
  MuscleLines lines{{},
                    track(knee_rolling()),
                    point(drawn.anchor),
                    drawn.towards,
                    drawn.point,
                    drawn.along,
                    static_cast<float>(drawn.start_m)};
  for (const auto& m : row.members) lines.members.push_back(member(m, member_weight(row.members, m)));
  return lines;
}

}  // namespace mobil::inline v0_3
