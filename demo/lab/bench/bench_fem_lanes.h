#pragma once
// What a stiffness of its own for every lane would cost: measured, not used. Each belly's nine numbers a pair of nodes
// are then state that streams by, 0.6 MB a block of 81 nodes.

#include <cstdint>
#include <vector>

#include <mobil/components/lanes.h>
#include "assets/fem/muscle_template.h"

namespace mobil {

/// A block whose lanes each have their own coefficients; free far face, mass damping as the template says.
struct OwnStiffness {
  OwnStiffness(const MuscleTemplate& muscle, const BellyScale<Lanes<float>>& scale);

  Cells cells;
  std::vector<Lanes<float>> coefficient;   // nine a pair of moving nodes, in the order of the kernel arrays
  std::vector<std::uint32_t> first, node;  // of each row of a node: its first pair; of each pair: the neighbour
  std::vector<Lanes<float>> push;          // Δt·M⁻¹/(1 + αΔt/2) at 2 ms, one a node
  std::vector<Lanes<float>> displacement, velocity, load;
  float keep;
};

/// So many steps of 2 ms under the block's constant load.
void step_own(OwnStiffness& block, std::uint32_t steps);

}  // namespace mobil
