#pragma once
// An effect of a muscle, separate from its method: the components that it adds to the row, their initial values, and
// its systems. Each has its own file here (line_motion_effect, inertia_effect) and an entry in `muscle_effects`.

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include <mobil/components/leg_frames.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/components/pose.h>
#include <mobil/engine/module.h>
#include <mobil/engine/world.h>
#include <mobil/schedule.h>
#include "systems/deformation/method.h"
#include "systems/muscles/muscle_size.h"
#include "systems/muscles/pose_history.h"

namespace mobil::inline v0_3 {

/// Initial values of a row by component: complete components and fields. If one is set twice, the last value holds.
class RowValues {
 public:
  template <template <class> class C>
  void set(const C<float>& row) {
    set(type_id<C<float>>(), &row, sizeof(row) / 4);
  }
  template <class Tag>
  void set_field(std::span<const float> row) {
    if (!row.empty()) set(type_id<Tag>(), row.data(), row.size());
  }
  template <template <class> class C>
  std::optional<C<float>> get() const {
    const float* const words = find(type_id<C<float>>());
    if (words == nullptr) return std::nullopt;
    C<float> row;
    std::memcpy(&row, words, sizeof(row));
    return row;
  }
  /// Returns a component's words, or null if no value is set. The row then keeps its value, or starts with zeros.
  const float* find(std::uint64_t part) const;

 private:
  struct Value {
    std::uint64_t part;
    std::size_t first, words;
  };
  void set(std::uint64_t part, const void* words, std::size_t count);

  std::vector<Value> values_;
  std::vector<float> words_;
};

/// A muscle that gets an effect. A stale `entity` has no components of the effect yet.
struct EffectStart {
  const World& world;
  Entity entity, person;
  Side side;
  const MuscleKind& kind;
  const MuscleSize& size;
  const LineOfAction<float>& line;
  std::uint32_t tick;
  float tick_s;
  RecentPoses& recent;
};

struct MuscleEffect {
  /// Returns its systems and every component that it adds to rows.
  Module (*module)();
  bool (*wanted)(const MuscleKind& kind);
  /// Sets initial values of its components; a muscle that has them keeps its values. It can also set the drive of the
  /// belly's end (EndDrive).
  void (*begin)(const EffectStart& start, RowValues& values);
  /// Appends the effect's components for a muscle of that kind.
  void (*parts)(const MuscleKind& kind, std::vector<ComponentId>& parts);
};

std::span<const MuscleEffect> muscle_effects();

}  // namespace mobil::inline v0_3
