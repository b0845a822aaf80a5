#pragma once
// Bones and muscles of the legs of people near the camera; as bytes too, because another rank may draw them.

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/engine/error.h>
#include <mobil/simulation.h>
#include "demo/walk/figure.h"

namespace mobil {

class CrowdLegs {
 public:
  /// One frame, as the person now is; good until asked for that number again. Errors: what make_figure refuses;
  /// somebody who has left.
  Result<const WalkRecording*> of(const Simulation& simulation, Entity person, std::uint64_t number);
  /// Lets go of the surfaces of who had this number.
  void forget(std::uint64_t number) { shown_.erase(number); }

 private:
  struct Shown {
    Figure figure;
    WalkRecording recording;
  };
  std::map<std::uint64_t, Shown> shown_;
};

/// The first frame, its bones and muscles; and taken out again, where another rank packed them. Errors: bytes that do
/// not agree with themselves.
std::vector<std::byte> pack_legs(const WalkRecording& legs);
Result<WalkRecording> unpack_legs(std::span<const std::byte> bytes);

}  // namespace mobil
