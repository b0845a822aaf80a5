#include <mobil/systems/surfaces/body_surfaces.h>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/assets/surfaces/muscle_surfaces.h>
#include <mobil/engine/geometry.h>
#include "assets/surfaces/bone_surfaces.h"
#include "assets/surfaces/coarser_surface.h"
#include "assets/surfaces/leg_bones.h"
#include "assets/surfaces/muscle_lattice.h"
#include "assets/surfaces/surface_mesh.h"
#include "assets/surfaces/tissue.h"

namespace mobil::inline v0_3 {
namespace {

constexpr double passage_per_height = 0.04 / 1.80;

struct Texture {
  std::vector<TexturePlace> place;
  std::vector<AlongStencil> along;
};
/// Returns nothing if triangles have missing vertices. Packing reports that error.
Texture texture_of(const SurfaceMesh& mesh, std::vector<TexturePlace> place) {
  const auto there = [&](std::uint32_t v) { return v < place.size(); };
  if (mesh.triangle.size() % 3 != 0 || !std::ranges::all_of(mesh.triangle, there)) return {};
  auto along = along_stencils(mesh.triangle, place);
  for (TexturePlace& one : place) one = folded(one);
  return {std::move(place), std::move(along)};
}

/// Returns the vertex of the finer mesh that is nearest to each of the coarser one.
std::vector<std::size_t> nearest_vertices(const SurfaceMesh& fine, const SurfaceMesh& coarse) {
  std::vector<std::size_t> nearest;
  for (const Vec3<float>& at : coarse.position) {
    const auto away = [&](const Vec3<float>& p) {
      const float x = p.x - at.x, y = p.y - at.y, z = p.z - at.z;
      return x * x + y * y + z * z;
    };
    const auto found = std::ranges::min_element(fine.position, {}, away);
    nearest.push_back(static_cast<std::size_t>(found - fine.position.begin()));
  }
  return nearest;
}

struct Binding {
  const Body& body;
  const SurfaceChoice& choice;
  BodySurfaces made;

