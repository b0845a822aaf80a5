// A game loop of forty lines: one man walks, his leg muscles deform, and the loop reads his pose.

#include <cstdio>

#include <mobil/simulation.h>

int main() {
  mobil::Simulation simulation;

  mobil::BodyRequest body;
  body.height_m = 1.80F;
  body.mass_kg = 80;
  body.constitution = mobil::Constitution::athletic;
  mobil::GaitRequest gait;
  gait.speed_m_s = 5 / 3.6F;

  const auto person = simulation.spawn(body, gait);
  if (!person) {
    std::fprintf(stderr, "%s\n", person.error().message.c_str());
    return 2;
  }
  // An effect is a component: without this line muscles cost nothing.
  if (const auto added = simulation.set_muscles(*person); !added) {
    std::fprintf(stderr, "%s\n", added.error().message.c_str());
    return 2;
  }

  for (int frame = 0; frame < 90; ++frame) {
    const auto advance = simulation.advance(1.0 / 30);  // as many fixed ticks of 1/60 s as fit
    if (frame % 15 != 0) continue;
    const auto pose = simulation.get<mobil::Pose>(*person);
    const auto knee = simulation.get<mobil::JointAngles>(*person);
    const auto hamstrings = simulation.muscle(*person, mobil::Muscle::hamstrings, mobil::Side::right);
    const auto line = simulation.get<mobil::LineOfAction>(hamstrings);
    std::printf("%4.1f s  pelvis at z = %.2f m  right knee %4.1f deg  hamstrings %.1f mm from rest  (%u ticks)\n",
                simulation.time_s(), pose->position_m[0].z, knee->knee_flexion[mobil::Side::right] * 57.2958F,
                1000 * (line->length_m - line->rest_length_m), advance.count);
  }
}
