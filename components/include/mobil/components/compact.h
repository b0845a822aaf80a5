#pragma once
// Unseen walkers in their smallest moving representation: without pose, with their leg muscles in their own row. They
// lack Pose and everything computed from it.

namespace mobil::inline v0_3 {

/// Run-time sized column with entries for each moving muscle, in the table's order, right before left. An entry is its
/// line's elongation L − L₀ at the end of the last tick, m; then X and W of each of its modes, as in ModalState.
struct CompactState {};
/// Run-time sized column: sizes of the leg (LegScale); then for each moving muscle the part of its line's rest length
/// that no joint changes, m, and a, b and g of each mode, as in ModalMotion. Both sides are alike.
struct CompactMotion {};
/// Tag: state of each muscle in the person's options (Shared<LegMuscles>), in the table's order, five bits a muscle
/// from the lowest bit on. A value is a CompactMuscle or the number of modes.
struct CompactMuscles {};
enum CompactMuscle : unsigned { compact_none = 0, compact_static = 31 };

}  // namespace mobil::inline v0_3
