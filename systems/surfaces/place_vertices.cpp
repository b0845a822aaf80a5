#include "systems/surfaces/place_vertices.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "systems/surfaces/weights8-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

/// Returns Σ wᵢ uᵢ of eight vertices. Even and odd nodes are summed separately, so that two sums grow at once.
HWY_INLINE EightVec displaced(const LatticeBlock& block, const std::array<std::uint16_t, 8>& at, const float* node) {
  EightVec sum[2];
  for (std::size_t i = 0; i < 8; ++i) {
    const WideEight w = load(block.node_weight[i]);
    const float* u = node + 3 * std::size_t{at[i]};
    EightVec& s = sum[i % 2];
    if (i < 2) {
      s = {multiply(w, all(u[0])), multiply(w, all(u[1])), multiply(w, all(u[2]))};
    } else {
      s = {multiply_add(w, all(u[0]), s.x), multiply_add(w, all(u[1]), s.y), multiply_add(w, all(u[2]), s.z)};
    }
  }
  return {add(sum[0].x, sum[1].x), add(sum[0].y, sum[1].y), add(sum[0].z, sum[1].z)};
}

HWY_INLINE EightVec in_lattice(const LatticeBlock& block, const std::array<std::uint16_t, 8>& at, const float* node,
                               const SkinMaps& maps) {
  const EightVec u = displaced(block, at, node), q = load(block.rest_in_lattice);
  const WideEight across = all(maps.belly.across), along = all(maps.belly.along);
  return apply<true>(maps.frame,
                     {multiply_add(across, q.x, u.x), multiply_add(across, q.y, u.y), multiply_add(along, q.z, u.z)});
}

HWY_INLINE EightVec on_bones(const BoneBlock& block, const SkinMaps& maps) {
  const EightVec p = load(block.rest), a = apply<true>(maps.origin, p), b = apply<true>(maps.insertion, p);
  const WideEight origin = load(block.origin), insertion = load(block.insertion);
  return {multiply_add(origin, a.x, multiply(insertion, b.x)), multiply_add(origin, a.y, multiply(insertion, b.y)),
          multiply_add(origin, a.z, multiply(insertion, b.z))};
}

/// Returns vertices that bones hold.
HWY_INLINE EightVec on_held_bones(const BoneBlock& block, const HeldBlock& held, const SkinMaps& maps) {
  const EightVec p = load(block.rest), a = apply<true>(maps.origin_held, p), b = apply<true>(maps.insertion_held, p);
  const EightVec on = on_bones(block, maps);
  const WideEight origin = load(held.origin), insertion = load(held.insertion);
  const auto sum = [&](const WideEight& x, const WideEight& y, const WideEight& z)
                       HWY_ATTR { return multiply_add(origin, x, multiply_add(insertion, y, z)); };
  return {sum(a.x, b.x, on.x), sum(a.y, b.y, on.y), sum(a.z, b.z, on.z)};
}

void place_surface(const PackedSurface& surface, const SkinMaps& maps, const float* node, float sign, float* places) {
  const WideEight signs = all(sign);
  const auto put = [&](EightVec p) HWY_ATTR {
    p.x = multiply(signs, p.x);
    for (std::size_t i = 0; i < eight_parts; ++i) {
      const Rows rows = transposed({{p.x.part[i], p.y.part[i], p.z.part[i], p.x.part[i]}});
      for (std::size_t v = 0; v < 4; ++v) store_vertices(EightTag{}, rows.row[v], places + 4 * (4 * i + v), 4);
    }
    places += 4 * block_vertices;
  };
  const std::size_t alone = surface.lattice_only_blocks, both = surface.lattice.size() - alone;
  for (std::size_t i = 0; i < alone; ++i) put(in_lattice(surface.lattice[i], surface.node[i], node, maps));
  for (std::size_t i = 0; i < both; ++i) {
    const BoneBlock& block = surface.bone[i];
    const EightVec p = in_lattice(surface.lattice[alone + i], surface.node[alone + i], node, maps);
    const EightVec b = on_bones(block, maps);
    const WideEight lattice = load(block.lattice);
    put({multiply_add(lattice, p.x, b.x), multiply_add(lattice, p.y, b.y), multiply_add(lattice, p.z, b.z)});
  }
  const std::size_t loose = surface.bone.size() - surface.held.size();
  for (std::size_t i = both; i < loose; ++i) put(on_bones(surface.bone[i], maps));
  for (std::size_t i = loose; i < surface.bone.size(); ++i)
    put(on_held_bones(surface.bone[i], surface.held[i - loose], maps));
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(place_surface);
}

void place_vertices(const PackedSurface& surface, const SkinMaps& maps, const float* node, Side side, float* places) {
  HWY_DYNAMIC_DISPATCH(place_surface)(surface, maps, node, side == Side::left ? -1.0F : 1.0F, places);
}

}  // namespace mobil::inline v0_3
#endif
