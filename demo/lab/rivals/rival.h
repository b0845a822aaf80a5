#pragma once
// Other libraries on the same work, for comparison: explicit central differences on the paper's block of muscle. It has
// 2×2×8 cubes of 15 mm, 81 nodes, the face z = 0 fixed, lumped mass and a uniform traction on the far face. A separate
// program, built with -O3 -march=native, that shares no code with mobil.

#include <string>
#include <vector>

namespace rivals {

inline constexpr int muscles = 1024;    // stepped in turn
inline constexpr int steps_a_tick = 8;  // 2 ms each, about 60 Hz
inline constexpr double step_s = 0.002;
inline constexpr double damping_per_s = 8;  // mass damping α

/// One way of doing the work, and the time of one muscle's step, µs of this thread's processor.
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
  std::string check;       // reference of its result
  double check_error = 0;  // relative difference
  bool holds = false;      // the difference is small enough
  double far_z_m = 0;      // mean displacement of the first muscle's far face along z after those steps
};

// Each variant is measured for `limit_s`, at least twice.

/// Measures a sparse row-major stiffness in double precision, one muscle at a time; all share it.
Rival eigen(double limit_s);
/// Measures it with a separate stiffness for each muscle: bodies of 0.8–1.3 times the width, 0.85–1.15 times the
/// length.
Rival eigen_individual(double limit_s);
/// Measures 32 muscles as the columns of a matrix in single precision, with one shared stiffness.
Rival eigen_batched(double limit_s);
/// Measures Bullet's deformable body (linear corotated tetrahedra, explicit) at `dt_s`; 0: its largest stable step.
Rival bullet(double dt_s, double limit_s);

/// Returns true if Bullet was found when this program was built.
bool has_bullet();

}  // namespace rivals
