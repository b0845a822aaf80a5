#include <mobil/assets/surfaces/body_skin.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <span>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/body_composition.h>
#include <mobil/engine/interrupt.h>
#include "assets/body/body_scales.h"
#include "assets/body/growth.h"
#include "assets/surfaces/carried_skin.h"
#include "assets/surfaces/coarser_surface.h"
#include "assets/surfaces/form_mesh.h"
#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;
using form::BodyForm;
using form::TrunkFit;

using SkinMeshes = std::array<SkinMesh, skin_details>;

constexpr double min_fit = 0.7, max_fit = 1.4, min_thighs = 0.9;  // limits of a plausible body

std::vector<Vec> normals(const std::vector<std::uint32_t>& triangle, const std::vector<Vec>& place) {
  std::vector<Vec> normal(place.size(), Vec{0, 0, 0});
  for (std::size_t t = 0; t < triangle.size(); t += 3) {
    const std::uint32_t* v = &triangle[t];
    const Vec twice = cross(place[v[1]] - place[v[0]], place[v[2]] - place[v[0]]);
    for (std::size_t k = 0; k < 3; ++k) normal[v[k]] = normal[v[k]] + twice;
  }
  for (Vec& n : normal) n = length(n) > 0 ? normalised(n) : Vec{0, 1, 0};
  return normal;
}

constexpr std::array<int, skin_details> shared_turns = {256, 96, 40, 16};  // steps of a joint's angle

/// Returns the arms' share of a vertex, from the shoulder joint on.
double share_of_arm(const std::vector<SkinFrame>& frames, const SkinVertex& vertex) {
  double share = 0;
  for (std::size_t k = 0; k < SkinVertex::max_frames; ++k) {
    if (vertex.weight[k] == 0) continue;
    const std::size_t to = segment_of(frames[vertex.frame[k]].to);
    const bool is_arm = to >= index(Segment::clavicle_right) && to <= index(Segment::thumb_left);
    share += is_arm ? static_cast<double>(vertex.weight[k]) : 0;
  }
  return std::min(share, 1.0);
}

SkinMesh make_mesh(const BodyForm& form, const Body& body, SurfaceMesh surface, SkinDetail detail) {
  SkinMesh mesh;
  const std::vector<SkinPart> part = cut_clothes(form, surface, detail <= SkinDetail::near);
  for (const Vec3<float>& p : surface.position) mesh.place.push_back(to_double(p));
  for (std::size_t one = 0; one < skin_parts; ++one) {
    mesh.first_triangle[one] = static_cast<std::uint32_t>(mesh.triangle.size() / 3);
    for (std::size_t t = 0; t < part.size(); ++t) {
      if (part[t] != static_cast<SkinPart>(one)) continue;
      for (std::size_t k = 0; k < 3; ++k) mesh.triangle.push_back(surface.triangle[3 * t + k]);
    }
  }
  mesh.first_triangle[skin_parts] = static_cast<std::uint32_t>(mesh.triangle.size() / 3);
  SkinBinding binding = bind_skin(form, body, mesh.place, shared_turns[static_cast<std::size_t>(detail)]);
  mesh.frame = std::move(binding.frame);
  mesh.vertex = std::move(binding.vertex);
  for (std::size_t v = 0; v < binding.rest.size(); ++v)
    mesh.fat.push_back(fat_place(form, binding.rest[v], share_of_arm(mesh.frame, mesh.vertex[v])));
  for (const Vec& r : binding.rest) {
    // Arms hang next to the legs.
    const bool is_leg = r.y < 0.55 * form.size() || std::abs(r.x) < 0.19 * form.size();
    mesh.leg.push_back(leg_place(form.leg(), {-std::abs(r.x), r.y, r.z}, is_leg ? 1 : 0));
  }
  return mesh;
}

SkinMeshes make_meshes(Sex sex) {
  const Body body = *make_body(skin_body(sex));
  const BodyForm form(body);
  const SurfaceMesh surface = mesh_form(form);
  constexpr std::array<double, skin_details> share = {1, 0.14, 0.035, 0.012}, coarseness = {1, 1.8, 3.5, 6};
  // Flat skin bends as well: a coarser mesh must not have edges from the knee to the middle of the thigh.
  constexpr std::array<double, skin_details> longest_m = {1, 0.042, 0.07, 1};
  SkinMeshes mesh;
  for (std::size_t d = 0; d < skin_details; ++d) {
    check_interrupt();
    SurfaceMesh light = can_be_coarser() ? coarser(surface, share[d]) : mesh_form(form, coarseness[d]);
    if (share[d] < 1) {  // edge collapse leaves some
      drop_fins(light.triangle);
      drop_unused(light);
    }
    split_long_edges(form, light, longest_m[d]);
    mesh[d] = make_mesh(form, body, std::move(light), static_cast<SkinDetail>(d));
  }
  return mesh;
}

