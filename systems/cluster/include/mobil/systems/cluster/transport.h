#pragma once
// Transport of bytes between ranks, by MPI (mpi_transport.h) or within one process (local_transport.h).

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace mobil::inline v0_3 {

/// Channels of messages. Messages of different channels can overtake each other.
enum class Channel : int { commands, up, down, to_first, direct, beat };
inline constexpr int channel_count = 6;

/// One rank's access to the others. Used by one thread.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Index of this rank from 0, and the number of ranks.
  virtual int rank() const = 0;
  virtual int ranks() const = 0;
  /// Copies bytes and sends them without waiting for their arrival. Messages between two ranks in one channel arrive in
  /// order.
  virtual void send(int to, Channel channel, std::span<const std::byte> bytes) = 0;
  /// Receives the next bytes from that rank in that channel and reuses the memory of `bytes`. Returns false if none
  /// have arrived yet.
  virtual bool take(int from, Channel channel, std::vector<std::byte>& bytes) = 0;
  /// Ends all ranks. `line` is the reason and is printed once.
  [[noreturn]] virtual void stop(const std::string& line) = 0;
};

}  // namespace mobil::inline v0_3
