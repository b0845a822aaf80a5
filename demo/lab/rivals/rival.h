#pragma once
// What others' code needs for the same work: the paper's block of muscle (2×2×8 cubes of 15 mm, 81 nodes, the face z =
// 0 fixed, lumped mass, a uniform traction on the far face), explicit central differences. A program of its own, built
// with -O3 -march=native, that shares no code with mobil.

#include <string>
#include <vector>

namespace rivals {

inline constexpr int muscles = 1024;    // that are stepped in turn
inline constexpr int steps_a_tick = 8;  // 2 ms each, about 60 Hz
inline constexpr double step_s = 0.002;
inline constexpr double damping_per_s = 8;  // mass damping α

/// One way of doing the work and how long one muscle's step takes, µs on this thread's processor.
struct Variant {
  std::string name;
  double best_us = 0, median_us = 0;
};

/// A rival: the best of its variants counts.
struct Rival {
  std::string name;
  double dt_s = step_s;
  int repeats = 0;
  std::vector<Variant> variants;
  std::string check;       // what its result was compared with
  double check_error = 0;  // relative difference
  bool holds = false;      // the difference is as small as it must be
  double far_z_m = 0;      // mean displacement of the first muscle's far face along z after those steps
};

// Each variant is measured for `limit_s`, at least twice.

/// Sparse row-major stiffness in double precision, one muscle at a time; all share it.
Rival eigen(double limit_s);
/// The same with a stiffness of its own for every muscle: bodies of 0.8–1.3 times the width, 0.85–1.15 times the
/// length.
Rival eigen_individual(double limit_s);
/// 32 muscles as the columns of a matrix in single precision, one shared stiffness.
Rival eigen_batched(double limit_s);
/// Bullet's deformable body (linear corotated tetrahedra, explicit) at `dt_s`, or at its largest stable step when 0.
Rival bullet(double dt_s, double limit_s);

/// Whether Bullet was found when this program was built.
bool has_bullet();

}  // namespace rivals
