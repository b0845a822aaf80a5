#pragma once
// One view of a walk or a crowd for writers. Nothing is copied, so the recording must outlive this.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <mobil/assets/export/walk_recording.h>

namespace mobil::inline v0_3 {

/// Linear red, green, blue, 0–1.
inline constexpr Vec3<float> ivory_colour{0.80F, 0.74F, 0.60F};

/// Returns the colours of a muscle's vertices: its own, tendons and aponeuroses lighter; nothing without tissue.
std::vector<Vec3<float>> tissue_colours(const RecordedMuscle& muscle);

struct SeenFigure {
  std::span<const BoneSurface> surfaces;
  std::span<const std::size_t> cloth;  // as in RecordedFigure
  std::span<const SkinnedSurface> skin;
  std::span<const Vec3<float>> standing_m;
  bool z_back = false;
  std::size_t cloth_of(std::size_t surface) const { return cloth.empty() ? 0 : cloth[surface]; }
  /// Returns true if the recording has a rest pose.
  bool has_standing() const { return standing_m[index(Segment::head)].y != standing_m[index(Segment::foot_right)].y; }
  /// Returns one more than the largest cloth; 0 without surfaces.
  std::size_t cloths() const;
};

struct SeenPerson {
  std::string name;
  std::size_t figure = 0;
  Vec3<float> scale{1, 1, 1};
  std::span<const Vec3<float>> colours;
  const std::vector<Pose<float>>* frames = nullptr;
  std::span<const RecordedMuscle> muscles;
  std::span<const RecordedRoot> root;
  const RecordedFacts* facts = nullptr;  // or null
  bool loops = false, z_back = false;
  Vec3<float> colour(std::size_t cloth) const { return cloth < colours.size() ? colours[cloth] : ivory_colour; }
};

struct RecordedPeople {
  double frame_s = 0;
  bool is_walk = false;  // of one person, not of a crowd
  std::vector<SeenFigure> figures;
  std::vector<SeenPerson> people;
  /// Returns the beginning of a person's part names: the person's own name if there are several people.
  std::string prefix(const SeenPerson& person) const { return people.size() > 1 ? person.name + "_" : ""; }
};

RecordedPeople recorded_people(const WalkRecording& recording);
RecordedPeople recorded_people(const CrowdRecording& recording);

}  // namespace mobil::inline v0_3
