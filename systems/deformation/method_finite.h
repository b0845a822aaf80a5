#pragma once
// Method::finite: central differences at finite strain, with fibres that pull where there is Activation.

#include "systems/deformation/method.h"

namespace mobil::inline v0_3 {

extern const DeformationMethod finite_method;

/// How the two kinds of method differ in where a belly is at rest: its place at finite strain under what drives its end
/// (of its table of finite shapes at this activation, where it has one; else relaxed, of a belly that keeps its
/// volume), less the linear static answer.
BellyMotion finite_less_linear(const NextBelly& next);

}  // namespace mobil::inline v0_3
