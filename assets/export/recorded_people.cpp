#include "assets/export/recorded_people.h"

#include <algorithm>

namespace mobil::inline v0_3 {

namespace {

template <class Recorded>
const RecordedFacts* facts_of(const Recorded& recorded) {
  return recorded.facts ? &*recorded.facts : nullptr;
}

}  // namespace

std::vector<Vec3<float>> tissue_colours(const RecordedMuscle& muscle) {
  constexpr Vec3<float> tendon_colour{0.62F, 0.53F, 0.42F};
  std::vector<Vec3<float>> colours;
  for (const Tissue& tissue : muscle.tissue) {
    const float share = tendon_colour_share(tissue);
    const auto mixed = [share](float own, float tendon) { return (1 - share) * own + share * tendon; };
    colours.push_back({mixed(muscle.colour.x, tendon_colour.x), mixed(muscle.colour.y, tendon_colour.y),
                       mixed(muscle.colour.z, tendon_colour.z)});
  }
  return colours;
}

std::size_t SeenFigure::cloths() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) count = std::max(count, cloth_of(i) + 1);
  for (const SkinnedSurface& surface : skin) count = std::max(count, surface.cloth + 1);
  return count;
}

RecordedPeople recorded_people(const WalkRecording& recording) {
  RecordedPeople seen;
  seen.frame_s = recording.frame_s;
  seen.is_walk = true;
  seen.figures.push_back({recording.bones, {}, recording.skin, recording.standing_m, recording.z_back});
  seen.people.push_back({recording.name,
                         0,
                         {1, 1, 1},
                         recording.colours,
                         &recording.frames,
                         recording.muscles,
                         recording.root,
                         facts_of(recording),
                         recording.loops,
                         recording.z_back});
  return seen;
}

RecordedPeople recorded_people(const CrowdRecording& recording) {
  RecordedPeople seen;
  seen.frame_s = recording.frame_s;
  for (const RecordedFigure& figure : recording.figures)
    seen.figures.push_back({figure.surfaces, figure.cloth, figure.skin, figure.standing_m, recording.z_back});
  for (const RecordedPerson& person : recording.people) {
    seen.people.push_back({person.name, person.figure, person.scale, person.colours, &person.frames, person.muscles,
                           person.root, facts_of(person), false, recording.z_back});
  }
  return seen;
}

}  // namespace mobil::inline v0_3
