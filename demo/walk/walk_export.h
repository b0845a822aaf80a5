#pragma once
// Recordings of `mobil walk` for other programs: skins as they are drawn, cycles, and the way of roots.

#include <mobil/assets/export/walk_recording.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>
#include "demo/walk/drawn_skin.h"
#include "demo/walk/walk_options.h"

namespace mobil {

/// Frames of a walk: ticks last `tick_s`, and every second one is a picture.
struct WalkTiming {
  double tick_s = 1.0 / 60;
  std::uint32_t warm_up_ticks = 0, ticks = 0;
};

/// Returns the timing of whole strides, at about 30 pictures a second, or of `seconds` without --cycle. A cycle begins
/// after four strides, when muscles move steadily, and has a picture at both ends. Errors: as Simulation::spawn.
Result<WalkTiming> walk_timing(const WalkOptions& options);

/// Returns a person's facts for exporters.
RecordedFacts recorded_facts(const BodyRequest& body, const Gait<float>& gait, float heading_rad);

/// Adds a person's present root.
Result<void> record_root(const Simulation& simulation, Entity person, std::vector<RecordedRoot>& root);

/// Makes a cycle's last frame its first one after the way. Fails if muscles do not move steadily.
Result<void> close_walk(WalkRecording& recording);

/// Records where a skin is drawn in each frame, over the muscles. The recording's surfaces are those of `skin`.
void record_drawn_skin(DrawnSkin skin, WalkRecording& recording);

/// Recordings as the options want them in files: without the way for --in-place, with roots for --root-motion, pictures
/// in the axes of --axes.
struct WalkFiles {
  WalkRecording pictures, ticks;
  std::optional<WalkRecording> dressed;  // for formats with skins, if they do not have bones and muscles as well
  const WalkRecording& skinned() const { return dressed ? *dressed : pictures; }
};
WalkFiles walk_files(WalkRecording pictures, WalkRecording ticks, const WalkOptions& options);

}  // namespace mobil
