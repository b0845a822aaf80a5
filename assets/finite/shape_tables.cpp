#include "assets/finite/shape_tables.h"

#include <iterator>
#include <utility>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/muscle_table.h>
#include "assets/finite/packed_shapes.h"
#include "assets/surfaces/muscle_lattice.h"

namespace mobil::inline v0_3 {
namespace {

// In the order of muscles().
// clang-format off
constexpr PackedShapes tables[] = {
#include "assets/finite/tables/hamstrings.inl"
,
#include "assets/finite/tables/quadriceps.inl"
,
#include "assets/finite/tables/triceps_surae.inl"
,
#include "assets/finite/tables/tibialis_anterior.inl"
,
#include "assets/finite/tables/semimembranosus.inl"
,
#include "assets/finite/tables/semitendinosus.inl"
,
#include "assets/finite/tables/biceps_femoris_long_head.inl"
,
#include "assets/finite/tables/biceps_femoris_short_head.inl"
,
#include "assets/finite/tables/rectus_femoris.inl"
,
#include "assets/finite/tables/vastus_medialis.inl"
,
#include "assets/finite/tables/vastus_intermedius.inl"
,
#include "assets/finite/tables/vastus_lateralis.inl"
,
#include "assets/finite/tables/gastrocnemius_medial.inl"
,
#include "assets/finite/tables/gastrocnemius_lateral.inl"
,
#include "assets/finite/tables/soleus.inl"
,
#include "assets/finite/tables/plantaris.inl"
,
#include "assets/finite/tables/gluteus_maximus.inl"
,
#include "assets/finite/tables/hip_abductors.inl"
,
#include "assets/finite/tables/iliopsoas.inl"
,
#include "assets/finite/tables/short_adductors.inl"
,
#include "assets/finite/tables/adductor_magnus.inl"
,
#include "assets/finite/tables/deep_calf.inl"
,
#include "assets/finite/tables/peroneals.inl"
,
#include "assets/finite/tables/toe_extensors.inl"
,
#include "assets/finite/tables/gluteus_medius.inl"
,
#include "assets/finite/tables/gluteus_minimus.inl"
,
#include "assets/finite/tables/iliacus.inl"
,
#include "assets/finite/tables/psoas.inl"
,
#include "assets/finite/tables/pectineus.inl"
,
#include "assets/finite/tables/adductor_longus.inl"
,
#include "assets/finite/tables/adductor_brevis.inl"
,
#include "assets/finite/tables/tibialis_posterior.inl"
,
#include "assets/finite/tables/flexor_digitorum_longus.inl"
,
#include "assets/finite/tables/flexor_hallucis_longus.inl"
,
#include "assets/finite/tables/peroneus_longus.inl"
,
#include "assets/finite/tables/peroneus_brevis.inl"
,
#include "assets/finite/tables/extensor_digitorum_longus.inl"
,
#include "assets/finite/tables/extensor_hallucis_longus.inl"
,
#include "assets/finite/tables/peroneus_tertius.inl"
,
#include "assets/finite/tables/tensor_fasciae_latae.inl"
,
#include "assets/finite/tables/sartorius.inl"
,
#include "assets/finite/tables/gracilis.inl"
,
#include "assets/finite/tables/piriformis.inl"
,
#include "assets/finite/tables/quadratus_femoris.inl"
,
#include "assets/finite/tables/obturator_internus.inl"
,
#include "assets/finite/tables/obturator_externus.inl"
,
#include "assets/finite/tables/popliteus.inl"
};
// clang-format on
static_assert(std::size(tables) == lattice_muscles);

// The mesh of the control points, and the meshes from which shapes are extrapolated (errors in shape_samples.h).
constexpr Cells control_cells = {2, 2, 8}, coarse_cells = {4, 4, 16}, fine_cells = {6, 6, 24};

}  // namespace

ShapeTable shape_table(Muscle muscle) {
  return unpack_shapes(tables[static_cast<std::size_t>(muscle)]);
}

HexahedralMesh finite_mesh(Muscle muscle, const Cells& cells) {
  return *bend_block(cells, muscle_lattice(muscle), reference_belly_m(muscle),
                     belly_grading);  // a template's, so it is sound
}

SampledBelly sampled_belly(Muscle muscle) {
  const double foundation_hz = on_shank(muscle) ? 12 : 7;
  return {finite_mesh(muscle, coarse_cells),
          finite_mesh(muscle, fine_cells),
          {},
          static_foundation_factor * foundation_hz,
          control_cells};
}

Result<ShapeTable> make_shape_table(Muscle muscle) {
  const SampledBelly belly = sampled_belly(muscle);
  std::vector<ShapeSample> samples;
  for (const double ratio : sampled_ratios) {
    auto some = shape_samples(belly, ratio, sampled_shortenings, sampled_activations);
    if (!some) return tl::unexpected(some.error());
    samples.insert(samples.end(), std::move_iterator(some->begin()), std::move_iterator(some->end()));
  }
  return fit_shape_table(samples, finite_mesh(muscle, control_cells), shape_modes);
}

}  // namespace mobil::inline v0_3
