#pragma once
// Recorded walks, of one person or of many: all data that an exporter needs, however they were simulated.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
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
  Segment segment = Segment::pelvis;                 // the segment that is its parent
  Vec3<float> colour{0.45F, 0.08F, 0.07F};           // linear red, green, blue, 0–1
  std::vector<std::uint32_t> triangle;               // three indices each, wound outwards in the world
  std::vector<std::vector<Vec3<float>>> position_m;  // [frame][vertex], in the world (a left muscle as it stands there)
  std::vector<Tissue> tissue = {};                   // of each vertex; empty: `colour` alone
  FibreScale fibres = {};                            // of the tissue
};

/// A surface whose vertices follow several segments, in the place of the standing body (m).
struct SkinnedSurface {
  std::string name;
  std::size_t cloth = 0;  // which of a person's colours it has
  std::vector<Vec3<float>> position, normal;
  std::vector<std::array<std::uint8_t, 4>> joint;  // Segment, of each vertex
  std::vector<std::array<float, 4>> weight;        // add up to 1; 0 for unused joints
  std::vector<std::uint32_t> triangle;             // three indices each, wound outwards
  /// Texture place of each vertex, to the right and down from the texture's upper left corner, 0 to 1. The tangent is
  /// the unit vector of the texture's right on the surface, then 1 if normal × tangent is up, −1 if it is down. Both
  /// can be empty.
  std::vector<std::array<float, 2>> texture{};
  std::vector<std::array<float, 4>> tangent{};
  /// Vertices in the world as they are drawn, [frame][vertex], of a WalkRecording; or empty. Formats with morph targets
  /// add them to the blended joints, so that the skin covers bones and muscles. All of a skin's surfaces have them, or
  /// none.
  std::vector<std::vector<Vec3<float>>> drawn_m{};
};

/// Surfaces that follow segments, shared by people of the same look.
struct RecordedFigure {
  std::vector<BoneSurface> surfaces;
  std::vector<std::size_t> cloth;  // of each surface, a number of a person's colours; empty: the first
  std::vector<SkinnedSurface> skin;
  std::array<Vec3<float>, segment_count> standing_m{};  // as in WalkRecording; needed with a skin
};

/// A person's place on the ground and heading (Root, mobil/systems/poses/roots.h): rad about +Y, 0 toward +Z, or toward
/// −Z in a recording that put_z_back has turned.
struct RecordedRoot {
  double x_m = 0, z_m = 0;
  float heading_rad = 0;
};

/// Facts about a person. GLB has them as `extras` of the root node.
struct RecordedFacts {
  std::string sex;
  float height_m = 0, mass_kg = 0;
  float heading_rad = 0;              // of the first frame
  float stride_s = 0, speed_m_s = 0;  // of the gait; 0 for standing people
};

/// A walk sampled every `frame_s` seconds; frame i is at i · frame_s.
struct WalkRecording {
  double frame_s = 1.0 / 30;
  std::vector<Pose<float>> frames;
  std::vector<BoneSurface> bones;
  std::vector<RecordedMuscle> muscles;        // each with as many frames as `frames`
  std::string name = "walker";                // of the person; in files the root of all their parts
  double start_s = 0;                         // time of frame 0; tables start there, animations at 0
  std::vector<GroundReaction<float>> ground;  // of each frame; empty without simulated forces
  std::vector<SkinnedSurface> skin;           // in addition to the bones, in `colours`; can be empty
  /// Origins of the segments in the rest pose, in which no segment is turned (standing_pose, mobil/anthropometry.h).
  /// The skin is drawn for it. Without a skin it can be left at 0; segments then have their mean offsets.
  std::array<Vec3<float>, segment_count> standing_m{};
  std::vector<Vec3<float>> colours;  // linear, of cloths: bones', then the skin's; empty: ivory
  std::vector<Vec3<float>> tip_m;    // of each segment, its far end in its frame (Body::tip_m); can be empty
  std::vector<RecordedRoot> root{};  // of each frame, in GLB and USD the motion of the person's root; can be empty
  std::optional<RecordedFacts> facts{};
  bool loops = false;   // the last frame is the first one after the way (close_cycle)
  bool z_back = false;  // turned by put_z_back (recorded_axes.h)
  /// Poses `motion_difference_s` before and after each frame (mobil/forces.h), from which MJCF has velocities and
  /// accelerations; or empty.
  std::vector<std::array<Pose<float>, 2>> around{};
};

/// One of several people.
struct RecordedPerson {
  std::string name;
  std::size_t figure = 0;            // number in CrowdRecording::figures
  Vec3<float> scale{1, 1, 1};        // of its surfaces, along the axes of their segments
  std::vector<Vec3<float>> colours;  // linear, 0–1; bones' ivory where one is missing
  std::vector<Pose<float>> frames;
  std::vector<RecordedMuscle> muscles;
  std::vector<RecordedRoot> root{};  // as in WalkRecording
  std::optional<RecordedFacts> facts{};
};

/// Several people over the same time, with the same number of frames, sampled as in WalkRecording.
struct CrowdRecording {
  double frame_s = 1.0 / 30;
  std::vector<RecordedFigure> figures;
  std::vector<RecordedPerson> people;
  bool z_back = false;  // as in WalkRecording
};

}  // namespace mobil::inline v0_3
