#include <mobil/shard_bytes.h>

#include <array>
#include <cstdint>

#include <mobil/systems/snapshot/restore_limits.h>

namespace mobil::inline v0_3 {

Result<std::vector<std::byte>> pack_shard(const Simulation& simulation, std::span<const std::byte> host) {
  const std::size_t room = simulation.snapshot_bytes();
  const std::array<std::uint64_t, 2> sizes = {room, host.size()};
  std::vector<std::byte> bytes(sizeof sizes + sizes[0] + sizes[1]);
  std::byte* at = bytes.data();
  std::memcpy(at, sizes.data(), sizeof sizes);
  at += sizeof sizes;
  if (auto saved = simulation.save({at, room}); !saved) return tl::unexpected(saved.error());
  at += room;
  if (!host.empty()) std::memcpy(at, host.data(), host.size());
  return bytes;
}

Result<std::vector<std::byte>> unpack_shard(std::span<const std::byte> bytes, Simulation& simulation) {
  PlainReader reader(bytes);
  std::array<std::uint64_t, 2> sizes{};
  reader.take(sizes);
  const auto snapshot = reader.take_many<std::byte>(static_cast<std::size_t>(sizes[0]));
  auto host = reader.take_many<std::byte>(static_cast<std::size_t>(sizes[1]));
  if (!reader.whole()) return fail("a shard's bytes do not agree with themselves");
  if (auto done = simulation.restore(snapshot, RestoreLimits::none()); !done) return tl::unexpected(done.error());
  return host;
}

}  // namespace mobil::inline v0_3
