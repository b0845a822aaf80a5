#pragma once
// From a request to a gait.

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Completes and checks a request for a body. Fails on speeds other than 0 outside 0.3–2.3 m/s (at a leg of 0.90 m; in
/// proportion to √leg), step lengths outside 0.25–1.25 leg lengths, step frequencies outside 0.5–3 Hz (at that leg; in
/// proportion to 1/√leg), three values that disagree, or a style value outside its range.
Result<Gait<float>> resolve_gait(const Body& body, const GaitRequest& request);

/// The same of a walker of that height, whose limbs are in proportion.
Result<Gait<float>> resolve_gait(float height_m, const GaitRequest& request);

}  // namespace mobil::inline v0_3
