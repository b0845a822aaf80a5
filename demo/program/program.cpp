#include "demo/program/program.h"

#include "demo/program/commands.h"
#include "demo/program/named_entries.h"
#include "demo/program/progress.h"

namespace mobil {

Program mobil_program() {
  Program program = {
      .name = "mobil",
      .about =
          "mobil: crowds of virtual humans who walk, and whose muscles deform as they do.\n"
          "Body and gait parameters go in; a walking skeleton, its lines of action, finite-element muscles and "
          "anatomical\n"
          "surfaces come out. Quantities are SI or carry a unit: 180cm, 5km/h, 110steps/min.",
      .version = MOBIL_VERSION,
      .footer = "Example: mobil walk --height 1.80 --mass 80 --speed 5km/h --video --out out",
      .options = {{"--quiet", &quiet, "Say nothing of progress and of what was written; errors stay"}},
      .commands = {walk_command(), muscle_command(), body_command(), anatomy_command(), bench_command(),
                   compare_command(), stress_command(), paper_command(), frontier_command(), effects_command(),
                   schedule_command(), crowd_command(), town_command(), view_command(), bake_command(),
                   gait_fit_command(), completion_command()}};
  program.commands.push_back(man_command(names_of(program.commands)));
  return program;
}

}  // namespace mobil
