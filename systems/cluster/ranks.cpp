#include <mobil/systems/cluster/ranks.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <utility>

namespace mobil::inline v0_3 {
namespace {

using Steady = std::chrono::steady_clock;

// A waiting rank first polls, then yields the processor between polls, then sleeps as well. A sleep of 20 us takes 100
// us or more with coarse timers, and long messages need both sides to poll.
constexpr int looks_at_once = 200;
constexpr double before_naps_s = 2e-3;
constexpr auto nap = std::chrono::microseconds(20);
constexpr std::uint32_t beat_ticks = 16;

double seconds_since(Steady::time_point then) {
  return std::chrono::duration<double>(Steady::now() - then).count();
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

}  // namespace

/// Finds the children in a binomial tree with the first rank at its root.
Ranks::Ranks(Transport& transport, double silence_s)
    : transport_(transport), silence_s_(silence_s), said_(Steady::now()) {
  heard_.resize(static_cast<std::size_t>(count()), {0, Steady::now()});
  for (int step = 1; (rank() & step) == 0 && rank() + step < count(); step <<= 1) children_.push_back(rank() + step);
}

void Ranks::stop(const std::string& line) {
  transport_.stop(line);
  std::abort();
}

void Ranks::post(int to, Channel channel, const Message& message) {
  seal_message(message, out_);
  bytes_sent_ += out_.size();
  transport_.send(to, channel, out_);
}

/// Forwards the received message.
void Ranks::hand_on(int to, Channel channel) {
  bytes_sent_ += in_.size();
  transport_.send(to, channel, in_);
}

/// Waits for a message. It is valid until the next call.
Message Ranks::wait(int from, Channel channel, MessageKind kind) {
  const auto start = Steady::now();
  for (int looks = 0;; ++looks) {
    if (transport_.take(from, channel, in_)) {
      if (looks > 0) waited_s_ += seconds_since(start);
      return opened(in_, kind, from);
    }
    if (looks < looks_at_once) continue;
    const double waiting_s = seconds_since(start);
    if (waiting_s < before_naps_s) {
      std::this_thread::yield();
      continue;
    }
    alive();
    listen();
    look_for_silence(waiting_s, from);
    std::this_thread::sleep_for(nap);
  }
}

Message Ranks::opened(std::span<const std::byte> sealed, MessageKind kind, int from) {
  const auto message = open_message(sealed, kind);
  if (!message) stop(fmt::format("cluster: from rank {}: {}", from, message.error().message));
  return *message;
}

void Ranks::reduce(std::span<std::uint64_t> values, Operation operation) {
  for (const int child : children_) {
    const Message message = wait(child, Channel::up, MessageKind::numbers);
    if (message.bytes.size() != values.size_bytes())
      stop(fmt::format("cluster: rank {} shares {} bytes of numbers where {} are due", child, message.bytes.size(),
                       values.size_bytes()));
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::uint64_t value = 0;
      std::memcpy(&value, &message.bytes[i * sizeof value], sizeof value);
      values[i] = operation == Operation::sum ? values[i] + value : std::max(values[i], value);
    }
  }
  const Message own{MessageKind::numbers, tick_, std::as_bytes(values)};
  if (!first()) post(parent(), Channel::up, own);
  const Message all = hand_down(own, Channel::down);
  if (all.bytes.size() != values.size_bytes()) stop("cluster: the ranks do not share the same numbers");
  if (!first()) std::memcpy(values.data(), all.bytes.data(), all.bytes.size());
}

void Ranks::sum(std::span<std::uint64_t> values) {
  reduce(values, Operation::sum);
}

std::uint64_t Ranks::sum(std::uint64_t value) {
  reduce({&value, 1}, Operation::sum);
  return value;
}

std::uint64_t Ranks::most(std::uint64_t value) {
  reduce({&value, 1}, Operation::most);
  return value;
}

/// Sends the first rank's message down the tree.
Message Ranks::hand_down(const Message& message, Channel channel) {
  const Message all = first() ? message : wait(parent(), channel, message.kind);
  for (auto child = children_.rbegin(); child != children_.rend(); ++child)
    first() ? post(*child, channel, message) : hand_on(*child, channel);
  return all;
}

std::vector<std::byte> Ranks::share(std::span<const std::byte> bytes) {
  const Message message = hand_down({MessageKind::bytes, tick_, bytes}, Channel::down);
  return {message.bytes.begin(), message.bytes.end()};
}

std::vector<std::vector<std::byte>> Ranks::gather(std::span<const std::byte> bytes) {
  if (!first()) {
    post(0, Channel::to_first, {MessageKind::bytes, tick_, bytes});
    return {};
  }
  std::vector<std::vector<std::byte>> all{{bytes.begin(), bytes.end()}};
  for (int from = 1; from < count(); ++from) {
    const Message message = wait(from, Channel::to_first, MessageKind::bytes);
    all.emplace_back(message.bytes.begin(), message.bytes.end());
  }
  return all;
}

Result<void> Ranks::agree(const Result<void>& own) {
  const auto all = gather(bytes_of(own ? std::string() : own.error().message));
  std::string line;
  for (const auto& one : all) {
    if (!line.empty() || one.empty()) continue;
    line.assign(reinterpret_cast<const char*>(one.data()), one.size());
  }
  const auto agreed = share(bytes_of(line));
  if (agreed.empty()) return {};
  return fail(std::string(reinterpret_cast<const char*>(agreed.data()), agreed.size()));
}

void Ranks::send_commands(std::uint32_t tick, std::span<const std::byte> commands) {
  hand_down({MessageKind::commands, tick, commands}, Channel::commands);
}

std::span<const std::byte> Ranks::take_commands(std::uint32_t tick) {
  const Message message = hand_down({MessageKind::commands, tick, {}}, Channel::commands);
  if (message.tick != tick)
    stop(fmt::format("cluster: rank {} is at tick {}, and the commands are of tick {}", rank(), tick, message.tick));
  return message.bytes;
}

void Ranks::send(int to, std::span<const std::byte> bytes) {
  post(to, Channel::direct, {MessageKind::bytes, tick_, bytes});
}

std::vector<std::byte> Ranks::receive(int from) {
  const Message message = wait(from, Channel::direct, MessageKind::bytes);
  return {message.bytes.begin(), message.bytes.end()};
}

void Ranks::at_tick(std::uint32_t tick) {
  tick_ = tick;
  if (!std::exchange(within_ticks_, true)) {
    for (Heard& one : heard_) one = {tick, Steady::now()};
    say_alive();
  } else if (tick % beat_ticks == 0) {
    say_alive();
  }
  if (first() && tick % beat_ticks == 0) listen();
}

void Ranks::alive() {
  if (seconds_since(said_) > silence_s_ / 8) say_alive();
}

void Ranks::say_alive() {
  said_ = Steady::now();
  heard_[static_cast<std::size_t>(rank())] = {tick_, said_};
  if (!first()) post(0, Channel::beat, {MessageKind::beat, tick_, {}});
}

void Ranks::listen() {
  if (!first()) return;
  for (int from = 1; from < count(); ++from) {
    while (transport_.take(from, Channel::beat, beat_)) {
      const Message message = opened(beat_, MessageKind::beat, from);
      heard_[static_cast<std::size_t>(from)] = {message.tick, Steady::now()};
    }
  }
}

/// Stops all ranks if one has been silent for too long. The first rank receives all heartbeats and names the silent
/// rank. Others can detect only the first one, and wait 3 times longer, so that it can name another rank.
void Ranks::look_for_silence(double waiting_s, int from) {
  const double limit = limit_s();
  if (waiting_s < limit) return;
  if (first()) {
    const auto oldest = std::ranges::min_element(heard_, {}, &Heard::when);
    const double silent_s = seconds_since(oldest->when);
    if (silent_s < limit) return;  // all ranks are alive, and one of them works long
    stop(
        fmt::format("cluster: rank {} has been silent for {:.1f} s, since about tick {}; the run stops, --resume goes "
                    "on from the last snapshot",
                    oldest - heard_.begin(), silent_s, oldest->tick));
  }
  if (waiting_s > 3 * limit && from == 0)
    stop(
        fmt::format("cluster: rank 0 has been silent for {:.1f} s; the run stops, --resume goes on from the last "
                    "snapshot",
                    waiting_s));
}

}  // namespace mobil::inline v0_3
