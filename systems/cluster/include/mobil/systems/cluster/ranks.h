#pragma once
// Collective operations of ranks: they share numbers and bytes along a tree and send heartbeats. They are built from
// single messages instead of MPI's collectives. A waiting rank therefore sleeps instead of spinning, which would take
// half the time of a busy machine, and it can name a rank that does not respond.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/systems/cluster/message.h>
#include <mobil/systems/cluster/transport.h>

namespace mobil::inline v0_3 {

class Ranks {
 public:
  /// `silence_s` is the time without a heartbeat after which a rank within ticks stops all ranks. The limit is 10 times
  /// longer before the first tick and after `between_ticks`. For the first rank both are 3 times longer, so that the
  /// others do not name it too early.
  explicit Ranks(Transport& transport, double silence_s = 60);

  /// Index of this rank from 0, and the number of ranks.
  int rank() const { return transport_.rank(); }
  int count() const { return transport_.ranks(); }
  /// True for the rank that decides, and writes everything that exists once.
  bool first() const { return rank() == 0; }

  // All ranks must call these in the same order. A truncated or altered message stops all ranks.

  /// Replaces each value by the sum over all ranks (modulo 2⁶⁴).
  void sum(std::span<std::uint64_t> values);
  std::uint64_t sum(std::uint64_t value);
  /// Returns the maximum over all ranks.
  std::uint64_t most(std::uint64_t value);
  /// Returns the first rank's bytes. Those of other ranks are ignored.
  std::vector<std::byte> share(std::span<const std::byte> bytes);
  /// Returns the bytes of all ranks, by rank, at the first rank; nothing at others.
  std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes);
  /// Returns success if all ranks succeeded, or the error of the first rank that failed, the same at all ranks.
  Result<void> agree(const Result<void>& own);

  /// Sends the commands of a tick from the first rank to all others, without waiting for them.
  void send_commands(std::uint32_t tick, std::span<const std::byte> commands);
  /// Receives the commands of a tick. Valid until the next call that waits for another rank.
  std::span<const std::byte> take_commands(std::uint32_t tick);
  /// Send and receive bytes between two ranks, independent of all other messages.
  void send(int to, std::span<const std::byte> bytes);
  std::vector<std::byte> receive(int from);

  /// Marks the start of a tick of this rank.
  void at_tick(std::uint32_t tick);
  /// Sends a heartbeat if one is due. Call it between parts of long work.
  void alive();
  /// Announces work until the next tick that can take long.
  void between_ticks() { within_ticks_ = false; }
  /// Ends all ranks with that message.
  [[noreturn]] void stop(const std::string& line);

  /// Time spent waiting for other ranks since the start, s, and bytes sent.
  double waited_s() const { return waited_s_; }
  std::uint64_t bytes_sent() const { return bytes_sent_; }

 private:
  enum class Operation { sum, most };
  struct Heard {
    std::uint32_t tick = 0;
    std::chrono::steady_clock::time_point when;
  };

  void reduce(std::span<std::uint64_t> values, Operation operation);
  Message hand_down(const Message& message, Channel channel);
  void post(int to, Channel channel, const Message& message);
  void hand_on(int to, Channel channel);
  Message wait(int from, Channel channel, MessageKind kind);
  Message opened(std::span<const std::byte> sealed, MessageKind kind, int from);
  void say_alive();
  void listen();
  void look_for_silence(double waiting_s, int from);
  double limit_s() const { return within_ticks_ ? silence_s_ : 10 * silence_s_; }
  int parent() const { return rank() & (rank() - 1); }

  Transport& transport_;
  double silence_s_;
  bool within_ticks_ = false;
  std::uint32_t tick_ = 0;
  std::chrono::steady_clock::time_point said_;
  std::vector<Heard> heard_;                // by rank; at the first rank
  std::vector<std::byte> out_, in_, beat_;  // buffers, reused
  std::vector<int> children_;
  double waited_s_ = 0;
  std::uint64_t bytes_sent_ = 0;
};

}  // namespace mobil::inline v0_3
