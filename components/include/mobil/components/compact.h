#pragma once
// Walkers whom nobody looks at, as short as they can be while they go on: no pose, and their leg muscles in their own
// row. They lack Pose and all that is measured of it.

namespace mobil::inline v0_3 {

/// Run-time sized column: of each muscle that moves, in the table's order, right before left: its line's elongation
/// L − L₀ at the end of the last tick, m; then X and W of each of its motions, as in ModalState.
struct CompactState {};
/// Run-time sized column: sizes of the leg (LegScale); then of each muscle that moves its line's rest length less what
/// no joint changes of it, m, and a, b and g of each motion, as in ModalMotion. Alike on both sides.
struct CompactMotion {};
/// Tag: what each muscle of the person's choice (Shared<LegMuscles>) is, in the table's order, five bits a muscle from
/// the lowest on: a CompactMuscle, or how many modes it moves along.
struct CompactMuscles {};
enum CompactMuscle : unsigned { compact_none = 0, compact_static = 31 };

}  // namespace mobil::inline v0_3
