#pragma once
// People as they look from afar: smooth bodies of one shape a segment, the same for everybody but for size and colour.

#include <array>
#include <cstdint>
#include <vector>

#include "assets/surfaces/figure_shapes.h"
#include "components/body.h"
#include "components/pose.h"
#include "components/surface.h"
#include "systems/capture/scene.h"

namespace mobil {

/// What somebody of that number wears, by Cloth.
std::array<Colour, cloth_count> mannequin_colours(std::uint64_t number);

class Mannequins {
 public:
  Mannequins();

  void clear();
  /// `number` chooses the colours.
  void add(const Pose<float>& pose, float height_m, float mass_kg, std::uint64_t number);
  /// One mesh for each shape and colour, with as many copies as were added; good until the next change.
  void draw(std::vector<DrawMesh>& out) const;

 private:
  struct Copies {
    std::size_t shape;
    Colour colour;
    std::vector<Placement> placement;
  };
  std::vector<BoneSurface> shapes_;  // of a body of reference_height_m
  std::vector<Copies> copies_;       // shape by shape, colour by colour
  std::vector<std::size_t> first_;   // of each shape
};

}  // namespace mobil
