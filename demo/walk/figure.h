#pragma once
// What a walking person looks like: bones and muscle surfaces, built in or read from an anatomy folder.

#include <filesystem>
#include <optional>
#include <vector>

#include "assets/export/walk_recording.h"
#include "components/surface.h"
#include "systems/simulation.h"

namespace mobil {

/// A muscle surface bound to the mesh of its own muscle, or else of its group; one serves both sides.
struct FigureMuscle {
  Muscle muscle = Muscle::hamstrings;  // whose mesh that is
  Vec3<float> colour{};                // linear
  MuscleSurface surface;
};

struct Figure {
  std::vector<BoneSurface> bones;
  std::vector<FigureMuscle> muscles;
};

/// Surfaces for one person with muscles. Without a folder they are generated from published dimensions. Errors: those
/// of reading and fitting the folder's meshes.
Result<Figure> make_figure(const Simulation& simulation, const Human& human,
                           const std::optional<std::filesystem::path>& anatomy);

/// Begins a recording of the figure: bones, and each muscle's name, triangles and colour, right then left.
WalkRecording begin_recording(const Figure& figure, float frame_s);

/// Adds the person's present pose and skinned muscles as one frame.
void record_frame(const Figure& figure, const Simulation& simulation, const Human& human, WalkRecording& recording);

}  // namespace mobil
