#include "demo/anatomy/real_figure.h"
#include "demo/program/commands.h"
#include "demo/walk/walk_command.h"

namespace mobil {

std::vector<Subcommand> crowd_commands() {
  return {walk_command(&real_figure), crowd_command(), city_command(),     town_command(),
          view_command(),             bake_command(),  schedule_command(), anatomy_command()};
}

}  // namespace mobil
