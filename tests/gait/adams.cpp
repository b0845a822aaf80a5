#include "tests/gait/adams.h"

#include <fmt/format.h>

namespace mobil::step {

Error adams_error(AdamsFailure why, double time_s, double step_s, const AdamsCounts& counts) {
  switch (why) {
    case AdamsFailure::interval:
      return {
          fmt::format("integration: from {} s to {} s is no interval; give finite times, the end not before the begin",
                      time_s, step_s)};
    case AdamsFailure::options:
      return {
          "integration: the options are not valid; absolute tolerances must be above 0, relative ones 0 or more and "
          "below 1, steps not negative, the least not above the greatest, the evaluations above 0"};
    case AdamsFailure::not_finite:
      return {fmt::format(
          "integration: state or derivative is not finite at {:.9g} s, step {:.3g} s; mend: a finite start, and forces "
          "that are finite near it",
          time_s, step_s)};
    case AdamsFailure::underflow:
      return {fmt::format(
          "integration: the step fell to {:.3g} s at {:.9g} s; mend: name the times at which the forces jump, or allow "
          "a larger tolerance or a smaller least step",
          step_s, time_s)};
    case AdamsFailure::evaluations:
      return {fmt::format(
          "integration: {} evaluations did not reach the end from {:.9g} s, step {:.3g} s; mend: a larger tolerance, "
          "more evaluations, or softer springs and dampers",
          counts.evaluations, time_s, step_s)};
    case AdamsFailure::none:
      break;
  }
  return {"integration: no failure"};
}

}  // namespace mobil::step
