#include "systems/lod/basis_orders.h"

#include <algorithm>
#include <new>
#include <span>
#include <utility>

#include <mobil/engine/jobs.h>
#include "systems/bellies/leg_muscles_io.h"

namespace mobil::inline v0_3 {

void BasisOrders::Work::make() {
  int waits = 0;
  if (!stage.compare_exchange_strong(waits, 1)) return;
  try {
    made = std::make_unique<Result<BellyLibrary::Basis>>(BellyLibrary::make_basis(muscle, choice, key));
  } catch (...) {
    stage = 0;  // another thread can try
    stage.notify_all();
    throw;
  }
  stage = 2;
  stage.notify_all();
}

OrderedBasis BasisOrders::name_of(Muscle muscle, const LegMuscles& choice, const BellyLibrary::BasisKey& key) {
  return {hash_of(basis_choice(choice, muscle)),
          static_cast<float>(key.ratio),
          static_cast<float>(key.product),
          static_cast<std::uint16_t>(muscle),
          static_cast<std::uint16_t>(choice.modal.cells[2]),
          0};
}

bool BasisOrders::ready(BellyLibrary& library, Muscle muscle, const LegMuscles& choice, const BellyScale<float>& scale,
                        std::uint32_t tick, bool order, OrderedBases& ordered) {
  const auto across = static_cast<double>(scale.across), along = static_cast<double>(scale.along);
  const BellyLibrary::BasisKey key = BellyLibrary::basis_key(choice, muscle, across / along, across * along);
  if (const auto* const found = library.find_basis(muscle, choice, key); found != nullptr && found->given) return true;
  OrderedBasis name = name_of(muscle, choice, key);
  const auto same = [&](const OrderedBasis& other) {
    name.ready_tick = other.ready_tick;
    return name == other;
  };
  const std::span before(ordered.one.data(), ordered.count);
  if (const auto at = std::ranges::find_if(before, same); at != before.end()) {
    if (tick < at->ready_tick) return false;
    take_in(library, muscle, choice, key);
    return true;
  }
  if (ordered.count == ordered.one.size()) return true;
  if (!order) return false;
  name.ready_tick = tick + making_ticks_;
  ordered.one[ordered.count++] = name;
  if (library.find_basis(muscle, choice, key) != nullptr) return false;  // already made, but not usable before its tick
  auto work = std::make_shared<Work>();
  work->muscle = muscle;
  work->choice = choice;
  work->key = key;
  works_.push_back(work);
  background_.run(
      background_.user,
      [](void* argument) {
        const std::unique_ptr<std::shared_ptr<Work>> held(static_cast<std::shared_ptr<Work>*>(argument));
        const FloatMode mode;
        try {
          (*held)->make();
        } catch (const std::bad_alloc&) {  // the tick that needs the basis makes it
        }
      },
      new std::shared_ptr<Work>(work));
  return false;
}

/// Adds a finished basis, made here if no thread has started it. A request for the belly reports its error.
void BasisOrders::take_in(BellyLibrary& library, Muscle muscle, const LegMuscles& choice,
                          const BellyLibrary::BasisKey& key) {
  const auto is = [&](const std::shared_ptr<Work>& work) {
    return name_of(work->muscle, work->choice, work->key) == name_of(muscle, choice, key);
  };
  const auto at = std::ranges::find_if(works_, is);
  if (at == works_.end()) return;
  while ((*at)->stage != 2) {
    (*at)->make();
    (*at)->stage.wait(1);
  }
  if (*(*at)->made && library.find_basis(muscle, choice, key) == nullptr)
    library.bases_.push_back(std::move(**(*at)->made));
  works_.erase(at);
}

}  // namespace mobil::inline v0_3
