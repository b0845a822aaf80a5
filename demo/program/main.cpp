// `mobil`, `mobil-crowd` and `mobil-lab`, the command-line interface of the library.
// Exit status: 0 done, or the reader of stdout has gone (`| head`); 1 a bound did not hold, or requested output
// could not be written; 2 bad usage or input (one line on stderr with cause and remedy).

#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/program.h"

int main(int argc, char** argv) {
  mobil::prepare_streams();
  return mobil::output_status(mobil::run_own(MOBIL_NAME, mobil::MOBIL_COMMANDS(), argc, argv));
}
