#pragma once
// Elementary functions for set-up with the same bits on every machine; system libraries differ in the last bit. Each is
// computed with twice a double's digits and rounded. The result is the double nearest to the true value, except in
// about one of 10¹⁴ cases. A call costs about 1 µs, too slow for ticks.

namespace mobil::inline v0_3::exact {

/// NaN and infinity are treated as in the standard library.
double exp(double x);
double expm1(double x);
double log(double x);            // x below 0: NaN; 0: −infinity
double pow(double x, double y);  // x above 0
double cbrt(double x);
double sin(double x);  // |x| to 10⁶
double cos(double x);
double atan2(double y, double x);
double asin(double x);  // −1 to 1
double acos(double x);

inline float sin(float x) {
  return static_cast<float>(sin(double{x}));
}
inline float cos(float x) {
  return static_cast<float>(cos(double{x}));
}
inline float atan2(float y, float x) {
  return static_cast<float>(atan2(double{y}, double{x}));
}
inline float acos(float x) {
  return static_cast<float>(acos(double{x}));
}

}  // namespace mobil::inline v0_3::exact
