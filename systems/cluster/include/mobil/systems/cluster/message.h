#pragma once
// What ranks tell each other and what a run leaves on disk: bytes with a kind, a tick, a length and a seal. Nothing
// that comes in is trusted.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// What a message carries: a tick's commands, numbers to add up, a sign of life, bytes, a shard, a snapshot's index.
enum class MessageKind : std::uint32_t { commands = 1, numbers, beat, bytes, shard, index };

/// Good as long as the bytes it was read from.
struct Message {
  MessageKind kind = MessageKind::bytes;
  std::uint32_t tick = 0;
  std::span<const std::byte> bytes{};
};

/// The message as it travels and as it lies in files; into memory that is kept for the next one.
void seal_message(const Message& message, std::vector<std::byte>& out);
std::vector<std::byte> seal_message(const Message& message);
/// The first message of `in`, which then begins behind it. Errors, `in` staying as it is: too few bytes
/// (Status::missing); bytes that are no message of this version or that were altered.
Result<Message> take_message(std::span<const std::byte>& in);
/// The one message that `in` is. Errors: the same; more bytes than the message has; another kind.
Result<Message> open_message(std::span<const std::byte> in, MessageKind kind);

}  // namespace mobil::inline v0_3
