#pragma once
// Eigen under a linker name of ours, because a host can use Eigen with flags that change its functions. Packets are
// off, because their order of addition differs between instruction sets. Its temporaries are on the heap from 8 kB on,
// because threads can have small stacks. Include this before any header of Eigen.

#if defined(EIGEN_CORE_H)
#error "include engine/eigen.h before anything of Eigen"
#endif
#define EIGEN_DONT_VECTORIZE
#define EIGEN_STACK_ALLOCATION_LIMIT 8192
#define Eigen mobil_eigen  // NOLINT(bugprone-reserved-identifier)

#include <Eigen/Core>
#include <Eigen/Dense>
