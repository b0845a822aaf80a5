#include <mobil/systems/cluster/shard.h>

#include "engine/row_hash.h"

namespace mobil::inline v0_3 {

std::uint32_t shard_of(std::uint64_t number, std::uint32_t shards) {
  return static_cast<std::uint32_t>(mix64(number) % shards);
}

}  // namespace mobil::inline v0_3
