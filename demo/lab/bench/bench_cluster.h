#pragma once
// What ranks cost: a model of a crowd on many of them, after LogGP (Alexandrov, Ionescu, Schauser, Scheiman 1995),
// whose parameters are measured.

namespace mobil {

/// Times in s, of messages between two ranks and of a tick's work.
struct ClusterModel {
  // Latency is none of them: the first rank is ahead, and nobody waits for a single message.
  double overhead = 0;  // o: that a rank spends on sending a message
  double per_byte = 0;  // G: more for each byte of a long one
  double person = 0;    // of one awake walker, a tick
  double command = 0;   // of the first rank's host, for one command
  // As people do in `mobil crowd`: each is asked for something so often a tick, and a command has so many bytes.
  double commands_a_person = 0, bytes_a_command = 0;
};

/// A tick of so many people on so many ranks, s. People are spread by chance, so the fullest rank has about
/// √(2 ln ranks · people / ranks) more than the mean; where there are fewer cores than ranks, these take turns.
struct ClusterTick {
  double work = 0;    // of the fullest rank
  double serial = 0;  // of the first rank, while nobody else can go on: commands, and sending them down the tree
  double all() const { return work + serial; }
};
ClusterTick predict(const ClusterModel& model, double people, int ranks, int cores);
/// The most people whose tick takes no longer than that.
double people_within(const ClusterModel& model, double tick_s, int ranks, int cores);

}  // namespace mobil
