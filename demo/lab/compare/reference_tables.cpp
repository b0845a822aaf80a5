#include "demo/lab/compare/reference_tables.h"

/// Includes a file of assets/reference in the program, from NAME_begin to NAME_end. CMake gives its place to the
/// assembler.
#define REFERENCE_TABLE(NAME)                                                                                     \
  asm(".pushsection .rodata\n" #NAME "_begin:\n.incbin \"" #NAME ".csv\"\n" #NAME "_end:\n.byte 0\n.popsection"); \
  extern "C" const char NAME##_begin[], NAME##_end[]

REFERENCE_TABLE(bovi2011_emg);
REFERENCE_TABLE(centre_of_mass_excursion);
REFERENCE_TABLE(fukuchi2017_running_angles);
REFERENCE_TABLE(fukuchi2017_running_grf);
REFERENCE_TABLE(fukuchi2017_running_hip_height);
REFERENCE_TABLE(fukuchi2017_running_moments);
REFERENCE_TABLE(fukuchi2017_running_spatiotemporal);
REFERENCE_TABLE(lencioni2019_steps);
REFERENCE_TABLE(muscle_lengths);
REFERENCE_TABLE(pinzone2014);
REFERENCE_TABLE(santuz_emg);
REFERENCE_TABLE(schwartz2008_angles);
REFERENCE_TABLE(schwartz2008_angles_extremes);
REFERENCE_TABLE(schwartz2008_grf);
REFERENCE_TABLE(schwartz2008_grf_extremes);
REFERENCE_TABLE(schwartz2008_moments_powers);
REFERENCE_TABLE(schwartz2008_moments_powers_extremes);
REFERENCE_TABLE(schwartz2008_spatiotemporal);
REFERENCE_TABLE(schwartz2008_spatiotemporal_extremes);

namespace mobil {
namespace {

#define REFERENCE_ROW(NAME)    \
  {                            \
#NAME ".csv", {            \
      NAME##_begin, NAME##_end \
    }                          \
  }

const ReferenceTable tables[] = {
    REFERENCE_ROW(bovi2011_emg),
    REFERENCE_ROW(centre_of_mass_excursion),
    REFERENCE_ROW(fukuchi2017_running_angles),
    REFERENCE_ROW(fukuchi2017_running_grf),
    REFERENCE_ROW(fukuchi2017_running_hip_height),
    REFERENCE_ROW(fukuchi2017_running_moments),
    REFERENCE_ROW(fukuchi2017_running_spatiotemporal),
    REFERENCE_ROW(lencioni2019_steps),
    REFERENCE_ROW(muscle_lengths),
    REFERENCE_ROW(pinzone2014),
    REFERENCE_ROW(santuz_emg),
    REFERENCE_ROW(schwartz2008_angles),
    REFERENCE_ROW(schwartz2008_angles_extremes),
    REFERENCE_ROW(schwartz2008_grf),
    REFERENCE_ROW(schwartz2008_grf_extremes),
    REFERENCE_ROW(schwartz2008_moments_powers),
    REFERENCE_ROW(schwartz2008_moments_powers_extremes),
    REFERENCE_ROW(schwartz2008_spatiotemporal),
    REFERENCE_ROW(schwartz2008_spatiotemporal_extremes),
};

}  // namespace

std::span<const ReferenceTable> reference_tables() {
  return tables;
}

}  // namespace mobil
