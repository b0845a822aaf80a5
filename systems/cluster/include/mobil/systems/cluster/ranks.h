#pragma once
// What ranks do together: they share numbers and bytes along a tree, and say now and then that they are alive. These
// are made of single messages, not of MPI's own operations on all ranks: while one waits here it naps instead of
// spinning (which takes half of a busy machine's time), and can say which rank it is that does not answer.

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
  /// `silence_s`: a rank that says nothing for so long within ticks stops the work of all; ten times as long before the
  /// first tick and after `between_ticks`; three times as long as either where it is the first rank, whom the others
  /// must not name too soon.
  explicit Ranks(Transport& transport, double silence_s = 60);

  /// This rank, from 0 on, and how many there are.
  int rank() const { return transport_.rank(); }
  int count() const { return transport_.ranks(); }
  /// The one that decides and writes what there is one of.
  bool first() const { return rank() == 0; }

  // All ranks call these, in the same order. What arrives cut or altered stops the work.

  /// Each value becomes the sum of all ranks' (modulo 2⁶⁴).
  void sum(std::span<std::uint64_t> values);
  std::uint64_t sum(std::uint64_t value);
  /// The largest.
  std::uint64_t most(std::uint64_t value);
  /// The first rank's bytes; what others hand over is ignored.
  std::vector<std::byte> share(std::span<const std::byte> bytes);
  /// At the first rank everybody's, by rank; nothing at others.
  std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes);
  /// Success if all ranks have it; else the error of the first that has one, which all then have.
  Result<void> agree(const Result<void>& own);

  /// The commands of a tick, handed on to all ranks; the first one does not wait for the others.
  void send_commands(std::uint32_t tick, std::span<const std::byte> commands);
  /// Good until the next call that waits for another rank.
  std::span<const std::byte> take_commands(std::uint32_t tick);
  /// From one to another, apart from all the rest.
  void send(int to, std::span<const std::byte> bytes);
  std::vector<std::byte> receive(int from);

  /// This rank has come to that tick.
  void at_tick(std::uint32_t tick);
  /// It works on: to be said between parts of what may take long.
  void alive();
  /// From here to the next tick something is done that may take long.
  void between_ticks() { within_ticks_ = false; }
  /// Ends the work of all ranks with that line.
  [[noreturn]] void stop(const std::string& line);

  /// Since the beginning: spent waiting for others, s; bytes sent.
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
  std::vector<std::byte> out_, in_, beat_;  // kept for their memory
  std::vector<int> children_;
  double waited_s_ = 0;
  std::uint64_t bytes_sent_ = 0;
};

}  // namespace mobil::inline v0_3
