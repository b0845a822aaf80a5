#pragma once
// The muscles of the right leg as lofted surfaces, from measured sections and the body's own volumes.

#include <cstdint>
#include <optional>
#include <vector>

#include <mobil/assets/surfaces/surface_binding.h>
#include <mobil/components/body.h>
#include <mobil/components/muscle.h>
#include <mobil/components/surface.h>
#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {

/// A muscle surface with the muscles whose meshes can drive it: its own if that is simulated, else its group (tendons
/// and ligaments have only that). `tendon` has one value per vertex, 0 in the belly to 1 in the tendon. A ligament
/// follows only its two bones: bind it with bind_ligament, the others with bind_muscle (surface_binding.h).
struct GroupSurface {
  Muscle group, muscle;
  MuscleSurface surface;
  std::vector<float> tendon;
  Attachments attachments{};
  bool ligament = false;
};

/// Returns the `simulated` muscle whose mesh a surface follows: its own, else its group's. A tendon without either
/// follows the largest simulated member of its group. Returns nothing if none is simulated.
std::optional<Muscle> driving_muscle(const MuscleSet& simulated, Muscle group, Muscle muscle);

/// Room of drawn muscles. `alone` grows each by itself, away from the bone, and cuts it back to the measured femur,
/// tibia and fibula. `together` spreads its ends on the drawn bones, and cuts it back to these, to the muscle beneath and
/// to the skin of mean people (mobil/assets/body/leg_profile.h), growing it to its volume.
enum class MuscleRoom : std::uint8_t { alone, together };

/// Returns the single muscles that `simulated` ones drive, in the order of member_muscles(), then the calcaneal tendon,
/// the iliotibial tract and the patellar ligament. They are of the right side in world axes, the body standing in the
/// anatomical position at x = z = 0, m; closed, wound outwards, not yet bound. Each follows its measured path
/// (muscle_table.h) on this body's bones. Its girth encloses the muscle's volume, growing away from the bone. Takes a
/// tenth of a second, the first call a second more.
std::vector<GroupSurface> make_muscle_surfaces(const Body& body, const MuscleSet& simulated = usual_muscles(),
                                               MuscleRoom room = MuscleRoom::together);

}  // namespace mobil::inline v0_3
