#pragma once
// Bases that methods lack, made apart from the ticks. When one may be taken up follows from ticks, never from when it
// was done: a fixed time after it was first called for.

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include <mobil/systems/relevance/background.h>
#include "systems/muscles/belly_library.h"

namespace mobil::inline v0_3 {

class BasisOrders {
 public:
  explicit BasisOrders(const Background& background, std::uint32_t making_ticks)
      : background_(background), making_ticks_(making_ticks) {}

  /// Whether a belly of that size may have that choice of Method::reduced in this tick: its basis was prepared or
  /// loaded, or was called for long enough ago; it is in the library then, which waits for it where it is not done.
  /// Else it is ordered, where `order` says so.
  bool ready(BellyLibrary& library, Muscle muscle, const LegMuscles& choice, const BellyScale<float>& scale,
             std::uint32_t tick, bool order);

  /// All that were ordered, in that order: what choosing depends on.
  const OrderedBases& ordered() const { return ordered_; }
  void set_ordered(const OrderedBases& ordered) { ordered_ = ordered; }

 private:
  /// One that is made: whoever claims it first makes it.
  struct Work {
    Muscle muscle{};
    LegMuscles choice;
    BellyLibrary::BasisKey key{};
    std::atomic<int> stage{0};  // 0 waits, 1 is being made, 2 is done
    std::unique_ptr<Result<BellyLibrary::Basis>> made;

    void make();
  };

  static OrderedBasis name_of(Muscle muscle, const LegMuscles& choice, const BellyLibrary::BasisKey& key);
  void take_in(BellyLibrary& library, Muscle muscle, const LegMuscles& choice, const BellyLibrary::BasisKey& key);

  Background background_;
  std::uint32_t making_ticks_;
  OrderedBases ordered_;
  std::vector<std::shared_ptr<Work>> works_;
};

}  // namespace mobil::inline v0_3
