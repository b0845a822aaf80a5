#include <mobil/systems/cluster/message.h>

#include <fmt/format.h>

#include <cstring>

#include "engine/row_hash.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::uint64_t magic = 0x6d6f62696c2d3031;  // "mobil-01"

struct Header {
  std::uint64_t magic;
  std::uint32_t kind, tick;
  std::uint64_t bytes, seal;
};

std::uint64_t seal_of(Header header, std::span<const std::byte> bytes) {
  header.seal = 0;
  return mix64(hash_bytes(&header, sizeof header) ^ mix64(hash_bytes(bytes.data(), bytes.size())));
}

}  // namespace

void seal_message(const Message& message, std::vector<std::byte>& out) {
  Header header{magic, static_cast<std::uint32_t>(message.kind), message.tick, message.bytes.size(), 0};
  header.seal = seal_of(header, message.bytes);
  out.resize(sizeof header + message.bytes.size());
  std::memcpy(out.data(), &header, sizeof header);
  if (!message.bytes.empty()) std::memcpy(out.data() + sizeof header, message.bytes.data(), message.bytes.size());
}

std::vector<std::byte> seal_message(const Message& message) {
  std::vector<std::byte> out;
  seal_message(message, out);
  return out;
}

Result<Message> take_message(std::span<const std::byte>& in) {
  Header header{};
  if (in.size() < sizeof header) return fail("a message was cut: its beginning is missing", Status::missing);
  std::memcpy(&header, in.data(), sizeof header);
  if (header.magic != magic) return fail("these bytes are no message of this version of mobil");
  const auto left = in.subspan(sizeof header);
  if (header.bytes > left.size())
    return fail(fmt::format("a message was cut: {} of its {} bytes are there", left.size(), header.bytes),
                Status::missing);
  const auto bytes = left.first(static_cast<std::size_t>(header.bytes));
  if (header.seal != seal_of(header, bytes)) return fail("a message was altered on its way: its seal does not fit");
  in = left.subspan(bytes.size());
  return Message{static_cast<MessageKind>(header.kind), header.tick, bytes};
}

Result<Message> open_message(std::span<const std::byte> in, MessageKind kind) {
  auto message = take_message(in);
  if (!message) return message;
  if (!in.empty()) return fail(fmt::format("{} bytes too many lie behind a message", in.size()));
  if (message->kind != kind)
    return fail(fmt::format("a message of kind {} came where one of kind {} was due",
                            static_cast<std::uint32_t>(message->kind), static_cast<std::uint32_t>(kind)));
  return message;
}

}  // namespace mobil::inline v0_3
