#include <mobil/shard_bytes.h>

#include <array>
#include <cstdint>

namespace mobil::inline v0_3 {

Result<std::vector<std::byte>> pack_shard(const Simulation& simulation, const Relevance* relevance,
                                          std::span<const std::byte> host) {
  const std::size_t room = simulation.snapshot_bytes();
  const std::array<std::uint64_t, 3> sizes = {room, relevance != nullptr ? sizeof(RelevanceState) : 0, host.size()};
  std::vector<std::byte> bytes(sizeof sizes + sizes[0] + sizes[1] + sizes[2]);
  std::byte* at = bytes.data();
  std::memcpy(at, sizes.data(), sizeof sizes);
  at += sizeof sizes;
  if (auto saved = simulation.save({at, room}); !saved) return tl::unexpected(saved.error());
  at += room;
  if (relevance != nullptr) {
    const RelevanceState state = relevance->state();
    std::memcpy(at, &state, sizeof state);
    at += sizeof state;
  }
  if (!host.empty()) std::memcpy(at, host.data(), host.size());
  return bytes;
}

Result<std::vector<std::byte>> unpack_shard(std::span<const std::byte> bytes, Simulation& simulation,
                                            Relevance* relevance) {
  static_assert(std::is_trivially_copyable_v<RelevanceState>);
  PlainReader reader(bytes);
  std::array<std::uint64_t, 3> sizes{};
  reader.take(sizes);
  const auto snapshot = reader.take_many<std::byte>(static_cast<std::size_t>(sizes[0]));
  RelevanceState state;
  if (relevance != nullptr) reader.take(state);
  auto host = reader.take_many<std::byte>(static_cast<std::size_t>(sizes[2]));
  if (!reader.whole() || sizes[1] != (relevance != nullptr ? sizeof state : 0))
    return fail("a shard's bytes do not agree with themselves, or are of a shard that is made otherwise");
  if (auto done = simulation.restore(snapshot, RestoreLimits::none()); !done) return tl::unexpected(done.error());
  if (relevance != nullptr) relevance->set_state(state);
  return host;
}

}  // namespace mobil::inline v0_3
