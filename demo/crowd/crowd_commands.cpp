#include "demo/program/commands.h"

namespace mobil {

std::vector<Subcommand> crowd_commands() {
  return {crowd_command(), city_command(),     town_command(),   view_command(),
          bake_command(),  schedule_command(), anatomy_command()};
}

}  // namespace mobil
