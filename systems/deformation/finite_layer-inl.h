// Exchange between the elements of a layer and its two planes: elements read displacements and add forces, one register
// of lanes at a time. For inclusion only inside Highway's targets.

#if defined(MOBIL_SYSTEMS_DEFORMATION_FINITE_LAYER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_DEFORMATION_FINITE_LAYER_INL_H_
#undef MOBIL_SYSTEMS_DEFORMATION_FINITE_LAYER_INL_H_
#else
#define MOBIL_SYSTEMS_DEFORMATION_FINITE_LAYER_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "assets/fem/finite_kernel.h"
#include "systems/deformation/elastic-inl.h"
#include "systems/deformation/finite_element-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Reads an element's deformation. `u` contains displacements of the nodes from the lower plane's first one on.
HWY_NOINLINE inline void gather_element(const FiniteKernelElement& element, const float* u, ElementState& state) {
  for (std::size_t r = 0; r < 3; ++r, u += lane_count) {
    const auto face = [&](const std::uint32_t* node) HWY_ATTR {
      return face_sums(hn::Load(d, u + node_stride * node[0]), hn::Load(d, u + node_stride * node[1]),
                       hn::Load(d, u + node_stride * node[2]), hn::Load(d, u + node_stride * node[3]));
    };
    const std::uint32_t* const node = element.node.data();
    state.along[r] =
        gather_row(element, corner_sums(face(node), face(node + 4)), state.gradient[r], state.hourglass[r]);
  }
}

/// Adds an element's forces to its nodes' in the planes below and above it. `plane` is the number of nodes in a plane.
HWY_NOINLINE inline void scatter_element(const FiniteKernelElement& element, std::uint32_t plane,
                                         const ElementState& state, float* low, float* high) {
  for (std::size_t r = 0; r < 3; ++r) {
    const CornerSums sum = force_sums(element, state, r);
    const auto add = [&](const FaceCorners& part, const std::uint32_t* node, std::uint32_t first, float* force)
                         HWY_ATTR {
                           for (std::size_t a = 0; a < 4; ++a) {
                             float* const to = force + node_stride * (node[a] - first) + r * lane_count;
                             hn::Store(hn::Add(hn::Load(d, to), part.corner[a]), d, to);
                           }
                         };
    add(low_corners(sum), element.node.data(), 0, low);
    add(high_corners(sum), element.node.data() + 4, plane, high);
  }
}

// Nearly all bellies have layers of two by two elements. For these, both planes are read and written once per
// component, and stay in registers in between. AVX-512 has enough registers for that.
inline constexpr std::size_t small_layer = 4, small_plane = 9;  // elements, nodes

/// Returns the node of its plane at corner `a` of a face of element e.
constexpr std::size_t small_node(std::size_t e, std::size_t a) {
  return (e / 2 + (a == 2 || a == 3 ? 1 : 0)) * 3 + e % 2 + (a == 1 || a == 2 ? 1 : 0);
}
/// Returns true if no element before e has that node.
constexpr bool is_first_there(std::size_t e, std::size_t a) {
  for (std::size_t before = 0; before < e; ++before)
    for (std::size_t b = 0; b < 4; ++b)
      if (small_node(before, b) == small_node(e, a)) return false;
  return true;
}

template <std::size_t e>
HWY_INLINE void gather_small_element(const FiniteKernelElement* element, std::size_t r, const V (&low)[small_plane],
                                     const V (&high)[small_plane], ElementState* state) {
  const auto face = [](const V(&of)[small_plane]) HWY_ATTR {
    return face_sums(of[small_node(e, 0)], of[small_node(e, 1)], of[small_node(e, 2)], of[small_node(e, 3)]);
  };
  state[e].along[r] =
      gather_row(element[e], corner_sums(face(low), face(high)), state[e].gradient[r], state[e].hourglass[r]);
}

/// Reads the deformation of a whole layer, as gather_element does for one element.
HWY_NOINLINE inline void gather_small_layer(const FiniteKernelElement* element, const float* u, ElementState* state) {
  for (std::size_t r = 0; r < 3; ++r, u += lane_count) {
    V low[small_plane], high[small_plane];
    for (std::size_t n = 0; n < small_plane; ++n) {
      low[n] = hn::Load(d, u + node_stride * n);
      high[n] = hn::Load(d, u + node_stride * (n + small_plane));
    }
    gather_small_element<0>(element, r, low, high, state);
    gather_small_element<1>(element, r, low, high, state);
    gather_small_element<2>(element, r, low, high, state);
    gather_small_element<3>(element, r, low, high, state);
  }
}

template <std::size_t e>
HWY_INLINE void scatter_small_element(const FiniteKernelElement* element, const ElementState* state, std::size_t r,
                                      V (&low)[small_plane], V (&high)[small_plane]) {
  const CornerSums sum = force_sums(element[e], state[e], r);
  const FaceCorners below = low_corners(sum), above = high_corners(sum);
  for (std::size_t a = 0; a < 4; ++a) {
    const std::size_t n = small_node(e, a);
    low[n] = hn::Add(low[n], below.corner[a]);
    high[n] = is_first_there(e, a) ? above.corner[a] : hn::Add(high[n], above.corner[a]);
  }
}

/// Adds a layer's forces to those of the lower plane and sets those of the upper one, unlike scatter_element.
HWY_NOINLINE inline void scatter_small_layer(const FiniteKernelElement* element, const ElementState* state, float* low,
                                             float* high) {
  for (std::size_t r = 0; r < 3; ++r, low += lane_count, high += lane_count) {
    V at_low[small_plane], at_high[small_plane];
    for (std::size_t n = 0; n < small_plane; ++n) at_low[n] = hn::Load(d, low + node_stride * n);
    scatter_small_element<0>(element, state, r, at_low, at_high);
    scatter_small_element<1>(element, state, r, at_low, at_high);
    scatter_small_element<2>(element, state, r, at_low, at_high);
    scatter_small_element<3>(element, state, r, at_low, at_high);
    for (std::size_t n = 0; n < small_plane; ++n) {
      hn::Store(at_low[n], d, low + node_stride * n);
      hn::Store(at_high[n], d, high + node_stride * n);
    }
  }
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
