#pragma once
// Completes a gait request.

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/engine/error.h>
#include <mobil/usual_gait.h>

namespace mobil::inline v0_3 {

/// Completes and checks a request for a body. Speeds are 0 or 0.3–2.3 m/s, and step frequencies are 0.5–3 Hz, for a leg
/// of 0.90 m; they scale with √leg and 1/√leg. Step lengths are 0.25–1.25 leg lengths. A step length that is left out
/// is the usual one of that speed, leg, age and footwear. Errors: a value out of range, three inconsistent values, a
/// style value out of its range.
Result<Gait<float>> resolve_gait(const Body& body, const GaitRequest& request, Footwear footwear = Footwear::shoes);

/// Completes and checks a request for a body of those sizes and that age in shoes.
Result<Gait<float>> resolve_gait(const BodySize<float>& size, const GaitRequest& request, float age_y = usual_age_y);

/// Completes and checks a request for an adult of that height, m, with the legs of the unit body
/// (mobil/anthropometry.h).
Result<Gait<float>> resolve_gait(float height_m, const GaitRequest& request);

}  // namespace mobil::inline v0_3