#if defined(__wasm__)  // one thread, and a standard library without std::mutex
struct Mutex {
  void lock() {}
  void unlock() {}
};
#else
using Mutex = std::mutex;
#endif

/// Meshes of one sex, made at first use unless they were given before.
class SharedMeshes {
 public:
  const SkinMesh& of(Sex sex, SkinDetail detail) {
    const auto d = static_cast<std::size_t>(detail);
    if (const SkinMesh* const made = made_[d].load(std::memory_order_acquire)) return *made;
    const std::lock_guard lock(making_);
    if (made_[d].load(std::memory_order_relaxed) == nullptr) {
      SkinMeshes all = make_meshes(sex);
      for (std::size_t each = 0; each < skin_details; ++each) keep(each, std::move(all[each]));
    }
    return kept_[d];
  }
  void give(SkinDetail detail, SkinMesh mesh) {
    const std::lock_guard lock(making_);
    keep(static_cast<std::size_t>(detail), std::move(mesh));
  }

 private:
  void keep(std::size_t d, SkinMesh mesh) {
    if (made_[d].load(std::memory_order_relaxed) != nullptr) return;
    kept_[d] = std::move(mesh);
    made_[d].store(&kept_[d], std::memory_order_release);
  }

  Mutex making_;
  SkinMeshes kept_;
  std::array<std::atomic<const SkinMesh*>, skin_details> made_{};
};

SharedMeshes& shared_meshes(Sex sex) {
  static std::array<SharedMeshes, 2> meshes;
  return meshes[static_cast<std::size_t>(sex)];
}

TrunkFit part_of(const TrunkFit& fit, double share) {
  const auto part = [share](double whole) { return 1 + share * (whole - 1); };
  return {part(fit.hips), part(fit.waist), part(fit.chest), part(fit.neck), part(fit.between), part(fit.thighs)};
}

/// Makes the girths of hips, waist, chest and neck `over` times the survey's and leaves the places between unchanged.
void fit_girths(const Body& body, double over, TrunkFit& fit) {
  struct Place {
    double y_m, girth;  // of a body of 1.75 m
    double TrunkFit::*by;
  };
  const BodyMeasures m = body_measures(body.request);
  const std::array<Place, 3> places = {{{1.057, m.waist_girth, &TrunkFit::waist},
                                        {1.287, m.chest_girth, &TrunkFit::chest},
                                        {1.515, m.neck_girth, &TrunkFit::neck}}};
  constexpr int rounds = 8;
  for (int round = 0; round < rounds; ++round) {
    const BodyForm form(body, fit);
    const auto fitted = [over](double now, double girth, double wanted) {
      return std::clamp(now * over * wanted / girth, min_fit, max_fit);
    };
    for (const auto& [y_m, girth, by] : places) fit.*by = fitted(fit.*by, form.girth(form.scale().height(y_m)), girth);
    double hips = 0;  // at their widest
    for (const double y_m : {0.885, 0.905, 0.925}) hips = std::max(hips, form.girth(form.scale().height(y_m)));
    fit.hips = fitted(fit.hips, hips, m.buttock_girth);
    if (fit.hips <= min_fit) fit.thighs = std::clamp(fit.thighs * over * m.buttock_girth / hips, min_thighs, 1.0);
  }
}

/// Returns the shared surface on the form of another body, by way of bodies between the two.
std::vector<Vec> drawn_onto(const SkinMesh& mesh, const Body& body, const TrunkFit& fit, bool shod) {
  constexpr int stages = 4;
  std::vector<Vec> place = carried_skin(mesh, body.request.sex, body);
  const double size = static_cast<double>(body.request.height_m / skin_body(Sex::man).height_m);
  // Adults' girths grow less than their heights, children's about as much.
  const auto usual_kg = static_cast<double>(skin_body(Sex::man).mass_kg) * size * size *
                        std::lerp(1.0, size, child_part(static_cast<double>(body.request.age_y)));
  for (int stage = 1; stage <= stages; ++stage) {
    const double share = static_cast<double>(stage) / stages;
    Body between = body;
    between.request.mass_kg =
        static_cast<float>(usual_kg + share * (static_cast<double>(body.request.mass_kg) - usual_kg));
    const BodyForm form(stage == stages ? body : between, part_of(fit, share), shod);
    for (Vec& p : place) p = onto_surface(form, p, stage == stages ? 2 : 1);
  }
  return place;
}