  std::uint32_t add_part(std::string name, Segment segment, std::optional<Muscle> driver, Side side,
                         const SurfaceMesh& mesh, std::span<const TexturePlace> texture,
                         const MuscleTissue& tissue = {});
  Result<std::size_t> driver_of(Muscle muscle);
  Result<void> add(const BoneSurface& bone);
  Result<void> add(const DrivenSurface& muscle);
};

std::uint32_t Binding::add_part(std::string name, Segment segment, std::optional<Muscle> driver, Side side,
                                const SurfaceMesh& mesh, std::span<const TexturePlace> texture,
                                const MuscleTissue& tissue) {
  SurfacePart part{std::move(name), segment, driver, side, made.vertices, 0, 0, 0, tissue.fibres};
  part.vertices = static_cast<std::uint32_t>(mesh.position.size());
  part.first_index = static_cast<std::uint32_t>(made.index.size());
  part.indices = static_cast<std::uint32_t>(mesh.triangle.size());
  std::vector<std::uint32_t> triangle = mesh.triangle;
  if (driver && side == Side::left) turn_over(triangle);
  for (const std::uint32_t v : triangle) made.index.push_back(made.vertices + v);
  if (choice.textured) made.texture.insert(made.texture.end(), texture.begin(), texture.end());
  made.tissue.insert(made.tissue.end(), tissue.vertex.begin(), tissue.vertex.end());
  made.vertices += part.vertices;
  made.tissue.resize(made.vertices);
  made.part.push_back(std::move(part));
  return static_cast<std::uint32_t>(made.part.size() - 1);
}

Result<std::size_t> Binding::driver_of(Muscle muscle) {
  const auto known = std::ranges::find(made.driver, muscle, &BodySurfaces::Driver::muscle);
  if (known != made.driver.end()) return static_cast<std::size_t>(known - made.driver.begin());
  const auto rest = rest_mesh(body, muscle, choice.cells);
  if (!rest) return tl::unexpected(rest.error());
  const auto& node = rest->lattice.node;
  BodySurfaces::Driver driver{
      muscle, make_muscle_plan(body, muscle)->scale, static_cast<std::uint32_t>(node.size()), {}};
  for (const auto& n : node) driver.along.push_back(static_cast<float>(n.z / node.back().z));
  made.max_nodes = std::max(made.max_nodes, node.size());
  made.driver.push_back(std::move(driver));
  return made.driver.size() - 1;
}

Result<void> Binding::add(const BoneSurface& bone) {
  const std::string_view name = segment_name[index(bone.segment)];
  const Side side = name.ends_with("_left") ? Side::left : Side::right;
  const bool in_the_middle = side == Side::right && !name.ends_with("_right");
  if (in_the_middle ? !choice.sides[Side::right] && !choice.sides[Side::left] : !choice.sides[side]) return {};
  const Texture texture = choice.textured ? texture_of(bone.mesh, texture_places(bone.mesh.position)) : Texture{};
  auto rigid = pack_rigid(bone.mesh, texture.along);
  if (!rigid) return tl::unexpected(rigid.error());
  const std::uint32_t part = add_part(bone.mesh.name, bone.segment, std::nullopt, side, bone.mesh, texture.place);
  made.piece.push_back({std::move(*rigid), 0, {part, std::nullopt}});
  return {};
}

Result<void> Binding::add(const DrivenSurface& muscle) {
  const auto driver = driver_of(muscle.driver);
  if (!driver) return tl::unexpected(driver.error());
  const auto axes = geometry::columns(muscle.surface.rest_rotation);
  const SurfaceMesh& mesh = muscle.surface.mesh;
  const std::vector<TexturePlace> places = texture_places(mesh.position, axes[2], axes[1]);
  const Texture texture = choice.textured ? texture_of(mesh, places) : Texture{};
  auto packed = pack_surface(muscle.surface, body, made.driver[*driver].nodes, texture.along);
  if (!packed) return tl::unexpected(packed.error());
  made.max_places = std::max(made.max_places, packed->places());
  const MuscleTissue tissue = muscle_tissue(body, muscle.muscle, mesh, places, muscle.tendon);
  const std::string name = mesh.name.ends_with("_right") ? mesh.name.substr(0, mesh.name.size() - 6) : mesh.name;
  BodySurfaces::Piece piece{std::move(*packed), *driver, {}};
  for (const Side side : {Side::right, Side::left}) {
    if (!choice.sides[side]) continue;
    const Segment segment = on_side(on_shank(muscle.driver) ? Segment::shank_right : Segment::thigh_right, side);
    piece.part[side] = add_part(name + (side == Side::right ? "_right" : "_left"), segment, muscle.driver, side, mesh,
                                texture.place, tissue);
  }
  made.piece.push_back(std::move(piece));
  return {};
}

}  // namespace

Result<RestMesh> rest_mesh(const Body& body, Muscle muscle, const Cells& cells) {
  const auto plan = make_muscle_plan(body, muscle);
  if (!plan) return tl::unexpected(plan.error());
  auto lattice = bend_block(cells, muscle_lattice(muscle), reference_belly_m(muscle), belly_grading);
  if (!lattice) return tl::unexpected(lattice.error());
  for (auto& node : lattice->node) {
    node.x *= static_cast<double>(plan->scale.across);
    node.y *= static_cast<double>(plan->scale.across);
    node.z *= static_cast<double>(plan->scale.along);
  }
  const RestFrame frame{geometry::to_float(plan->start_m), geometry::to_float(plan->rotation)};
  return RestMesh{std::move(*lattice), frame, passage_per_height * static_cast<double>(body.request.height_m)};
}

Result<DrawnSurfaces> draw_surfaces(const Body& body, const SurfaceChoice& choice) {
  DrawnSurfaces drawn;
  if (!(choice.detail >= 0.05 && choice.detail <= 1))
    return fail(fmt::format("surfaces of {} of their triangles; choose 0.05 to 1", choice.detail));
  if (choice.detail < 1 && !can_be_coarser())
    return fail("this library was built without what makes surfaces coarser (MOBIL_PORTABLE); choose a detail of 1");
  if (choice.bones) drawn.bones = make_bone_surfaces(body);
  for (BoneSurface& bone : drawn.bones) bone.mesh = coarser(bone.mesh, choice.detail);
  if (choice.simulated.none()) return drawn;
  if (choice.clear_of_bones) drawn.clear_of = std::make_shared<const LegBones>(body);
  for (auto& muscle : make_muscle_surfaces(body, choice.simulated)) {
    const auto driver = driving_muscle(choice.simulated, muscle.group, muscle.muscle);
    const SurfaceMesh fine = std::exchange(muscle.surface.mesh, {});
    muscle.surface.mesh = coarser(fine, choice.detail);
    if (choice.detail < 1) {
      const std::vector<std::size_t> nearest = nearest_vertices(fine, muscle.surface.mesh);
      for (auto* values : {&muscle.tendon, &muscle.surface.origin_held, &muscle.surface.insertion_held}) {
        const std::vector<float> was = std::exchange(*values, {});
        if (was.empty()) continue;
        for (const std::size_t v : nearest) values->push_back(was[v]);
      }
    }
    if (muscle.ligament) {
      bind_ligament(muscle.surface, muscle.attachments.origin_m, muscle.attachments.insertion_m);
    } else {
      const auto mesh = rest_mesh(body, *driver, choice.cells);
      if (!mesh) return tl::unexpected(mesh.error());
      bind_muscle(muscle.surface, mesh->lattice, mesh->frame, muscle.attachments, mesh->min_passage_m);
    }
    drawn.muscles.push_back({*driver, muscle.muscle, std::move(muscle.surface), std::move(muscle.tendon)});
  }
  return drawn;
}

Result<BodySurfaces> bind_surfaces(const Body& body, const DrawnSurfaces& drawn, const SurfaceChoice& choice) {
  Binding binding{body, choice, {}};
  const BoneScales scales = bone_scales(body);
  for (std::size_t s = 0; s < segment_count; ++s) binding.made.bone_scale[s] = geometry::to_float(scales[s]);
  binding.made.sides = choice.sides;
  binding.made.clear_of = drawn.clear_of;
  for (const BoneSurface& bone : drawn.bones) {
    if (auto done = binding.add(bone); !done) return tl::unexpected(done.error());
  }
  for (const DrivenSurface& muscle : drawn.muscles) {
    if (auto done = binding.add(muscle); !done) return tl::unexpected(done.error());
  }
  return std::move(binding.made);
}

Result<BodySurfaces> bind_surfaces(const Body& body, const SurfaceChoice& choice) {
  const auto drawn = draw_surfaces(body, choice);
  if (!drawn) return tl::unexpected(drawn.error());
  return bind_surfaces(body, *drawn, choice);
}

SurfaceFit fit_surfaces(const BodySurfaces& bound, const Body& body) {
  SurfaceFit fit;
  const BoneScales scales = bone_scales(body);
  for (std::size_t s = 0; s < segment_count; ++s) {
    const Vec3<float> own = geometry::to_float(scales[s]), &was = bound.bone_scale[s];
    fit.bone[s] = {own.x / was.x, own.y / was.y, own.z / was.z};
  }
  for (const BodySurfaces::Driver& driver : bound.driver) {
    const auto plan = make_muscle_plan(body, driver.muscle);
    assert(plan);
    const BellyScale<float> own = plan->scale;
    fit.belly.push_back({own.across / driver.scale.across, own.along / driver.scale.along});
  }
  return fit;
}

}  // namespace mobil::inline v0_3
