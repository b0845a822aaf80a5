#pragma once
// `mobil muscle --activation LEVEL`: one real muscle of somebody who stands, excited and let go.

#include <filesystem>
#include <string>

#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>

namespace mobil {

struct ContractionRequest {
  Muscle muscle{};
  float level = 0;     // excitation, 0 to 1
  double seconds = 1;  // excited from a tenth of it to six tenths
  std::filesystem::path out;
};

/// As typed. Fails, naming the option, on a muscle that is none of the table's, a level outside 0 to 1, seconds outside
/// 0.05 to 60.
Result<ContractionRequest> read_contraction(const std::string& level, const std::string& muscle,
                                            const std::string& seconds, const std::string& out);

/// The CSV, a row a tick of 1/480 s, and its story in a few lines.
struct Contraction {
  std::string csv, summary;
};
Result<Contraction> contract_muscle(const ContractionRequest& request);

}  // namespace mobil
