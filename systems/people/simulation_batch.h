#pragma once
// People and muscles on their way into a simulation: all of them come, or none.

#include <algorithm>
#include <span>
#include <vector>

#include "systems/muscles/change_muscles.h"
#include "systems/simulation.h"

namespace mobil {

/// What a batch has done so far is undone unless it is `done`.
class Simulation::Batch {
 public:
  Batch(Simulation& of, std::size_t room) : of_(of) { made.reserve(room); }
  ~Batch() {
    if (done) return;
    for (const Entity entity : made) {
      if (of_.people_.find(entity) != nullptr) of_.people_.remove(entity);
    }
    of_.world_.undo_create(made);
    of_.work_->recent = {};  // others will have these handles
    std::fill(entities.begin(), entities.end(), Entity{});
  }
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  std::vector<Entity> made;      // people and muscles as they came; there is room for all that will
  std::span<Entity> entities{};  // the caller's
  bool done = false;

 private:
  Simulation& of_;
};

}  // namespace mobil
