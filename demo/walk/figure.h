#pragma once
// The figure of a walking person, with generated surfaces or real meshes, and its recording.

#include <optional>
#include <string>
#include <vector>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/simulation.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/surface_contacts.h>

namespace mobil {

struct Figure {
  std::vector<BoneSurface> bones;
  BodySurfaces muscles;  // right and left; with contacts also bones, which are not drawn from here
  std::optional<SurfaceContacts> contacts;
  std::vector<std::string> said;    // about the folder and its meshes, "FILE: …"
  std::vector<SurfaceMesh> skins;   // of right legs, if the folder has some (mobil/assets/surfaces/custom_skin.h)
  std::vector<Vec3<float>> rest_m;  // with skins, all vertices of the right leg's muscles at rest
};

/// Generates surfaces for one person with muscles from published dimensions. `contact` keeps muscles from penetrating
/// each other and bones.
Result<Figure> make_figure(const Person& person, bool contact = false);

/// Returns the person's muscles with a mesh that a surface can follow, without bones.
SurfaceChoice simulated_surfaces(const Person& person);

/// Binds surfaces to the meshes of the person's muscles.
Result<Figure> bound_figure(const Person& person, DrawnSurfaces drawn, const SurfaceChoice& choice, bool contact);

/// Begins a recording of the figure: bones, and each muscle's name, triangles and colour, right then left.
WalkRecording begin_recording(const Figure& figure, double frame_s);

/// Adds the person's current pose and surfaces as one frame.
void record_frame(const Figure& figure, const Simulation& simulation, const Person& person, WalkRecording& recording);

}  // namespace mobil
