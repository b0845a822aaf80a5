#pragma once
// Eigen as all our sources have it: under a name of ours to the linker, for a host may use Eigen too, with flags that
// change how its functions work; and without its packets, whose order of adding differs between instruction sets.
// Include this and nothing of Eigen's before it.

#if defined(EIGEN_CORE_H)
#error "include engine/eigen.h before anything of Eigen"
#endif
#define EIGEN_DONT_VECTORIZE
#define Eigen mobil_eigen  // NOLINT(bugprone-reserved-identifier)

#include <Eigen/Core>
#include <Eigen/Dense>
