#pragma once
// Elementary functions for set-up, whose bits are the same on every machine: those of a machine's own library differ in
// the last one. Each is computed with twice a double's digits and then rounded, so it is the nearest double to the true
// value in all but one case of some 10¹⁴. One takes about a microsecond: not for ticks.

namespace mobil::inline v0_3::exact {

/// NaN and infinity give what the standard library's give.
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
