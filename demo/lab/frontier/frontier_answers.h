#pragma once
// Results of a method on a muscle's walks, for `mobil frontier`: control points, tick by tick.

#include "demo/lab/frontier/frontier_method.h"

namespace mobil {

/// Displacement (m) of the control points, 243 numbers a tick, node-major, for sixteen walks; every `stride`th tick
/// from `first` on.
struct FrontierAnswer {
  std::size_t first = 0, stride = 1;
  std::vector<Lanes<float>> displacement_m;

  std::size_t samples() const;
};

/// Samples the control points' displacements of a mesh of any cells, by its own field if a control point is within an
/// element. Throws Stopped on cells that are not a multiple of the control points' across.
class FrontierSampler {
 public:
  FrontierSampler(const HexahedralMesh& mesh, const HexahedralMesh& points);
  /// Writes to `to` the lanes in the bits of `lanes`. `displacement` contains a block's nodes.
  void sample(const float* displacement, std::uint32_t lanes, Lanes<float>* to) const;

 private:
  struct Place {
    std::uint32_t before, after;
    float part;
  };
  std::vector<Place> place_;
};

/// Runs sixteen individuals (frontier_individuals) over their walks. `loads` adds those of the frame. Fails if steps
/// and ticks never coincide.
FrontierAnswer answer_of(const FrontierDrive& drive, const FrontierMethod& method,
                         const std::vector<FrontierIndividual>& individuals, bool loads);

/// Root mean square and largest differences, gathered over muscles.
struct FrontierError {
  double square = 0, reference_square = 0, largest_m = 0;

  /// Adds the distinct walks, at the ticks of `answer`; `truth` contains those and all between them.
  void add(const FrontierAnswer& answer, const FrontierAnswer& truth, std::size_t walks);
  void add(const FrontierError& other);
  /// Returns NaN if nothing was added.
  double relative() const;
};

}  // namespace mobil
