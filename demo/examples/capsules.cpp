// Capsules driven by walkers: a game moves each capsule by the root motion of its person in the frame. A wall stops
// some of them, and their people are placed at their capsules. Footsteps are reported with their exact time, and people
// who reach a door are moved elsewhere.
//
// Prints footsteps, and exits with 1 if a capsule is in the wall or away from its person, or if footsteps are missing.

#include <cmath>
#include <cstdio>
#include <vector>

#include <mobil/simulation.h>
#include <mobil/systems/people/step_event.h>
#include <mobil/systems/poses/roots.h>

namespace {

constexpr double frame_s = 1.0 / 50, wall_z_m = 6, door_z_m = 8, radius_m = 0.3;

/// Returns the capsule moved by a root's motion, up to the wall.
mobil::Root pushed(const mobil::Root& capsule, const mobil::RootMotion& by) {
  mobil::Root to = moved(capsule, by);
  const bool wall_ahead = capsule.x_m < 1.5;  // the others walk past it
  if (wall_ahead && to.z_m > wall_z_m - radius_m) to.z_m = wall_z_m - radius_m;
  return to;
}

double apart(const mobil::Root& a, const mobil::Root& b) {
  return std::hypot(a.x_m - b.x_m, a.z_m - b.z_m);
}

/// Returns a request that moves a person's root to `to`. It sets the walking line, whose offset from the root is kept.
mobil::PlaceRequest under(const mobil::Simulation& simulation, mobil::Entity person, const mobil::Root& root,
                          const mobil::Root& to) {
  const auto state = *simulation.get<mobil::GaitState>(person);
  const mobil::Root line{state.line_x_m, state.line_z_m, root.heading_rad};
  const mobil::Root there = moved(to, root_motion(root, line));
  return {person, static_cast<float>(there.x_m), static_cast<float>(there.z_m),
          state.heading_rad + to.heading_rad - root.heading_rad};
}

}  // namespace

int main() {
  mobil::Simulation simulation;
  std::vector<mobil::SpawnRequest> requests(4);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    requests[i].gait.speed_m_s = 1.1F + 0.15F * static_cast<float>(i);
    requests[i].x_m = static_cast<float>(i);
  }
  std::vector<mobil::Entity> people(requests.size());
  if (!simulation.spawn(requests, people) || !simulation.enable(people, mobil::Feature::step_events)) return 2;

  std::vector<mobil::Root> before(people.size()), after(people.size()), capsules(people.size());
  std::vector<mobil::PlaceRequest> placed;
  simulation.roots(people, capsules);
  double alpha_s = 0, worst_m = 0;
  int heard = 0, through_the_door = 0;
  for (int frame = 0; frame < 400; ++frame) {
    simulation.roots(people, before, alpha_s);
    const mobil::Ticks ticks = simulation.advance(frame_s);
    alpha_s = ticks.alpha * simulation.tick_s();
    for (const mobil::StepEvent& event : simulation.events()) {
      if (event.kind != mobil::StepEventKind::heel_strike) continue;
      const double at_s = (event.tick - 1 + static_cast<double>(event.part)) * simulation.tick_s();
      if (++heard % 16 == 1)
        std::printf("%.4f s: walker %u, %s heel, at x = %5.2f m, z = %5.2f m\n", at_s, event.person.index,
                    event.side == mobil::Side::right ? "right" : "left ", static_cast<double>(event.place_m.x),
                    static_cast<double>(event.place_m.z));
    }
    simulation.roots(people, after, alpha_s);
    placed.clear();
    for (std::size_t i = 0; i < people.size(); ++i) {
      capsules[i] = pushed(capsules[i], root_motion(before[i], after[i]));
      if (capsules[i].z_m > door_z_m) {
        capsules[i].z_m -= door_z_m;
        ++through_the_door;
      }
      if (apart(capsules[i], after[i]) > 1e-3) placed.push_back(under(simulation, people[i], after[i], capsules[i]));
    }
    if (!simulation.place(placed)) return 2;
    simulation.roots(people, after, alpha_s);
    for (std::size_t i = 0; i < people.size(); ++i) worst_m = std::fmax(worst_m, apart(capsules[i], after[i]));
    if (capsules[0].z_m > wall_z_m - radius_m + 1e-9 || capsules[1].z_m > wall_z_m - radius_m + 1e-9) return 1;
  }
  std::printf("%d footsteps, %d times through the door; capsules within %.2f mm of their people\n", heard,
              through_the_door, 1e3 * worst_m);
  return worst_m < 5e-3 && heard > 40 && through_the_door == 2 ? 0 : 1;
}
