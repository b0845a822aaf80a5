#pragma once
// Makes missing modal bases in the background. A basis becomes usable a fixed number of ticks after its first request,
// independent of when it was finished.

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include <mobil/systems/lod/background.h>
#include "systems/bellies/belly_library.h"

namespace mobil::inline v0_3 {

class BasisOrders {
 public:
  /// Sets where ordered bases are made, and after how many ticks they become usable.
  void make_by(const Background& background, std::uint32_t making_ticks) {
    background_ = background;
    making_ticks_ = making_ticks;
  }

  /// Returns true if a belly of this size can use this choice of Method::modal in this tick. Its basis was then
  /// prepared or loaded, or was ordered long enough ago and is in the library; an unfinished basis is waited for.
  /// Otherwise orders the basis if `order` is set. `ordered` lists all orders in sequence; choices depend on it.
  bool ready(BellyLibrary& library, Muscle muscle, const LegMuscles& choice, const BellyScale<float>& scale,
             std::uint32_t tick, bool order, OrderedBases& ordered);

 private:
  /// A basis to make. The first thread that claims it makes it.
  struct Work {
    Muscle muscle{};
    LegMuscles choice;
    BellyLibrary::BasisKey key{};
    std::atomic<int> stage{0};  // 0 waiting, 1 being made, 2 done
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
