// Rollback: two peers simulate the same two hundred people. One receives inputs six ticks late, repeats the ticks and
// then has the other's state bit for bit. A third peer joins with a snapshot, which includes the game's own component.

#include <cmath>
#include <cstdio>
#include <vector>

#include <mobil/host_parts.h>
#include <mobil/simulation.h>
#include <mobil/snapshot_file.h>

namespace {

template <class F>
struct Score {
  mobil::UInt32<F> points;
};

constexpr std::uint32_t late_ticks = 6;

/// Applies the input of a tick: every twentieth tick a person turns.
void apply_input(mobil::Simulation& simulation, const std::vector<mobil::Entity>& people, std::uint32_t tick) {
  if (tick % 20 == 5) (void)simulation.turn_to(people[tick * 7 % people.size()], std::sin(static_cast<float>(tick)));
}

}  // namespace

int main() {
  const mobil::SimulationOptions options{.modules = {{.name = "game", .parts = {mobil::component_id<Score>()}}}};
  mobil::Simulation server(options), client(options), joiner(options);
  std::vector<mobil::Entity> people(200);
  std::vector<mobil::SpawnRequest> asked(people.size());
  for (std::size_t i = 0; i < asked.size(); ++i) asked[i].x_m = static_cast<float>(i);
  for (mobil::Simulation* const peer : {&server, &client}) {
    if (!peer->spawn(asked, people)) return 2;  // the same handles on both
    peer->parts().add(people[3], Score<float>{7});
  }

  mobil::Rollback window(late_ticks + 1);
  std::vector<std::uint64_t> truth;
  int rollbacks = 0, desyncs = 0;
  for (std::uint32_t tick = 0; tick < 200; ++tick) {
    apply_input(server, people, tick);
    server.tick();
    truth.push_back(server.state_hash());
    if (!window.keep(client)) return 2;
    client.tick();  // without the input, which has not arrived
    if (tick % 20 != 5 + late_ticks) continue;
    if (const auto done = window.back(client, late_ticks + 1); !done) {
      std::fprintf(stderr, "%s\n", done.error().message.c_str());
      return 2;
    }
    for (std::uint32_t again = tick - late_ticks; again <= tick; ++again) {
      apply_input(client, people, again);
      if (!window.keep(client)) return 2;
      client.tick();
    }
    ++rollbacks;
    if (client.state_hash() != truth[tick]) ++desyncs;
  }
  std::vector<std::byte> bytes(server.snapshot_bytes());
  if (!server.save(bytes) || !joiner.restore(bytes)) return 2;
  const bool joined = joiner.state_hash() == server.state_hash() && joiner.get<Score>(people[3])->points == 7;
  std::printf("%d rollbacks of %u ticks, %d desyncs; the joined peer has %s\n", rollbacks, late_ticks + 1, desyncs,
              joined ? "the same state" : "a different state");
  return rollbacks > 5 && desyncs == 0 && joined ? 0 : 1;
}