/// Moves a part's points to the mean of their neighbours and back onto the surface, so toes become a shoe's tip.
void even_out(const SkinMesh& mesh, SkinPart part, const BodyForm& form, std::vector<Vec>& place) {
  constexpr int rounds = 25;
  const auto p = static_cast<std::size_t>(part);
  const std::span triangles = std::span(mesh.triangle)
                                  .subspan(3 * std::size_t{mesh.first_triangle[p]},
                                           3 * std::size_t{mesh.first_triangle[p + 1] - mesh.first_triangle[p]});
  std::vector<bool> moves(place.size(), false);  // false if shared with other parts
  for (const std::uint32_t v : triangles) moves[v] = true;
  for (std::size_t i = 0; i < mesh.triangle.size(); ++i) {
    if (i < 3 * mesh.first_triangle[p] || i >= 3 * mesh.first_triangle[p + 1]) moves[mesh.triangle[i]] = false;
  }
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Vec> mean = neighbour_means(triangles, place);
    for (std::size_t v = 0; v < place.size(); ++v) {
      if (moves[v]) place[v] = onto_surface(form, mean[v], 1);
    }
  }
}

/// Returns kg/m³ from the share of fat (Siri 1961).
double density(const Body& body) {
  return 1e3 * 4.95 / (static_cast<double>(body.composition.fat_kg / body.request.mass_kg) + 4.50);
}

/// Returns the air in the lungs at rest, m³ (functional residual capacity, 18 to 70 years; Quanjer et al. 1993). Above
/// the usual index it falls by 2.9 % for each kg/m² up to 30 (Jones & Nzekwu 2006: three quarters of that at 20).
/// Children's grow with the cube of height, our assumption.
double lung_volume(const Body& body) {
  constexpr double usual_index = 24, last_index = 30, by_index = 0.0288;
  const auto height = static_cast<double>(body.request.height_m),
             index = static_cast<double>(body.composition.body_mass_index),
             age = static_cast<double>(std::clamp(body.request.age_y, 18.0F, 70.0F));
  const auto litres_at = [&](double tall) {
    return body.request.sex == Sex::woman ? 2.24 * tall + 0.001 * age - 1.00 : 2.34 * tall + 0.01 * age - 1.09;
  };
  constexpr double grown = 1.75;
  const double litres = std::lerp(litres_at(height), litres_at(grown) * std::pow(height / grown, 3),
                                  child_part(static_cast<double>(body.request.age_y)));
  return 1e-3 * litres * std::exp(-by_index * (std::clamp(index, usual_index, last_index) - usual_index));
}

}  // namespace

double enclosed_volume(const std::vector<std::uint32_t>& triangle, const std::vector<Vec>& place) {
  double six_fold = 0;
  for (std::size_t t = 0; t < triangle.size(); t += 3)
    six_fold += dot(place[triangle[t]], cross(place[triangle[t + 1]], place[triangle[t + 2]]));
  return six_fold / 6;
}

SkinBuild skin_build(const BodyRequest& body, float index_step) {
  constexpr float min_index = 13.5F, max_index = 64.5F, first_adult_y = 17, child_step_y = 2, adult_step_y = 15,
                  oldest_y = 85;
  const float age = body.age_y < first_adult_y
                        ? child_step_y * std::round(body.age_y / child_step_y)
                        : std::clamp(usual_age_y + adult_step_y * std::round((body.age_y - usual_age_y) / adult_step_y),
                                     usual_age_y, oldest_y);
  const auto age_y = static_cast<int>(age);
  const auto tall = static_cast<double>(build_body(body.sex, age_y, min_index).height_m);
  const float heaviest = std::min(max_index, static_cast<float>(living_mass_kg(tall, age).high_kg / (tall * tall))),
              index = body.mass_kg / (body.height_m * body.height_m);
  const int step = static_cast<int>(
      std::clamp(std::round(index / index_step), std::ceil(min_index / index_step), std::floor(heaviest / index_step)));
  return {age_y, step, build_body(body.sex, age_y, index_step * static_cast<float>(step))};
}

