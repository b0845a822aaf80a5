#pragma once
// Excitation of the leg's muscles by phase and speed, from measured EMG and from the moments of walks.

#include <string>

namespace mobil {

/// Curves as source, fitted by least squares, and their quality, a line for each muscle.
struct ExcitationFit {
  std::string source, quality;
};

/// Fits the measured muscles to bovi2011_emg.csv, and all other lines to their excitation in walks of the reference
/// body whose muscles make its moments (ExcitationSource::moments). Takes some seconds.
ExcitationFit fit_excitation();

}  // namespace mobil
