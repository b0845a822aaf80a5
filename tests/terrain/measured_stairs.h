#pragma once
// Measured people on stairs: M. Bovi, M. Rabuffetti, P. Mazzoleni, M. Ferrarin, A multiple-task gait analysis approach:
// kinematic, kinetic and EMG reference data for healthy young and adult subjects, Gait Posture 33 (2011) 6–13, its
// addendum; 20 young subjects, mean height 1.47 m. Mean angles in deg, every 5 % from a foot's strike on a stair (going
// up, the last but one; also going down) to its next strike, on the floor.

#include <cstddef>

namespace mobil::bovi {

inline constexpr std::size_t instants = 21;

/// Flexion of the knee; flexion of the ankle without its mean over the cycle, because its zero differs; flexion of the
/// thigh from the vertical, forward.
struct Stride {
  double thigh[instants], knee[instants], ankle[instants];
};

inline constexpr Stride ascending = {{60.2, 56.3, 50.5, 42.3, 34.1, 26.0, 18.1, 11.4, 6.9,  4.0, 1.3,
                                      -2.1, -5.4, -6.0, -1.8, 6.3,  14.5, 20.0, 21.0, 17.2, 12.1},
                                     {69.3, 70.0, 68.1, 61.7, 53.7, 44.6, 35.3, 27.8, 24.1, 23.9, 24.3,
                                      23.0, 20.6, 22.1, 33.4, 52.7, 68.0, 68.3, 53.7, 33.7, 21.2},
                                     {0.4, 5.1,  9.0,   10.7,  11.0,  9.8,  7.8, 5.8, 4.9, 5.1, 4.8,
                                      0.5, -9.7, -20.6, -23.8, -16.9, -6.7, 0.4, 3.2, 1.5, -2.4}};

inline constexpr Stride descending = {{16.3, 14.2, 14.7, 13.9, 11.5, 8.9,  7.1,  6.3,  6.4,  7.1, 7.6,
                                       7.7,  9.2,  12.7, 17.3, 22.7, 27.5, 29.7, 27.6, 22.2, 16.3},
                                      {14.3, 19.3, 26.4, 29.7, 29.8, 29.1, 30.1, 33.3, 39.0, 46.7, 55.4,
                                       64.6, 75.3, 85.7, 92.9, 95.1, 90.0, 76.1, 55.2, 34.4, 22.7},
                                      {-33.0, -15.3, -0.6, 4.9,  7.0,  8.2,  9.3,  11.2, 13.0, 14.1, 13.9,
                                       11.7,  4.3,   -5.7, -8.5, -6.4, -4.1, -2.9, -3.9, -7.8, -9.3}};

}  // namespace mobil::bovi
