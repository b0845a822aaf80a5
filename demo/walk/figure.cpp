#include "demo/walk/figure.h"

#include <algorithm>
#include <array>

#include "assets/import/fit_anatomy.h"
#include "assets/surfaces/bone_surfaces.h"
#include "assets/surfaces/muscle_surfaces.h"
#include "assets/surfaces/surface_binding.h"
#include "assets/surfaces/surface_mesh.h"
#include "engine/geometry.h"
#include "systems/skinning/skinning.h"

namespace mobil {
namespace {

constexpr double blend_per_height = 0.04 / 1.80;
constexpr Vec3<float> belly_colour{0.40F, 0.055F, 0.04F}, tendon_colour{0.62F, 0.53F, 0.42F};

/// The mesh of one person's muscle: the template's nodes at the person's size.
HexahedralMesh individual_cage(const MuscleTemplate& shape, const BellyScale<float>& scale) {
  HexahedralMesh cage = shape.mesh;
  for (auto& node : cage.node) {
    node.x *= static_cast<double>(scale.across);
    node.y *= static_cast<double>(scale.across);
    node.z *= static_cast<double>(scale.along);
  }
  return cage;
}

bool is_tendon(const std::string& name) {
  return name.find("tendon") != std::string::npos || name.find("ligament") != std::string::npos;
}

/// Those with a belly, whose mesh a surface may follow.
MuscleSet simulated(const Simulation& simulation, const Human& human) {
  MuscleSet set;
  for (const HumanMuscle& own : human.muscles) {
    const bool belly = simulation.world().shared<MuscleTemplate>(own.entity[right]) != nullptr;
    set.set(static_cast<std::size_t>(own.plan.muscle), belly);
  }
  return set;
}

/// Binds a surface, and what there is of it beyond the kneecap, to the mesh of the muscle that drives it.
void bind(const Simulation& simulation, const Human& human, Muscle driver, const Attachments& attachments,
          MuscleSurface& surface, Ligament* beyond = nullptr) {
  const auto& [plan, entity, method] = *std::find_if(
      human.muscles.begin(), human.muscles.end(), [driver](const HumanMuscle& m) { return m.plan.muscle == driver; });
  const auto* shape = simulation.world().shared<MuscleTemplate>(entity[right]);
  const HexahedralMesh cage = individual_cage(*shape, plan.scale);
  const RestFrame frame{geometry::to_float(plan.start_m), geometry::to_float(plan.rotation)};
  const Passages passages = bind_muscle(surface, cage, frame, attachments,
                                        blend_per_height * static_cast<double>(human.body.request.height_m));
  if (beyond != nullptr) bind_beyond(beyond->surface, surface, cage, frame, passages, beyond->ends);
}

FigureMuscle figure_muscle(Muscle muscle, MuscleSurface surface) {
  const Vec3<float> colour = is_tendon(surface.mesh.name) ? tendon_colour : belly_colour;
  return {muscle, colour, std::move(surface)};
}

Result<Figure> real_figure(const Simulation& simulation, const Human& human, const std::filesystem::path& folder) {
  const auto anatomy = load_anatomy(folder.string());
  if (!anatomy) return tl::unexpected(anatomy.error());
  auto fitted = fit_anatomy(*anatomy, human.body);
  if (!fitted) return tl::unexpected(fitted.error());
  Figure figure;
  // The folder holds a pelvis and legs; the rest of the skeleton is generated.
  std::array<bool, segment_count> real{};
  for (const auto& bone : fitted->bones) real[index(bone.segment)] = true;
  figure.bones = std::move(fitted->bones);
  for (auto& bone : make_bone_surfaces(human.body)) {
    if (!real[index(bone.segment)]) figure.bones.push_back(std::move(bone));
  }
  for (auto& muscle : fitted->muscles) {
    const auto driver = driving_muscle(simulated(simulation, human), muscle.group, muscle.muscle);
    if (!driver) continue;
    auto ligament = cut_at_kneecap(muscle, human.body);
    bind(simulation, human, *driver, muscle.attachments, muscle.surface, ligament ? &*ligament : nullptr);
    figure.muscles.push_back(figure_muscle(*driver, std::move(muscle.surface)));
    if (ligament) figure.muscles.push_back(figure_muscle(*driver, std::move(ligament->surface)));
  }
  return figure;
}

}  // namespace

Result<Figure> make_figure(const Simulation& simulation, const Human& human,
                           const std::optional<std::filesystem::path>& anatomy) {
  if (anatomy) return real_figure(simulation, human, *anatomy);
  Figure figure;
  figure.bones = make_bone_surfaces(human.body);
  for (auto& muscle : make_muscle_surfaces(human.body)) {
    const auto driver = driving_muscle(simulated(simulation, human), muscle.group, muscle.muscle);
    if (!driver) continue;
    if (muscle.ligament) {
      bind_ligament(muscle.surface, muscle.attachments.origin_m, muscle.attachments.insertion_m);
    } else {
      bind(simulation, human, *driver, muscle.attachments, muscle.surface);
    }
    figure.muscles.push_back(figure_muscle(*driver, std::move(muscle.surface)));
  }
  return figure;
}

WalkRecording begin_recording(const Figure& figure, float frame_s) {
  WalkRecording recording;
  recording.frame_s = frame_s;
  recording.bones = figure.bones;
  for (const auto& muscle : figure.muscles) {
    std::string name = muscle.surface.mesh.name;
    if (name.ends_with("_right")) name.resize(name.size() - 6);
    for (std::size_t side = 0; side < 2; ++side) {
      RecordedMuscle recorded;
      recorded.name = name + (side == right ? "_right" : "_left");
      recorded.segment = on_side(
          muscle_row(muscle.muscle).drawn.along == LegBone::shank ? Segment::shank_right : Segment::thigh_right, side);
      recorded.colour = muscle.colour;
      recorded.triangle = muscle.surface.mesh.triangle;
      if (side == left) turn_over(recorded.triangle);
      recording.muscles.push_back(std::move(recorded));
    }
  }
  return recording;
}

void record_frame(const Figure& figure, const Simulation& simulation, const Human& human, WalkRecording& recording) {
  const auto pose = simulation.get<Pose>(human.entity);
  if (!pose) return;
  recording.frames.push_back(*pose);
  std::size_t next = 0;
  for (const auto& muscle : figure.muscles) {
    for (std::size_t side = 0; side < 2; ++side) {
      const Entity entity = simulation.muscle(human.entity, muscle.muscle, static_cast<Side>(side));
      const auto line = simulation.get<LineOfAction>(entity);
      const auto nodes = simulation.nodal_displacement(entity);
      auto& out = recording.muscles[next++].position_m.emplace_back(muscle.surface.mesh.position.size());
      if (!line || nodes.first == nullptr) continue;
      const SkinPose skin = skin_pose(muscle.surface, static_cast<Side>(side), human.body, *pose, *line);
      skin_surface(muscle.surface, skin, {nodes.first, lane_count, nodes.nodes}, side == left, out);
    }
  }
}

}  // namespace mobil
