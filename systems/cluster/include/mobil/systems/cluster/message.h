#pragma once
// Messages between ranks and records on disk: bytes with a kind, a tick, a length and a checksum (the seal). Input is
// never trusted.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Content of a message: a tick's commands, numbers to reduce, a heartbeat, bytes, a shard, or a snapshot's index.
enum class MessageKind : std::uint32_t { commands = 1, numbers, beat, bytes, shard, index };

/// A message, valid as long as the bytes that it was read from.
struct Message {
  MessageKind kind = MessageKind::bytes;
  std::uint32_t tick = 0;
  std::span<const std::byte> bytes{};
};

/// Encodes a message for sending or storing. The first function reuses the memory of `out`.
void seal_message(const Message& message, std::vector<std::byte>& out);
std::vector<std::byte> seal_message(const Message& message);
/// Decodes the first message of `in` and removes it from `in`. Errors, with `in` unchanged: too few bytes
/// (Status::missing), altered bytes, bytes that are not a message of this version.
Result<Message> take_message(std::span<const std::byte>& in);
/// Decodes the only message of `in`. Errors: those of take_message, further bytes, another kind.
Result<Message> open_message(std::span<const std::byte> in, MessageKind kind);

}  // namespace mobil::inline v0_3
