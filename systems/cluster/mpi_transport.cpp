#include <mobil/mpi_transport.h>

#include <cstdlib>
#include <string_view>

#ifdef MOBIL_HAS_MPI
#include <mpi.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <iterator>
#include <list>
#endif

namespace mobil::inline v0_3 {

bool started_as_rank() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    if (std::getenv(name) != nullptr) return true;
  return false;
}

bool first_by_environment() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"})
    if (const char* rank = std::getenv(name)) return std::string_view(rank) == "0";
  return true;
}

#ifdef MOBIL_HAS_MPI
namespace {

/// Maximum size of a piece, because MPI counts bytes in an int. The last piece of a message is shorter than this.
constexpr std::size_t piece_bytes = std::size_t{1} << 30;

class MpiTransport : public Transport {
 public:
  MpiTransport() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_dup(MPI_COMM_WORLD, &ranks_of_ours_);
    MPI_Comm_rank(ranks_of_ours_, &rank_);
    MPI_Comm_size(ranks_of_ours_, &ranks_);
    coming_.resize(static_cast<std::size_t>(ranks_) * channel_count);
  }
  /// Ends all ranks during an exception, because the others would wait for this rank.
  ~MpiTransport() override {
    if (std::uncaught_exceptions() > 0) stop("cluster: a rank ends by an exception");
    for (Sent& one : sent_) MPI_Waitall(static_cast<int>(one.pieces.size()), one.pieces.data(), MPI_STATUSES_IGNORE);
    // Receives remaining heartbeats, because some MPIs report unreceived messages.
    std::vector<std::byte> left;
    for (int from = 0; from < ranks_; ++from) {
      while (take(from, Channel::beat, left)) {
      }
    }
    MPI_Comm_free(&ranks_of_ours_);
    MPI_Finalize();
  }
  MpiTransport(const MpiTransport&) = delete;
  MpiTransport& operator=(const MpiTransport&) = delete;

  int rank() const override { return rank_; }
  int ranks() const override { return ranks_; }

  void send(int to, Channel channel, std::span<const std::byte> bytes) override {
    keep_what_arrived();
    if (spare_.empty()) spare_.emplace_back();
    sent_.splice(sent_.end(), spare_, spare_.begin());
    Sent& one = sent_.back();
    one.bytes.assign(bytes.begin(), bytes.end());
    one.pieces.clear();
    for (std::size_t at = 0; at <= bytes.size(); at += piece_bytes) {
      const auto count = static_cast<int>(std::min(piece_bytes, bytes.size() - at));
      MPI_Isend(one.bytes.data() + at, count, MPI_BYTE, to, static_cast<int>(channel), ranks_of_ours_,
                &one.pieces.emplace_back());
    }
  }

  /// Receives long messages in pieces over several calls, without waiting for the sender.
  bool take(int from, Channel channel, std::vector<std::byte>& bytes) override {
    Coming& coming = coming_[static_cast<std::size_t>(from) * channel_count + static_cast<std::size_t>(channel)];
    for (;;) {
      if (!coming.on_its_way) {
        int there = 0, count = 0;
        MPI_Message message;
        MPI_Status status;
        MPI_Improbe(from, static_cast<int>(channel), ranks_of_ours_, &there, &message, &status);
        if (there == 0) return false;
        MPI_Get_count(&status, MPI_BYTE, &count);
        coming.at = coming.bytes.size();
        coming.bytes.resize(coming.at + static_cast<std::size_t>(count));
        MPI_Imrecv(coming.bytes.data() + coming.at, count, MPI_BYTE, &message, &coming.request);
        coming.on_its_way = true;
      }
      int done = 0;
      MPI_Test(&coming.request, &done, MPI_STATUS_IGNORE);
      if (done == 0) return false;
      coming.on_its_way = false;
      if (coming.bytes.size() - coming.at == piece_bytes) continue;  // a further piece follows
      bytes.swap(coming.bytes);
      coming.bytes.clear();
      return true;
    }
  }

  [[noreturn]] void stop(const std::string& line) override {
    std::fprintf(stderr, "%s\n", line.c_str());
    std::fflush(nullptr);
    MPI_Abort(ranks_of_ours_, 2);
    std::_Exit(2);
  }

 private:
  struct Sent {
    std::vector<std::byte> bytes;
    std::vector<MPI_Request> pieces;
  };

  struct Coming {
    std::vector<std::byte> bytes;
    std::size_t at = 0;  // start of the piece in transit
    MPI_Request request = MPI_REQUEST_NULL;
    bool on_its_way = false;
  };

  /// Reuses buffers of sent messages, because new pages cost more than copying into them.
  void keep_what_arrived() {
    for (auto one = sent_.begin(); one != sent_.end();) {
      int done = 0;
      MPI_Testall(static_cast<int>(one->pieces.size()), one->pieces.data(), &done, MPI_STATUSES_IGNORE);
      const auto next = std::next(one);
      if (done != 0) spare_.splice(spare_.end(), sent_, one);
      one = next;
    }
  }

  MPI_Comm ranks_of_ours_ = MPI_COMM_NULL;
  int rank_ = 0, ranks_ = 1;
  std::list<Sent> sent_, spare_;
  std::vector<Coming> coming_;  // by sender and channel
};

}  // namespace

Result<std::unique_ptr<Transport>> mpi_transport() {
  return std::make_unique<MpiTransport>();
}
#else
Result<std::unique_ptr<Transport>> mpi_transport() {
  return fail("this mobil was built without MPI; install libopenmpi-dev, configure again (cmake), and build");
}
#endif

}  // namespace mobil::inline v0_3
