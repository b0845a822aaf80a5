#pragma once
// An effect of a muscle beside its method, as one value: the parts that it puts on the row, what these begin with, and
// its systems. Each has a file of its own here (line_motion_effect, inertia_effect) and a row in `muscle_effects`.

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

/// Values that rows begin with, by part: whole rows of components and fields. Of a part set twice the last holds.
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
  /// A part's words; null where it has none here: it keeps what the row has, or begins with zeros.
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

/// A muscle that begins with an effect. `entity` may be stale: then it has nothing of the effect yet.
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
  /// Its systems, and every part that it puts on rows.
  Module (*module)();
  bool (*wanted)(const MuscleKind& kind);
  /// The values that its parts begin with; those of a muscle that has them go on. It may set what drives the belly's
  /// end (EndDrive) too.
  void (*begin)(const EffectStart& start, RowValues& values);
  /// Appends the parts that a muscle of that kind has of it.
  void (*parts)(const MuscleKind& kind, std::vector<ComponentId>& parts);
};

std::span<const MuscleEffect> muscle_effects();

}  // namespace mobil::inline v0_3
