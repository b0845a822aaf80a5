#pragma once
// Architecture of the leg's muscles: fibres, pennation, belly and tendon in a body, from the published columns of the
// table, as `mobil body` writes them. The simulation reads fibre and tendon (MemberPlan).
//
// Sources.
//   Fibres, pennation, belly: Ward, Eng, Smallwood & Lieber, Are current measurements of lower extremity muscle
//     architecture accurate? Clin. Orthop. Relat. Res. 467, 2009; 21 cadavers of 1.684 m. Fibre lengths are at a
//     sarcomere length of 2.7 µm; the belly extends from its first fibre to its last.
//   Tendon and its matching fibre length: the gait2392 model of OpenSim (Delp et al. 1990), with the length of the
//     muscle's path there in the anatomical position. The tendon includes its part within the belly. The model's
//     quadriceps end on the kneecap.
//   A muscle that the model lacks has the path's length less the fibres' as its tendon.
//   Density 1060 kg/m³: Mendez & Keys, Metabolism 9, 1960. Volumes: mobil/muscle_table.h.

#include <vector>

#include <mobil/components/body.h>
#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {

inline constexpr double muscle_density_kg_m3 = 1060;

/// Parameters of a muscle of one leg of one body in the anatomical position. A group has the sums of its members'
/// volume, mass and both sections. Its lengths and angle are means by the members' volumes in the reference body.
struct MuscleParameters {
  double volume_m3 = 0, mass_kg = 0;
  double muscle_tendon_m = 0;  // along the path, L₀
  double belly_m = 0, fibre_m = 0, pennation_deg = 0;
  double model_fibre_m = 0, tendon_m = 0;  // the model's pair: slack tendon and matching fibres
  double section_m2 = 0;                   // volume over belly
  double physiological_section_m2 = 0;     // volume · cos(pennation) over fibre length
};

/// Return the parameters. Belly and fibres scale with stature, tendon and its fibres with the muscle's path, as in
/// OpenSim. The volume is member_volume_m3's (mobil/assets/muscles/muscle_plan.h).
MuscleParameters member_parameters(const Body& body, const MemberMuscle& member);
MuscleParameters muscle_parameters(const Body& body, Muscle muscle);

/// A point to which a muscle is fixed or round which it bends, right leg in the anatomical position, m.
struct PathPlace {
  LegBone bone;
  Vec3<double> in_bone_m, world_m;  // in the bone's frame (muscle_table.h); the body standing at x = z = 0
};
/// Returns the places from origin to insertion, without edges that the path clears in this position. A path that ends
/// on the kneecap ends there in the shank's frame.
std::vector<PathPlace> member_places(const Body& body, const MemberMuscle& member);

}  // namespace mobil::inline v0_3
