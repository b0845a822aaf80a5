#pragma once
// A muscle's surface where its cage and its bones are now.

#include <cstddef>
#include <cstdint>
#include <span>

#include "components/body.h"
#include "components/muscle.h"
#include "components/pose.h"
#include "components/surface.h"

namespace mobil {

struct RigidPose {
  Vec3<float> position_m;
  Quat<float> rotation;
};

/// Everything rigid that one surface follows. `frame`: the muscle's, as LineOfAction carries it (for a left muscle in
/// the mirror image). Its ends: world transforms now and in the standing body, as they are (not mirrored), of the bones
/// or, where the surface's ends turn otherwise than they do, of its attachments.
struct SkinPose {
  RigidPose frame;
  RigidPose origin_now, origin_rest, insertion_now, insertion_rest;
};

/// Gathers the above for one side's copy of a (right-hand) surface. The body stands at x = z = 0 at rest.
SkinPose skin_pose(const MuscleSurface& surface, Side side, const Body& body, const Pose<float>& pose,
                   const LineOfAction<float>& line);

/// One individual's nodal displacement: component c of node n (m, the muscle's frame) at first[(3·n + c)·stride].
/// Within a block `first` is the lane's first float and the stride 16; in a plain array the stride is 1.
struct NodalLane {
  const float* first;
  std::size_t stride;
  std::uint32_t nodes;
};

/// World positions of a surface's vertices, m: with M the motion of a bone since rest, F the muscle's frame,
///   p = cage · F(rest_in_cage + Σ wᵢ uᵢ) + origin · M_origin(p₀) + insertion · M_insertion(p₀).
/// A left muscle's surface (`is_left`) is computed in the mirror image and reflected; its triangles are to be turned by
/// the caller. The surface is bound to a cage of no more than displacement.nodes nodes; `out` has as many entries as it
/// has vertices. Quickest up to 4096 nodes (64 kB of stack). No heap.
void skin_surface(const MuscleSurface& surface, const SkinPose& pose, const NodalLane& displacement, bool is_left,
                  std::span<Vec3<float>> out);

}  // namespace mobil
