#pragma once
// A lane is one entity's place in a block of sixteen. A component is a template over its scalar F. C<float> is one
// entity's row; C<Lanes<float>> is a block of sixteen rows, each field stored as sixteen adjacent numbers.

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace mobil::inline v0_3 {

/// Rows in a block.
inline constexpr std::size_t lane_count = 16;

/// Sixteen values of one field, one per lane, aligned for the widest register.
template <class T>
struct alignas(64) Lanes {
  T lane[lane_count];

  constexpr T& operator[](std::size_t i) { return lane[i]; }
  constexpr const T& operator[](std::size_t i) const { return lane[i]; }
};

/// Unsigned integer of the same shape as a scalar: UInt32<float> is a number, UInt32<Lanes<float>> sixteen of them.
template <class F>
using UInt32 = std::conditional_t<std::is_same_v<F, Lanes<float>>, Lanes<std::uint32_t>, std::uint32_t>;

/// A point, direction or other vector; unit and frame are documented at the field that holds it.
template <class F>
struct Vec3 {
  F x, y, z;
};

/// Unit quaternion, w the scalar part; rotates a segment's axes into its parent's or the world's.
template <class F>
struct Quat {
  F x, y, z, w;
};

/// Index of a bilateral field: the right side is 0, the left side 1.
namespace sides {
enum Side : std::uint32_t { right = 0, left = 1 };
}  // namespace sides
using sides::Side;  // Side::left is ours; plain left can be std::left

}  // namespace mobil::inline v0_3
