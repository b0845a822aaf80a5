// The paper's check after the finite elements: the deformed mesh's end, compared with the line of action.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <mobil/muscle_table.h>
#include <mobil/simulation.h>
#include "tests/labels.h"
#include "tests/simulation/people.h"

MOBIL_TEST_LABELS("slow");

namespace mobil::line_end_test {
constexpr double rounding_m = 2e-6;

struct EndError {
  double worst_m = 0, largest_change_m = 0;
  double worst_part = 0;  // relative to the change, without rounding (m)
};

/// Returns the distance of the mesh's end from the line's, for one person's muscles over a second of walking, by
/// muscle.
std::vector<EndError> end_errors(const SamplePerson& who, const LegMuscles& choice) {
  Simulation simulation(sharing());
  const Entity person = simulation.spawn(who.body, who.gait).value();
  EXPECT_TRUE(simulation.set_muscles(person, choice));
  const std::vector<MuscleRef> muscles = simulation.muscles(person);
  std::vector<EndError> errors(muscles.size());
  for (int tick = 0; tick < 60; ++tick) {
    simulation.tick();
    for (std::size_t m = 0; m < errors.size(); ++m) {
      for (const Entity muscle : muscles[m].entity) {
        const auto line = *simulation.get<LineOfAction>(muscle);
        const auto belly = *simulation.get<BellyReport>(muscle);
        const double change = static_cast<double>(line.length_m) - static_cast<double>(line.rest_length_m);
        const double off = std::abs(static_cast<double>(belly.elongation_m) - change);
        errors[m].worst_m = std::max(errors[m].worst_m, off);
        errors[m].largest_change_m = std::max(errors[m].largest_change_m, std::abs(change));
        if (off > rounding_m)
          errors[m].worst_part = std::max(errors[m].worst_part, (off - rounding_m) / std::abs(change));
      }
    }
  }
  return errors;
}

class LineEnd : public testing::TestWithParam<int> {};

// With a displacement drive the mesh's end is the line's for any method.
TEST_P(LineEnd, DrivenEndFollowsTheLineExactly) {
  for (const Method method : {Method::explicit_central, Method::statics}) {
    LegMuscles choice;
    choice.muscles = usual_muscles() | muscle_members();
    choice.method = method;
    for (const EndError& e : end_errors(sample_person(GetParam()), choice)) {
      EXPECT_GT(e.largest_change_m, 1e-3);
      EXPECT_LT(e.worst_m, rounding_m);
    }
  }
}

// The paper's force, +k(L − L₀) spread over the face, moves the face's mean as far as the line in the static solution.
TEST_P(LineEnd, PaperForceEndIsWithinThreeThousandths) {
  LegMuscles choice;
  choice.muscles = usual_muscles() | muscle_members();
  choice.drive = Drive::force;
  choice.method = Method::statics;
  for (const EndError& e : end_errors(sample_person(GetParam()), choice)) {
    EXPECT_GT(e.largest_change_m, 1e-3);
    EXPECT_LT(e.worst_part, 0.003);
  }
}

INSTANTIATE_TEST_SUITE_P(People, LineEnd, testing::Values(0, 7, 19, 33));

}  // namespace mobil::line_end_test
