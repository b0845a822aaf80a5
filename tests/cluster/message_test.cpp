#include <mobil/systems/cluster/message.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

namespace mobil {
namespace {

std::vector<std::byte> some_bytes() {
  const auto given = *rc::gen::arbitrary<std::vector<std::uint8_t>>();
  std::vector<std::byte> bytes;
  for (const std::uint8_t one : given) bytes.push_back(std::byte{one});
  return bytes;
}

RC_GTEST_PROP(Message, RoundTripKeepsTheBytes, ()) {
  const auto bytes = some_bytes();
  const auto tick = *rc::gen::arbitrary<std::uint32_t>();
  const auto sealed = seal_message({MessageKind::commands, tick, bytes});
  const auto message = open_message(sealed, MessageKind::commands);
  RC_ASSERT(message.has_value());
  RC_ASSERT(message->tick == tick);
  RC_ASSERT(std::vector<std::byte>(message->bytes.begin(), message->bytes.end()) == bytes);
}

RC_GTEST_PROP(Message, OneAlteredBitIsNoticed, ()) {
  auto sealed = seal_message({MessageKind::bytes, 7, some_bytes()});
  const auto at = *rc::gen::inRange<std::size_t>(0, sealed.size());
  sealed[at] ^= std::byte{static_cast<std::uint8_t>(1U << *rc::gen::inRange(0, 8))};
  RC_ASSERT(!open_message(sealed, MessageKind::bytes).has_value());
}

RC_GTEST_PROP(Message, EveryCutIsNoticed, ()) {
  const auto sealed = seal_message({MessageKind::bytes, 7, some_bytes()});
  const auto left = *rc::gen::inRange<std::size_t>(0, sealed.size());
  RC_ASSERT(!open_message(std::span(sealed).first(left), MessageKind::bytes).has_value());
}

RC_GTEST_PROP(Message, ForeignBytesAreRefused, ()) {
  const auto bytes = some_bytes();
  std::span<const std::byte> in = bytes;
  RC_ASSERT(!take_message(in).has_value());
  RC_ASSERT(in.size() == bytes.size());
}

TEST(Message, IsRefusedWhenAnotherKindIsExpected) {
  const auto sealed = seal_message({MessageKind::beat, 3, {}});
  EXPECT_TRUE(open_message(sealed, MessageKind::beat));
  EXPECT_FALSE(open_message(sealed, MessageKind::commands));
}

TEST(Message, SeveralAreReadInSequence) {
  auto all = seal_message({MessageKind::commands, 1, {}});
  const auto second = seal_message({MessageKind::commands, 2, all});
  all.insert(all.end(), second.begin(), second.end());
  std::span<const std::byte> in = all;
  EXPECT_EQ(take_message(in)->tick, 1U);
  EXPECT_EQ(take_message(in)->tick, 2U);
  EXPECT_TRUE(in.empty());
}

}  // namespace
}  // namespace mobil
