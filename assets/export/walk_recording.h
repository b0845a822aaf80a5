#pragma once
// A recorded walk: everything that an exporter needs to know, and nothing of how it came about.

#include <cstdint>
#include <string>
#include <vector>

#include "components/lanes.h"
#include "components/pose.h"
#include "components/segments.h"
#include "components/surface.h"

namespace mobil {

/// One muscle's surface over the whole recording.
struct RecordedMuscle {
  std::string name;
  Segment segment = Segment::pelvis;                 // the segment it hangs under
  Vec3<float> colour{0.45F, 0.08F, 0.07F};           // linear red, green, blue, 0–1
  std::vector<std::uint32_t> triangle;               // three indices each, wound outwards in the world
  std::vector<std::vector<Vec3<float>>> position_m;  // [frame][vertex], in the world (a left muscle as it stands there)
};

/// A walk sampled every `frame_s` seconds; frame i is at i · frame_s.
struct WalkRecording {
  float frame_s = 1.0F / 30.0F;
  std::vector<Pose<float>> frames;
  std::vector<BoneSurface> bones;
  std::vector<RecordedMuscle> muscles;  // each with as many frames as `frames`
};

}  // namespace mobil
