#pragma once
// The muscles of the right leg as lofted surfaces, from measured sections and the body's own volumes.

#include <cstdint>
#include <optional>
#include <vector>

#include <mobil/assets/surfaces/surface_binding.h>
#include <mobil/components/body.h>
#include <mobil/components/muscle.h>
#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// A muscle surface with the meshes that can drive it: its own muscle's where that is simulated, else its group's
/// (tendons and ligaments have no other). `tendon`: one a vertex, 0 in the belly to 1 in the tendon. A ligament follows
/// its two bones alone: bind it with bind_ligament, the others with bind_muscle (surface_binding.h).
struct GroupSurface {
  Muscle group, muscle;
  MuscleSurface surface;
  std::vector<float> tendon;
  Attachments attachments{};
  bool ligament = false;
};

/// The one of the `simulated` muscles whose mesh a surface follows: its own, else its group's, or of a tendon, which
/// has none of its own, that of the group's largest member; nothing where none of them is simulated.
std::optional<Muscle> driving_muscle(const MuscleSet& simulated, Muscle group, Muscle muscle);

/// How muscles are drawn: as they would grow alone, away from the bone; or cut back to the muscle beneath and to the
/// leg's skin, whose measures are mean people's (mobil/assets/body/leg_profile.h), growing until their volume is met.
enum class MuscleRoom : std::uint8_t { alone, together };

/// The members in the order of member_muscles(), then the calcaneal tendon and the patellar ligament; right side, world
/// axes, the body standing in the anatomical position at x = z = 0, m; closed, wound outwards, not bound yet. Each
/// follows its measured path (muscle_table.h) on this body's bones; its girth is set so that it encloses the member's
/// volume, growing away from the bone, and it is cut back where it would enter the femur or the tibia.
std::vector<GroupSurface> make_muscle_surfaces(const Body& body, MuscleRoom room = MuscleRoom::together);

/// Volume of each member in this body, its physique included, m³, in the order of member_muscles().
std::vector<double> member_volumes_m3(const Body& body);

}  // namespace mobil::inline v0_3
