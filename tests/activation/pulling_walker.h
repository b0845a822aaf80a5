#pragma once
// A walker with forces and active single muscles excited as in walking people, with lines of action only.

#include <mobil/simulation.h>

namespace mobil::test {

inline Result<Entity> pulling_walker(Simulation& simulation, float speed_m_s,
                                     ExcitationSource source = ExcitationSource::phase) {
  const auto person = simulation.spawn({.height_m = 1.8F, .mass_kg = 80}, {.speed_m_s = speed_m_s});
  if (!person) return person;
  LegMuscles choice;
  choice.method = Method::none;
  choice.muscles = muscle_members();
  choice.line_motion = true;
  choice.activation = source;
  if (auto done = simulation.enable(*person, Feature::forces); !done) return tl::unexpected(done.error());
  if (auto done = simulation.set_muscles(*person, choice); !done) return tl::unexpected(done.error());
  return person;
}

}  // namespace mobil::test
