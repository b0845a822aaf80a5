#pragma once
// Paths of muscles in the form that kernels read.

#include <cstddef>
#include <vector>

#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {

/// Paths of a muscle's members: rows of the table in single precision, at the size of the published leg. They are
/// immutable and shared by all people. mobil/muscle_table.h describes their course.
struct MuscleLines {
  struct Point {
    LegBone bone;
    Vec3<float> at_m;
    PathHold hold = PathHold::fixed;
    /// For an edge, index of the member's point that ends the straight line bent by it. The number of points is the
    /// path's end.
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
  // The drawn line runs from the anchor to a point of members[towards], or to the end of that path if it has no such
  // point. The belly begins start_m from the anchor.
  Point anchor;
  std::size_t towards, point;
  LegBone along;  // bone with which start_m scales
  float start_m;
};

/// Builds the path of one line alone, without what is drawn.
MuscleLines make_single_line(const MemberMuscle& line);
/// Builds the lines of a muscle. Its length is the volume-weighted mean of its members' lengths.
MuscleLines make_muscle_lines(Muscle muscle);

}  // namespace mobil::inline v0_3
