#pragma once
// Paths of muscles as kernels read them.

#include <cstddef>
#include <vector>

#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {

/// The paths of a muscle's members: the table's rows in single precision, at the published leg's size. Immutable, the
/// same for everybody. How they run: mobil/muscle_table.h.
struct MuscleLines {
  struct Point {
    LegBone bone;
    Vec3<float> at_m;
    PathHold hold = PathHold::fixed;
    /// Of an edge: which of the member's points (their number: the path's end) closes the straight line that it bends.
    std::size_t straight_to = 0;
  };
  using Track = KneeSpline<float>;
  struct Member {
    std::vector<Point> path;
    float weight;
    bool on_kneecap;
    Track kneecap;
  };
  std::vector<Member> members;
  Track rolling;  // of the knee
  // The drawn line: from the anchor towards a point of members[towards], or what its path ends on where it has no such
  // point; the belly begins start_m from the anchor.
  Point anchor;
  std::size_t towards, point;
  LegBone along;  // the bone that start_m scales with
  float start_m;
};

/// A muscle's lines: its length is the volume-weighted mean of its members'.
MuscleLines make_muscle_lines(Muscle muscle);

}  // namespace mobil::inline v0_3
