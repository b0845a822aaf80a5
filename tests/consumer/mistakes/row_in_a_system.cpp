// SAYS: a system takes blocks of sixteen
#include <mobil/schedule.h>
#include <mobil/simulation.h>

int main() {
  mobil::ScheduleBuilder systems;
  systems.add("mine", [](mobil::Pose<float>& pose) { pose.position_m[0].x = 0; });
}
