#pragma once
// People with leg muscles of every kind, and the distance between their bellies.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "assets/fem/muscle_template.h"
#include "tests/simulation/people.h"
#include "tests/simulation/simulation_hash.h"

namespace mobil {

inline constexpr std::array methods = {Method::explicit_central, Method::implicit_central, Method::newmark,
                                       Method::statics};

inline std::string name(Method method) {
  return std::string(method_name[static_cast<std::size_t>(method)]);
}

inline std::vector<Entity> muscles_of(const Simulation& simulation, Entity person) {
  std::vector<Entity> all;
  for (const auto& own : simulation.muscles(person)) {
    all.insert(all.end(), own.entity.begin(), own.entity.end());
  }
  return all;
}

inline std::vector<float> displacement(const Simulation& simulation, Entity muscle) {
  const NodalView nodes = nodal_displacement(simulation.world(), muscle);
  std::vector<float> u(3 * std::size_t{nodes.nodes});
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = nodes.first[i * lane_count];
  return u;
}

inline Entity join_with(Simulation& simulation, const SamplePerson& p, const LegMuscles& choice) {
  const Entity person = join(simulation, p, false);
  const auto added = simulation.set_muscles(person, choice);
  EXPECT_TRUE(added) << added.error().message;
  return person;
}

/// Largest nodal displacement (m) of a person's muscles, and largest difference from another person's.
struct Difference {
  double most = 0, apart = 0;
};

inline void compare(const Simulation& a, Entity in_a, const Simulation& b, Entity in_b, Difference& d) {
  const auto ma = muscles_of(a, in_a), mb = muscles_of(b, in_b);
  for (std::size_t m = 0; m < ma.size(); ++m) {
    const auto ua = displacement(a, ma[m]), ub = displacement(b, mb[m]);
    ASSERT_EQ(ua.size(), ub.size());
    for (std::size_t i = 0; i < ua.size(); ++i) {
      ASSERT_TRUE(std::isfinite(ua[i]) && std::isfinite(ub[i]));
      d.most = std::max(d.most, static_cast<double>(std::abs(ua[i])));
      d.apart = std::max(d.apart, static_cast<double>(std::abs(ua[i] - ub[i])));
    }
  }
}

inline double limit_of(const Simulation& simulation, Entity muscle) {
  const auto scale = *simulation.get<BellyScale>(muscle);
  return *critical_step(simulation.world().shared<MuscleTemplate>(muscle)->critical_steps,
                        static_cast<double>(scale.across), static_cast<double>(scale.along));
}

}  // namespace mobil
