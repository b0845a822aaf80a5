#pragma once
// Recorded walks, of one person or of many: everything that an exporter needs to know, and nothing of how it came
// about.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/components/pose.h>
#include <mobil/components/segments.h>
#include <mobil/components/surface.h>
#include <mobil/forces.h>

namespace mobil::inline v0_3 {

/// One muscle's surface over the whole recording.
struct RecordedMuscle {
  std::string name;
  Segment segment = Segment::pelvis;                 // the segment it hangs under
  Vec3<float> colour{0.45F, 0.08F, 0.07F};           // linear red, green, blue, 0–1
  std::vector<std::uint32_t> triangle;               // three indices each, wound outwards in the world
  std::vector<std::vector<Vec3<float>>> position_m;  // [frame][vertex], in the world (a left muscle as it stands there)
};

/// A surface whose vertices follow several segments, drawn where the body stands (m).
struct SkinnedSurface {
  std::string name;
  std::size_t cloth = 0;  // which of a person's colours it has
  std::vector<Vec3<float>> position, normal;
  std::vector<std::array<std::uint8_t, 4>> joint;  // Segment, of each vertex
  std::vector<std::array<float, 4>> weight;        // add up to 1; 0 where there are fewer
  std::vector<std::uint32_t> triangle;             // three indices each, wound outwards
  /// Of each vertex, where it lies in a texture, to the right and down from its upper left corner, 0 to 1, and which
  /// way on the surface is right there: a unit vector, and 1 where normal × that is up, −1 where it is down. Or none of
  /// both.
  std::vector<std::array<float, 2>> texture{};
  std::vector<std::array<float, 4>> tangent{};
};

/// Surfaces that follow segments, shared by all people who look like that.
struct RecordedFigure {
  std::vector<BoneSurface> surfaces;
  std::vector<std::size_t> cloth;  // of each surface: which of a person's colours it has; empty: the first
  std::vector<SkinnedSurface> skin;
  std::array<Vec3<float>, segment_count> standing_m{};  // where the segments are that the skin is drawn about
};

/// A walk sampled every `frame_s` seconds; frame i is at i · frame_s.
struct WalkRecording {
  double frame_s = 1.0 / 30;
  std::vector<Pose<float>> frames;
  std::vector<BoneSurface> bones;
  std::vector<RecordedMuscle> muscles;        // each with as many frames as `frames`
  std::string name = "walker";                // of the person; in files the root of all that is theirs
  double start_s = 0;                         // when frame 0 was; tables tell times from there, animations from 0
  std::vector<GroundReaction<float>> ground;  // of each frame; none where forces were not simulated
  std::vector<SkinnedSurface> skin;           // besides the bones, in the colours of `colours`; or none
  std::array<Vec3<float>, segment_count> standing_m{};  // where the segments are that the skin is drawn about
  std::vector<Vec3<float>> colours;                     // linear, of cloths: bones', then the skin's; none: ivory
  std::vector<Vec3<float>> tip_m;  // of each segment, its far end in its frame (Body::tip_m); or none
};

/// One of several people.
struct RecordedPerson {
  std::string name;
  std::size_t figure = 0;            // which of CrowdRecording::figures
  Vec3<float> scale{1, 1, 1};        // of its surfaces, along the axes of their segments
  std::vector<Vec3<float>> colours;  // linear, 0–1; where one is missing bones' ivory
  std::vector<Pose<float>> frames;
  std::vector<RecordedMuscle> muscles;
};

/// Several people over the same time: as many frames each, sampled as in WalkRecording.
struct CrowdRecording {
  double frame_s = 1.0 / 30;
  std::vector<RecordedFigure> figures;
  std::vector<RecordedPerson> people;
};

}  // namespace mobil::inline v0_3
