#pragma once
// How bytes get from one rank to another: by MPI (mpi_transport.h), or within one process (local_transport.h).

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace mobil::inline v0_3 {

/// Messages of different channels may overtake each other.
enum class Channel : int { commands, up, down, to_first, direct, beat };
inline constexpr int channel_count = 6;

/// One rank's end. Used by one thread.
class Transport {
 public:
  virtual ~Transport() = default;

  /// This rank, from 0 on, and how many there are.
  virtual int rank() const = 0;
  virtual int ranks() const = 0;
  /// Copies bytes and does not wait until they have arrived. What one rank sends another in one channel arrives in that
  /// order.
  virtual void send(int to, Channel channel, std::span<const std::byte> bytes) = 0;
  /// The next bytes from that rank in that channel, into memory that is kept for the next ones; false where none have
  /// arrived yet.
  virtual bool take(int from, Channel channel, std::vector<std::byte>& bytes) = 0;
  /// Ends the work of all ranks. `line` says why, once.
  [[noreturn]] virtual void stop(const std::string& line) = 0;
};

}  // namespace mobil::inline v0_3