BodyRequest build_body(Sex sex, int age_y, float body_mass_index) {
  BodyRequest body = skin_body(sex);
  body.age_y = static_cast<float>(age_y);
  if (static_cast<double>(body.age_y) < adult_age_y)
    body.height_m = static_cast<float>(growth(sex, body.age_y).height_m.median);
  body.mass_kg = body_mass_index * body.height_m * body.height_m;
  return body;
}

const SkinMesh& skin_mesh(Sex sex, SkinDetail detail) {
  return shared_meshes(sex).of(sex, detail);
}

void give_skin_mesh(Sex sex, SkinDetail detail, SkinMesh mesh) {
  shared_meshes(sex).give(detail, std::move(mesh));
}

TrunkFit fit_trunk(const Body& body) {
  const SkinMesh &light = skin_mesh(body.request.sex, SkinDetail::far),
                 &full = skin_mesh(body.request.sex, SkinDetail::hero);
  // Coarser meshes cut corners.
  const double rounder = enclosed_volume(full.triangle, full.place) / enclosed_volume(light.triangle, light.place);
  const double wanted = static_cast<double>(body.request.mass_kg) / density(body) + lung_volume(body);
  const auto volume = [&](double over, TrunkFit& fit) {
    fit_girths(body, over, fit);
    return rounder *
           enclosed_volume(light.triangle, skin_at_rest(BodyForm(body, fit), drawn_onto(light, body, fit, false)));
  };
  // Means of a survey do not describe one body, so girths and volume can each be slightly off. The places between those
  // where girths are measured take up the rest. Volume is nearly linear in such small changes.
  constexpr double may = 0.012, trial = 1.05;  // the mesh adds 0.7 %
  TrunkFit fit;
  const double usual = volume(1, fit), sense = wanted > usual ? 1 : -1, need = sense * (wanted - usual);
  const double over = 1 + sense * may, gain = sense * (volume(over, fit) - usual);
  if (gain > 0 && need <= gain) {
    fit_girths(body, 1 + need / gain * (over - 1), fit);
    return fit;
  }
  const double left = need - gain - may * wanted;
  if (left <= 0) return fit;
  fit.between = 1 + sense * (trial - 1);
  const double more = sense * (volume(over, fit) - usual) - gain;
  const double beyond = more > 0 ? left / more : 1;
  fit.between = std::clamp(1 + sense * (trial - 1) * beyond, min_fit, max_fit);
  fit_girths(body, over, fit);
  return fit;
}

Result<BodySkin> make_body_skin(const Body& body, SkinDetail detail, const SkinDress& dress) {
  if (auto ok = check_body(body.request); !ok) return tl::unexpected(ok.error());
  if (has_own_limbs(body.request))
    return fail(
        "a skin for limbs of their own lengths; make one for the body without them, which stretches at the joints");
  return make_body_skin(body, fit_trunk(body), detail, dress);
}

BodySkin make_body_skin(const Body& body, const TrunkFit& fit, SkinDetail detail, const SkinDress& dress) {
  const SkinMesh& mesh = skin_mesh(body.request.sex, detail);
  std::vector<Vec> place = drawn_onto(mesh, body, fit, dress.dressed);
  const BodyForm form(body, fit, dress.dressed);
  if (dress.dressed && detail <= SkinDetail::near) even_out(mesh, SkinPart::shoes, form, place);
  std::vector<Vec> rest = skin_at_rest(form, place);
  if (dress.dressed) {
    const std::vector<Vec> bare = normals(mesh.triangle, rest);
    const std::vector<double> off = cloth_thickness(form, place);
    for (std::size_t v = 0; v < rest.size(); ++v) rest[v] = rest[v] + off[v] * bare[v];
  }
  BodySkin skin;
  skin.sex = body.request.sex;
  skin.detail = detail;
  skin.standing = standing_pose(body);
  skin.leg = leg_grid(form, body.composition);
  const std::vector<Vec> normal = normals(mesh.triangle, rest);
  for (std::size_t v = 0; v < rest.size(); ++v) {
    skin.rest.push_back(to_float(rest[v]));
    skin.normal.push_back(to_float(normal[v]));
  }
  return skin;
}

}  // namespace mobil::inline v0_3
