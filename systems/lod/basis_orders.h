#pragma once
// Bases that methods lack, made apart from the ticks. When one may be taken up follows from ticks, never from when it
// was done: a fixed time after it was first called for.

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include <mobil/systems/lod/background.h>
#include "systems/bellies/belly_library.h"

namespace mobil::inline v0_3 {

class BasisOrders {
 public:
  /// Where what is called for later is made, and after how many ticks it may be taken.
  void make_by(const Background& background, std::uint32_t making_ticks) {
    background_ = background;
    making_ticks_ = making_ticks;
  }

  /// Whether a belly of that size may have that choice of Method::reduced in this tick: its basis was prepared or
  /// loaded, or was called for long enough ago; it is in the library then, which waits for it where it is not done.
  /// Else it is ordered, where `order` says so. `ordered`: all that were, in that order: what choosing depends on.
  bool ready(BellyLibrary& library, Muscle muscle, const LegMuscles& choice, const BellyScale<float>& scale,
             std::uint32_t tick, bool order, OrderedBases& ordered);

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
  std::uint32_t making_ticks_ = 0;
  std::vector<std::shared_ptr<Work>> works_;
};

}  // namespace mobil::inline v0_3
