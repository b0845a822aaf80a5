#pragma once
// Measured excitations of leg muscles as sums of harmonics: assets/muscles/excitation_curves.h.

#include <string>

#include <mobil/engine/error.h>

namespace mobil {

/// The curves as source, fitted by least squares to bovi2011_emg.csv; and how near they are, a line a muscle and speed.
struct ExcitationFit {
  std::string source, quality;
};
Result<ExcitationFit> fit_excitation();

}  // namespace mobil
