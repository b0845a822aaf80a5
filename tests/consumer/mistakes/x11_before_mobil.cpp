// SAYS: write #undef Status between its headers and those of mobil
#define Status int  // as X11/Xlib.h
#include <mobil/simulation.h>

int main() {
  mobil::Simulation simulation;
}
