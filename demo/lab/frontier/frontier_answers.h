#pragma once
// What a method makes of a muscle's walks, for `mobil frontier`: where the control points are, tick by tick.

#include "demo/lab/frontier/frontier_method.h"

namespace mobil {

/// Displacement (m) of the control points, 243 numbers a tick, node-major, sixteen walks each; of every `stride`th tick
/// from `first` on.
struct FrontierAnswer {
  std::size_t first = 0, stride = 1;
  std::vector<Lanes<float>> displacement_m;

  std::size_t samples() const;
};

/// The control points' displacements of a mesh of any cells: that of its own field where a control point lies within
/// an element. Throws Stopped on cells that are no multiple of the control points' across.
class FrontierSampler {
 public:
  FrontierSampler(const HexahedralMesh& mesh, const HexahedralMesh& points);
  /// `displacement`: a block's nodes; of `to` the lanes named by the bits of `lanes` are written.
  void sample(const float* displacement, std::uint32_t lanes, Lanes<float>* to) const;

 private:
  struct Place {
    std::uint32_t before, after;
    float part;
  };
  std::vector<Place> place_;
};

/// Sixteen individuals (frontier_individuals) over their walks. `loads`: with the frame's. Fails where steps
/// never meet ticks.
FrontierAnswer answer_of(const FrontierDrive& drive, const FrontierMethod& method,
                         const std::vector<FrontierIndividual>& individuals, bool loads);

/// Root mean square and largest differences, gathered over muscles.
struct FrontierError {
  double square = 0, reference_square = 0, largest_m = 0;

  /// Of the walks that are their own, at the ticks of `answer`; `truth` has those and all between them.
  void add(const FrontierAnswer& answer, const FrontierAnswer& truth, std::size_t walks);
  void add(const FrontierError& other);
  /// NaN where nothing was added.
  double relative() const;
};

}  // namespace mobil
