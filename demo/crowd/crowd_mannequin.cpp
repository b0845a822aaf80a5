#include "demo/crowd/crowd_mannequin.h"

#include <array>
#include <span>

#include "assets/body/anthropometry.h"
#include "assets/surfaces/figure_shapes.h"
#include "demo/crowd/crowd_people.h"
#include "systems/surfaces/far_figure.h"

namespace mobil {
namespace {

constexpr std::uint64_t mesh_keys = 0x6d616e6e00000000, colour_stream = 0x50000;

constexpr std::array skins = {Colour{0.86F, 0.68F, 0.57F}, Colour{0.74F, 0.54F, 0.42F}, Colour{0.55F, 0.38F, 0.28F},
                              Colour{0.93F, 0.77F, 0.67F}};
constexpr std::array shirts = {Colour{0.40F, 0.48F, 0.56F}, Colour{0.74F, 0.70F, 0.63F}, Colour{0.45F, 0.53F, 0.48F},
                               Colour{0.70F, 0.56F, 0.42F}, Colour{0.50F, 0.48F, 0.54F}, Colour{0.84F, 0.83F, 0.80F},
                               Colour{0.29F, 0.34F, 0.41F}};
constexpr std::array trousers = {Colour{0.22F, 0.26F, 0.34F}, Colour{0.38F, 0.36F, 0.34F}, Colour{0.55F, 0.50F, 0.42F},
                                 Colour{0.27F, 0.36F, 0.47F}};
constexpr std::array shoes = {Colour{0.16F, 0.15F, 0.15F}, Colour{0.34F, 0.25F, 0.19F}, Colour{0.82F, 0.81F, 0.79F}};

constexpr std::array<std::span<const Colour>, cloth_count> palette = {skins, shirts, trousers, shoes};

std::size_t cloth(Segment segment) {
  return static_cast<std::size_t>(cloth_of(segment));
}

/// Which of its palette each cloth has.
std::array<std::size_t, cloth_count> chosen_colours(std::uint64_t number) {
  CrowdRandom random(0, number, colour_stream);
  std::array<std::size_t, cloth_count> chosen{};
  for (std::size_t c = 0; c < palette.size(); ++c) chosen[c] = random.below(palette[c].size());
  return chosen;
}

}  // namespace

std::array<Colour, cloth_count> mannequin_colours(std::uint64_t number) {
  const auto chosen = chosen_colours(number);
  std::array<Colour, cloth_count> colours{};
  for (std::size_t c = 0; c < cloth_count; ++c) colours[c] = palette[c][chosen[c]];
  return colours;
}

Mannequins::Mannequins() {
  const auto body = make_body(far_body);
  if (!body) return;
  shapes_ = make_figure_shapes(*body);
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    first_.push_back(copies_.size());
    for (const Colour& colour : palette[cloth(shapes_[i].segment)]) copies_.push_back({i, colour, {}});
  }
}

void Mannequins::clear() {
  for (Copies& copies : copies_) copies.placement.clear();
}

void Mannequins::add(const Pose<float>& pose, float height_m, float mass_kg, std::uint64_t number) {
  const Vec3<float> scale = far_scale(height_m, mass_kg);
  const auto chosen = chosen_colours(number);
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    const Segment segment = shapes_[i].segment;
    const std::size_t s = index(segment);
    copies_[first_[i] + chosen[cloth(segment)]].placement.push_back(
        {.position = pose.position_m[s], .rotation = pose.rotation[s], .scale = scale});
  }
}

void Mannequins::draw(std::vector<DrawMesh>& out) const {
  for (const Copies& copies : copies_) {
    if (copies.placement.empty()) continue;
    out.push_back({.position = shapes_[copies.shape].mesh.position,
                   .triangle = shapes_[copies.shape].mesh.triangle,
                   .colour = copies.colour,
                   .wetness = 0.1F,
                   .placement = copies.placement,
                   .key = mesh_keys + copies.shape});
  }
}

}  // namespace mobil
