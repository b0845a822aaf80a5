#pragma once
// A modified snapshot with a valid seal, as an adversary would make it.

#include <cstddef>
#include <cstring>
#include <span>

#include "engine/snapshot_bytes.h"

namespace mobil {

/// Seals a snapshot again. Returns false if it does not have a snapshot's layout.
inline bool reseal_snapshot(std::span<std::byte> snapshot) {
  constexpr std::size_t parts_at = 32;  // front, world and blocks in the header
  SnapshotLayout layout;
  if (snapshot.size() < SnapshotLayout::header_bytes) return false;
  std::uint64_t part[3];
  std::memcpy(part, &snapshot[parts_at], sizeof part);
  for (const std::uint64_t bytes : part) {
    if (bytes > snapshot.size()) return false;
  }
  layout.front = part[0];
  layout.world = part[1];
  layout.blocks = part[2];
  if (layout.bytes() != snapshot.size()) return false;
  seal_snapshot(layout, snapshot, Jobs{}, nullptr, nullptr);
  return true;
}

}  // namespace mobil
