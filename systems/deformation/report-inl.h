// Reports of a block after its tick. For inclusion only inside Highway's targets.

#if defined(MOBIL_SYSTEMS_DEFORMATION_REPORT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_DEFORMATION_REPORT_INL_H_
#undef MOBIL_SYSTEMS_DEFORMATION_REPORT_INL_H_
#else
#define MOBIL_SYSTEMS_DEFORMATION_REPORT_INL_H_
#endif

#include "engine/fused-inl.h"
#include "systems/deformation/elastic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Returns the volume inside the deformed boundary, m³. Each bilinear patch sweeps the mean of its two triangulations.
HWY_INLINE V enclosed_volume(const KernelArrays& kernel, V across, V along, const float* u) {
  const auto determinant = [](const Vector& a, const Vector& b, const Vector& c) HWY_ATTR {
    const V x = neg_mul_add(b.z, c.y, hn::Mul(b.y, c.z));
    const V y = neg_mul_add(b.x, c.z, hn::Mul(b.z, c.x));
    const V z = neg_mul_add(b.y, c.x, hn::Mul(b.x, c.y));
    return mul_add(a.x, x, mul_add(a.y, y, hn::Mul(a.z, z)));
  };
  const auto minus = [](const Vector& a, const Vector& b) HWY_ATTR {
    return Vector{hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
  };
  const auto place = [&](std::uint32_t n) HWY_ATTR {
    const float* p = u + node_stride * n;
    const float* rest = kernel.rest_m.data() + 3 * std::size_t{n};
    return Vector{mul_add(across, hn::Set(d, rest[0]), hn::Load(d, p)),
                  mul_add(across, hn::Set(d, rest[1]), hn::Load(d, p + lane_count)),
                  mul_add(along, hn::Set(d, rest[2]), hn::Load(d, p + 2 * lane_count))};
  };
  V sum = hn::Zero(d);
  for (const Quad& quad : kernel.skin) {
    const Vector a = place(quad[0]), b = place(quad[1]), c = place(quad[2]), e = place(quad[3]);
    sum = hn::Add(sum, hn::Add(determinant(a, minus(b, e), c), determinant(e, minus(a, c), b)));
  }
  return hn::Mul(sum, hn::Set(d, 1.0F / 12.0F));
}

/// Reports elongation, reaction and volume.
template <Stiffness stiffness>
HWY_NOINLINE void report_shape(const BellyBlock& block, const Factors& factor, std::size_t first_lane) {
  const Cells& cells = block.muscle.mesh.cells;
  const KernelArrays& kernel = block.muscle.kernel;
  const float* const u = block.displacement + first_lane;
  const std::uint32_t far = first_insertion_node(cells);
  V elongation = hn::Zero(d), reaction = elongation;
  std::uint32_t n = far;
  const float* coefficient = coefficients<stiffness>(kernel, cells[2]);
  for (std::uint32_t j = 0; j <= cells[1]; ++j) {
    for (std::uint32_t i = 0; i <= cells[0]; ++i, ++n) {
      reaction = hn::Add(reaction, elastic_force<stiffness>(cells, i, j, cells[2], u, factor, coefficient).z);
      elongation =
          mul_add(hn::Set(d, kernel.far_share[n - far]), hn::Load(d, u + node_stride * n + 2 * lane_count), elongation);
    }
  }
  const V volume = enclosed_volume(kernel, factor.b, factor.a, u);
  const V rest_volume = hn::Mul(factor.mass, hn::Set(d, kernel.volume_m3));
  hn::Store(elongation, d, block.report.elongation_m.lane + first_lane);
  hn::Store(reaction, d, block.report.reaction_n.lane + first_lane);
  hn::Store(hn::Div(volume, rest_volume), d, block.report.volume_ratio.lane + first_lane);
}

/// Reports ½·vᵀ·M·v with the lumped mass.
HWY_NOINLINE inline void report_kinetic_energy(const BellyBlock& block, const Factors& factor, std::size_t first_lane) {
  const Cells& cells = block.muscle.mesh.cells;
  V sum = hn::Zero(d);
  for (std::uint32_t n = plane_nodes(cells); n < node_count(cells); ++n) {
    V square = hn::Zero(d);
    for (std::size_t c = 0; c < node_stride; c += lane_count) {
      const V speed = hn::Load(d, block.velocity + first_lane + node_stride * n + c);
      square = mul_add(speed, speed, square);
    }
    sum = mul_add(square, hn::Set(d, block.muscle.kernel.mass_kg[n]), sum);
  }
  hn::Store(hn::Mul(hn::Set(d, 0.5F), hn::Mul(factor.mass, sum)), d, block.report.kinetic_energy_j.lane + first_lane);
}

/// Reports ½·uᵀ·K·u.
template <Stiffness stiffness>
HWY_NOINLINE void report_strain_energy(const BellyBlock& block, const Factors& factor, std::size_t first_lane) {
  const Cells& cells = block.muscle.mesh.cells;
  const float* const u = block.displacement + first_lane;
  const float* coefficient = coefficients<stiffness>(block.muscle.kernel, 1);
  V sum = hn::Zero(d);
  const float* at = u + node_stride * plane_nodes(cells);
  for (std::uint32_t k = 1; k <= cells[2]; ++k) {
    for (std::uint32_t j = 0; j <= cells[1]; ++j) {
      for (std::uint32_t i = 0; i <= cells[0]; ++i, at += node_stride) {
        const Vector f = elastic_force<stiffness>(cells, i, j, k, u, factor, coefficient);
        sum = mul_add(f.x, hn::Load(d, at), sum);
        sum = mul_add(f.y, hn::Load(d, at + lane_count), sum);
        sum = mul_add(f.z, hn::Load(d, at + 2 * lane_count), sum);
      }
    }
  }
  hn::Store(hn::Mul(hn::Set(d, 0.5F), sum), d, block.report.strain_energy_j.lane + first_lane);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
